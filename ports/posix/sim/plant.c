#include "plant.h"

#define TWO_PI 6.283185307179586

double sim_exp_neg(double x)
{
    /* e^-x = e^-k (e^-f/4)^4, k whole, f < 1; Pade (5,5) on f/4. */
    const int k = x < 700 ? (int)x : 700;
    const double f = (x - k) / 4;
    const double even = 30240 + f * f * (3360 + 30 * f * f);
    const double odd = f * (15120 + f * f * (420 + f * f));
    double e = (even - odd) / (even + odd);
    double power = 0.36787944117144233; /* e^-1 */
    if (x > 700) { return 0; }
    e *= e;
    e *= e;
    for (int n = k; n > 0; n /= 2) {
        if (n % 2) { e *= power; }
        power *= power;
    }
    return e;
}

/* Dry friction may take up to `most` off a velocity, never turn it. */
static double shrink(double v, double most)
{
    return v > most ? v - most : v < -most ? v + most : 0;
}

void plant_advance(struct plant *p, const struct sim_device *d, double dt_s, double ref_A,
                   int held)
{
    const int n = (int)(dt_s / d->substep_s) + 1;
    const double h = dt_s / n;
    const double keep_cur = sim_exp_neg(TWO_PI * d->current_hz * h);
    const double keep_mon = d->mon_lag_s > 0 ? sim_exp_neg(h / d->mon_lag_s) : 0;
    const double h_mass = h / d->mass_kg;
    const double h_rotor = h / d->rotor_kg;
    const double viscous = 1 / (1 + h_rotor * d->viscous_nspm); /* implicit */

    for (int i = 0; i < n; i++) {
        p->cur_A = ref_A + (p->cur_A - ref_A) * keep_cur;
        p->mon_A = p->cur_A + (p->mon_A - p->cur_A) * keep_mon;
        if (!held) {
            const double stretch = p->x_m - p->q_m;
            double T = d->cable_npm * stretch + d->cable_nspm * (p->v_mps - p->w_mps);
            if (stretch < 0 || T < 0) { T = 0; }
            p->v_mps = shrink(p->v_mps + h * SIM_GRAVITY - h_mass * T, h_mass * d->mu_mass * T);
            p->w_mps = shrink((p->w_mps + h_rotor * (T - d->kf_npa * p->cur_A)) * viscous,
                              h_rotor * (d->coulomb_n + d->mu_motor * T));
            p->x_m += h * p->v_mps;
            p->q_m += h * p->w_mps;
        }
    }
}
