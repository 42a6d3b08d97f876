/* SPDX-License-Identifier: MIT */
#include "lab/contact/nailed.h"

#include "box/hand_judge.h"

#include "sim/path.h"

#include <math.h>

#define STEP_S 20e-6
#define ENDS_S 0.2 /* of the hold that says what is held, as hand_judge.h has it */

struct nail {
    double x_m, v_mps, T_N;
};

/* One step of m x'' = K (target - x) + B (target' - x') - T - dry(mu T), T what the string bears.
 */
static void step(struct nail *n, const struct bilateral_run_cfg *c, double target_m, double v_mps)
{
    const struct sim_finger_par *f = &c->board.exo.finger[EXH_INDEX];
    const struct sim_device *d = &c->board.device;
    const double out_m = n->x_m - c->at_m;
    const double T_N = d->cable_npm * out_m + d->cable_nspm * n->v_mps;
    double pull_N;
    n->T_N = out_m > 0 && T_N > 0 ? T_N : 0;
    pull_N = f->k_Npm * (target_m - n->x_m) + f->b_Nspm * (v_mps - n->v_mps) - n->T_N;
    pull_N -= d->mu_mass * n->T_N * (n->v_mps > 0 ? 1 : -1);
    n->v_mps += pull_N / f->mass_kg * STEP_S;
    n->x_m += n->v_mps * STEP_S;
}

/* The tension of one contact, from its first moment to the end of the hold. */
struct course {
    double N[200000];
    int n;
};

static double settled_s(const struct course *is)
{
    const int ends = is->n < (int)(ENDS_S / STEP_S) ? is->n : (int)(ENDS_S / STEP_S);
    double mean_N = 0;
    int last = 0;
    for (int i = is->n - ends; i < is->n; i++) { mean_N += is->N[i] / ends; }
    for (int i = 0; i < is->n; i++) {
        if (fabs(is->N[i] - mean_N) > SETTLED_BAND * mean_N) { last = i + 1; }
    }
    return last < is->n ? last * STEP_S : -1;
}

int nailed_settle(const struct bilateral_run_cfg *c, double *settle_s, int cap)
{
    static struct course is;
    const struct sim_finger_par *f = &c->board.exo.finger[EXH_INDEX];
    const struct sim_path_load load = {.k_Npm = f->k_Npm, .b_Nspm = f->b_Nspm};
    struct sim_path_par par = c->board.exo.path[EXH_INDEX];
    struct sim_path path;
    struct nail nail = {par.start_m, 0, 0};
    double was_m = par.start_m;
    int n = 0;
    par.believed_m = c->at_m;
    sim_path_start(&path, &par, &load, NULL, c->board.seed);
    is.n = 0;
    for (long i = 0; path.phase != SIM_PATH_DONE && n < cap; i++) {
        double now_m;
        sim_path_advance(&path, (double)i * STEP_S);
        now_m = sim_path_at(&path, (double)i * STEP_S);
        step(&nail, c, now_m, (now_m - was_m) / STEP_S);
        was_m = now_m;
        if (path.phase == SIM_PATH_WITHDRAW && is.n) {
            settle_s[n++] = settled_s(&is);
            is.n = 0;
        } else if (path.phase != SIM_PATH_WITHDRAW && (is.n || nail.T_N > 0) &&
                   is.n < (int)(sizeof is.N / sizeof is.N[0])) {
            is.N[is.n++] = nail.T_N;
        }
    }
    return n;
}
