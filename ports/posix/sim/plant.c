/* SPDX-License-Identifier: MIT */
#include "plant.h"

#include "step.h"

#include <stddef.h>

#define TWO_PI 6.283185307179586

double sim_exp_neg(double x)
{
    /* e^-x = e^-k (e^-f/4)^4, k whole, f < 1; Pade (5,5) on f/4. */
    const int k = x < 700 ? (int)x : 700;
    const double f = (x - k) / 4;
    double even, odd, e;
    double power = 0.36787944117144233; /* e^-1 */
    if (x > 700) { return 0; }
    even = 30240 + f * f * (3360 + 30 * f * f);
    odd = f * (15120 + f * f * (420 + f * f));
    e = (even - odd) / (even + odd);
    e *= e;
    e *= e;
    for (int n = k; n > 0; n /= 2) {
        if (n % 2) { e *= power; }
        power *= power;
    }
    return e;
}

/* What a deviation of the current adds to the monitor's: y (e^-x - e^-y) / (y - x). */
static double through(double x, double y, double keep_x, double keep_y)
{
    const double apart = y - x;
    if (apart < 1e-4 * y && apart > -1e-4 * y) { return y * sim_exp_neg((x + y) / 2); }
    return y * (keep_x - keep_y) / apart;
}

/* Times are differences of sums: a millionth over a step is none. */
static int steps_in(const struct sim_device *d, double dt_s)
{
    return (int)(0.999999 * dt_s / d->substep_s) + 1;
}

static struct plant_piece piece_of(const struct sim_device *d, double dt_s, int n, double hand_nspm)
{
    const double h_s = dt_s / n, x = TWO_PI * d->current_hz * h_s;
    struct plant_piece s;
    s.n = n;
    s.h_s = h_s;
    s.half_s = h_s / 2;
    s.keep_cur = s.cur_to_mon = sim_exp_neg(x);
    s.keep_mon = 0;
    if (d->mon_lag_s > 0) {
        s.keep_mon = sim_exp_neg(h_s / d->mon_lag_s);
        s.cur_to_mon = through(x, h_s / d->mon_lag_s, s.keep_cur, s.keep_mon);
    }
    s.mean_cur = (1 - s.keep_cur) / x;
    s.h_mass = h_s / d->mass_kg;
    s.h_rotor = h_s / d->rotor_kg;
    s.half_mass = s.h_mass / 2;
    s.half_rotor = s.h_rotor / 2;
    s.rub_mass = s.h_mass * d->mu_mass;
    s.rub_half = s.half_mass * d->mu_mass;
    s.damp_mass = 1 / (1 + s.h_mass / 2 * hand_nspm);
    s.damp_rotor = 1 / (1 + s.h_rotor / 2 * d->viscous_nspm);
    return s;
}

struct plant_piece plant_piece_of(const struct sim_device *d, double dt_s)
{
    return piece_of(d, dt_s, steps_in(d, dt_s), 0);
}

/* The rare sub-steps beyond the first, apart from it: inline they would take its registers. */
__attribute__((noinline)) static void more_steps(
    struct plant *p, const struct sim_device *d, const struct plant_piece *s, double ref_A)
{
    for (int i = 1; i < s->n; i++) {
        step_string(p, d, s, ref_A, NULL, 0);
        step_current(p, s, ref_A);
    }
}

void plant_advance_piece(
    struct plant *p, const struct sim_device *d, const struct plant_piece *s, double ref_A)
{
    step_string(p, d, s, ref_A, NULL, 0);
    step_current(p, s, ref_A);
    if (s->n > 1) { more_steps(p, d, s, ref_A); }
}

void plant_hold_piece(struct plant *p, const struct plant_piece *s, double ref_A)
{
    for (int i = 0; i < s->n; i++) { step_current(p, s, ref_A); }
}

__attribute__((noinline)) const struct plant_piece *plant_pieces_put(
    struct plant_pieces *c, unsigned at, const struct sim_device *d, double dt_s, double hand_nspm)
{
    c->dt_s[at] = dt_s;
    c->piece[at] = piece_of(d, dt_s, steps_in(d, dt_s), hand_nspm);
    return &c->piece[at];
}

