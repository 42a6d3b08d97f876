#include "analysis.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Physical values lie far below; the square of this is far from overflow. */
#define VALUE_MAX 1e9

/* Spread or correlation below this share of the value is rounding, not data:
 * 1e-12 of a 10 mm position is far below any encoder step. */
#define ROUNDING 1e-12

const struct fall_opt fall_opt_default = {
    .min_samples = 1,
    .lag = 1,
    .band_lo_N = 0.8,
    .band_hi_N = 4.5,
    .force = FALL_FORCE_CENTRE,
    .replicates = 1000,
    .seed = 2013,
};

const struct fall_rest_opt fall_rest_opt_default = {
    .observe_s = 5.0,
    .window_s = 0.5,
    .travel_m = 0.25e-3,
    .force_N = 4.0,
    .encoder_step_m = 0.0,
    .range_m = 1.99,
};

const char *fall_status_text(enum fall_status status)
{
    switch (status) {
    case FALL_OK:
        return "ok";
    case FALL_NO_MEMORY:
        return "out of memory";
    case FALL_BAD_LOG:
        return "log damaged: times or starts do not rise, or a value is no number";
    case FALL_BAD_OPT:
        return "an option is out of range";
    case FALL_TOO_FEW:
        return "too few pairs in the force band";
    case FALL_FLAT:
        return "position or force does not vary";
    case FALL_NO_RISE:
        return "force does not rise with position";
    case FALL_UNBOUNDED:
        return "no upper end";
    case FALL_FEW_FALLS:
        return "too few falls with a line";
    case FALL_IO:
        return "cannot write the file";
    }
    return "unknown status";
}

const char *fall_rest_text(enum fall_rest_class rest)
{
    switch (rest) {
    case FALL_AT_REST:
        return "rest";
    case FALL_BUZZ:
        return "buzz";
    case FALL_OSCILLATES:
        return "oscillates";
    case FALL_INCOMPLETE:
        return "incomplete";
    case FALL_REST_CLASSES:
        break;
    }
    return "unknown";
}

/* Never a null pointer for an empty list; calloc refuses a product that wraps. */
static void *alloc(size_t n, size_t size_B)
{
    return calloc(n ? n : 1, size_B);
}

/* ---- Contacts ------------------------------------------------------------ */

/* False for NaN too: a NaN compares false with everything. */
static int sane(double x)
{
    return x > -VALUE_MAX && x < VALUE_MAX;
}

static int sample_sane(const struct fall_sample *s)
{
    return sane(s->t_s) && sane(s->q_m) && sane(s->qd_mps) && sane(s->f_des_N) &&
           sane(s->i_des_A) && sane(s->f_mon_N);
}

static size_t fall_end(const struct fall_log *log, size_t fall)
{
    return fall + 1 < log->falls ? log->start[fall + 1] : log->samples;
}

static enum fall_status check_log(const struct fall_log *log)
{
    if (log->falls == 0) { return FALL_BAD_LOG; }
    for (size_t f = 0; f < log->falls; f++) {
        const size_t end = fall_end(log, f);
        if (log->start[f] >= end || end > log->samples) { return FALL_BAD_LOG; }
        for (size_t i = log->start[f]; i < end; i++) {
            const struct fall_sample *s = &log->sample[i];
            if (!sample_sane(s)) { return FALL_BAD_LOG; }
            if (i > log->start[f] && !(s->t_s > s[-1].t_s)) { return FALL_BAD_LOG; }
        }
    }
    return FALL_OK;
}

/* The next contact of a fall at or after `from`; 0 if there is none. */
static int next_contact(const struct fall_log *log, size_t fall, size_t from,
                        struct fall_contact *out)
{
    const size_t end = fall_end(log, fall);
    size_t i = from;

    while (i < end && !log->sample[i].c) {
        i++;
    }
    if (i == end) { return 0; }
    out->first = i;
    while (i < end && log->sample[i].c) {
        i++;
    }
    out->end = i;
    out->fall = fall;
    out->open = i == end;
    return 1;
}

/* Counts the contacts; keeps them too when `at` is there. */
static size_t scan(const struct fall_log *log, size_t min_samples, struct fall_contact *at)
{
    struct fall_contact c;
    size_t n = 0;

    for (size_t f = 0; f < log->falls; f++) {
        for (size_t from = log->start[f]; next_contact(log, f, from, &c); from = c.end) {
            if (c.end - c.first < min_samples) { continue; }
            if (at) { at[n] = c; }
            n++;
        }
    }
    return n;
}

enum fall_status fall_dissect(const struct fall_log *log, size_t min_samples,
                              struct fall_contacts *out)
{
    *out = (struct fall_contacts){NULL, 0};
    const enum fall_status status = check_log(log);
    if (status != FALL_OK) { return status; }

