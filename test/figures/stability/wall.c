/* SPDX-License-Identifier: MIT */
#include "wall.h"

#include <math.h>
#include <string.h>

#define LSB_M (1 / 1073741824.0)

/* --- the plant --- */

/* v' = a - p v for t: the way and the speed. */
static double glide(double *v, double a, double p, double t)
{
    const double v0 = *v;
    double ends, e;
    if (p <= 0) {
        *v = v0 + a * t;
        return (v0 + 0.5 * a * t) * t;
    }
    ends = a / p;
    e = -expm1(-p * t);
    *v = v0 + (ends - v0) * e;
    return ends * t + (v0 - ends) * e / p;
}

/* When v' = a - p v comes to rest, or never. */
static double stops(double v, double a, double p)
{
    if (v == 0 || (v > 0) == (a > 0) || a == 0) { return HUGE_VAL; }
    return p > 0 ? log1p(-v * p / a) / p : -v / a;
}

static void advance(struct wall *w, double push_N)
{
    const double p = w->viscous_Nspm / w->mass_kg;
    double left = w->T_s;
    while (left > 0) {
        double a, rest_s;
        if (w->v_mps == 0 && fabs(push_N) <= w->coulomb_N) { return; }
        a = push_N - copysign(w->coulomb_N, w->v_mps != 0 ? w->v_mps : push_N);
        a /= w->mass_kg;
        rest_s = w->coulomb_N > 0 ? stops(w->v_mps, a, p) : HUGE_VAL;
        if (rest_s >= left) {
            w->x_m += glide(&w->v_mps, a, p, left);
            return;
        }
        w->x_m += glide(&w->v_mps, a, p, rest_s);
        w->v_mps = 0;
        left -= rest_s;
    }
}

/* --- the controller --- */

static int32_t rounded(double v)
{
    return v >= INT32_MAX ? INT32_MAX : v <= INT32_MIN ? INT32_MIN : (int32_t)lrint(v);
}

static int32_t counts(const struct wall *w)
{
    return (int32_t)floor(w->x_m / w->step_m + w->phase);
}

static struct exh_contact_in measured(struct wall *w)
{
    struct exh_contact_in in = {0, 0, w->lim_m_q30};
    if (w->step_m > 0) {
        const int32_t cnt = counts(w);
        in.pos_m_q30 = exh_quad_pos_m_q30(&w->quad, cnt);
        in.vel_mps_q27 = exh_velocity_window_step(&w->velocity, &w->velocity_cfg, cnt);
    } else {
        in.pos_m_q30 = rounded(w->x_m / LSB_M);
        in.vel_mps_q27 = rounded(((double)in.pos_m_q30 - w->pos_m_q30) / (8 * w->T_s));
        w->pos_m_q30 = in.pos_m_q30;
    }
    return in;
}

/* What the law asks for at rest in the wall is its bias: 0 here is where it carries the load. */
static double command(struct wall *w)
{
    const struct exh_permit open = {EXH_PERMIT_OPEN, INT32_C(1) << 30, 0, 1, {0, 0}};
    struct exh_force_ledger f;
    exh_contact_step(&w->contact, &w->par, measured(w), &f);
    if (w->f_max_N > 0) {
        exh_drive_force_step(&w->drive, &w->drive_cfg, &open, &f);
        return f.force_N_q20 / 1048576.0 - w->bias_N;
    }
    return (double)(f.spring_N_q20 + f.damper_N_q20) / 1048576.0 - w->bias_N;
}

static int set_drive(struct wall *w)
{
    struct exh_drive_par *p = &w->drive_par;
    for (int i = 0; i < EXH_DRIVE_ROWS; i++) { ((int32_t *)p)[i] = exh_drive_rows[i].dflt; }
    p->f_max_N_q20 = rounded(w->f_max_N * 1048576);
    p->slew_up_Nps = p->slew_down_Nps = 10000000;
    p->person_N_q20 = EXH_Q(100, 1, EXH_Q_FORCE);
    w->knot[0].x = w->knot[0].y = 0;
    w->knot[1].x = EXH_Q(100, 1, EXH_Q_FORCE);
    w->knot[1].y = EXH_Q(6, 1, EXH_Q_CUR);
    if (exh_table_setup(w->knot, 2) != 0) { return -EXH_E_RANGE; }
    return exh_drive_setup(
        &w->drive_cfg, p, w->T, (struct exh_table){w->knot, 2}, (struct exh_table){NULL, 0});
}

int wall_start(struct wall *w)
{
    static const struct exh_velocity_par difference = {0};
    const struct exh_contact_par law = {
        rounded(w->k_Npm * 1024), rounded(w->b_Nspm * 1048576), 0, 0, 0};
    int err = 0;
    w->T_s = (double)w->T.num / w->T.den;
    w->par = law;
    w->quad.step_m_q42 = rounded(w->step_m * 4398046511104.0);
    w->quad.speed_max_mps_q27 = exh_quad_rows[1].dflt;
    memset(&w->contact, 0, sizeof w->contact);
    memset(&w->velocity, 0, sizeof w->velocity);
    memset(&w->drive, 0, sizeof w->drive);
    memset(w->queue_N, 0, sizeof w->queue_N);
    w->at = 0;
    /* Without a limit the wall begins a metre above, so that it is never left. */
    w->lim_m_q30 = w->f_max_N > 0 ? -rounded(w->load_N / w->k_Npm / LSB_M) : -(INT32_C(1) << 30);
    w->bias_N = w->f_max_N > 0 ? w->load_N : w->par.k_Npm_q10 / 1024.0 + w->load_N;
    if (w->step_m > 0) {
        err = exh_velocity_window_setup(
            &w->velocity_cfg, (struct exh_velocity_scale){w->quad.step_m_q42, w->T}, &difference);
    }
    if (err == 0 && w->f_max_N > 0) {
        err = set_drive(w);
        w->drive.force_N_q20 = rounded(w->load_N * 1048576);
    }
    w->pos_m_q30 = rounded(w->x_m / LSB_M);
    if (w->step_m > 0) { exh_velocity_window_step(&w->velocity, &w->velocity_cfg, counts(w)); }
    return err;
}

void wall_tick(struct wall *w)
{
    const int acts = (w->at + 1) % (w->delay + 1);
    w->queue_N[w->at] = command(w);
    advance(w, -w->queue_N[acts]);
    w->at = acts;
}
