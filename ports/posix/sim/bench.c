/* SPDX-License-Identifier: MIT */
#include "bench.h"

#define DRAWN_M  0.15
#define CAUGHT_M 0.07
#define HAND_S   1.0
#define PULL_MPS 0.05
#define FAR_M    1.0 /* a slack string: its end is that far from taut */

static void put_slack(struct plant *p)
{
    p->x_m = p->q_m - FAR_M;
    p->v_mps = 0;
}

void bench_start(struct bench *b, struct plant *p, const struct sim_device *d, unsigned wrong)
{
    const struct plant rest = {0};
    const struct bench none = {0};
    *b = none;
    b->wrong = wrong;
    b->device = *d;
    if (wrong & BENCH_MOTOR_REVERSED) { b->device.kf_npa = -d->kf_npa; }
    *p = rest;
    p->q_m = DRAWN_M;
    put_slack(p);
}

void bench_prepare(struct bench *b, const struct plant *p, struct sim_random *r,
    enum bench_place place, double mass_kg)
{
    b->place = place;
    if (place == BENCH_MASS) { b->device.mass_kg = mass_kg; }
    b->moving = 1;
    b->from_s = b->now_s;
    b->until_s = b->now_s + HAND_S * (1 + 0.5 * sim_random_unit(r));
    b->from_m = p->q_m;
    b->to_m = DRAWN_M + 1e-3 * (2 * sim_random_unit(r) - 1);
}

int bench_ready(const struct bench *b) { return !b->moving; }

/* The hand draws the string from where it is to where it is wanted. */
static void guide(struct bench *b, struct plant *p)
{
    const double u = b->now_s < b->until_s ? (b->now_s - b->from_s) / (b->until_s - b->from_s) : 1;
    if (!(b->wrong & BENCH_STUCK)) {
        p->q_m = b->from_m + u * u * (3 - 2 * u) * (b->to_m - b->from_m);
    }
    p->w_mps = p->v_mps = 0;
    p->x_m = p->q_m; /* just taut */
    b->moving = b->now_s < b->until_s;
}

/* Limits of the string: it does not move in beyond its end or where it is caught. The mass does not
 * move below its support. */
static void hold_back(struct bench *b, struct plant *p, double before_m)
{
    const double end_m = b->wrong & BENCH_CAUGHT ? CAUGHT_M : 0;
    const int loose = b->place == BENCH_SLACK || (b->wrong & BENCH_NO_MASS);
    if (p->q_m < end_m && !(b->wrong & BENCH_ENDLESS)) {
        p->q_m = end_m;
        if (p->w_mps < 0) { p->w_mps = 0; }
    }
    if (b->wrong & BENCH_STUCK) {
        p->q_m = before_m;
        p->w_mps = 0;
    }
    if (loose) {
        put_slack(p);
    } else if (p->x_m > b->to_m || (b->wrong & BENCH_FIXED_MASS)) {
        p->x_m = b->to_m;
        if (p->v_mps > 0 || (b->wrong & BENCH_FIXED_MASS)) { p->v_mps = 0; }
    }
}

void bench_advance(struct bench *b, struct plant *p, double dt_s, double ref_A)
{
    const double before_m = p->q_m;
    b->now_s += dt_s;
    plant_advance(p, &b->device, dt_s, ref_A, b->moving);
    if (b->moving) {
        guide(b, p);
        return;
    }
    hold_back(b, p, before_m);
    if ((b->wrong & BENCH_PULLED) && b->place == BENCH_SLACK) {
        p->q_m = before_m + PULL_MPS * dt_s;
        p->w_mps = PULL_MPS;
        put_slack(p);
    }
}

double bench_encoder_m(const struct bench *b, const struct plant *p)
{
    return b->wrong & BENCH_ENCODER_REVERSED ? -p->q_m : p->q_m;
}