    const size_t n = scan(log, min_samples, NULL);
    out->at = alloc(n, sizeof *out->at);
    if (!out->at) { return FALL_NO_MEMORY; }
    out->n = scan(log, min_samples, out->at);
    return FALL_OK;
}

void fall_contacts_free(struct fall_contacts *contacts)
{
    free(contacts->at);
    *contacts = (struct fall_contacts){NULL, 0};
}

/* ---- Pairs --------------------------------------------------------------- */

static enum fall_status pairs_alloc(struct fall_pairs *p, size_t cap)
{
    p->n = 0;
    p->at = alloc(cap, sizeof *p->at);
    return p->at ? FALL_OK : FALL_NO_MEMORY;
}

void fall_pairs_free(struct fall_pairs *pairs)
{
    free(pairs->at);
    *pairs = (struct fall_pairs){NULL, 0};
}

enum fall_status fall_pool(const struct fall_log *log, const struct fall_contacts *contacts,
                           size_t lag, struct fall_pairs *out)
{
    size_t n = 0;

    for (size_t i = 0; i < contacts->n; i++) {
        const size_t len = contacts->at[i].end - contacts->at[i].first;
        n += len > lag ? len - lag : 0;
    }
    if (pairs_alloc(out, n) != FALL_OK) { return FALL_NO_MEMORY; }
    for (size_t i = 0; i < contacts->n; i++) {
        const struct fall_contact *c = &contacts->at[i];
        for (size_t q = c->first; lag < c->end - q; q++) {
            out->at[out->n].q_m = log->sample[q].q_m;
            out->at[out->n].f_N = log->sample[q + lag].f_mon_N;
            out->at[out->n].fall = c->fall;
            out->n++;
        }
    }
    return FALL_OK;
}

/* Merges [lo, mid) and [mid, hi); of two equal forces the left one goes first,
 * which is what makes the sort stable. */
static void merge(const struct fall_pair *from, struct fall_pair *to, size_t lo, size_t mid,
                  size_t hi)
{
    size_t left = lo, right = mid;

    for (size_t i = lo; i < hi; i++) {
        if (left < mid && (right == hi || from[left].f_N <= from[right].f_N)) {
            to[i] = from[left++];
        } else {
            to[i] = from[right++];
        }
    }
}

static enum fall_status sort_by_force(struct fall_pairs *p)
{
    struct fall_pairs tmp;

    if (pairs_alloc(&tmp, p->n) != FALL_OK) { return FALL_NO_MEMORY; }
    for (size_t run = 1; run < p->n; run *= 2) {
        for (size_t lo = 0; lo < p->n; lo += 2 * run) {
            const size_t mid = run < p->n - lo ? lo + run : p->n;
            const size_t hi = run < p->n - mid ? mid + run : p->n;
            merge(p->at, tmp.at, lo, mid, hi);
        }
        struct fall_pair *swap = p->at;
        p->at = tmp.at;
        tmp.at = swap;
    }
    fall_pairs_free(&tmp);
    return FALL_OK;
}

enum fall_status fall_band(const struct fall_pairs *in, double lo_N, double hi_N,
                           struct fall_pairs *out)
{
    if (pairs_alloc(out, in->n) != FALL_OK) { return FALL_NO_MEMORY; }
    for (size_t i = 0; i < in->n; i++) {
        if (in->at[i].f_N >= lo_N && in->at[i].f_N <= hi_N) { out->at[out->n++] = in->at[i]; }
    }
    return sort_by_force(out);
}

/* ---- Average and fit ------------------------------------------------------ */

/* Each window is summed afresh, oldest first: no error is carried along, and equal
 * positions give equal averages to the last bit. */
static struct fall_pair window(const struct fall_pair *first, enum fall_force force)
{
    double q = 0.0, f = 0.0;

    for (size_t i = 0; i < FALL_WINDOW; i++) {
        q += first[i].q_m;
        f += first[i].f_N;
    }
    struct fall_pair out = first[FALL_WINDOW / 2];
    out.q_m = q / FALL_WINDOW;
    if (force == FALL_FORCE_NEWEST) { out.f_N = first[FALL_WINDOW - 1].f_N; }
    if (force == FALL_FORCE_MEAN) { out.f_N = f / FALL_WINDOW; }
    return out;
}

/* `out` has room for as many pairs as `sorted` holds. */
static void average_into(const struct fall_pairs *sorted, enum fall_force force,
                         struct fall_pairs *out)
{
    out->n = sorted->n < FALL_WINDOW ? 0 : sorted->n - (FALL_WINDOW - 1);
    for (size_t i = 0; i < out->n; i++) {
        out->at[i] = window(&sorted->at[i], force);
    }
}

