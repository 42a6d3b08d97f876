#include "plant.h"

#define TWO_PI 6.283185307179586

double sim_exp_neg(double x)
{
    /* e^-x = (e^-x/2^n)^(2^n), Pade (3,3) on x/2^n <= 1/16. */
    int n = 0;
    double e;
    if (x > 700) { return 0; }
    while (x > 0.0625) {
        x *= 0.5;
        n++;
    }
    e = (120 - x * (60 - x * (12 - x))) / (120 + x * (60 + x * (12 + x)));
    while (n-- > 0) { e *= e; }
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
