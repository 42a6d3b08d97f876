/* SPDX-License-Identifier: MIT */
#include "lab/fit/score.h"

#include <string.h>

#define REST_WANTED  0.995
#define SWING_WANTED 0.95

/* Rows that most plants fail come first; falls that do not rest are the dear ones. */
static const int order[TABLE2_ROWS] = {5, 4, 0, 3, 2, 1};

/* One row at one scale of both gains: the share of falls that do as wanted. */
struct wanted {
    int at_15, falls, first;
    double share, room; /* room: from the gate to 1 */
};

static struct settle_wall wall_of(const struct settle_wall *w, int row, double scale)
{
    struct settle_wall at = *w;
    at.T_s = 1 / table2_paper[row].rate_Hz;
    at.k_Npm = table2_paper[row].k_Npm * scale;
    at.b_Nspm = table2_paper[row].b_Nspm * scale;
    return at;
}

static double shortfall(const struct wanted *x, int failed)
{
    const double lacks = (x->share - (double)(x->falls - failed) / x->falls) / x->room;
    return lacks > 0 ? lacks * lacks : 0;
}

/* Falls that do not as wanted; given up once that alone is dearer than what is left. */
static int failures(
    const struct sim_device *d, const struct settle_wall *w, const struct wanted *x, double left)
{
    int failed = 0;
    for (int i = 0; i < x->falls && shortfall(x, failed) <= left; i++) {
        const int rests = settle_run(d, w, settle_case_at(x->first + i)) == SETTLE_REST;
        failed += rests == x->at_15;
    }
    return failed;
}

struct score score_plant(const struct plant_point *p, enum estimate_kind kind,
    const struct score_plan *plan, double bound)
{
    const struct wanted want[2] = {{0, plan->falls, plan->first, REST_WANTED, 1 - TABLE2_REST_MIN},
        {1, plan->falls_at_15, plan->first, SWING_WANTED, 1 - TABLE2_SWING_MIN}};
    struct sim_device d;
    struct settle_wall w;
    struct score s;
    double cost = 0;
    memset(&s, 0, sizeof s);
    if (space_apply(p, kind, &d, &w) < 0) { return s; }
    for (int i = 0; i < 2 * TABLE2_ROWS; i++) {
        const int row = order[i % TABLE2_ROWS];
        const struct wanted *x = &want[i / TABLE2_ROWS];
        const struct settle_wall at = wall_of(&w, row, x->at_15 ? 1.5 : 1);
        const int failed = failures(&d, &at, x, bound - cost);
        const float share = (float)(x->falls - failed) / (float)x->falls;
        (x->at_15 ? s.swing : s.rest)[row] = share;
        cost += shortfall(x, failed);
        if (cost > bound) { return s; }
    }
    s.cost = (float)cost;
    s.done = 1;
    return s;
}

double score_margin(const struct score *s)
{
    double least = 1;
    for (int i = 0; i < TABLE2_ROWS; i++) {
        const double rest = ((double)s->rest[i] - TABLE2_REST_MIN) / (1 - TABLE2_REST_MIN);
        const double swing = ((double)s->swing[i] - TABLE2_SWING_MIN) / (1 - TABLE2_SWING_MIN);
        least = rest < least ? rest : least;
        least = swing < least ? swing : least;
    }
    return least;
}

double score_rest(const struct plant_point *p, enum estimate_kind kind, int row, double k_Npm,
    double b_Nspm, const struct score_plan *plan)
{
    const struct wanted want = {0, plan->falls, plan->first, 1, 1};
    struct sim_device d;
    struct settle_wall w;
    if (space_apply(p, kind, &d, &w) < 0) { return 0; }
    w = wall_of(&w, row, 1);
    w.k_Npm = k_Npm;
    w.b_Nspm = b_Nspm;
    return 1 - (double)failures(&d, &w, &want, 1) / plan->falls;
}
