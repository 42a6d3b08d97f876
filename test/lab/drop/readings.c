/* SPDX-License-Identifier: MIT */
#include "lab/drop/readings.h"

#include "falls/quantile.h"
#include "lab/drop/reading.h"

#define RUNS_MAX 1000

static double median(const struct table2_readings *t, int row, int reading)
{
    double v[RUNS_MAX];
    const struct table2_result *r = t->r + row * t->stride;
    int n = 0;
    for (int i = 0; i < t->runs && i < RUNS_MAX; i++) {
        if (r[i].done && r[i].reading_Npm[reading] > 0) { v[n++] = r[i].reading_Npm[reading]; }
    }
    return quantile(v, n, t->runs, 0.5);
}

static const struct table2_row *compared(const struct table2_result *r)
{
    const struct table2_row *row = table2_at(r->rate_Hz);
    return row && row->k_Npm == r->k_Npm && row->b_Nspm == r->b_Nspm ? row : NULL;
}

void table2_readings_print(FILE *f, const struct table2_readings *t)
{
    fprintf(f,
        "\nStiffness by every reading of the analysis, N/m (%s%d run%s a rate)\n"
        "  a, b: force over position; position over force, inverted. same, aligned: F_mon(n) with\n"
        "  q(n); with q(n-1), which it answers. all contacts; the first of each fall; while the\n"
        "  motor moves; the whole fall, in contact or not.\n\n  %-17s",
        t->runs > 1 ? "median of " : "", t->runs, t->runs > 1 ? "s" : "", "Hz");
    for (int row = 0; row < t->rows; row++) { fprintf(f, " %8.6g", t->r[row * t->stride].rate_Hz); }
    fprintf(f, "\n  %-17s", "paper");
    for (int row = 0; row < t->rows; row++) {
        const struct table2_row *paper = compared(&t->r[row * t->stride]);
        if (paper != NULL) {
            fprintf(f, " %8.0f", paper->stiffness_Npm);
        } else {
            fprintf(f, " %8s", "-");
        }
    }
    fprintf(f, "\n");
    for (int i = 0; i < READINGS; i++) {
        fprintf(f, "  %-17s", reading_table[i].name);
        for (int row = 0; row < t->rows; row++) {
            const double v = median(t, row, i);
            if (v > 0) {
                fprintf(f, " %8.0f", v);
            } else {
                fprintf(f, " %8s", "-");
            }
        }
        fprintf(f, "\n");
    }
}

void table2_readings_csv(FILE *f, const struct table2_readings *t)
{
    fprintf(f, "rate_hz,k_n_per_m,b_ns_per_m,reading,runs,stiffness_n_per_m,paper_n_per_m\n");
    for (int row = 0; row < t->rows; row++) {
        const struct table2_result *r = &t->r[row * t->stride];
        const struct table2_row *paper = compared(r);
        for (int i = 0; i < READINGS; i++) {
            const double v = median(t, row, i);
            fprintf(f, "%.9g,%.9g,%.9g,%s,%d,", r->rate_Hz, r->k_Npm, r->b_Nspm,
                reading_table[i].name, t->runs);
            if (v > 0) { fprintf(f, "%.6g", v); }
            fputc(',', f);
            if (paper != NULL) { fprintf(f, "%.6g", paper->stiffness_Npm); }
            fputc('\n', f);
        }
    }
}

void readings_judge(const struct fall_log *log, const struct sim_device *d, struct table2_result *r)
{
    const enum fall_status status = reading_all(log, d->step_m / d->decode, r->reading_Npm);
    if (status != FALL_OK) { table2_failed(r, "readings", fall_status_text(status)); }
}
