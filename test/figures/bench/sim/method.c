/* SPDX-License-Identifier: MIT */
#include "method.h"

#include <string.h>

const char *const method_name[METHODS] = {
    "explicit", "semi-implicit", "leapfrog", "midpoint", "rk4", "flow"};

#define TWO_PI 6.283185307179586

/* What stays the same from step to step. */
struct part {
    const struct sim_device *d;
    const struct plant_hand *hand;
    double h_s, ref_A;
    double keep, keep_half, keep_mon, cur_to_mon;
    double per_mass, per_rotor;
    /* midpoint: 1 / of the determinant, by the ways of mass and rotor, taut */
    double m2, w2, join, inverse[3][3];
};

static double shrink(double v, double most)
{
    return v > most ? v - most : v < -most ? v + most : 0;
}

static double tension(const struct sim_device *d, double x, double v, double q, double w)
{
    const double T = d->cable_npm * (x - q) + d->cable_nspm * (v - w);
    return x < q || T < 0 ? 0 : T;
}

static int way(double v, double net_N, double dry_N)
{
    if (v != 0) { return v > 0 ? 1 : -1; }
    return net_N > dry_N ? 1 : net_N < -dry_N ? -1 : 0;
}

/* The force on the mass, without the string's. */
static inline double push_N(const struct part *s, double t_s, double x, double v)
{
    const struct plant_hand *const h = s->hand;
    if (h == NULL) { return s->d->mass_kg * SIM_GRAVITY; }
    return h->k_Npm * (h->x_m + h->v_mps * t_s - x) + h->b_Nspm * (h->v_mps - v);
}

static struct part part_of(
    const struct sim_device *d, double h_s, double ref_A, const struct plant_hand *hand)
{
    struct part s;
    memset(&s, 0, sizeof s);
    s.d = d;
    s.hand = hand;
    s.h_s = h_s;
    s.ref_A = ref_A;
    s.keep = sim_exp_neg(TWO_PI * d->current_hz * h_s);
    s.keep_half = sim_exp_neg(TWO_PI * d->current_hz * h_s / 2);
    s.cur_to_mon = s.keep;
    if (d->mon_lag_s > 0) { /* and is not that of the current: no device here has it so */
        const double y = h_s / d->mon_lag_s;
        s.keep_mon = sim_exp_neg(y);
        s.cur_to_mon = y * (s.keep - s.keep_mon) / (y - TWO_PI * d->current_hz * h_s);
    }
    s.per_mass = 1 / d->mass_kg;
    s.per_rotor = 1 / d->rotor_kg;
    return s;
}

static void step_current(struct plant *p, const struct part *s)
{
    const double off_A = p->cur_A - s->ref_A;
    p->cur_A = s->ref_A + off_A * s->keep;
    p->mon_A = s->ref_A + (p->mon_A - s->ref_A) * s->keep_mon + off_A * s->cur_to_mon;
}

/* --- explicit Euler --- */

static void step_explicit(struct plant *p, const struct part *s, double t_s)
{
    const struct sim_device *const d = s->d;
    const double h = s->h_s, T = tension(d, p->x_m, p->v_mps, p->q_m, p->w_mps);
    const double a = s->per_mass * (push_N(s, t_s, p->x_m, p->v_mps) - T);
    const double c = s->per_rotor * (T - d->kf_npa * p->cur_A - d->viscous_nspm * p->w_mps);
    p->x_m += h * p->v_mps;
    p->q_m += h * p->w_mps;
    p->v_mps = shrink(p->v_mps + h * a, h * s->per_mass * d->mu_mass * T);
    p->w_mps = shrink(p->w_mps + h * c, h * s->per_rotor * (d->coulomb_n + d->mu_motor * T));
    step_current(p, s);
}

/* --- what midpoint and RK4 share: ways held for a step --- */

struct ways {
    int mass, rotor;
};

