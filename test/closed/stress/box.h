/* SPDX-License-Identifier: MIT */
/* Stress: the box as docs/SAFETY.md and NUMERICS.md describe it, written once more and in another
 * way: no table, no triggers. What the library does in a tick must be what this says. */
#ifndef STRESS_BOX_H
#define STRESS_BOX_H

#include "exhand/safety.h"
#include "exhand/motion.h"

enum box_gate { BOX_SHUT, BOX_OPEN, BOX_FALLS };

struct box {
    int state; /* enum exh_state */
    uint32_t faults, present;
    unsigned late, opened;
    uint64_t armed, ramped, gone; /* ticks in ARM, in its ramp, in RELEASE */
    uint64_t calm;                /* ticks in a row, up to the last, with a small force command */
    uint64_t fast, still;         /* ticks in a row beyond the speed limit; pulled without count */
    int32_t cnt;
    int32_t held, from; /* force of the last tick; when the release began */
    int32_t off;        /* code of the last tick, from dac_zero */
    int limited;        /* a limit acted in the last tick, PULL aside */
};

/* in ticks */
struct box_times {
    uint64_t arm, ramp, release, fast, still;
    int64_t share; /* of 2^30 a tick of the ramp */
    int late_most;
    int32_t small_N_q20;
};

struct box_times box_times(
    const struct exh_safety_par *par, const struct exh_motion_par *watch, struct exh_period T);

/* One tick; raised: causes that the box gets, `ready` as in struct exh_safety_in. */
enum box_gate box_step(struct box *b, const struct box_times *t, const struct exh_safety_in *in);
/* Of 2^30: how much of the force limit counts. */
int64_t box_share(const struct box *b, const struct box_times *t);

#endif
