/* SPDX-License-Identifier: MIT */
#include "identify/fit.h"

#include "identify/solve.h"

#include "sim/random.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define N       MODEL_PARS
#define HUBER   4.0 /* deviations: farther ones count less */
#define CHANCES 4   /* times MODEL_CHANCES runs give the scatter of a model, */
#define SCATTER 2.0 /* of which so many variances of an observation are too much */

struct work {
    const struct identify_data *d;
    const struct observations *o;
    float *q[MODEL_LANES]; /* positions of runs side by side */
    double *at;       /* the model's positions at the observations, where the cost was seen last */
    double *r;        /* residuals, centred in their groups */
    double *j[N];     /* their derivatives, */
    double *down[N];  /* of two sides what was seen with the step down */
    double *w;        /* weights */
    double *sum, *ws; /* of groups */
    unsigned free;    /* bits of what is fitted */
    double floor;     /* counts that no observation is better than */
};

static double *numbers(size_t n) { return calloc(n ? n : 1, sizeof(double)); }

static void work_free(struct work *w)
{
    for (int i = 0; i < MODEL_LANES; i++) { free(w->q[i]); }
    free(w->at);
    free(w->r);
    free(w->w);
    free(w->sum);
    free(w->ws);
    for (int i = 0; i < N; i++) {
        free(w->j[i]);
        free(w->down[i]);
    }
}

static int work_open(struct work *w, const struct identify_data *d, const struct observations *o)
{
    int ok;
    memset(w, 0, sizeof *w);
    w->d = d;
    w->o = o;
    w->at = numbers(o->n);
    w->r = numbers(o->n);
    w->w = numbers(o->n);
    w->sum = numbers(o->groups);
    w->ws = numbers(o->groups);
    ok = w->at && w->r && w->w && w->sum && w->ws;
    for (int i = 0; i < N; i++) {
        w->j[i] = numbers(o->n);
        w->down[i] = numbers(o->n);
        ok &= w->j[i] != NULL && w->down[i] != NULL;
    }
    for (int i = 0; i < MODEL_LANES; i++) {
        w->q[i] = calloc(d->n ? d->n : 1, sizeof *w->q[i]);
        ok &= w->q[i] != NULL;
    }
    if (!ok) { work_free(w); }
    return ok ? 0 : -1;
}

static void means(const struct work *w, int models, double *const *to)
{
    for (int n = 0; n < models; n++) {
        for (size_t i = 0; i < w->o->n; i++) {
            const struct observation *o = &w->o->o[i];
            double sum = 0;
            for (uint32_t k = 0; k < o->ticks; k++) { sum += (double)w->q[n][o->from + k]; }
            to[n][i] = sum / o->ticks;
        }
    }
}

/* The models' means over the ticks of each observation. */
static void predict(struct work *w, const struct model *m, int models, double *const *to)
{
    model_run(m, models, w->d, w->o->last, w->q);
    means(w, models, to);
}

static void centre(struct work *w, double *v)
{
    memset(w->sum, 0, w->o->groups * sizeof *w->sum);
    memset(w->ws, 0, w->o->groups * sizeof *w->ws);
    for (size_t i = 0; i < w->o->n; i++) {
        w->sum[w->o->o[i].group] += w->w[i] * v[i];
        w->ws[w->o->o[i].group] += w->w[i];
    }
    for (size_t i = 0; i < w->o->n; i++) {
        const unsigned g = w->o->o[i].group;
        v[i] -= w->sum[g] / w->ws[g];
    }
}

/* The cost, Huber's, of these positions; residuals are left centred, weights those of the
 * observations. */
static double cost_at(struct work *w, const double *at)
{
    double cost = 0;
    for (size_t i = 0; i < w->o->n; i++) {
        w->r[i] = (double)w->o->o[i].cnt - at[i];
        w->w[i] = (double)w->o->o[i].share / (1 / (double)w->o->o[i].weight + w->floor * w->floor);
    }
    centre(w, w->r);
    for (size_t i = 0; i < w->o->n; i++) {
        const double e = fabs(w->r[i]) * sqrt(w->w[i]);
        cost += e < HUBER ? e * e : HUBER * (2 * e - HUBER);
        if (!(e < HUBER)) { w->w[i] *= HUBER / e; }
    }
    return w->o->counted > 0 ? cost / w->o->counted : (double)INFINITY;
}