static struct ways ways_of(const struct plant *p, const struct part *s, double t_s)
{
    const struct sim_device *const d = s->d;
    struct ways k = {p->v_mps > 0 ? 1 : -1, p->w_mps > 0 ? 1 : -1};
    if (p->v_mps == 0 || p->w_mps == 0) {
        const double T = tension(d, p->x_m, p->v_mps, p->q_m, p->w_mps);
        k.mass = way(p->v_mps, push_N(s, t_s, p->x_m, p->v_mps) - T, d->mu_mass * T);
        k.rotor = way(p->w_mps, T - d->kf_npa * p->cur_A - d->viscous_nspm * p->w_mps,
            d->coulomb_n + d->mu_motor * T);
    }
    return k;
}

/* Stops bodies that have turned and would stick at their place. */
static void stick(struct plant *p, const struct part *s, struct ways k, double t_s)
{
    const int mass = k.mass * p->v_mps < 0, rotor = k.rotor * p->w_mps < 0;
    struct plant at = *p;
    if (!mass && !rotor) { return; }
    if (mass) { at.v_mps = 0; }
    if (rotor) { at.w_mps = 0; }
    k = ways_of(&at, s, t_s);
    if (mass && k.mass == 0) { p->v_mps = 0; }
    if (rotor && k.rotor == 0) { p->w_mps = 0; }
}

/* --- implicit midpoint --- */

/* With V, W the mean speeds: m2 V = m2 v + push0 - (1 + i mu) T, T = T0 + join (V - W), and so on.
 * These are two equations, and only the ways decide their determinant. */
static void prepare_midpoint(struct part *s)
{
    const struct sim_device *const d = s->d;
    const double hand_N = s->hand ? s->hand->k_Npm * s->h_s / 2 + s->hand->b_Nspm : 0;
    s->m2 = 2 * d->mass_kg / s->h_s + hand_N;
    s->w2 = 2 * d->rotor_kg / s->h_s + d->viscous_nspm;
    s->join = d->cable_npm * s->h_s / 2 + d->cable_nspm;
    for (int i = -1; i <= 1; i++) {
        for (int j = -1; j <= 1; j++) {
            const double up = (1 + i * d->mu_mass) * s->join,
                         down = (1 - j * d->mu_motor) * s->join;
            s->inverse[i + 1][j + 1] = 1 / (s->m2 * s->w2 + s->m2 * down + s->w2 * up);
        }
    }
}

/* Mean speeds; taut or not. */
static void solve(const struct part *s, const struct plant *p, struct ways k, double push,
    double drag, int taut, double *V, double *W)
{
    const struct sim_device *const d = s->d;
    const double hand_N = s->hand ? s->hand->k_Npm * s->h_s / 2 + s->hand->b_Nspm : 0;
    const double up = 1 + k.mass * d->mu_mass, down = 1 - k.rotor * d->mu_motor;
    const double c = s->join, T0 = taut ? d->cable_npm * (p->x_m - p->q_m) : 0;
    const double a = (s->m2 - hand_N) * p->v_mps + push - up * T0;
    const double b =
        (s->w2 - d->viscous_nspm) * p->w_mps - drag - k.rotor * d->coulomb_n + down * T0;
    if (!taut || k.mass == 0 || k.rotor == 0) {
        *V = k.mass ? a / (s->m2 + (taut ? up * c : 0)) : 0;
        *W = k.rotor ? b / (s->w2 + (taut ? down * c : 0)) : 0;
        return;
    }
    *V = (a * (s->w2 + down * c) + up * c * b) * s->inverse[k.mass + 1][k.rotor + 1];
    *W = (b * (s->m2 + up * c) + down * c * a) * s->inverse[k.mass + 1][k.rotor + 1];
}

static void step_midpoint(struct plant *p, const struct part *s, double t_s)
{
    const struct sim_device *const d = s->d;
    const double h = s->h_s, half = h / 2;
    const double cur_A = s->ref_A + (p->cur_A - s->ref_A) * s->keep_half;
    const double push = push_N(s, t_s + half, p->x_m, 0);
    const struct ways k = ways_of(p, s, t_s);
    double V, W;
    solve(s, p, k, push, d->kf_npa * cur_A, 1, &V, &W);
    if (tension(d, p->x_m + half * V, V, p->q_m + half * W, W) <= 0) {
        solve(s, p, k, push, d->kf_npa * cur_A, 0, &V, &W);
    }
    p->x_m += h * V;
    p->q_m += h * W;
    p->v_mps = k.mass ? 2 * V - p->v_mps : 0;
    p->w_mps = k.rotor ? 2 * W - p->w_mps : 0;
    step_current(p, s);
    stick(p, s, k, t_s + h);
}

