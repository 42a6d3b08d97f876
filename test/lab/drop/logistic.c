/* SPDX-License-Identifier: MIT */
#include "lab/drop/logistic.h"

#include "sim/ln.h"
#include "sim/plant.h"

#define LAPSE   0.005
#define STEP    0.01 /* octaves, of m */
#define ROOM    0.5  /* octaves looked at beyond the nodes */
#define WIDTHS  14
#define WIDTH   0.01 /* octaves, the least s; each is 1.5 times the one before */
#define CHI2_95 3.841

static double share(double x, double m, double s)
{
    const double z = (x - m) / s;
    const double e = sim_exp_neg(z < 0 ? -z : z);
    return LAPSE + (1 - 2 * LAPSE) * (z < 0 ? 1 / (1 + e) : e / (1 + e));
}

static double likelihood(const struct logistic_node *node, int n, double m, double s)
{
    double sum = 0;
    for (int i = 0; i < n; i++) {
        const double p = share(node[i].x, m, s);
        if (node[i].rest > 0) { sum += node[i].rest * sim_ln(p); }
        if (node[i].rest < node[i].falls) { sum += (node[i].falls - node[i].rest) * sim_ln(1 - p); }
    }
    return sum;
}

/* The best over all widths, and that width. */
static double best_of(const struct logistic_node *node, int n, double m, double *width)
{
    double s = WIDTH, best = 0;
    for (int i = 0; i < WIDTHS; i++, s *= 1.5) {
        const double l = likelihood(node, n, m, s);
        if (i > 0 && l <= best) { continue; }
        best = l;
        *width = s;
    }
    return best;
}

/* How much more than binomial the counts scatter about the curve; 1 at least. */
static double scatter(const struct logistic_node *node, int n, double m, double s)
{
    double sum = 0;
    for (int i = 0; i < n; i++) {
        const double p = share(node[i].x, m, s), off = node[i].rest - node[i].falls * p;
        sum += off * off / (node[i].falls * p * (1 - p));
    }
    return n > 2 && sum > n - 2 ? sum / (n - 2) : 1;
}

/* The interval about the best m, by so much likelihood. */
static void widen(const struct logistic_node *node, int n, double least, struct logistic *to)
{
    double width;
    while (to->low > node[0].x - ROOM && best_of(node, n, to->low - STEP, &width) >= least) {
        to->low -= STEP;
    }
    while (to->high < node[n - 1].x + ROOM && best_of(node, n, to->high + STEP, &width) >= least) {
        to->high += STEP;
    }
    to->low -= STEP;
    to->high += STEP;
}

struct logistic logistic_fit(const struct logistic_node *node, int n)
{
    struct logistic to = {LOGISTIC_NONE, 0, 0, 0};
    double best = 0, width = WIDTH, best_width = WIDTH;
    int any = 0;
    while (n > 0 && 2 * node->rest < node->falls) {
        node++;
        n--;
    }
    if (n == 0) { return to; }
    if (2 * node[n - 1].rest >= node[n - 1].falls) {
        to.status = LOGISTIC_OPEN;
        to.at = to.low = to.high = node[n - 1].x;
        return to;
    }
    for (double m = node[0].x - ROOM; m < node[n - 1].x + ROOM; m += STEP) {
        const double l = best_of(node, n, m, &width);
        if (any && l <= best) { continue; }
        any = 1;
        best = l;
        best_width = width;
        to.at = m;
    }
    to.status = LOGISTIC_OK;
    to.low = to.high = to.at;
    widen(node, n, best - CHI2_95 / 2 * scatter(node, n, to.at, best_width), &to);
    return to;
}
