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
    double p[SIM_CURVE_TERMS]; /* what y runs after, of the polynomial */
    double off;                /* y less that, at the start */
};

/* The input at t_s. */
double sim_curve_at(const struct sim_curve *x, double t_s);

/* Settled at x. */
void sim_lag_start(struct sim_lag *l, double tau_s, double x);

/* From x->start_s on, the input is x; the output goes on from where it is then. */
void sim_lag_follow(struct sim_lag *l, const struct sim_curve *x);

/* The output at t_s >= start. */
double sim_lag_at(const struct sim_lag *l, double t_s);

/* Sine and cosine from + - x; |x| < 1e6; error < 1e-15 + 1e-16 |x|. */
double sim_sin(double x);
double sim_cos(double x);

#endif
