/* SPDX-License-Identifier: MIT */
#include "drop/print.h"

#include <string.h>

/* The paper's row that a result may be held against: its rate and its gains. */
static const struct table2_row *compared(const struct table2_result *r)
{
    const struct table2_row *row = table2_at(r->rate_Hz);
    return row && row->k_Npm == r->k_Npm && row->b_Nspm == r->b_Nspm ? row : NULL;
}

/* --- for programs --- */

/* Fields: empty where there is no value. */
static void positive(FILE *f, double v)
{
    fputc(',', f);
    if (v > 0) { fprintf(f, "%.6g", v); }
}

static void share(FILE *f, int known, double v)
{
    fputc(',', f);
    if (known) { fprintf(f, "%.4f", v); }
}

void table2_csv_header(FILE *f)
{
    fprintf(f, "rate_hz,k_n_per_m,b_ns_per_m,stiffness_a_n_per_m,stiffness_b_n_per_m,ci_low,"
               "ci_high,r2,oscillating_falls,falls,paper_n_per_m,ratio\n");
}

void table2_csv_line(FILE *f, const struct table2_result *r)
{
    const struct table2_row *paper = compared(r);
    const double theirs_Npm = paper ? paper->stiffness_Npm : 0;
    fprintf(f, "%.9g,%.9g,%.9g", r->rate_Hz, r->k_Npm, r->b_Nspm);
    positive(f, r->a_Npm);
    positive(f, r->b_Npm);
    positive(f, r->ci_low_Npm);
    positive(f, r->ci_bounded ? r->ci_high_Npm : 0);
    share(f, r->b_Npm > 0, r->r2);
    fprintf(f, ",%d,%d", r->oscillating, r->falls);
    positive(f, theirs_Npm);
    positive(f, paper ? r->b_Npm / theirs_Npm : 0);
    fputc('\n', f);
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

static void print_run(FILE *f, const struct table2_result *r)
{
    const struct table2_row *paper = compared(r);
    const double theirs_Npm = paper ? paper->stiffness_Npm : 1;
    const int line = r->b_Npm > 0;
    struct text b, interval, r2, theirs, ratio;
    fprintf(f, "%6.6g %6.6g %6.6g %11s %17s %7s %7d of %-3d %5d %7s %12s\n", r->rate_Hz, r->k_Npm,
        r->b_Nspm, text(&b, line, 0, r->b_Npm),
        range(&interval, r->ci_low_Npm, r->ci_bounded ? r->ci_high_Npm : 0),
        text(&r2, line, 2, r->r2), r->oscillating, r->falls, r->buzzing,
        text(&theirs, paper != NULL, 0, theirs_Npm),
        text(&ratio, paper != NULL && line, 2, r->b_Npm / theirs_Npm));
}

void table2_print_runs(FILE *f, const struct table2_result *r, int rows)
{
    fprintf(f,
        "\nOne run of %d falls a rate, beside the paper's Table II "
        "(B: position over force, monitor paired to the tick it answers)\n\n"
        "  rate      k      b   stiffness     95 %% interval      r2   oscillating  buzz   paper   "
        "ours/paper\n"
        "    Hz    N/m   Ns/m         N/m               N/m                  falls           N/m\n",
        r->falls);
    for (int i = 0; i < rows; i++) { print_run(f, &r[i]); }
    for (int i = 0; i < rows; i++) {
        if (r[i].line != FALL_OK) {
            fprintf(f, "%6.6g Hz: no stiffness: %s.\n", r[i].rate_Hz, fall_status_text(r[i].line));
        }
    }
}

/* Why a row misses the paper by more than a tenth: one honest sentence; NULL when
 * it does not. */
static const char *deviation(const struct table2_result *r)
{
    const struct table2_row *paper = compared(r);
    const double ratio = paper ? r->b_Npm / paper->stiffness_Npm : 1;
    if (r->b_Npm <= 0 || (ratio > 0.9 && ratio < 1.1)) { return NULL; }
    if (r->b_Nspm == 0) {
        return "without damping the command is k q, so the fit returns k whatever the device; "
               "what took the paper's below k is not in this model";
    }
    if (r->ci_bounded && paper->stiffness_Npm <= r->ci_high_Npm &&
        paper->stiffness_Npm >= r->ci_low_Npm) {
        return "inside our 95 % interval; ten falls do not settle it";
    }
    return "the excess over k is damper force and ringing, and these hang on friction, inertia and "
           "delay of a device nobody has published";
}

static void print_deviations(FILE *f, const struct table2_result *r, int rows)
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

void table2_print_paper(FILE *f, const struct table2_result *r, int rows)
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
