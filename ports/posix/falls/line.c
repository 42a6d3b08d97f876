/* SPDX-License-Identifier: MIT */
#include "falls/line.h"

/* Spread or correlation below this share of the value is rounding, not data:
 * 1e-12 of a 10 mm position is far below any encoder step. */
#define ROUNDING 1e-12

static void means_and_ends(const struct fall_pairs *p, struct fall_fit *out)
{
    double q = 0.0, f = 0.0;

    out->q_min_m = out->q_max_m = p->at[0].q_m;
    out->f_min_N = out->f_max_N = p->at[0].f_N;
    for (size_t i = 0; i < p->n; i++) {
        const double qi = p->at[i].q_m, fi = p->at[i].f_N;
        q += qi;
        f += fi;
        if (qi < out->q_min_m) { out->q_min_m = qi; }
        if (qi > out->q_max_m) { out->q_max_m = qi; }
        if (fi < out->f_min_N) { out->f_min_N = fi; }
        if (fi > out->f_max_N) { out->f_max_N = fi; }
    }
    out->q_mean_m = q / (double)p->n;
    out->f_mean_N = f / (double)p->n;
}

static int is_flat(double lo, double hi)
{
    const double size = -lo > hi ? -lo : hi;
    return hi - lo <= ROUNDING * (size + ROUNDING); /* the floor: squares stay above 0 */
}

void fall_fit_line(const struct fall_pairs *averaged, struct fall_fit *out)
{
    double qq = 0.0, ff = 0.0, qf = 0.0;

    *out = (struct fall_fit){.status = FALL_TOO_FEW, .n = averaged->n};
    if (averaged->n < FALL_MIN_PAIRS - (FALL_WINDOW - 1)) { return; }
    means_and_ends(averaged, out);
    out->status = FALL_FLAT;
    if (is_flat(out->q_min_m, out->q_max_m) || is_flat(out->f_min_N, out->f_max_N)) { return; }

    /* Second pass around the means: no cancellation of large squares. */
    for (size_t i = 0; i < averaged->n; i++) {
        const double dq = averaged->at[i].q_m - out->q_mean_m;
        const double df = averaged->at[i].f_N - out->f_mean_N;
        qq += dq * dq;
        ff += df * df;
        qf += dq * df;
    }
    out->a_Npm = qf / qq;
    out->r2 = (qf / qq) * (qf / ff);
    out->status = FALL_NO_RISE;
    if (qf > 0.0 && out->r2 > ROUNDING) {
        out->b_Npm = ff / qf;
        out->status = FALL_OK;
    }
}