/* --- RK4 --- */

struct slope {
    double x, v, q, w;
};

static inline struct slope slope_at(const struct part *s, struct ways k, double t_s, double cur_A,
    double x, double v, double q, double w)
{
    const struct sim_device *const d = s->d;
    const double T = tension(d, x, v, q, w);
    struct slope r = {v, 0, w, 0};
    if (k.mass) { r.v = s->per_mass * (push_N(s, t_s, x, v) - T - k.mass * d->mu_mass * T); }
    if (k.rotor) {
        r.w = s->per_rotor * (T - d->kf_npa * cur_A - d->viscous_nspm * w -
                                 k.rotor * (d->coulomb_n + d->mu_motor * T));
    }
    return r;
}

static void step_rk4(struct plant *p, const struct part *s, double t_s)
{
    const double h = s->h_s, half = h / 2;
    const struct ways k = ways_of(p, s, t_s);
    const double mid_A = s->ref_A + (p->cur_A - s->ref_A) * s->keep_half;
    const double end_A = s->ref_A + (p->cur_A - s->ref_A) * s->keep;
    const struct plant y = *p;
    const struct slope a = slope_at(s, k, t_s, y.cur_A, y.x_m, y.v_mps, y.q_m, y.w_mps);
    const struct slope b = slope_at(s, k, t_s + half, mid_A, y.x_m + half * a.x,
        y.v_mps + half * a.v, y.q_m + half * a.q, y.w_mps + half * a.w);
    const struct slope c = slope_at(s, k, t_s + half, mid_A, y.x_m + half * b.x,
        y.v_mps + half * b.v, y.q_m + half * b.q, y.w_mps + half * b.w);
    const struct slope e = slope_at(s, k, t_s + h, end_A, y.x_m + h * c.x, y.v_mps + h * c.v,
        y.q_m + h * c.q, y.w_mps + h * c.w);
    const double sixth = h / 6;
    p->x_m = y.x_m + sixth * (a.x + 2 * (b.x + c.x) + e.x);
    p->v_mps = y.v_mps + sixth * (a.v + 2 * (b.v + c.v) + e.v);
    p->q_m = y.q_m + sixth * (a.q + 2 * (b.q + c.q) + e.q);
    p->w_mps = y.w_mps + sixth * (a.w + 2 * (b.w + c.w) + e.w);
    step_current(p, s);
    stick(p, s, k, t_s + h);
}

/* --- all of them --- */

void method_advance(enum method m, struct plant *p, const struct sim_device *d, double dt_s,
    double ref_A, const struct plant_hand *hand)
{
    const int n = method_steps(d, dt_s);
    struct part s;
    if (m == METHOD_SEMI) {
        semi_advance(p, d, dt_s, ref_A, hand);
        return;
    }
    if (m == METHOD_LEAPFROG) {
        leapfrog_advance(p, d, dt_s, ref_A, hand);
        return;
    }
    if (m == METHOD_FLOW) {
        flow_advance(p, d, dt_s, ref_A, hand);
        return;
    }
    if (m == METHOD_REFERENCE) {
        wide_advance(p, d, dt_s, ref_A, hand);
        return;
    }
    s = part_of(d, dt_s / n, ref_A, hand);
    if (m == METHOD_MIDPOINT) { prepare_midpoint(&s); }
    for (int i = 0; i < n; i++) {
        if (m == METHOD_EXPLICIT) {
            step_explicit(p, &s, i * s.h_s);
        } else if (m == METHOD_MIDPOINT) {
            step_midpoint(p, &s, i * s.h_s);
        } else {
            step_rk4(p, &s, i * s.h_s);
        }
    }
}
