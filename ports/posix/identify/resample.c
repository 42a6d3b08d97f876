/* SPDX-License-Identifier: MIT */
#include "identify/estimate.h"

#include "base/jobs.h"
#include "identify/session.h"

#include "sim/plant.h"
#include "sim/random.h"

#include <math.h>
#include <string.h>

#define SEED       0x7265736D70 /* differs from all seeds of simulated devices */
#define STUDENT_95 2.3646       /* for RESAMPLES - 1 */
#define TRIES      4            /* starts of a fit, at most */

struct again {
    int done, lag_told;
    struct model at;
};

struct context {
    const struct estimate_of *e;
    const struct identify_data *d;
};

/* Repeats from other starts until the model fits this run as well as the device's. A fit in a local
 * minimum does not show how well a run determines a device. */
static int told_again(struct again *r, const struct identify_data *d, const struct estimate_of *e,
    struct sim_random *chance)
{
    const struct fit *was = &e->fit;
    struct fit first = *was, best = *was;
    struct lag lag;
    struct observations all;
    int err = observe(&all, d, 3, 0, 0.05) || fit_weigh(&was->at, d, &all) ? -1 : 0;
    first.held = 0;
    r->lag_told = err == 0 && e->lag_told && estimate_lag(&first, &lag, d) == 0;
    best.cost = (double)INFINITY;
    for (int i = 0; i < TRIES && err == 0 && !(best.cost < 1.25 * was->cost); i++) {
        struct fit f = first;
        fit_shake(&f, chance);
        estimate_lag_anew(&f);
        err = estimate_finish(&f, d, &all);
        if (f.cost < best.cost) { best = f; }
    }
    if (err == 0 && r->lag_told) { estimate_lag_end(&best, &lag, d); }
    observe_free(&all);
    r->at = best.at;
    return err;
}

static void work(const void *ctx, int i, void *result)
{
    const struct context *c = ctx;
    struct again *r = result;
    struct sim_random chance = {SEED + (uint64_t)i};
    struct identify_session s;
    struct identify_data data;
    memset(&s, 0, sizeof s);
    s.board = posix_config_default();
    s.board.device = model_device(&c->e->fit.at, c->d->T_s, c->d->servo_Hz);
    s.board.device.mass_kg = c->d->mass_kg;
    if (c->e->lag_told) { s.board.device.mon_lag_s = c->e->lag.monitor_s; }
    (void)plant_take_step(&s.board.device, 0, 0);
    s.board.seed = sim_random_u64(&chance) >> 1;
    s.rate_Hz = (uint32_t)(1 / c->d->T_s + 0.5);
    s.mass_kg = c->d->mass_kg;
    s.par = &c->d->par;
    if (identify_session(&s, &data) || data.result != EXH_PROBE_DONE) {
        identify_data_free(&data);
        return;
    }
    r->done = told_again(r, &data, c->e, &chance) == 0;
    identify_data_free(&data);
}

static double log_or(int i, double v)
{
    return model_row[i].in_log && v > 0 && i != MODEL_MU_MOTOR && i != MODEL_MU_MASS ? log(v) : v;
}

static double back(int i, double u)
{
    const double v = model_row[i].in_log && i != MODEL_MU_MOTOR && i != MODEL_MU_MASS ? exp(u) : u;
    return v < model_row[i].min ? model_row[i].min : v > model_row[i].max ? model_row[i].max : v;
}

static double lower(double a, double b) { return a < b ? a : b; }

/* The lag is within the delay. If the monitor does not determine it in each run, it may be anything
 * within. */
static void within_delay(struct fit *f, int told)
{
    const double least_s = model_row[MODEL_LAG].min;
    const double rest_s = f->at.value[MODEL_DELAY] - 0.5 / MODEL_SERVO_HZ;
    const double most_s = rest_s > least_s ? rest_s : least_s;
    f->low[MODEL_LAG] = told ? lower(f->low[MODEL_LAG], most_s) : least_s;
    f->high[MODEL_LAG] = told ? lower(f->high[MODEL_LAG], most_s) : most_s;
    f->at.value[MODEL_LAG] = lower(f->at.value[MODEL_LAG], most_s);
}

/* The sum of both frictions of the string; its parts were taken before. */
static void take_sum(struct fit *f, const struct model *told, const struct again *r, int n)
{
    const double value = model_mu(&f->at);
    double mean = 0, square = 0, half;
    for (int k = 0; k < n; k++) { mean += (model_mu(&r[k].at) - model_mu(told)) / n; }
    for (int k = 0; k < n; k++) {
        const double apart = model_mu(&r[k].at) - model_mu(told) - mean;
        square += apart * apart / (n - 1);
    }
    half = STUDENT_95 * sqrt(square * (1 + 1.0 / n));
    f->mu_low = value > half ? value - half : 0;
    f->mu_high = value + half;
}

static void take(struct fit *f, const struct again *r, int n)
{
    const struct model told = f->at;
    int lags = 0;
    for (int i = 0; i < MODEL_PARS; i++) {
        const double u = log_or(i, told.value[i]);
        double mean = 0, square = 0, half;
        for (int k = 0; k < n; k++) { mean += (log_or(i, r[k].at.value[i]) - u) / n; }
        for (int k = 0; k < n; k++) {
            const double apart = log_or(i, r[k].at.value[i]) - u - mean;
            square += apart * apart / (n - 1);
        }
        half = STUDENT_95 * sqrt(square * (1 + 1.0 / n));
        f->at.value[i] = back(i, u - mean);
        f->low[i] = back(i, u - mean - half);
        f->high[i] = back(i, u - mean + half);
    }
    take_sum(f, &told, r, n);
    for (int k = 0; k < n; k++) { lags += r[k].lag_told; }
    within_delay(f, lags == n);
}

int identify_resample(struct estimate_of *e, const struct identify_data *d, int jobs)
{
    static struct again r[RESAMPLES];
    const struct context c = {e, d};
    const struct jobs all = {RESAMPLES, jobs, sizeof r[0], r, work, &c, "fits", posix_interrupt};
    int n = 0, status;
    memset(r, 0, sizeof r);
    status = jobs_run(&all);
    if (status) { return status; }
    for (int k = 0; k < RESAMPLES; k++) {
        if (r[k].done) { r[n++] = r[k]; }
    }
    if (n < RESAMPLES) { return 1; } /* what was found cannot even do it again */
    take(&e->fit, r, n);
    return 0;
}
