/* SPDX-License-Identifier: MIT */
#include "settle.h"

#include "codes.h"
#include "grid.h"
#include "plant.h"
#include "random.h"

#include <string.h>

#define TRAVEL_M  0.25e-3 /* more than this in the window is no rest */
#define FORCE_N   4.0
#define WINDOW_S  0.5
#define STUCK_S   0.01 /* standing so long, and the force too: it is over */
#define SAME_N    1e-6
#define GIVE_UP_S 3.0
#define RANGE_M   1.99
#define OUTPUTS   256 /* on their way to the drive */
#define BLOCK     32  /* cases that fill each axis */

struct span {
    double low, high;
    int any;
};

struct run {
    const struct sim_device *d;
    const struct settle_wall *w;
    struct plant plant;
    struct plant_pieces pieces;
    double now_s, tick_s, servo_s, contact_s; /* < 0: no contact yet */
    double grid, ref_A, latched_A, force_N, start_cnt;
    /* the controller */
    struct estimate velocity;
    double cnt, turn_m, lim_m;
    int inward, touching;
    /* outputs under way */
    double out_s[OUTPUTS], out_A[OUTPUTS];
    unsigned head, queued;
    /* what is judged */
    struct span way, force;
    int touched, still;
};

/* In a block of cases, each part of 0..1 occurs once, in a separate order for each axis and
 * block. */
static double part_of(int i, uint64_t axis)
{
    struct sim_random order = {(uint64_t)(i / BLOCK) << 8 | axis},
                      within = {(uint64_t)i << 8 | axis};
    int part[BLOCK] = {0};
    for (int n = 0; n < BLOCK; n++) {
        const int other = (int)(sim_random_u64(&order) >> 33) % (n + 1);
        part[n] = part[other];
        part[other] = n;
    }
    within.state = ~within.state;
    return (part[i % BLOCK] + sim_random_unit(&within)) / BLOCK;
}

struct settle_case settle_case_at(int i)
{
    return (struct settle_case){
        part_of(i, 0), part_of(i, 1), part_of(i, 2), part_of(i, 3), part_of(i, 4)};
}

static double clamp(double v, double low, double high)
{
    return v < low ? low : v > high ? high : v;
}

static double size_of(double v) { return v < 0 ? -v : v; }

static void widen(struct span *s, double v)
{
    if (!s->any || v < s->low) { s->low = v; }
    if (!s->any || v > s->high) { s->high = v; }
    s->any = 1;
}

static double count(const struct run *r)
{
    return (double)sim_floor(r->plant.q_m * r->d->decode / r->d->step_m + r->grid);
}

/* As exhand/contact.h and exhand/drive.h have it, without their rounding. */
static double law(struct run *r, double cnt)
{
    const struct settle_wall *w = r->w;
    const double step_m = r->d->step_m / r->d->decode;
    const double pos_m = (cnt - r->start_cnt) * step_m, past_m = pos_m - r->lim_m;
    const double v_mps = estimate_step(&r->velocity, &w->velocity, w->T_s, cnt) * step_m / w->T_s;
    const double back_m = r->inward ? pos_m - r->turn_m : r->turn_m - pos_m;
    const double top_N = r->d->kf_npa * r->d->peak_a, slew_N = w->slew_Nps * w->T_s;
    double asked_N;

    if (back_m > w->f0_band_m) { r->inward = !r->inward; }
    if (back_m > w->f0_band_m || back_m < 0) { r->turn_m = pos_m; }
    r->cnt = cnt;
    r->touching = past_m >= 0;
    asked_N = w->f0_N * r->inward + (r->touching ? w->k_Npm * past_m + w->b_Nspm * v_mps : 0);
    asked_N = clamp(asked_N, 0, w->f_max_N < top_N ? w->f_max_N : top_N);
    return clamp(asked_N, r->force_N - slew_N, r->force_N + slew_N);
}

static void tick(struct run *r)
{
    const struct sim_device *d = r->d;
    const double was_N = r->force_N, cnt = count(r);
    const unsigned end = (r->head + r->queued) % OUTPUTS;
    r->force_N = law(r, cnt);
    if (r->queued < OUTPUTS) {
        r->out_s[end] = r->now_s + d->delay_tick * r->w->T_s + d->delay_s;
        r->out_A[end] = clamp(r->force_N / d->kf_npa, -d->peak_a, d->peak_a);
        r->queued++;
    }
    if (r->touching && r->contact_s < 0) { r->contact_s = r->now_s; }
    r->still = r->plant.v_mps == 0 && r->plant.w_mps == 0 && size_of(r->force_N - was_N) < SAME_N
                   ? r->still + 1
                   : 0;
    r->tick_s += r->w->T_s;
}

