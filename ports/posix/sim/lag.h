/* SPDX-License-Identifier: MIT */
/* Lag: a first-order low-pass behind an input that is known in closed form, so its
 * output is too: nothing is integrated, at no time step.
 *
 *   x(s) = c0 + c1 s + … + c5 s^5 + amp sin(omega s + phase),   s = t - start
 *   tau y' = x - y
 *
 * A held value, a line between two rows of a recording, a minimum-jerk movement and a sine
 * are all such inputs. + - x / only: the same digits on every machine.
 */
#ifndef SIM_LAG_H
#define SIM_LAG_H

#define SIM_CURVE_TERMS 6

struct sim_curve {
    double start_s;
    double c[SIM_CURVE_TERMS];
    double amp, omega_radps, phase_rad;
};

struct sim_lag {
    double tau_s;              /* 0: none */
    struct sim_curve x;        /* the input */
    double p[SIM_CURVE_TERMS]; /* what y runs after, of the polynomial, */
    int terms;                 /* up to its last that is not 0; of a line 2 */
    double off;                /* y less that, at the start */
};

/* A polynomial's terms up to the last that is not 0, at least one; and its value by them. */
static inline int sim_poly_terms(const double c[SIM_CURVE_TERMS])
{
    int n = SIM_CURVE_TERMS;
    while (n > 1 && c[n - 1] == 0) { n--; }
    return n;
}

static inline double sim_poly(const double c[SIM_CURVE_TERMS], int terms, double s)
{
    double v = c[SIM_CURVE_TERMS - 1];
    if (terms == 1) { return c[0]; }
    for (int k = SIM_CURVE_TERMS - 2; k >= 0; k--) { v = v * s + c[k]; }
    return v;
}

/* The input at t_s. */
double sim_curve_at(const struct sim_curve *x, double t_s);

/* Settled at x. */
void sim_lag_start(struct sim_lag *l, double tau_s, double x);

/* From x->start_s on, the input is x; the output goes on from where it is then. */
void sim_lag_follow(struct sim_lag *l, const struct sim_curve *x);

/* What the output runs after: the particular solution, which for a polynomial is
 * x - tau x' + tau^2 x'' - …, and for the sine the sine, smaller and later. */
double sim_lag_sine(const struct sim_lag *l, double s);
static inline double sim_lag_target(const struct sim_lag *l, double s)
{
    const double v = sim_poly(l->p, l->terms, s);
    return l->x.amp != 0 ? v + sim_lag_sine(l, s) : v;
}

/* The output at t_s >= start. */
double sim_lag_at(const struct sim_lag *l, double t_s);

/* e^-(s / tau_s) for s >= 0 of sim_grid_s(), as it was last worked out for one of two lengths. left
 * 0: for none yet, since s may be 0. Of one tau. */
struct sim_decay {
    double s[2], left[2];
};
double sim_decay_at(struct sim_decay *d, double tau_s, double s);

/* 1: the output does not change any more. */
static inline int sim_lag_rests(const struct sim_lag *l)
{
    return l->off == 0 && l->terms == 1 && l->x.amp == 0;
}

/* The same output as sim_lag_at(). left: what is left of e^-(t / tau). */
static inline double sim_lag_left(const struct sim_lag *l, double t_s, double left)
{
    return sim_lag_target(l, t_s - l->x.start_s) + l->off * left;
}

/* From a straight line, or from rest, on to another line, as sim_lag_follow() does; tau is not 0.
 * Without a branch, since the rest of x is 0. */
struct sim_line {
    double start_s, at, slope;
};
static inline void sim_lag_line(struct sim_lag *l, const struct sim_line *x, double left)
{
    const double s = x->start_s - l->x.start_s, y = l->p[1] * s + l->p[0] + l->off * left;
    l->x.start_s = x->start_s;
    l->x.c[0] = x->at;
    l->x.c[1] = l->p[1] = x->slope;
    l->p[0] = x->at - l->tau_s * x->slope;
    l->terms = 2;
    l->off = y - l->p[0];
}

/* Sine and cosine from + - x; |x| < 1e6; error < 1e-15 + 1e-16 |x|. */
double sim_sin(double x);
double sim_cos(double x);

#endif
