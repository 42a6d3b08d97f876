/* SPDX-License-Identifier: MIT */
#include "identify/lag.h"

#include "identify/solve.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define TAPS    128   /* of the answer to a step, ticks, at most */
#define LONG    9     /* lags, behind which it is over */
#define BEHIND  0.01  /* s: so long a step is looked at */
#define BIG     0.1   /* of the largest current: a step */
#define FEW     20    /* steps, too few for a fit */
#define LEAST_S 10e-6 /* of a lag */
#define MOST_S  0.01
#define FAR_S   50e-6 /* largest change of a wait in one step */
#define STEPS   60
#define ENOUGH  1e-7 /* a plain step that lowers the cost by a smaller share is the last */
#define PLAIN   1e-2
#define SHOWN   0.5 /* of the monitor's own variance, at least, is what should be seen */
#define KNOWN   0.1 /* of the drive's period: a wait is known no worse than this, */
#define POOR    0.2 /* of the drive's lag: with a larger error it is unknown */
#define EDGE    50  /* and of so many the first and the last are left out */

/* What is fitted: the logarithms of both lags, and the wait of each step. */
enum { SHORT, LONGER, LAGS };

struct group {
    size_t from, n; /* samples behind one step */
    double wait_s;
    double c, b[LAGS], h; /* sums over them: of the derivative by its wait, squared; times others */
};

struct work {
    const struct identify_data *d;
    struct group *group;
    size_t groups, n;      /* n: samples in all */
    uint32_t *at;          /* which they are */
    double *r;             /* residuals, */
    double *j[LAGS];       /* and their derivatives, by the lags */
    double *j_wait;        /* and by the wait */
    double *keep_s;        /* waits before a step of the fit; those that are known */
    double a[LAGS * LAGS]; /* the normal matrix of the lags, what the waits leave of it */
    double shown;          /* share of the monitor's variance that is no residual */
};

/* --- what should be seen --- */

/* The answer to a step, of two lags one behind the other. */
static double answer(double t_s, double a_s, double b_s)
{
    const double b = fabs(a_s - b_s) < 1e-3 * a_s ? 1.002 * a_s : b_s;
    return t_s <= 0 ? 0 : 1 - (a_s * exp(-t_s / a_s) - b * exp(-t_s / b)) / (a_s - b);
}

static double coded_A(const struct work *w, size_t i) { return (double)w->d->sample[i].coded_A; }

static void see(
    struct work *w, const struct group *g, double a_s, double b_s, double more_s, double *seen_A)
{
    const double wait_s = g->wait_s + more_s, T_s = w->d->T_s;
    const double ticks = (wait_s + LONG * (a_s > b_s ? a_s : b_s)) / T_s;
    const size_t taps = ticks < TAPS - 1 ? (size_t)ticks + 1 : TAPS;
    double tap[TAPS];
    for (size_t k = 0; k < taps; k++) { tap[k] = answer((double)k * T_s - wait_s, a_s, b_s); }
    for (size_t s = g->from; s < g->from + g->n; s++) {
        const size_t i = w->at[s];
        seen_A[s] = coded_A(w, i - taps);
        for (size_t k = taps - 1; k > 0; k--) {
            seen_A[s] += (coded_A(w, i - k) - coded_A(w, i - k - 1)) * tap[k];
        }
    }
}

/* To r: off the line through what should be seen, as scale and zero of the monitor are its own.
 * Their sum of squares. */
static double residuals(struct work *w, const double u[LAGS], double more_s, double *r)
{
    const double n = (double)w->n;
    double x1 = 0, y1 = 0, xx = 0, xy = 0, yy = 0, slope;
    for (size_t g = 0; g < w->groups; g++) {
        see(w, &w->group[g], exp(u[SHORT]), exp(u[LONGER]), more_s, r);
    }
    for (size_t k = 0; k < w->n; k++) {
        const double x = r[k], y = (double)w->d->sample[w->at[k]].mon_A;
        x1 += x / n;
        y1 += y / n;
        xx += x * x;
        xy += x * y;
        yy += y * y;
    }
    xx -= n * x1 * x1;
    xy -= n * x1 * y1;
    yy -= n * y1 * y1;
    slope = xx > 0 ? xy / xx : 0;
    for (size_t k = 0; k < w->n; k++) {
        r[k] = (double)w->d->sample[w->at[k]].mon_A - y1 - slope * (r[k] - x1);
    }
    w->shown = yy > 0 ? slope * xy / yy : 0;
    return yy - slope * xy;
}

/* --- the fit --- */

static void by(struct work *w, double *j, double grain)
{
    for (size_t k = 0; k < w->n; k++) { j[k] = (j[k] - w->r[k]) / grain; }
}

