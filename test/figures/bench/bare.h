/* SPDX-License-Identifier: MIT */
/* Bare integer code: the least that does the same sum as exactly, as one would write it for one
 * device: no ledger, no hysteresis, no limits of what its inputs may be. */
#ifndef BENCH_BARE_H
#define BENCH_BARE_H

#include <stdint.h>

/* The contact law: contact test, F0 by the velocity's sign, one sum rounded once, clamp. N, q20, of
 * m, q30, and m/s, q27. */
struct bare_law {
    int32_t k_q10, b_q20, f0_q20, lim_q30, f_max_q20;
};
int32_t bare_law(const struct bare_law *p, int32_t pos_q30, int32_t vel_q27);

/* --- velocity out of counts: m/s, q27 --- */

struct bare_scale {
    int32_t gain; /* m/s q27 of a count a tick, times 2^shift */
    unsigned shift;
};

/* The difference to the last count, through a pole of 1 - 2^-n (0: none). */
struct bare_pole {
    struct bare_scale scale;
    unsigned n;
    int32_t v, last;
};
int32_t bare_pole(struct bare_pole *s, int32_t cnt);

/* Alpha-beta observer: position and velocity in counts and counts a tick, q32. */
struct bare_track {
    struct bare_scale scale;
    int32_t alpha_q31, beta_q31;
    int64_t pos, vel;
};
int32_t bare_track(struct bare_track *s, int32_t cnt);

#endif
