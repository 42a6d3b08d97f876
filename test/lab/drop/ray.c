/* SPDX-License-Identifier: MIT */
#include "lab/drop/ray.h"

#include "sim/plant.h"

#define K_MAX_NPM  1e6 /* what the scene takes */
#define B_MAX_NSPM 1e3
#define IN_VAIN    8 /* of gain 1: where nothing rested up to here nothing will */
#define LN_2       0.69314718055994531

static double two_to(double x)
{
    return x < 0 ? sim_exp_neg(-x * LN_2) : 1 / sim_exp_neg(x * LN_2);
}

double ray_gain(const struct ray *r, int node)
{
    return r->first * two_to((double)node / r->per_octave);
}

struct ray_border ray_border(const struct ray *r, ray_at *at, void *ctx)
{
    struct logistic_node node[RAY_NODES];
    struct ray_border x = {LOGISTIC_NONE, 0, 0, 0, 0, 0};
    struct logistic fit;
    int restless = 0, rested = 0;
    for (; x.nodes < RAY_NODES; x.nodes++) {
        const double gain = ray_gain(r, x.nodes);
        struct logistic_node *to = &node[x.nodes];
        if (gain * r->k_Npm > K_MAX_NPM || gain * r->b_Nspm > B_MAX_NSPM) { break; }
        if (rested ? restless >= r->per_octave : gain > IN_VAIN) { break; }
        to->x = (double)x.nodes / r->per_octave;
        x.error = at(ctx, r, gain, &to->rest, &to->falls);
        if (x.error) { return x; }
        rested |= to->rest > 0;
        restless = to->rest > 0 ? 0 : restless + 1;
    }
    fit = logistic_fit(node, x.nodes);
    x.status = fit.status;
    x.gain = r->first * two_to(fit.at);
    x.low = r->first * two_to(fit.low);
    x.high = r->first * two_to(fit.high);
    return x;
}
