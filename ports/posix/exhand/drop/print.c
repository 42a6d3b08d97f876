/* SPDX-License-Identifier: MIT */
#include "drop/print.h"

#include "base/names.h"

#include <string.h>

/* The paper's row that runs may be held against: their rate and their gains. */
static const struct table2_row *compared(const struct table2_runs *r)
{
    const struct table2_row *row = table2_at(r->rate_Hz);
    return row && row->k_Npm == r->k_Npm && row->b_Nspm == r->b_Nspm ? row : NULL;
}

/* Why a row has no values, or no stiffness; empty: it has both. */
static const char *why_blank(char to[NAMES_B + 32], const struct table2_runs *r)
{
    char what[NAMES_B];
    to[0] = '\0';
    if (r->faults) {
        names_faults(what, sizeof what, r->faults);
        snprintf(to, NAMES_B + 32, "the box stopped: %s", what);
    } else if (r->incomplete) {
        snprintf(
            to, NAMES_B + 32, "%d of %d falls were not seen to their end", r->incomplete, r->falls);
    } else if (!(r->b_Npm > 0)) {
        snprintf(to, NAMES_B + 32, "no stiffness: %s", fall_status_text(r->line));
    }
    return to;
}

static int is_void(const struct table2_runs *r) { return r->faults || r->incomplete; }

/* --- for programs --- */

/* Fields: empty where there is no value. */
static void positive(FILE *f, double v)
{
    fputc(',', f);
    if (v > 0) { fprintf(f, "%.6g", v); }
}

static void share(FILE *f, double v)
{
    fputc(',', f);
    if (v >= 0) { fprintf(f, "%.4f", v); }
}

void table2_csv_header(FILE *f)
{
    fprintf(f, "rate_hz,k_n_per_m,b_ns_per_m,runs,falls,stiffness_b_n_per_m,ci_low,ci_high,runs_5,"
               "runs_95,stiffness_a_n_per_m,r2,resting_pairs_share,oscillating_falls,"
               "oscillating_share_at_1_5x,paper_n_per_m,ratio,blank_because\n");
}

void table2_csv_line(FILE *f, const struct table2_runs *r)
{
    const struct table2_row *paper = compared(r);
    char why[NAMES_B + 32];
    const double value[] = {
        r->b_Npm, r->low_Npm, r->high_Npm, r->low_5_Npm, r->high_5_Npm, r->a_Npm, r->r2};
    fprintf(f, "%.9g,%.9g,%.9g,%d,%d", r->rate_Hz, r->k_Npm, r->b_Nspm, r->runs, r->falls);
    for (size_t i = 0; i < sizeof value / sizeof value[0]; i++) { positive(f, value[i]); }
    share(f, r->resting);
    fputc(',', f);
    if (!is_void(r)) { fprintf(f, "%d", r->oscillating); }
    share(f, r->swing);
    positive(f, paper ? paper->stiffness_Npm : 0);
    positive(f, paper ? r->b_Npm / paper->stiffness_Npm : 0);
    fprintf(f, ",%s\n", why_blank(why, r));
}

void table2_runs_csv_header(FILE *f)
{
    fprintf(f, "rate_hz,k_n_per_m,b_ns_per_m,seed,wall_phase,q_lim_m,stiffness_a_n_per_m,"
               "stiffness_b_n_per_m,ci_low,ci_high,r2,resting_pairs_share,falls,oscillating_falls,"
               "incomplete_falls,faults\n");
}

void table2_runs_csv_line(FILE *f, const struct table2_result *r)
{
    const double value[] = {
        r->a_Npm, r->b_Npm, r->ci_low_Npm, r->ci_bounded ? r->ci_high_Npm : 0, r->r2};
    char faults[NAMES_B] = "";
    fprintf(f, "%.9g,%.9g,%.9g,%llu,%.4f,%.9g", r->rate_Hz, r->k_Npm, r->b_Nspm,
        (unsigned long long)r->seed, r->phase, r->q_lim_m);
    for (size_t i = 0; i < sizeof value / sizeof value[0]; i++) { positive(f, value[i]); }
    share(f, r->resting);
    if (r->faults) { names_faults(faults, sizeof faults, r->faults); }
    fprintf(f, ",%d,%d,%d,%s\n", r->falls, r->oscillating, r->incomplete, faults);
}