static double residuals(struct work *w, const struct model *m)
{
    predict(w, m, 1, &w->at);
    return cost_at(w, w->at);
}

/* --- what a model can foretell --- */

/* To w->r: the variance of each prediction over when the drive takes each command over. */
static void scatter(struct work *w, const struct model *m)
{
    struct sim_random chance = {1};
    memset(w->r, 0, w->o->n * sizeof *w->r);
    for (int c = 0; c < CHANCES; c++) {
        model_chances(m, w->d, w->o->last, &chance, w->q);
        means(w, MODEL_CHANCES, w->j);
        for (int k = 0; k < MODEL_CHANCES; k++) { centre(w, w->j[k]); }
        for (size_t i = 0; i < w->o->n; i++) {
            double mean = 0, square = 0;
            for (int k = 0; k < MODEL_CHANCES; k++) { mean += w->j[k][i] / MODEL_CHANCES; }
            for (int k = 0; k < MODEL_CHANCES; k++) {
                square += (w->j[k][i] - mean) * (w->j[k][i] - mean);
            }
            w->r[i] += square / (MODEL_CHANCES - 1) / CHANCES;
        }
    }
}

/* Where a string becomes slack and strikes, the following motion is unpredictable. A group with
 * more scatter than the tolerance of its observations gets almost no weight. */
int fit_weigh(const struct model *m, const struct identify_data *d, struct observations *o)
{
    struct work w;
    if (work_open(&w, d, o)) { return -1; }
    for (size_t i = 0; i < o->n; i++) { w.w[i] = (double)o->o[i].weight; }
    scatter(&w, m);
    memset(w.sum, 0, o->groups * sizeof *w.sum);
    memset(w.ws, 0, o->groups * sizeof *w.ws);
    for (size_t i = 0; i < o->n; i++) {
        w.sum[o->o[i].group] += w.w[i] * w.r[i];
        w.ws[o->o[i].group]++;
    }
    o->counted = 0;
    for (size_t i = 0; i < o->n; i++) {
        const unsigned g = o->o[i].group;
        const double share = 1 / (1 + pow(w.sum[g] / w.ws[g] / SCATTER, 4));
        o->o[i].share = (float)share;
        o->counted += share;
    }
    work_free(&w);
    return 0;
}

/* --- coordinates: the free rotor's parameters first, as ratios --- */

static double clamped(int i, double v)
{
    return v < model_row[i].min ? model_row[i].min : v > model_row[i].max ? model_row[i].max : v;
}

/* What lifts and what lets sink, as factors of the weight. */
static void to_free(const struct model *m, double u[N])
{
    const double *v = m->value, kf = v[MODEL_KF];
    u[MODEL_ROTOR] = log(kf / (v[MODEL_ROTOR] * v[MODEL_STEP]));
    u[MODEL_COULOMB] = v[MODEL_COULOMB] / kf;
    u[MODEL_VISCOUS] = v[MODEL_VISCOUS] / v[MODEL_ROTOR];
    u[MODEL_DELAY] = v[MODEL_DELAY];
    u[MODEL_KF] = log(kf);
    u[MODEL_LAG] = log(v[MODEL_LAG]);
    u[MODEL_STEP] = log(v[MODEL_STEP]);
    u[MODEL_CABLE_K] = log(v[MODEL_CABLE_K] / kf);
    u[MODEL_CABLE_B] = v[MODEL_CABLE_B] / kf;
    u[MODEL_MU_MOTOR] = log((1 + v[MODEL_MU_MOTOR]) / (1 - v[MODEL_MU_MASS]) / kf);
    u[MODEL_MU_MASS] = log((1 - v[MODEL_MU_MOTOR]) / (1 + v[MODEL_MU_MASS]) / kf);
}