enum fall_status fall_average(const struct fall_pairs *sorted, enum fall_force force,
                              struct fall_pairs *out)
{
    if (pairs_alloc(out, sorted->n) != FALL_OK) { return FALL_NO_MEMORY; }
    average_into(sorted, force, out);
    return FALL_OK;
}

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

/* ---- Bootstrap ------------------------------------------------------------ */

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
    r->times = alloc(falls, sizeof *r->times);
    r->inside = alloc(falls, sizeof *r->inside);
    r->a = alloc(replicates, sizeof *r->a);
    r->slope = alloc(replicates, sizeof *r->slope);
    return r->times && r->inside && r->a && r->slope ? FALL_OK : FALL_NO_MEMORY;
}

/* A replicate can hold more pairs than the data; grows the two lists as needed. */
static enum fall_status replicas_room(struct replicas *r, size_t n)
{
    if (n <= r->cap) { return FALL_OK; }
    fall_pairs_free(&r->drawn);
    fall_pairs_free(&r->averaged);
    r->cap = 0;
    if (pairs_alloc(&r->drawn, n + n / 4) != FALL_OK) { return FALL_NO_MEMORY; }
    if (pairs_alloc(&r->averaged, n + n / 4) != FALL_OK) { return FALL_NO_MEMORY; }
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
        average_into(&r->drawn, opt->force, &r->averaged);
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

static int bootstrap_opt_ok(const struct fall_opt *opt)
{
    return opt->replicates == 0 || (opt->replicates >= 40 && opt->replicates <= 1000000);
}

enum fall_status fall_bootstrap(const struct fall_pairs *sorted, size_t falls,
                                const struct fall_opt *opt, struct fall_interval *a,
                                struct fall_interval *b)
{
    struct replicas r;

    *a = *b = (struct fall_interval){.status = FALL_FEW_FALLS};
    if (!bootstrap_opt_ok(opt) || falls > UINT32_MAX) { return FALL_BAD_OPT; }
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

/* ---- The whole chain -------------------------------------------------------- */

static int opt_ok(const struct fall_opt *opt)
{
    return sane(opt->band_lo_N) && sane(opt->band_hi_N) && opt->band_lo_N <= opt->band_hi_N &&
           bootstrap_opt_ok(opt);
}

enum fall_status fall_stiffness(const struct fall_log *log, const struct fall_opt *opt,
                                struct fall_stiffness *out)
{
    struct fall_contacts contacts;

    memset(out, 0, sizeof *out);
    out->raw.at = out->band.at = out->averaged.at = NULL;
    if (!opt_ok(opt)) { return FALL_BAD_OPT; }
    enum fall_status status = fall_dissect(log, opt->min_samples, &contacts);
    if (status == FALL_OK) { status = fall_pool(log, &contacts, opt->lag, &out->raw); }
    if (status == FALL_OK) {
        status = fall_band(&out->raw, opt->band_lo_N, opt->band_hi_N, &out->band);
    }
    if (status == FALL_OK) { status = fall_average(&out->band, opt->force, &out->averaged); }
    if (status == FALL_OK) {
        out->contacts = contacts.n;
        fall_fit_line(&out->averaged, &out->fit);
        status = fall_bootstrap(&out->band, log->falls, opt, &out->a, &out->b);
    }
    fall_contacts_free(&contacts);
    return status;
}

void fall_stiffness_free(struct fall_stiffness *s)
{
    fall_pairs_free(&s->raw);
    fall_pairs_free(&s->band);
    fall_pairs_free(&s->averaged);
}

/* ---- Files ------------------------------------------------------------------ */

static enum fall_status write_pairs(const char *path, const struct fall_pair *at, size_t n)
{
    FILE *f = fopen(path, "w");