static double earlier(double a, double b) { return a < b ? a : b; }

/* To the next event, which then has happened; whether it was a tick. */
static int advance(struct run *r)
{
    double next_s = earlier(r->tick_s, r->servo_s);
    if (r->queued) { next_s = earlier(next_s, r->out_s[r->head]); }
    if (next_s > r->now_s) {
        const double dt_s = sim_grid_s(r->now_s, next_s);
        if (dt_s > 0) {
            plant_advance_piece(
                &r->plant, r->d, plant_pieces_find(&r->pieces, r->d, dt_s, 0), r->ref_A);
        }
        r->now_s = next_s;
    }
    while (r->queued && r->out_s[r->head] <= r->now_s) {
        r->latched_A = r->out_A[r->head];
        r->head = (r->head + 1) % OUTPUTS;
        r->queued--;
    }
    if (r->servo_s <= r->now_s) {
        r->ref_A = r->latched_A;
        r->servo_s += 1 / r->d->servo_hz;
    }
    if (r->tick_s > r->now_s) { return 0; }
    tick(r);
    return 1;
}

static void start(
    struct run *r, const struct sim_device *d, const struct settle_wall *w, struct settle_case c)
{
    memset(r, 0, sizeof *r);
    r->d = d;
    r->w = w;
    r->grid = c.grid;
    r->plant.q_m = -d->height_m;
    r->start_cnt = count(r);
    /* Where the count began and where this fall does: each may be off by the jitter. */
    r->plant.q_m += d->height_jitter_m * (4 * c.height - 2);
    r->plant.x_m = r->plant.q_m;
    r->lim_m = sim_wall_m(d, c.wall);
    r->cnt = count(r);
    estimate_start(&r->velocity, r->cnt);
    r->turn_m = (r->cnt - r->start_cnt) * d->step_m / d->decode;
    r->tick_s = c.tick * w->T_s;
    r->servo_s = c.servo / d->servo_hz;
    r->contact_s = -1;
}

/* Nothing moves and nothing that is under way will move it. */
static int stuck(const struct run *r)
{
    const double T_s = r->w->T_s,
                 late_s = r->d->delay_tick * T_s + r->d->delay_s + 1 / r->d->servo_hz;
    return r->still > ESTIMATE_TICKS + 1 && r->still * T_s > late_s + STUCK_S + T_s &&
           size_of(r->plant.cur_A - r->ref_A) * r->d->kf_npa < 1e-3;
}

static enum settle_end judge(const struct run *r)
{
    const double noise_N = r->d->kf_npa * r->d->mon_noise_a;
    if (!r->touched) { return SETTLE_ASTRAY; }
    return r->way.high - r->way.low > TRAVEL_M || r->force.high - r->force.low > FORCE_N - noise_N
               ? SETTLE_MOVES
               : SETTLE_REST;
}

enum settle_end settle_run(
    const struct sim_device *d, const struct settle_wall *w, struct settle_case c)
{
    const double window_s = WINDOW_S > 4 * w->T_s ? WINDOW_S : 4 * w->T_s;
    struct run r;
    start(&r, d, w, c);
    for (;;) {
        double end_s;
        if (!advance(&r)) { continue; }
        if (size_of(r.plant.q_m) > RANGE_M) { return SETTLE_ASTRAY; }
        if (r.contact_s < 0) {
            if (r.now_s > GIVE_UP_S) { return SETTLE_ASTRAY; }
            continue;
        }
        end_s = r.contact_s + d->observe_s;
        if (stuck(&r)) { return r.touching ? SETTLE_REST : SETTLE_ASTRAY; }
        if (r.now_s >= end_s) { return judge(&r); }
        if (r.now_s >= end_s - window_s) {
            widen(&r.way, r.cnt * d->step_m / d->decode);
            widen(&r.force, d->kf_npa * r.plant.mon_A);
            r.touched |= r.touching;
        }
    }
}
