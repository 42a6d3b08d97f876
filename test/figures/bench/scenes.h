/* SPDX-License-Identifier: MIT */
/* The scenes as they are shipped beside the same in double, float and long double, at any rate. */
#ifndef BENCH_SCENES_H
#define BENCH_SCENES_H

#include "bench.h"

#include "pipe.h"

#include "bilateral/bilateral.h"
#include "glove/glove.h"
#include "guarded/guarded.h"

enum { FIXED, DOUBLE, FLOAT, WAYS };
extern const char *const scenes_way[WAYS];

/* Runs one scene at a rate for so many seconds of it; prints scene,rate,way,quantity,unit,max,rms.
 */
void scenes_wall(const char *name, uint32_t rate_Hz, double seconds); /* minimal, drop, guarded */
void scenes_hand(const char *name, uint32_t rate_Hz, double seconds); /* glove, bilateral */

/* Ops of one tick: the scene's own, or the same in double or float, at 2 kHz and in contact. */
void scenes_wall_setup(const char *name);
void scenes_hand_setup(const char *name);
extern void (*const scenes_wall_op[WAYS])(uint32_t i);
extern void (*const scenes_hand_op[WAYS])(uint32_t i);

/* The paper's gains at a rate; above 2 kHz those of 2 kHz. */
void scenes_gains(uint32_t rate_Hz, int32_t *k_Npm, int32_t *b_Nspm);

/* One quantity of a run. */
struct scenes_sum {
    struct error way[WAYS];
};
void scenes_print(const char *scene, uint32_t rate_Hz, const char *quantity, const char *unit,
    const struct scenes_sum *sum);

/* Of the minimal scene, whose parts are private. */
int32_t minimal_force_N_q20(void);
void minimal_par(struct pipe_wall_par *p, long double *lim_m);
void minimal_now(struct pipe_wall_now *now);
extern const struct exh_scene exh_scene_minimal;

#endif
