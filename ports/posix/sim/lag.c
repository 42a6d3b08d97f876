/* SPDX-License-Identifier: MIT */
#include "lag.h"

#include "grid.h"
#include "plant.h"

/* Behind so many tau less is left than 2.9e-20: of what is below 900 y, not half a last bit of y.
 */
#define SETTLED 45

/* pi/2 in two parts: the first has 33 bits, so that a multiple of it is exact. */
#define HALF_PI_HI 1.57079632673412561417
#define HALF_PI_LO 6.07710050650619224932e-11
#define TWO_BY_PI  0.63661977236758134308

/* Of an angle within +-pi/4: Taylor, the first term left out is below 1e-17. */
static double short_sin(double x)
{
    const double z = x * x;
    double sum = 0;
    for (int n = 17; n >= 3; n -= 2) { sum = (1 + sum) * -z / (n * (n - 1)); }
    return x + x * sum;
}

static double short_cos(double x)
{
    const double z = x * x;
    double sum = 0;
    for (int n = 18; n >= 2; n -= 2) { sum = (1 + sum) * -z / (n * (n - 1)); }
    return 1 + sum;
}

/* sin(x + quarter pi/2). */
static double turned_sin(double x, long quarter)
{
    const double turns = x * TWO_BY_PI;
    const long n = (long)(turns < 0 ? turns - 0.5 : turns + 0.5);
    const double rest = (x - (double)n * HALF_PI_HI) - (double)n * HALF_PI_LO;
    const long q = (n + quarter) & 3;
    const double v = q & 1 ? short_cos(rest) : short_sin(rest);
    return q & 2 ? -v : v;
}

double sim_sin(double x) { return turned_sin(x, 0); }

double sim_cos(double x) { return turned_sin(x, 1); }

double sim_curve_at(const struct sim_curve *x, double t_s)
{
    const double s = t_s - x->start_s;
    double v = sim_poly(x->c, SIM_CURVE_TERMS, s);
    if (x->amp != 0) { v += x->amp * sim_sin(x->omega_radps * s + x->phase_rad); }
    return v;
}

static double size_of(double v) { return v < 0 ? -v : v; }

__attribute__((noinline)) double sim_lag_sine(const struct sim_lag *l, double s)
{
    const double wt = l->x.omega_radps * l->tau_s;
    const double a = l->x.omega_radps * s + l->x.phase_rad;
    return l->x.amp / (1 + wt * wt) * (sim_sin(a) - wt * sim_cos(a));
}

void sim_lag_start(struct sim_lag *l, double tau_s, double x)
{
    const struct sim_lag none = {0};
    *l = none;
    l->tau_s = tau_s;
    l->x.c[0] = l->p[0] = x;
    l->terms = 1;
}

void sim_lag_follow(struct sim_lag *l, const struct sim_curve *x)
{
    const double y = sim_lag_at(l, x->start_s);
    double above = 0;
    l->x = *x;
    for (int k = SIM_CURVE_TERMS - 1; k >= 0; k--) {
        above = x->c[k] - l->tau_s * (k + 1) * above;
        l->p[k] = above;
    }
    l->terms = sim_poly_terms(l->p);
    l->off = l->tau_s > 0 ? y - sim_lag_target(l, 0) : 0;
}

double sim_lag_at(const struct sim_lag *l, double t_s)
{
    const double s = t_s - l->x.start_s;
    double y = sim_lag_target(l, s);
    if (l->off != 0 && !(s > SETTLED * l->tau_s && size_of(l->off) < 900 * size_of(y))) {
        y += l->off * sim_exp_neg(s / l->tau_s);
    }
    return y;
}

double sim_decay_at(struct sim_decay *d, double tau_s, double s)
{
    const unsigned at = sim_grid_slot(s, 2);
    if (d->s[at] != s || d->left[at] == 0) {
        d->s[at] = s;
        d->left[at] = sim_exp_neg(s / tau_s);
    }
    return d->left[at];
}
