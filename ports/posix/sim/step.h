/* SPDX-License-Identifier: MIT */
/* Step: one sub-step of the plant, for one plant or for plants side by side. Internal. */
#ifndef SIM_STEP_H
#define SIM_STEP_H

#include "plant.h"

/* Dry friction may take up to `most` off a velocity, never turn it. A sub-step waits for each of
 * its operations, but not for a predicted branch; plants side by side (STEP_LANES) have none. */
static inline double shrink(double v, double most)
{
#ifdef STEP_LANES
    const double taken = v < most ? v : most;
    return v - (taken > -most ? taken : -most);
#else
    if (!(v <= most)) { return v - most; } /* also if it is no number */
    return v < -most ? v + most : 0;
#endif
}

static inline void step_current(struct plant *p, const struct plant_piece *s, double ref_A)
{
    const double off_A = p->cur_A - ref_A;
    p->mon_A = ref_A + (p->mon_A - ref_A) * s->keep_mon + off_A * s->cur_to_mon;
    p->cur_A = ref_A + off_A * s->keep_cur;
}

static inline double tension(const struct sim_device *d, double stretch_m, double opening_mps)
{
    const double T = d->cable_npm * stretch_m + d->cable_nspm * opening_mps;
    const double pull_N = T > 0 ? T : 0;
    return stretch_m < 0 ? 0 : pull_N;
}

/* hand NULL: no hand, and the mass has its weight; t_s: the middle of the step. */
__attribute__((always_inline)) static inline void step_string(struct plant *p,
    const struct sim_device *d, const struct plant_piece *s, double ref_A,
    const struct plant_hand *hand, double t_s)
{
    const double x = p->x_m + s->half_s * p->v_mps, q = p->q_m + s->half_s * p->w_mps;
    const double pull_N = d->kf_npa * (ref_A + (p->cur_A - ref_A) * s->mean_cur);
    double push_N = d->mass_kg * SIM_GRAVITY, T = tension(d, x - q, p->v_mps - p->w_mps), v, w;
    if (hand) {
        push_N = hand->k_Npm * (hand->x_m + t_s * hand->v_mps - x) + hand->b_Nspm * hand->v_mps;
    }
    v = shrink((p->v_mps + s->half_mass * (push_N - T)) * s->damp_mass, s->rub_half * T);
    w = shrink((p->w_mps + s->half_rotor * (T - pull_N)) * s->damp_rotor,
        s->half_rotor * (d->coulomb_n + d->mu_motor * T));
    T = tension(d, x - q, v - w);
    if (hand) { push_N -= hand->b_Nspm * v; }
    p->v_mps = shrink(p->v_mps + s->h_mass * (push_N - T), s->rub_mass * T);
    p->w_mps = shrink(p->w_mps + s->h_rotor * (T - pull_N - d->viscous_nspm * w),
        s->h_rotor * (d->coulomb_n + d->mu_motor * T));
    p->x_m = x + s->half_s * p->v_mps;
    p->q_m = q + s->half_s * p->w_mps;
}

#endif