static void from_free(const double u[N], struct model *m)
{
    double *v = m->value, kf, up, down, mu;
    v[MODEL_KF] = kf = clamped(MODEL_KF, exp(u[MODEL_KF]));
    v[MODEL_STEP] = clamped(MODEL_STEP, exp(u[MODEL_STEP]));
    v[MODEL_ROTOR] = clamped(MODEL_ROTOR, kf / (v[MODEL_STEP] * exp(u[MODEL_ROTOR])));
    v[MODEL_COULOMB] = clamped(MODEL_COULOMB, u[MODEL_COULOMB] * kf);
    v[MODEL_VISCOUS] = clamped(MODEL_VISCOUS, u[MODEL_VISCOUS] * v[MODEL_ROTOR]);
    v[MODEL_DELAY] = clamped(MODEL_DELAY, u[MODEL_DELAY]);
    v[MODEL_CABLE_K] = clamped(MODEL_CABLE_K, exp(u[MODEL_CABLE_K]) * kf);
    v[MODEL_CABLE_B] = clamped(MODEL_CABLE_B, u[MODEL_CABLE_B] * kf);
    v[MODEL_LAG] = clamped(MODEL_LAG, exp(u[MODEL_LAG]));
    /* The lag is part of the delay: with less delay nothing would change any more. */
    if (v[MODEL_DELAY] < v[MODEL_LAG] + 0.5 / MODEL_SERVO_HZ) {
        v[MODEL_DELAY] = v[MODEL_LAG] + 0.5 / MODEL_SERVO_HZ;
    }
    up = exp(u[MODEL_MU_MOTOR]) * kf;
    down = exp(u[MODEL_MU_MASS]) * kf;
    mu = up - down > 1e-9 ? (up + down - 2) / (up - down) : 0;
    v[MODEL_MU_MASS] = mu > 0.9 ? 0.9 : clamped(MODEL_MU_MASS, mu);
    mu = up * (1 - v[MODEL_MU_MASS]) - 1;
    v[MODEL_MU_MOTOR] = mu > 0.9 ? 0.9 : clamped(MODEL_MU_MOTOR, mu);
}

/* A step that moves the model by more than rounding and less than what is curved. */
static double grain(int i, const double u[N])
{
    static const double least[N] = {
        0.006, 0.0004, 0.4, 20e-6, 0.01, 0.006, 0.006, 0.04, 0.002, 0.002, 0.1};
    const double share = 0.006 * fabs(u[i]);
    const int plain = i == MODEL_COULOMB || i == MODEL_VISCOUS || i == MODEL_CABLE_B;
    return plain && share > least[i] ? share : least[i];
}

/* What is fitted, with the step up and, of two sides, the step down. */
struct stepped {
    struct model m[2 * N];
    double *to[2 * N], apart[N];
    int n;
};

static void steps_of(struct work *w, const struct model *m, int two_sided, struct stepped *s)
{
    double u[N];
    to_free(m, u);
    s->n = 0;
    for (int i = 0; i < N; i++) {
        const double h = (two_sided ? 4 : 1) * grain(i, u);
        double up[N], down[N];
        if (!(w->free >> i & 1)) { continue; }
        memcpy(up, u, sizeof up);
        memcpy(down, u, sizeof down);
        up[i] += h;
        if (two_sided) { down[i] -= h; }
        if (!model_row[i].in_log && down[i] < 0) { down[i] = 0; }
        s->apart[i] = up[i] - down[i];
        from_free(up, &s->m[s->n]);
        s->to[s->n++] = w->j[i];
        if (!two_sided) { continue; }
        from_free(down, &s->m[s->n]);
        s->to[s->n++] = w->down[i];
    }
}

/* By differences: wide and two-sided, as the model is rough where something sticks or slackens; or,
 * at half the price, from where the cost was seen last. */
static void derivatives(struct work *w, const struct model *m, int two_sided)
{
    struct stepped s;
    steps_of(w, m, two_sided, &s);
    for (int i = 0; i < s.n; i += MODEL_LANES) {
        predict(w, &s.m[i], s.n - i < MODEL_LANES ? s.n - i : MODEL_LANES, &s.to[i]);
    }
    for (int i = 0; i < N; i++) {
        const double *down = two_sided ? w->down[i] : w->at;
        if (!(w->free >> i & 1)) {
            memset(w->j[i], 0, w->o->n * sizeof *w->j[i]);
            continue;
        }
        for (size_t k = 0; k < w->o->n; k++) { w->j[i][k] = (w->j[i][k] - down[k]) / s.apart[i]; }
        centre(w, w->j[i]);
    }
}