/* At u, where w->r is: of the lags, what the waits of the steps leave. */
static void normal(struct work *w, const double u[LAGS], double rhs[LAGS])
{
    const double grain = 0.01, wait_s = 2e-6;
    memset(w->a, 0, sizeof w->a);
    memset(rhs, 0, LAGS * sizeof *rhs);
    for (int p = 0; p < LAGS; p++) {
        double moved[LAGS] = {u[SHORT], u[LONGER]};
        moved[p] += grain;
        (void)residuals(w, moved, 0, w->j[p]);
        by(w, w->j[p], grain);
    }
    (void)residuals(w, u, wait_s, w->j_wait);
    by(w, w->j_wait, wait_s);
    for (struct group *g = w->group; g < w->group + w->groups; g++) {
        g->c = g->h = g->b[SHORT] = g->b[LONGER] = 0;
        for (size_t k = g->from; k < g->from + g->n; k++) {
            g->c += w->j_wait[k] * w->j_wait[k];
            g->h += w->j_wait[k] * w->r[k];
            for (int p = 0; p < LAGS; p++) {
                g->b[p] += w->j_wait[k] * w->j[p][k];
                rhs[p] -= w->j[p][k] * w->r[k];
                for (int q = 0; q < LAGS; q++) { w->a[p * LAGS + q] += w->j[p][k] * w->j[q][k]; }
            }
        }
        for (int p = 0; p < LAGS && g->c > 0; p++) {
            rhs[p] += g->b[p] * g->h / g->c;
            for (int q = 0; q < LAGS; q++) { w->a[p * LAGS + q] -= g->b[p] * g->b[q] / g->c; }
        }
    }
}

static double within(double v, double low, double high)
{
    return v < low ? low : v > high ? high : v;
}

/* By x, and each wait by what that leaves for it. */
static void move(struct work *w, double u[LAGS], const double x[LAGS])
{
    for (int p = 0; p < LAGS; p++) {
        u[p] = within(u[p] + within(x[p], -0.5, 0.5), log(LEAST_S), log(MOST_S));
    }
    for (struct group *g = w->group; g < w->group + w->groups; g++) {
        const double left = g->h + g->b[SHORT] * x[SHORT] + g->b[LONGER] * x[LONGER];
        const double by_s = g->c > 0 ? -left / g->c : 0;
        g->wait_s = within(g->wait_s + within(by_s, -FAR_S, FAR_S), 0, MOST_S);
    }
}

/* From u and the waits down. The sum of squares there. */
static double descend(struct work *w, double u[LAGS])
{
    double rhs[LAGS], x[LAGS], raise = 1e-3, sum = residuals(w, u, 0, w->r);
    for (int i = 0; i < STEPS; i++) {
        const double was = sum, from[LAGS] = {u[SHORT], u[LONGER]};
        normal(w, u, rhs);
        for (size_t g = 0; g < w->groups; g++) { w->keep_s[g] = w->group[g].wait_s; }
        if (solve_raised(LAGS, w->a, raise, rhs, x)) { break; }
        move(w, u, x);
        sum = residuals(w, u, 0, w->r);
        if (sum < was && sum > (1 - ENOUGH) * was && raise < PLAIN) { break; }
        raise = sum < was ? raise / 8 : raise * 8;
        if (sum < was) { continue; }
        memcpy(u, from, sizeof from);
        for (size_t g = 0; g < w->groups; g++) { w->group[g].wait_s = w->keep_s[g]; }
        sum = residuals(w, u, 0, w->r);
        if (raise > 1e6) { break; }
    }
    normal(w, u, rhs);
    return sum;
}

/* --- the samples behind each step --- */

static void choose(struct work *w)
{
    const double ticks = BEHIND / w->d->T_s;
    const size_t most = ticks > TAPS ? TAPS : ticks < 4 ? 4 : (size_t)ticks;
    double most_A = 0;
    for (size_t i = 0; i < w->d->n; i++) { most_A = fmax(most_A, fabs(coded_A(w, i))); }
    for (size_t i = TAPS + 2; i < w->d->n; i++) {
        const double by_A = coded_A(w, i - 1) - coded_A(w, i - 2);
        struct group *g = w->group;
        if (fabs(by_A) > BIG * most_A) { w->group[w->groups++].from = w->n; }
        if (w->groups == 0) { continue; }
        g += w->groups - 1;
        if (g->n < most) {
            w->at[w->n++] = (uint32_t)i;
            g->n++;
        }
    }
}

static void work_free(struct work *w)
{
    free(w->group);
    free(w->at);
    free(w->r);
    free(w->j_wait);
    for (int p = 0; p < LAGS; p++) { free(w->j[p]); }
    free(w->keep_s);
}

static double *numbers(size_t n) { return calloc(n + 1, sizeof(double)); }