void plant_advance(struct plant *p, const struct sim_device *d, double dt_s, double ref_A, int held)
{
    const struct plant_piece s = piece_of(d, dt_s, held ? 1 : steps_in(d, dt_s), 0);
    if (held) {
        plant_hold_piece(p, &s, ref_A);
    } else {
        plant_advance_piece(p, d, &s, ref_A);
    }
}

/* Stretch s of a taut string, friction with its motion: s'' = -w2 s - c s'. With g = 1 - h c / 2, a
 * step has determinant 1 - g h c and trace 2 - g h c - g h^2 w2. It is stable if h c < 2 and
 * g (h^2 w2 + 2 h c) < 4, so if h^2 w2 < 4 and h c < 2.
 * - Viscous friction and the hand's damping are implicit and stable at any step. But if one of them
 *   would stop its part within a step, dry friction is underestimated. */
static int step_ok(const struct sim_device *d, double hand_npm, double hand_nspm, double h_s)
{
    const double per_kg = (1 + d->mu_mass) / d->mass_kg + (1 + d->mu_motor) / d->rotor_kg;
    const double w2 = d->cable_npm * per_kg + hand_npm / d->mass_kg, c = d->cable_nspm * per_kg;
    const double twice_s = 2 * h_s;
    return twice_s * twice_s * w2 <= 4 && twice_s * c <= 2 && h_s * hand_nspm <= d->mass_kg &&
           h_s * d->viscous_nspm <= d->rotor_kg;
}

int plant_step_will_do(const struct sim_device *d, double hand_npm, double hand_nspm)
{
    return step_ok(d, hand_npm, hand_nspm, d->substep_s);
}

double plant_step_that_will_do(const struct sim_device *d, double hand_npm, double hand_nspm)
{
    static const double step_s[] = {
        1e-3, 5e-4, 2e-4, 1e-4, 5e-5, 2e-5, 1e-5, 5e-6, 2e-6, 1e-6, 5e-7, 2e-7, 1e-7};
    for (unsigned i = 0; i < sizeof step_s / sizeof step_s[0]; i++) {
        if (step_ok(d, hand_npm, hand_nspm, step_s[i])) { return step_s[i]; }
    }
    return 0;
}

int plant_take_step(struct sim_device *d, double hand_npm, double hand_nspm)
{
    const double enough_s = plant_step_that_will_do(d, hand_npm, hand_nspm);
    if (plant_step_will_do(d, hand_npm, hand_nspm)) { return 0; }
    if (enough_s == 0 || d->substep_s != sim_device_default().substep_s) { return -1; }
    d->substep_s = enough_s;
    return 0;
}

static inline void stop(double *x_m, double *v_mps, double end_m)
{
    if (*x_m >= end_m) { return; }
    *x_m = end_m;
    if (*v_mps < 0) { *v_mps = 0; }
}

static inline void step_finger(struct plant *p, const struct sim_device *d,
    const struct plant_piece *s, double ref_A, const struct plant_hand *hand, double t_s)
{
    step_string(p, d, s, ref_A, hand, t_s);
    step_current(p, s, ref_A);
    stop(&p->x_m, &p->v_mps, hand->end_m);
    stop(&p->q_m, &p->w_mps, hand->end_m);
}

/* Apart from the finger's loop over events: inline it would take its registers. */
__attribute__((noinline)) void plant_advance_hand_piece(struct plant *p, const struct sim_device *d,
    const struct plant_piece *s, double ref_A, const struct plant_hand *hand)
{
    int i = 0;
    do {
        step_finger(p, d, s, ref_A, hand, (i + 0.5) * s->h_s);
    } while (++i < s->n);
}

void plant_advance_hand(struct plant *p, const struct sim_device *d, double dt_s, double ref_A,
    const struct plant_hand *hand)
{
    const struct plant_piece s = piece_of(d, dt_s, steps_in(d, dt_s), hand->b_Nspm);
    plant_advance_hand_piece(p, d, &s, ref_A, hand);
}