static void normal(const struct work *w, double a[N][N], double g[N])
{
    for (int i = 0; i < N; i++) {
        g[i] = 0;
        for (size_t k = 0; k < w->o->n; k++) { g[i] += w->w[k] * w->j[i][k] * w->r[k]; }
        for (int l = 0; l <= i; l++) {
            double s = 0;
            for (size_t k = 0; k < w->o->n; k++) { s += w->w[k] * w->j[i][k] * w->j[l][k]; }
            a[i][l] = a[l][i] = s;
        }
    }
}

static void move(struct model *m, const double x[N])
{
    double u[N];
    to_free(m, u);
    for (int i = 0; i < N; i++) {
        static const double far[N] = {0.5, 1, 500, 1e-3, 0.1, 0.2, 0.5, 5, 0.1, 0.1, 0.5};
        const double most = far[i];
        u[i] += x[i] > most ? most : x[i] < -most ? -most : x[i];
    }
    from_free(u, m);
}

int fit_run(
    struct fit *f, const struct identify_data *d, const struct observations *o, struct fit_how how)
{
    struct work w;
    double a[N][N], g[N], x[N], mean[N] = {0}, sums = 0, raise = how.bold ? 1e-6 : 1e-3;
    if (work_open(&w, d, o)) { return -1; }
    w.free = how.free & ~f->held;
    w.floor = how.floor_m / d->step_m;
    f->good = 0;
    f->cost = residuals(&w, &f->at);
    for (f->steps = 0; f->steps < how.steps && !f->good; f->steps++) {
        const double was = f->cost;
        int here = 0;
        /* Plain steps are short: their derivatives are those of the first. */
        if (!how.bold || f->steps == 0) { derivatives(&w, &f->at, !how.one_sided); }
        normal(&w, a, g);
        for (int tries = 0; tries < 8 && !here; tries++) {
            struct model next = f->at;
            double cost;
            if (solve_raised(N, a[0], raise, g, x) == 0) {
                move(&next, x);
                cost = residuals(&w, &next);
                if (cost < f->cost || (how.bold && cost < 1.2 * f->cost)) {
                    f->at = next;
                    f->cost = cost;
                    raise = how.bold ? 0 : raise > 1e-7 ? raise / 10 : raise;
                    here = 1;
                }
            }
            if (!here) { raise *= 10; }
        }
        if (how.bold == 2 && f->steps >= 2) {
            to_free(&f->at, x);
            for (int i = 0; i < N; i++) { mean[i] += x[i]; }
            sums++;
        }
        f->good = !how.bold && was - f->cost < how.enough * was;
        if (!f->good && !here) { (void)residuals(&w, &f->at); }
    }
    if (how.bold == 2 && sums > 0) {
        for (int i = 0; i < N; i++) { mean[i] /= sums; }
        from_free(mean, &f->at);
        f->cost = residuals(&w, &f->at);
    }
    work_free(&w);
    return 0;
}

void fit_shake(struct fit *f, struct sim_random *chance)
{
    /* Shares of a value that is no logarithm, else of 1. */
    static const double far[N] = {0.01, 0.05, 0.05, 0.05, 0.01, 0.01, 0.02, 0.1, 0.01, 0.01, 0.1};
    double u[N];
    to_free(&f->at, u);
    for (int i = 0; i < N; i++) {
        const int plain =
            i == MODEL_COULOMB || i == MODEL_VISCOUS || i == MODEL_CABLE_B || i == MODEL_DELAY;
        const double by = far[i] * (plain ? u[i] : 1) * (2 * sim_random_unit(chance) - 1);
        if (!(f->held >> i & 1)) { u[i] += by; }
    }
    from_free(u, &f->at);
}

void fit_costs(const struct model *m, int models, const struct identify_data *d,
    const struct observations *o, double floor_m, double *cost)
{
    struct work w;
    const int opened = work_open(&w, d, o) == 0;
    w.floor = floor_m / d->step_m;
    for (int i = 0; i < models; i++) {
        const int lane = i % MODEL_LANES, left = models - i;
        cost[i] = (double)INFINITY;
        if (!opened) { continue; }
        if (lane == 0) { predict(&w, &m[i], left < MODEL_LANES ? left : MODEL_LANES, w.j); }
        cost[i] = cost_at(&w, w.j[lane]);
    }
    if (opened) { work_free(&w); }
}
