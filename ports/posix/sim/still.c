/* SPDX-License-Identifier: MIT */
#include "still.h"

#include "codes.h"

#define TWO_PI  6.283185307179586
#define SPARE_N 1e-9
#define SPARE   1.00001 /* exp is no better than 1e-12, and times are differences */

static double size_of(double v) { return v < 0 ? -v : v; }

static int friction_holds(const struct plant *p, const struct sim_device *d, double ref_A)
{
    const double T = d->cable_npm * (p->x_m - p->q_m);
    return T > 0 && size_of(d->mass_kg * SIM_GRAVITY - T) < d->mu_mass * T - SPARE_N &&
           size_of(T - d->kf_npa * ref_A) < d->coulomb_n + d->mu_motor * T - SPARE_N;
}

/* As plant.c has it, a share of each is left behind a step; what the current adds to the monitor is
 * the rest at most. */
static int currents_settled(
    const struct plant *p, const struct sim_device *d, double ref_A, double longest_s)
{
    const double keep_cur = sim_exp_neg(TWO_PI * d->current_hz * longest_s);
    const double keep_mon = d->mon_lag_s > 0 ? sim_exp_neg(longest_s / d->mon_lag_s) : 0;
    const double off_A = p->cur_A - ref_A;
    return size_of(off_A) < 1e-12 && ref_A + off_A * keep_cur == p->cur_A &&
           ref_A + (p->mon_A - ref_A) * keep_mon == p->mon_A &&
           p->mon_A + off_A * (1 - keep_mon) == p->mon_A;
}

int sim_mass_still(const struct sim_mass *m, double longest_s)
{
    const struct plant *p = &m->plant;
    return !m->benched && m->fall.phase == FALL_FREE && m->fall.contact_s >= 0 && p->v_mps == 0 &&
           p->w_mps == 0 && m->latched_A == m->ref_A && friction_holds(p, &m->device, m->ref_A) &&
           currents_settled(p, &m->device, m->ref_A, SPARE * longest_s);
}

int sim_mass_pass(struct sim_mass *m, double until_s)
{
    if (fall_next_s(&m->fall) <= until_s) { return 0; }
    m->now_s = until_s;
    return 1;
}

void sim_mass_monitor(const struct sim_mass *m, int16_t *low_raw, int16_t *high_raw)
{
    const double half_A = m->device.mon_noise_a / 2;
    *low_raw = sim_monitor_code(&m->device, m->plant.mon_A - half_A);
    *high_raw = sim_monitor_code(&m->device, m->plant.mon_A + half_A);
}