/* --- for people --- */

struct text {
    char s[32];
};

/* A dash where there is no value. */
static const char *text(struct text *t, int known, int decimals, double v)
{
    if (known) {
        snprintf(t->s, sizeof t->s, "%.*f", decimals, v);
    } else {
        strcpy(t->s, "-");
    }
    return t->s;
}

/* "lo..hi", "lo.." without an upper end, "-" without either. */
static const char *range(struct text *t, double lo, double hi)
{
    if (lo <= 0) { return text(t, 0, 0, 0); }
    if (hi > 0) {
        snprintf(t->s, sizeof t->s, "%.0f..%.0f", lo, hi);
    } else {
        snprintf(t->s, sizeof t->s, "%.0f..", lo);
    }
    return t->s;
}

static const char *percent(struct text *t, double share)
{
    if (share < 0) { return text(t, 0, 0, 0); }
    snprintf(t->s, sizeof t->s, "%.3g %%", 100 * share);
    return t->s;
}

static void print_row(FILE *f, const struct table2_runs *r)
{
    const struct table2_row *paper = compared(r);
    const double theirs_Npm = paper ? paper->stiffness_Npm : 1;
    const int line = r->b_Npm > 0;
    struct text b, interval, runs, r2, resting, rest, swing, theirs, ratio;
    fprintf(f, "%6.6g %6.6g %6.6g %10s %15s %15s %5s %8s %8s %8s %6s %6s\n", r->rate_Hz, r->k_Npm,
        r->b_Nspm, text(&b, line, 0, r->b_Npm), range(&interval, r->low_Npm, r->high_Npm),
        range(&runs, r->runs > 1 ? r->low_5_Npm : 0, r->high_5_Npm), text(&r2, line, 2, r->r2),
        percent(&resting, r->resting), percent(&rest, is_void(r) ? -1 : 1 - r->rest),
        percent(&swing, r->swing), text(&theirs, paper != NULL, 0, theirs_Npm),
        text(&ratio, paper != NULL && line, 2, r->b_Npm / theirs_Npm));
}

static void print_blanks(FILE *f, const struct table2_runs *r, int rows)
{
    for (int i = 0; i < rows; i++, r++) {
        char why[NAMES_B + 32];
        if (*why_blank(why, r)) {
            fprintf(f, "%6.6g Hz: blank: %s.\n", r->rate_Hz, why);
        } else if (r->lines < r->runs) {
            fprintf(f, "%6.6g Hz: %d of %d runs without a stiffness: %s.\n", r->rate_Hz,
                r->runs - r->lines, r->runs, fall_status_text(r->line));
        }
    }
}

void table2_print_runs(FILE *f, const struct table2_runs *r, int rows)
{
    fprintf(f, "\n%d run%s of %d falls a rate, beside the paper's Table II. ", r->runs,
        r->runs == 1 ? "" : "s", r->runs ? r->falls / r->runs : 0);
    if (r->places) {
        fprintf(f, "Each run draws the wall's position between\ntwo encoder counts; values are "
                   "medians of the runs, intervals cover that position.\n");
    } else {
        fprintf(f,
            "The wall lies %.3f counts above an\nencoder count (first row); the intervals "
            "hold for this position alone.\n",
            r->phase);
    }
    fprintf(f,
        "Stiffness: the inverse slope of position over monitored force, 0.8..4.5 N. A pair is a "
        "monitored force\nand the position of the tick that commanded it. Pairs at rest: the share "
        "after the last movement.\n\n"
        "  rate      k      b  stiffness    95 %% interval    90 %% of runs    r2    pairs    "
        "falls "
        "   1.5x   paper  ours/\n"
        "    Hz    N/m   Ns/m        N/m       of median             N/m        at rest    "
        "oscillating     N/m  paper\n");
    for (int i = 0; i < rows; i++) { print_row(f, &r[i]); }
    print_blanks(f, r, rows);
}

