/* SPDX-License-Identifier: MIT */
#include "lab/drop/preset.h"

#include "base/option.h"
#include "base/outfile.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define BEFORE_S 0.01
#define SHOWN_S  0.5

int original_take(const char *text)
{
    if (strcmp(text, ORIGINAL_NAME) == 0) { return 0; }
    cli_complain("--preset: %s: no such preset (" ORIGINAL_NAME
                 "): the commercial system beside this box",
        text);
    return 2;
}

/* --- contacts --- */

void original_add(struct original_contact *c, const struct fall_sample *s, double wall_m)
{
    const double err_N = s->f_mon_N - s->f_des_N;
    if (!s->c) { return; }
    if (s->f_mon_N > c->peak_N) { c->peak_N = s->f_mon_N; }
    if (s->q_m - wall_m > c->deepest_m) { c->deepest_m = s->q_m - wall_m; }
    c->err_N += err_N * err_N;
    c->rms_N += s->f_des_N * s->f_des_N;
    c->ticks++;
}

void original_end(struct original_contact *c)
{
    if (c->ticks == 0) { return; }
    c->err_N = sqrt(c->err_N / (double)c->ticks);
    c->rms_N = sqrt(c->rms_N / (double)c->ticks);
}

/* --- the table --- */

static void cell(double v, int digits)
{
    if (v < ORIGINAL_NONE) {
        printf(" %14s |", "-");
    } else {
        printf(" %14.*f |", digits, v);
    }
}

void original_print(const struct original_table *t)
{
    printf("| %-40s | %-4s |", "", "");
    for (int k = 0; k < t->columns; k++) { printf(" %14s |", t->column[k]); }
    printf("\n|--|--|");
    for (int k = 0; k < t->columns; k++) { printf("--:|"); }
    printf("\n");
    for (int i = 0; i < t->rows; i++) {
        printf("| %-40s | %-4s |", t->row[i].what, t->row[i].unit);
        for (int k = 0; k < t->columns; k++) {
            cell(t->value[i * t->columns + k], t->row[i].digits);
        }
        printf("\n");
    }
}

/* --- files --- */

static void write_csv(FILE *f, const void *ctx)
{
    const struct original_table *t = ctx;
    fprintf(f, "what,unit");
    for (int k = 0; k < t->columns; k++) { fprintf(f, ",\"%s\"", t->column[k]); }
    for (int i = 0; i < t->rows; i++) {
        fprintf(f, "\n\"%s\",%s", t->row[i].what, t->row[i].unit);
        for (int k = 0; k < t->columns; k++) {
            const double v = t->value[i * t->columns + k];
            fputc(',', f);
            if (v >= ORIGINAL_NONE) { fprintf(f, "%.9g", v); }
        }
    }
    fputc('\n', f);
}

struct picture {
    const char *const *trace;
    int n;
};

static void write_gp(FILE *f, const void *ctx)
{
    const struct picture *p = ctx;
    fprintf(f, "# Made by exhand. Inside this directory, PLOTS the way to ports/posix/plot:\n"
               "#   gnuplot -c original.gp PLOTS\nplots=ARG1\nfiles='");
    for (int k = 0; k < p->n; k++) { fprintf(f, " original_%d.csv", k); }
    fprintf(f, "'\narray names[%d]\n", p->n);
    for (int k = 0; k < p->n; k++) { fprintf(f, "names[%d]='%s'\n", k + 1, p->trace[k]); }
    fprintf(f, "load plots.'/original.gp'\n");
}

int original_out(const char *dir, const struct original_table *t, const char *const *trace, int n)
{
    const struct picture p = {trace, n};
    return outfile_write(dir, "original.csv", write_csv, t) |
           outfile_write(dir, "original.gp", write_gp, &p);
}

struct trace {
    const struct fall_sample *s;
    size_t n, contact;
    double wall_m;
};

static void write_trace(FILE *f, const void *ctx)
{
    const struct trace *t = ctx;
    const double from_s = t->s[t->contact].t_s;
    fprintf(f, "t_s,past_m,f_des_n,f_mon_n\n");
    for (size_t i = 0; i < t->n; i++) {
        const double t_s = t->s[i].t_s - from_s;
        if (t_s < -BEFORE_S || t_s > SHOWN_S) { continue; }
        fprintf(f, "%.9g,%.9g,%.9g,%.9g\n", t_s, t->s[i].q_m - t->wall_m, t->s[i].f_des_N,
            t->s[i].f_mon_N);
    }
}

int original_trace(
    const char *dir, int n_th, const struct fall_sample *s, size_t n, size_t contact, double wall_m)
{
    const struct trace t = {s, n, contact, wall_m};
    char name[32];
    (void)snprintf(name, sizeof name, "original_%d.csv", n_th);
    return outfile_write(dir, name, write_trace, &t);
}