static int work_open(struct work *w, const struct identify_data *d)
{
    const size_t n = d->n + 1;
    int ok;
    memset(w, 0, sizeof *w);
    w->d = d;
    w->group = calloc(n, sizeof *w->group);
    w->at = calloc(n, sizeof *w->at);
    w->r = numbers(n);
    w->j_wait = numbers(n);
    w->keep_s = numbers(n);
    ok = w->group && w->at && w->r && w->j_wait && w->keep_s;
    for (int p = 0; p < LAGS; p++) {
        w->j[p] = numbers(n);
        ok &= w->j[p] != NULL;
    }
    if (ok) {
        choose(w);
    } else {
        work_free(w);
    }
    return ok ? 0 : -1;
}

/* --- results --- */

static int rising(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The waits that are known lie within a period of the drive: both, and their mean. 1: too few. */
static int waits(struct work *w, double variance, double *least_s, double *mean_s)
{
    const double period_s = 1 / w->d->servo_Hz, known_s = KNOWN * period_s;
    size_t n = 0, edge;
    *mean_s = 0;
    for (size_t g = 0; g < w->groups; g++) {
        if (w->group[g].c * known_s * known_s > variance) { w->keep_s[n++] = w->group[g].wait_s; }
    }
    if (n < FEW) { return 1; }
    for (size_t k = 0; k < n; k++) { *mean_s += w->keep_s[k] / (double)n; }
    qsort(w->keep_s, n, sizeof w->keep_s[0], rising);
    edge = n / EDGE;
    *least_s = (w->keep_s[edge] + w->keep_s[n - 1 - edge] - period_s) / 2;
    return 0;
}

/* From lags apart, close and short; to best those of the least squares. */
static double fit(struct work *w, double delay_s, double best[LAGS])
{
    static const double start_s[][LAGS] = {{100e-6, 300e-6}, {150e-6, 170e-6}, {20e-6, 250e-6}};
    double least = (double)INFINITY, a[LAGS * LAGS];
    struct group *kept = calloc(w->groups, sizeof *kept);
    for (size_t i = 0; i < sizeof start_s / sizeof start_s[0] && kept; i++) {
        double u[LAGS] = {log(start_s[i][SHORT]), log(start_s[i][LONGER])}, sum;
        for (size_t g = 0; g < w->groups; g++) {
            w->group[g].wait_s = within(delay_s - 200e-6, 0, MOST_S);
        }
        sum = descend(w, u);
        if (!(sum < least)) { continue; }
        least = sum;
        memcpy(best, u, LAGS * sizeof *best);
        memcpy(a, w->a, sizeof a);
        memcpy(kept, w->group, w->groups * sizeof *kept);
    }
    if (isfinite(least)) {
        memcpy(w->group, kept, w->groups * sizeof *kept);
        memcpy(w->a, a, sizeof a);
    }
    free(kept);
    return least;
}

void lag_swap(struct lag *lag)
{
    const struct lag was = *lag;
    lag->drive_s = was.monitor_s;
    lag->drive_error_s = was.monitor_error_s;
    lag->monitor_s = was.drive_s;
    lag->monitor_error_s = was.drive_error_s;
}

void lag_order(struct lag *lag, double delay_s)
{
    const double off_s = fabs(lag->run_s + lag->drive_s - delay_s);
    if (fabs(lag->run_s + lag->monitor_s - delay_s) < off_s) { lag_swap(lag); }
}

/* Standard error of lag p at the end of the last fit; infinite: no information. */
static double error_s(const struct work *w, const double u[LAGS], double variance, int p)
{
    double unit[LAGS] = {0}, x[LAGS];
    unit[p] = 1;
    if (solve_raised(LAGS, w->a, 0, unit, x) || !(x[p] > 0)) { return (double)INFINITY; }
    return exp(u[p]) * sqrt(x[p] * variance);
}

int lag_tell(struct lag *lag, const struct identify_data *d, double delay_s)
{
    double u[LAGS] = {0}, sum = 0, variance;
    struct work w;
    int err;
    memset(lag, 0, sizeof *lag);
    if (work_open(&w, d)) { return -1; }
    err = w.groups < FEW;
    if (err == 0) { sum = fit(&w, delay_s, u); }
    if (!isfinite(sum)) { err = -1; }
    if (err == 0) {
        variance = sum / (double)w.n;
        err = waits(&w, variance, &lag->wait_s, &lag->run_s) || !(w.shown > SHOWN);
        lag->drive_s = exp(u[SHORT]);
        lag->monitor_s = exp(u[LONGER]);
        lag->drive_error_s = error_s(&w, u, variance, SHORT);
        lag->monitor_error_s = error_s(&w, u, variance, LONGER);
        lag_order(lag, delay_s);
        err = err || !(lag->drive_error_s < POOR * lag->drive_s);
    }
    work_free(&w);
    return err;
}
