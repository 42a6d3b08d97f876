#include "part.h"

#include <stdlib.h>
#include <string.h>

static uint64_t splitmix64(uint64_t *state)
{
    uint64_t z = (*state += 0x9E3779B97F4A7C15u);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
}

struct replicas {
    struct fall_pairs drawn, averaged; /* room for `cap` pairs each              */
    size_t cap;
    size_t *times;  /* how often each fall was drawn                             */
    size_t *inside; /* pairs of each fall                                        */
    double *a;      /* N/m of each replicate that gave a line                    */
    double *slope;  /* m/N of the same                                           */
    size_t n;
};

static void replicas_free(struct replicas *r)
{
    fall_pairs_free(&r->drawn);
    fall_pairs_free(&r->averaged);
    free(r->times);
    free(r->inside);
    free(r->a);
    free(r->slope);
}

static enum fall_status replicas_alloc(struct replicas *r, size_t falls, size_t replicates)
{
    memset(r, 0, sizeof *r);
    r->drawn.at = NULL;
    r->averaged.at = NULL;
    r->times = part_alloc(falls, sizeof *r->times);
    r->inside = part_alloc(falls, sizeof *r->inside);
    r->a = part_alloc(replicates, sizeof *r->a);
    r->slope = part_alloc(replicates, sizeof *r->slope);
    return r->times && r->inside && r->a && r->slope ? FALL_OK : FALL_NO_MEMORY;
}

/* A replicate can hold more pairs than the data; grows the two lists as needed. */
static enum fall_status replicas_room(struct replicas *r, size_t n)
{
    if (n <= r->cap) { return FALL_OK; }
    fall_pairs_free(&r->drawn);
    fall_pairs_free(&r->averaged);
    r->cap = 0;
    if (part_pairs_alloc(&r->drawn, n + n / 4) != FALL_OK) { return FALL_NO_MEMORY; }
    if (part_pairs_alloc(&r->averaged, n + n / 4) != FALL_OK) { return FALL_NO_MEMORY; }
    r->cap = n + n / 4;
    return FALL_OK;
}

/* Draws as many falls as there are; the sorted pairs, each as often as its fall. */
static enum fall_status draw(struct replicas *r, const struct fall_pairs *sorted, size_t falls,
                             uint64_t *rng)
{
    size_t n = 0;

    memset(r->times, 0, falls * sizeof *r->times);
    for (size_t i = 0; i < falls; i++) {
        /* High part of a product, not a remainder: unbiased to 2^-32 * falls. */
        const size_t f = (size_t)(((splitmix64(rng) >> 32) * (uint64_t)falls) >> 32);
        r->times[f]++;
        n += r->inside[f];
    }
    if (replicas_room(r, n) != FALL_OK) { return FALL_NO_MEMORY; }
    r->drawn.n = 0;
    for (size_t i = 0; i < sorted->n; i++) {
        for (size_t t = 0; t < r->times[sorted->at[i].fall]; t++) {
            r->drawn.at[r->drawn.n++] = sorted->at[i];
        }
    }
    return FALL_OK;
}

static int by_value(const void *left, const void *right)
{
    const double l = *(const double *)left, r = *(const double *)right;
    return (l > r) - (l < r);
}

/* The value below which `permille` of the sorted values lie, between two of them
 * in proportion. n > 0. */
static double percentile(const double *sorted, size_t n, size_t permille)
{
    const size_t at = (n - 1) * permille / 1000;
    const double rest = (double)((n - 1) * permille % 1000) / 1000.0;

    return at + 1 < n ? sorted[at] + rest * (sorted[at + 1] - sorted[at]) : sorted[at];
}

static void interval_a(struct replicas *r, struct fall_interval *out)
{
    qsort(r->a, r->n, sizeof *r->a, by_value);
    out->status = FALL_OK;
    out->lo_Npm = percentile(r->a, r->n, 25);
    out->mid_Npm = percentile(r->a, r->n, 500);
    out->hi_Npm = percentile(r->a, r->n, 975);
}

static double inverse_or_0(double slope_mpN)
{
    return slope_mpN > 1.0 / VALUE_MAX ? 1.0 / slope_mpN : 0.0;
}

static void interval_b(struct replicas *r, struct fall_interval *out)
{
    qsort(r->slope, r->n, sizeof *r->slope, by_value);
    out->lo_Npm = inverse_or_0(percentile(r->slope, r->n, 975));
    out->mid_Npm = inverse_or_0(percentile(r->slope, r->n, 500));
    out->hi_Npm = inverse_or_0(percentile(r->slope, r->n, 25));
    out->status = out->hi_Npm > 0.0 ? FALL_OK : FALL_UNBOUNDED;
}

static enum fall_status replicate(struct replicas *r, const struct fall_pairs *sorted, size_t falls,
                                  const struct fall_opt *opt)
{
    uint64_t rng = opt->seed;
    struct fall_fit fit;

    for (size_t i = 0; i < sorted->n; i++) {
        r->inside[sorted->at[i].fall]++;
    }
    for (size_t i = 0; i < opt->replicates; i++) {
        if (draw(r, sorted, falls, &rng) != FALL_OK) { return FALL_NO_MEMORY; }
        part_average_into(&r->drawn, opt->force, &r->averaged);
        fall_fit_line(&r->averaged, &fit);
        if (fit.status == FALL_OK || fit.status == FALL_NO_RISE) {
            r->a[r->n] = fit.a_Npm;
            /* r2/a is the slope of q over F with its sign, also where B has none. */
            r->slope[r->n] = fit.r2 > 0.0 ? fit.r2 / fit.a_Npm : 0.0;
            r->n++;
        }
    }
    return FALL_OK;
}

int part_bootstrap_opt_ok(const struct fall_opt *opt)
{
    return opt->replicates == 0 || (opt->replicates >= 40 && opt->replicates <= 1000000);
}

enum fall_status fall_bootstrap(const struct fall_pairs *sorted, size_t falls,
                                const struct fall_opt *opt, struct fall_interval *a,
                                struct fall_interval *b)
{
    struct replicas r;

    *a = *b = (struct fall_interval){.status = FALL_FEW_FALLS};
    if (!part_bootstrap_opt_ok(opt) || falls > UINT32_MAX) { return FALL_BAD_OPT; }
    for (size_t i = 0; i < sorted->n; i++) {
        if (sorted->at[i].fall >= falls) { return FALL_BAD_OPT; }
    }
    if (falls < 2 || opt->replicates == 0) { return FALL_OK; }

    enum fall_status status = replicas_alloc(&r, falls, opt->replicates);
    if (status == FALL_OK) { status = replicate(&r, sorted, falls, opt); }
    if (status == FALL_OK) {
        a->replicates = b->replicates = r.n;
        /* An interval of the lucky half would say more than the data does. */
        if (r.n >= opt->replicates - opt->replicates / 10) {
            interval_a(&r, a);
            interval_b(&r, b);
        }
    }
    replicas_free(&r);
    return status;
}
