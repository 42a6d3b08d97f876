/* SPDX-License-Identifier: MIT */
#include "falls/jackknife.h"

#include "falls/line.h"
#include "falls/pairs.h"

#include <stdlib.h>
#include <string.h>

/* Beyond the table Fisher's expansion about the normal quantile: within 1e-4 from 10 degrees on. */
double fall_t(size_t degrees)
{
    static const double exact[] = {
        12.7062, 4.3027, 3.1824, 2.7764, 2.5706, 2.4469, 2.3646, 2.3060, 2.2622};
    const double z = 1.959963985, z2 = z * z, n = (double)degrees;
    if (degrees <= sizeof exact / sizeof exact[0]) { return exact[degrees - 1]; }
    return z + z * (z2 + 1) / (4 * n) + z * ((5 * z2 + 16) * z2 + 3) / (96 * n * n) +
           z * (((3 * z2 + 19) * z2 + 17) * z2 - 15) / (384 * n * n * n);
}

/* Newton from above falls until it has arrived; no libm. */
static double square_root(double x)
{
    double r = x > 1 ? x : 1, next;
    if (!(x > 0)) { return 0; }
    while ((next = (r + x / r) / 2) < r) { r = next; }
    return r;
}

/* Sum, and sum of squares about the first value: enough for a variance. */
struct spread {
    double first, sum, square;
    size_t n;
};

static void take(struct spread *s, double value)
{
    if (s->n++ == 0) { s->first = value; }
    s->sum += value - s->first;
    s->square += (value - s->first) * (value - s->first);
}

/* Half an interval: t times the jackknife's standard error. */
static double reach(const struct spread *s)
{
    const double n = (double)s->n;
    const double about_mean = s->square - s->sum * s->sum / n;
    return fall_t(s->n - 1) * square_root(about_mean * (n - 1) / n);
}

/* The line without the pairs of one fall; 0 if there were none to leave out. */
static size_t leave_out(const struct fall_pairs *sorted, size_t fall, struct fall_pairs *rest)
{
    rest->n = 0;
    for (size_t i = 0; i < sorted->n; i++) {
        if (sorted->at[i].fall != fall) { rest->at[rest->n++] = sorted->at[i]; }
    }
    return sorted->n - rest->n;
}

/* Position over force, with its sign also where B has none. */
static double slope_mpN(const struct fall_fit *fit)
{
    return fit->r2 > 0.0 ? fit->r2 / fit->a_Npm : 0.0;
}

static double inverse_or_0(double slope)
{
    return slope > 1.0 / FALL_VALUE_MAX ? 1.0 / slope : 0.0;
}

static int has_line(const struct fall_fit *fit)
{
    return fit->status == FALL_OK || fit->status == FALL_NO_RISE;
}

static void intervals(const struct fall_fit *fit, const struct spread *of_a,
    const struct spread *of_slope, struct fall_interval *a, struct fall_interval *b)
{
    const double slope = slope_mpN(fit), by = reach(of_slope), by_a = reach(of_a);
    *a = (struct fall_interval){FALL_OK, fit->a_Npm - by_a, fit->a_Npm + by_a, of_a->n};
    *b = (struct fall_interval){
        FALL_OK, inverse_or_0(slope + by), inverse_or_0(slope - by), of_a->n};
    if (!(b->hi_Npm > 0.0)) { b->status = FALL_UNBOUNDED; }
}

enum fall_status fall_jackknife(const struct fall_pairs *sorted, size_t falls,
    enum fall_force force, struct fall_interval *a, struct fall_interval *b)
{
    struct fall_pairs rest = {NULL, 0}, averaged = {NULL, 0};
    struct spread of_a = {0, 0, 0, 0}, of_slope = {0, 0, 0, 0};
    struct fall_fit fit;
    int every = 1;

    *a = *b = (struct fall_interval){.status = FALL_FEW_FALLS};
    enum fall_status status = fall_pairs_alloc(&rest, sorted->n);
    if (status == FALL_OK) { status = fall_pairs_alloc(&averaged, sorted->n); }
    for (size_t f = 0; status == FALL_OK && every && f < falls; f++) {
        if (leave_out(sorted, f, &rest) == 0) { continue; }
        fall_average_into(&rest, force, &averaged);
        fall_fit_line(&averaged, &fit);
        every = has_line(&fit);
        take(&of_a, fit.a_Npm);
        take(&of_slope, slope_mpN(&fit));
    }
    if (status == FALL_OK && every && of_a.n >= 2) {
        fall_average_into(sorted, force, &averaged);
        fall_fit_line(&averaged, &fit);
        if (has_line(&fit)) { intervals(&fit, &of_a, &of_slope, a, b); }
    }
    fall_pairs_free(&rest);
    fall_pairs_free(&averaged);
    return status;
}