/* Why a row misses the paper by more than a tenth: one honest sentence; NULL when
 * it does not. */
static const char *deviation(const struct table2_runs *r)
{
    const struct table2_row *paper = compared(r);
    const double ratio = paper ? r->b_Npm / paper->stiffness_Npm : 1;
    if (r->b_Npm <= 0 || (ratio > 0.9 && ratio < 1.1)) { return NULL; }
    if (r->b_Nspm == 0) {
        return "without damping the command is k q, so the fit returns k whatever the device; "
               "what took the paper's below k is not in this model";
    }
    if (paper->stiffness_Npm >= r->low_5_Npm && paper->stiffness_Npm <= r->high_5_Npm) {
        return "inside what 90 % of our runs give; one run of ten falls does not settle it";
    }
    return "the excess over k is damper force and ringing, and these depend on friction, inertia "
           "and delay of a device without published values";
}

static void print_deviations(FILE *f, const struct table2_runs *r, int rows)
{
    int n = 0;
    for (int i = 0; i < rows; i++, r++) {
        const struct table2_row *paper = compared(r);
        const char *why = deviation(r);
        if (why == NULL) { continue; }
        if (n++ == 0) {
            fprintf(f, "\nWhere ours differs from the paper by more than a tenth, and why:\n");
        }
        fprintf(f, "  %.6g Hz: ours %.2f k, the paper's %.2f k: %s.\n", r->rate_Hz,
            r->b_Npm / r->k_Npm, paper->stiffness_Npm / paper->k_Npm, why);
    }
    if (n > 0) {
        fprintf(f,
            "  All: the device is simulated; its friction, inertia and delay were fitted so that "
            "the paper's points rest and 1.5x does not.\n");
    }
}

void table2_print_paper(FILE *f, const struct table2_runs *r, int rows)
{
    double slow_Npm = 0, fast_Npm = 0;
    for (int i = 0; i < rows; i++) {
        const struct table2_row *paper = compared(&r[i]);
        if (paper == &table2_paper[0]) { slow_Npm = r[i].b_Npm; }
        if (paper == &table2_paper[TABLE2_ROWS - 1]) { fast_Npm = r[i].b_Npm; }
    }
    if (slow_Npm > 0 && fast_Npm > 0) {
        fprintf(f, "\nStiffness at 2000 Hz over 90 Hz: %.1f (paper 36).\n", fast_Npm / slow_Npm);
    }
    print_deviations(f, r, rows);
}

static int gate(FILE *f, const struct table2_runs *r, int rows, int at_15)
{
    const double least = at_15 ? TABLE2_SWING_MIN : TABLE2_REST_MIN;
    int failed = 0;
    struct text share;
    for (int i = 0; i < rows; i++) { failed += (at_15 ? r[i].swing : r[i].rest) < least; }
    fprintf(f, "%s: falls that %s, >= %.0f %%:", failed ? "FAILED" : "passed",
        at_15 ? "oscillate at 1.5 times both gains" : "come to rest at the gains", 100 * least);
    for (int i = 0; i < rows; i++) {
        fprintf(f, "%s %s at %.6g Hz", i ? "," : "",
            percent(&share, at_15 ? r[i].swing : r[i].rest), r[i].rate_Hz);
    }
    fprintf(f, "\n");
    return failed;
}

int table2_print_gates(FILE *f, const struct table2_runs *r, int rows)
{
    const int rest = gate(f, r, rows, 0);
    return rest + gate(f, r, rows, 1);
}
