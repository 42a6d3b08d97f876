/* SPDX-License-Identifier: MIT */
/* Method: ways to integrate the simulator's plant (sim/plant.h), to be compared with the one it
 * has.
 *
 * The same equations for all, and the lags of current and monitor exact in all. Euler's two treat
 * friction as the simulator does, as an impulse that only shrinks a velocity. Midpoint and RK4 hold
 * its direction, and whether a body is stuck, for a step; a velocity that has turned within it and
 * would stick is zero then. Slackness is looked at in every stage, and located by the exact flow
 * alone.
 */
#ifndef BENCH_METHOD_H
#define BENCH_METHOD_H

#include "sim/plant.h"

enum method {
    METHOD_EXPLICIT, /* Euler: positions by the old speeds */
    METHOD_SEMI,     /* Euler: positions by the new speeds */
    METHOD_LEAPFROG, /* half a step, forces, half a step; sim/plant.c itself */
    METHOD_MIDPOINT, /* implicit, its two velocities solved for */
    METHOD_RK4,      /* the classical one */
    METHOD_FLOW,     /* e^(At) of each mode, changes of mode located */
    METHODS,
    METHOD_REFERENCE = METHODS /* the flow in 113 bits */
};
extern const char *const method_name[METHODS];

/* As plant_advance_hand(), or, hand being NULL, plant_advance(); by steps of at most d->substep_s.
 * The flow needs a hand with a fixed target, and ignores the ends of a finger's way. */
void method_advance(enum method m, struct plant *p, const struct sim_device *d, double dt_s,
    double ref_A, const struct plant_hand *hand);

/* So many steps; times are differences of sums: a millionth over one is none. */
static inline int method_steps(const struct sim_device *d, double dt_s)
{
    return (int)(0.999999 * dt_s / d->substep_s) + 1;
}

/* Nothing but the current moves: by any method the same. */
void leapfrog_hold(struct plant *p, const struct sim_device *d, double dt_s, double ref_A);

/* Each has a separate source: sim/plant.c, flow_body.h twice. */
void leapfrog_advance(struct plant *p, const struct sim_device *d, double dt_s, double ref_A,
    const struct plant_hand *hand);
void semi_advance(struct plant *p, const struct sim_device *d, double dt_s, double ref_A,
    const struct plant_hand *hand);
void flow_advance(struct plant *p, const struct sim_device *d, double dt_s, double ref_A,
    const struct plant_hand *hand);
void wide_advance(struct plant *p, const struct sim_device *d, double dt_s, double ref_A,
    const struct plant_hand *hand);

#endif
