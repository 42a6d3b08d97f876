/* SPDX-License-Identifier: MIT */
#include "lab/fit/score.h"

#include "sim/plant.h"
#include "sim/random.h"

#include <string.h>

#define FALLS        10
#define REST_WEIGHT  20
#define SWING_WEIGHT 6
#define REST_WANTED  0.98
#define SWING_WANTED 0.95
#define WORST_LN     2 /* of one row: e^2 times too much, or no line at all */

/* The dear rows that most plants fail come first. */
static const int order[TABLE2_ROWS] = {5, 0, 4, 2, 1, 3};

double score_step_m(const struct plant_point *p)
{
    return space_value(space_find("step"), p->u[space_find("step")]);
}

static double observe_s(const struct score_plan *plan, int row)
{
    return table2_paper[row].rate_Hz <= 100 ? plan->observe_slow_s : plan->observe_s;
}

int score_run(const struct plant_point *p, const struct score_plan *plan, struct score_gains at,
    struct run *r)
{
    struct run_setting setting[SPACE_ROWS + 1];
    struct sim_random wall = {at.seed ^ 0x77616C6C}; /* not the run's own chance */
    struct run_cfg c;
    memset(&c, 0, sizeof c);
    c.board = posix_config_default();
    space_apply(p, &c, setting);
    if (!plan->fixed_wall) {
        const double off_m = (sim_random_unit(&wall) - 0.5) * score_step_m(p);
        setting[c.settings++] = (struct run_setting){"q_lim", c.board.device.height_m + off_m};
    }
    c.rate_Hz = (uint32_t)table2_paper[at.row].rate_Hz;
    c.k_Npm = at.k_Npm;
    c.b_Nspm = at.b_Nspm;
    c.board.falls = at.falls;
    c.board.seed = at.seed;
    c.board.device.observe_s = observe_s(plan, at.row);
    if (!plant_step_will_do(&c.board.device, 0, 0)) {
        c.board.device.substep_s = plant_step_that_will_do(&c.board.device, 0, 0);
    }
    return run_drop(&c, r) < 0 ? -1 : 0;
}

/* How far a fall is from what is wanted of it, 0..1 and a little more for a slope. */
static double shortfall(const struct fall_rest *f, int wanted_oscillating)
{
    const double travel = f->travel_m / fall_rest_opt_default.travel_m;
    const double force = f->force_N / fall_rest_opt_default.force_N;
    double w = travel > force ? travel : force;
    if (f->rest == FALL_INCOMPLETE) { return 1.2; }
    if (w > 5) { w = 5; }
    if (!wanted_oscillating) { return w > 1 ? 1 + 0.04 * w : w > 0.7 ? w - 0.7 : 0; }
    return w > 1.3 ? 0 : w > 1 ? 0.3 * (1.3 - w) / 0.3 : 1 + 0.2 * (1 - w);
}

int score_oscillating(
    const struct run *r, double step_m, double observe_s, int wanted, double *soft)
{
    struct fall_rest_opt opt = fall_rest_opt_default;
    struct fall_rest rest[FALLS];
    struct fall_contacts contacts;
    int n = 0;
    opt.observe_s = observe_s;
    opt.encoder_step_m = step_m;
    *soft = 0;
    if (r->log.falls > FALLS || fall_dissect(&r->log, 1, &contacts) != FALL_OK) { return -1; }
    if (fall_rest(&r->log, &contacts, &opt, rest) != FALL_OK) { n = -1; } /* not a perfect score */
    for (size_t i = 0; n >= 0 && i < r->log.falls; i++) {
        *soft += shortfall(&rest[i], wanted);
        n += rest[i].rest == FALL_OSCILLATES || rest[i].rest == FALL_INCOMPLETE;
    }
    fall_contacts_free(&contacts);
    return n;
}

static struct score_gains gains(int row, double scale, int falls, uint64_t seed)
{
    const struct table2_row *t = &table2_paper[row];
    return (struct score_gains){row, t->k_Npm * scale, t->b_Nspm * scale, falls, seed};
}

/* The runs at the gains; 0, or -1 when one failed. */
static int at_the_gains(
    const struct plant_point *p, const struct score_plan *plan, int row, struct score *s)
{
    double sum[READINGS] = {0}, unrest = 0, soft = 0;
    int oscillating = 0, none[READINGS] = {0};
    for (int i = 0; i < plan->runs; i++) {
        double S[READINGS];
        struct run r;
        const uint64_t seed = plan->seed + (uint64_t)(i * TABLE2_ROWS + row);
        const int err = score_run(p, plan, gains(row, 1, FALLS, seed), &r);
        const int n =
            err ? -1 : score_oscillating(&r, score_step_m(p), observe_s(plan, row), 0, &soft);
        if (n < 0 || reading_all(&r.log, score_step_m(p), S) != FALL_OK) {
            run_free(&r);
            return -1;
        }
        run_free(&r);
        oscillating += n;
        unrest += soft;
        for (int k = 0; k < READINGS; k++) {
            none[k] |= !(S[k] > 0);
            sum[k] += S[k] > 0 ? space_ln(S[k] / table2_paper[row].k_Npm) : 0;
        }
    }
    for (int k = 0; k < READINGS; k++) {
        s->ln_k[row][k] = (float)(none[k] ? (double)SCORE_NONE : sum[k] / plan->runs);
    }
    s->rest[row] = 1 - (float)oscillating / (float)(FALLS * plan->runs);
    unrest /= FALLS * plan->runs;
    if (unrest > 1 - REST_WANTED) { s->unrest += (float)(REST_WEIGHT * unrest); }
    return 0;
}

static int at_15(
    const struct plant_point *p, const struct score_plan *plan, int row, struct score *s)
{
    double soft = 0;
    struct run r;
    const uint64_t seed = plan->seed + 500 + (uint64_t)row;
    const int err = score_run(p, plan, gains(row, 1.5, plan->falls_at_15, seed), &r);
    const int n = err ? -1 : score_oscillating(&r, score_step_m(p), observe_s(plan, row), 1, &soft);
    run_free(&r);
    if (n < 0) { return -1; }
    soft /= plan->falls_at_15;
    s->swing[row] = (float)n / (float)plan->falls_at_15;
    if (soft > 1 - SWING_WANTED) { s->unrest += (float)(SWING_WEIGHT * soft); }
    return 0;
}

struct score score_plant(const struct plant_point *p, const struct score_plan *plan, double bound)
{
    struct score s;
    memset(&s, 0, sizeof s);
    for (int i = 0; i < TABLE2_ROWS; i++) {
        if (at_the_gains(p, plan, order[i], &s) < 0) { return s; }
        if ((double)s.unrest > bound) { return s; }
        if (at_15(p, plan, order[i], &s) < 0) { return s; }
        if ((double)s.unrest > bound) { return s; }
    }
    s.done = 1;
    return s;
}

double score_cost(const struct score *s, int reading)
{
    double cost = (double)s->unrest;
    if (!s->done) { return 1e9; }
    for (int i = 0; i < TABLE2_ROWS; i++) {
        const double paper = space_ln(table2_paper[i].stiffness_Npm / table2_paper[i].k_Npm);
        double e = (double)s->ln_k[i][reading] - paper;
        e = e < 0 ? -e : e;
        cost += e < WORST_LN ? e * e : WORST_LN * WORST_LN;
    }
    return cost;
}
