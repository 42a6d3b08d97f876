/* SPDX-License-Identifier: MIT */
/* Semi-implicit Euler, friction as an impulse, current at the end of a step: what the simulator had
 * before. */
#include "method.h"

#include <stddef.h>

#define TWO_PI 6.283185307179586

/* Dry friction may take up to `most` off a velocity, never turn it. */
static double shrink(double v, double most)
{
    return v > most ? v - most : v < -most ? v + most : 0;
}

/* What stays the same from sub-step to sub-step of h_s. */
struct step {
    double h_s, ref_A, kf_npa;
    double keep_cur, keep_mon;
    double h_mass, h_rotor; /* of a force, the change of speed */
    double viscous;         /* implicit */
};

static struct step step_of(const struct sim_device *d, double h_s, double ref_A)
{
    struct step s;
    s.h_s = h_s;
    s.ref_A = ref_A;
    s.kf_npa = d->kf_npa;
    s.keep_cur = sim_exp_neg(TWO_PI * d->current_hz * h_s);
    s.keep_mon = d->mon_lag_s > 0 ? sim_exp_neg(h_s / d->mon_lag_s) : 0;
    s.h_mass = h_s / d->mass_kg;
    s.h_rotor = h_s / d->rotor_kg;
    s.viscous = 1 / (1 + s.h_rotor * d->viscous_nspm);
    return s;
}

static void step_current(struct plant *p, const struct step *s)
{
    p->cur_A = s->ref_A + (p->cur_A - s->ref_A) * s->keep_cur;
    p->mon_A = p->cur_A + (p->mon_A - p->cur_A) * s->keep_mon;
}

/* push_mps: the speed that a force other than the string's adds to the mass. damp: the share of it
 * that this force's own damping leaves (implicit). */
static inline void step_string(
    struct plant *p, const struct sim_device *d, const struct step *s, double push_mps, double damp)
{
    const double stretch = p->x_m - p->q_m;
    double T = d->cable_npm * stretch + d->cable_nspm * (p->v_mps - p->w_mps);
    if (stretch < 0 || T < 0) { T = 0; }
    p->v_mps = shrink((p->v_mps + push_mps - s->h_mass * T) * damp, s->h_mass * d->mu_mass * T);
    p->w_mps = shrink((p->w_mps + s->h_rotor * (T - s->kf_npa * p->cur_A)) * s->viscous,
        s->h_rotor * (d->coulomb_n + d->mu_motor * T));
    p->x_m += s->h_s * p->v_mps;
    p->q_m += s->h_s * p->w_mps;
}

void semi_advance(struct plant *p, const struct sim_device *d, double dt_s, double ref_A,
    const struct plant_hand *hand)
{
    const int n = method_steps(d, dt_s);
    const struct step s = step_of(d, dt_s / n, ref_A);
    const double damp = hand ? 1 / (1 + s.h_mass * hand->b_Nspm) : 1;
    for (int i = 0; i < n; i++) {
        double push_mps = s.h_s * SIM_GRAVITY;
        if (hand) {
            const double ahead_m = hand->x_m + (i + 1) * s.h_s * hand->v_mps - p->x_m;
            push_mps = s.h_mass * (hand->k_Npm * ahead_m + hand->b_Nspm * hand->v_mps);
        }
        step_current(p, &s);
        step_string(p, d, &s, push_mps, damp);
    }
}