    if (!f) { return FALL_IO; }
    int bad = fputs("q_m,f_mon_n\n", f) < 0;
    for (size_t i = 0; i < n && !bad; i++) {
        bad = fprintf(f, "%.9g,%.9g\n", at[i].q_m, at[i].f_N) < 0;
    }
    bad |= fclose(f) != 0;
    return bad ? FALL_IO : FALL_OK;
}

enum fall_status fall_write_plot(const struct fall_stiffness *s, enum fall_direction direction,
                                 const struct fall_plot_paths *paths)
{
    const struct fall_fit *fit = &s->fit;
    struct fall_pair end[2] = {{fit->q_min_m, fit->f_min_N, 0}, {fit->q_max_m, fit->f_max_N, 0}};
    size_t ends = 0;

    if (fit->status == FALL_OK) {
        ends = 2;
        for (size_t i = 0; i < ends; i++) {
            if (direction == FALL_A) {
                end[i].f_N = fit->f_mean_N + fit->a_Npm * (end[i].q_m - fit->q_mean_m);
            } else {
                end[i].q_m = fit->q_mean_m + (end[i].f_N - fit->f_mean_N) / fit->b_Npm;
            }
        }
    }
    enum fall_status status = write_pairs(paths->raw, s->raw.at, s->raw.n);
    if (status == FALL_OK) { status = write_pairs(paths->averaged, s->averaged.at, s->averaged.n); }
    if (status == FALL_OK) { status = write_pairs(paths->line, end, ends); }
    return status;
}

/* ---- Rest -------------------------------------------------------------------- */

struct span {
    double q_lo, q_hi, f_lo, f_hi;
    size_t n;
};

static void span_add(struct span *w, const struct fall_sample *s)
{
    if (w->n == 0 || s->q_m < w->q_lo) { w->q_lo = s->q_m; }
    if (w->n == 0 || s->q_m > w->q_hi) { w->q_hi = s->q_m; }
    if (w->n == 0 || s->f_mon_N < w->f_lo) { w->f_lo = s->f_mon_N; }
    if (w->n == 0 || s->f_mon_N > w->f_hi) { w->f_hi = s->f_mon_N; }
    w->n++;
}

/* A count reaches the log rounded: a quarter of a step tells 2 from 3 counts, and
 * 1 from none. */
static enum fall_rest_class judge(double travel_m, double force_N, const struct fall_rest_opt *opt)
{
    const double step = opt->encoder_step_m;

    if (travel_m > opt->travel_m || force_N > opt->force_N) { return FALL_OSCILLATES; }
    if (travel_m > 0.25 * step && travel_m < 2.25 * step) { return FALL_BUZZ; }
    return FALL_AT_REST;
}

static void rest_of_fall(const struct fall_log *log, const struct fall_contact *contact,
                         const struct fall_rest_opt *opt, struct fall_rest *out)
{
    const size_t first = log->start[contact->fall], end = fall_end(log, contact->fall);
    struct span w = {0.0, 0.0, 0.0, 0.0, 0};

    out->t_contact_s = log->sample[contact->first].t_s;
    if (end - first < 2) { return; }
    const double tick_s =
        (log->sample[end - 1].t_s - log->sample[first].t_s) / (double)(end - 1 - first);
    const double stop_s = out->t_contact_s + opt->observe_s - 0.5 * tick_s;
    const double window_s = opt->window_s > 4 * tick_s ? opt->window_s : 4 * tick_s;

    if (log->sample[end - 1].t_s + tick_s <= stop_s) { return; }
    for (size_t i = contact->first; i < end && log->sample[i].t_s < stop_s; i++) {
        if (log->sample[i].t_s >= stop_s - window_s) { span_add(&w, &log->sample[i]); }
    }
    /* A window is rarely a whole number of ticks: by one it may seem short. */
    if (w.n < 3 || (double)w.n * tick_s < 0.9 * (opt->window_s - tick_s)) { return; }
    const enum fall_rest_class rest = judge(w.q_hi - w.q_lo, w.f_hi - w.f_lo, opt);
    /* A position that stands still at the end of its range says nothing of the mass. */
    if (rest != FALL_OSCILLATES && (w.q_lo <= -opt->range_m || w.q_hi >= opt->range_m)) { return; }
    out->travel_m = w.q_hi - w.q_lo;
    out->force_N = w.f_hi - w.f_lo;
    out->rest = rest;
}

static int rest_opt_ok(const struct fall_rest_opt *o)
{
    return o->window_s > 0.0 && o->window_s <= o->observe_s && sane(o->observe_s) &&
           o->travel_m >= 0.0 && sane(o->travel_m) && o->force_N >= 0.0 && sane(o->force_N) &&
           o->encoder_step_m >= 0.0 && sane(o->encoder_step_m) && o->range_m > 0.0 &&
           sane(o->range_m);
}

enum fall_status fall_rest(const struct fall_log *log, const struct fall_contacts *contacts,
                           const struct fall_rest_opt *opt, struct fall_rest *out)
{
    const enum fall_status status = check_log(log);

    if (status != FALL_OK) { return status; }
    if (!rest_opt_ok(opt)) { return FALL_BAD_OPT; }
    for (size_t f = 0; f < log->falls; f++) {
        out[f] = (struct fall_rest){.rest = FALL_INCOMPLETE};
    }
    /* Last to first, so that the first contact of a fall has the last word. */
    for (size_t i = contacts->n; i-- > 0;) {
        struct fall_rest *r = &out[contacts->at[i].fall];
        *r = (struct fall_rest){.rest = FALL_INCOMPLETE};
        rest_of_fall(log, &contacts->at[i], opt, r);
    }
    return FALL_OK;
}
