/* SPDX-License-Identifier: MIT */
#include "drop/outdir.h"

#include "base/option.h"
#include "drop/print.h"

#include <errno.h>
#include <string.h>
#include <sys/stat.h>

#define NAME_B 64 /* room for the longest name of a file in the directory */

static const char *const made[] = {
    "table2.csv", "runs.csv", "pictures.gp", "force_position.png", "fall.png"};

static void path(char to[TABLE2_PATH_B], const char *dir, const char *name)
{
    snprintf(to, TABLE2_PATH_B, "%s/%s", dir, name);
}

FILE *outdir_create(const char *dir, const char *name)
{
    char p[TABLE2_PATH_B];
    FILE *f;
    path(p, dir, name);
    f = fopen(p, "w");
    if (f == NULL) { cli_complain("%s: %s", p, strerror(errno)); }
    return f;
}

int outdir_finish(FILE *f, const char *dir, const char *name)
{
    const int bad = ferror(f);
    if (fclose(f) == 0 && !bad) { return 0; }
    cli_complain("%s/%s: can't be written", dir, name);
    return 1;
}

int outdir_open(const char *dir)
{
    char p[TABLE2_PATH_B];
    FILE *f;
    if (strlen(dir) + NAME_B > TABLE2_PATH_B) {
        cli_complain("--out: %.40s...: longer than %d bytes: choose a shorter path", dir,
            TABLE2_PATH_B - NAME_B);
        return 2;
    }
    if (mkdir(dir, 0777) != 0 && errno != EEXIST) {
        cli_complain("--out: %s: %s: give a directory that can be made", dir, strerror(errno));
        return 2;
    }
    for (size_t i = 0; i < sizeof made / sizeof made[0]; i++) {
        path(p, dir, made[i]);
        remove(p); /* what a run doesn't make must not look as if it had */
    }
    path(p, dir, made[0]);
    f = fopen(p, "w");
    if (f == NULL) {
        cli_complain("--out: %s: %s: give a directory that can be written", dir, strerror(errno));
        return 2;
    }
    fclose(f);
    remove(p);
    return 0;
}

void outdir_path(char to[TABLE2_PATH_B], const char *dir, double rate_Hz, const char *suffix)
{
    snprintf(to, TABLE2_PATH_B, "%s/drop_%gHz%s", dir, rate_Hz, suffix);
}

int outdir_table(const char *dir, const struct table2_runs *r, int rows)
{
    FILE *f = outdir_create(dir, "table2.csv");
    int err = f == NULL;
    if (f) {
        table2_csv_header(f);
        for (int i = 0; i < rows; i++) { table2_csv_line(f, &r[i]); }
        err |= outdir_finish(f, dir, "table2.csv");
    }
    return err;
}

int outdir_runs(const char *dir, const struct table2_result *r, int n)
{
    FILE *f = outdir_create(dir, "runs.csv");
    if (f == NULL) { return 1; }
    table2_runs_csv_header(f);
    for (int i = 0; i < n; i++) {
        if (r[i].done) { table2_runs_csv_line(f, &r[i]); }
    }
    return outdir_finish(f, dir, "runs.csv");
}

/* --- pictures --- */

/* Panel variables of plot/force_position.gp for one run. */
static void panel(FILE *f, const char *name, const struct table2_result *r)
{
    fprintf(f,
        "%s_raw='drop_%gHz_raw.csv'; %s_avg='drop_%gHz_averaged.csv'; "
        "%s_line='drop_%gHz_line.csv'\n",
        name, r->rate_Hz, name, r->rate_Hz, name, r->rate_Hz);
    fprintf(f, "%s_rate=%.6g; %s_k=%.6g; %s_b=%.6g; %s_stiffness='", name, r->rate_Hz, name,
        r->k_Npm, name, r->b_Nspm, name);
    if (r->b_Npm > 0) { fprintf(f, "%.0f", r->b_Npm); }
    fprintf(f, "'; %s_q0=%.9g\n", name, r->q_lim_m);
}

static void list(FILE *f, const char *name, const struct table2_result *r, int rows,
    void (*item)(FILE *f, const struct table2_result *r))
{
    fprintf(f, "%s='", name);
    for (int i = 0; i < rows; i++) {
        if (i > 0) { fputc(' ', f); }
        item(f, &r[i]);
    }
    fprintf(f, "'\n");
}

static void item_file(FILE *f, const struct table2_result *r)
{
    fprintf(f, "drop_%gHz_fall.csv", r->rate_Hz);
}
static void item_rate(FILE *f, const struct table2_result *r) { fprintf(f, "%.6g", r->rate_Hz); }
static void item_q_lim(FILE *f, const struct table2_result *r) { fprintf(f, "%.9g", r->q_lim_m); }
static void item_k(FILE *f, const struct table2_result *r) { fprintf(f, "%.6g", r->k_Npm); }
static void item_b(FILE *f, const struct table2_result *r) { fprintf(f, "%.6g", r->b_Nspm); }
static void item_stiffness(FILE *f, const struct table2_result *r)
{
    if (r->b_Npm > 0) {
        fprintf(f, "%.0f", r->b_Npm);
    } else {
        fputc('-', f);
    }
}

int outdir_pictures(
    const char *dir, const struct sim_device *d, const struct table2_result *r, int rows)
{
    FILE *f = outdir_create(dir, "pictures.gp");
    if (f == NULL) { return 1; }
    fprintf(f, "# Made by exhand drop. Inside this directory, PLOTS the way to ports/posix/plot:\n"
               "#   gnuplot -c pictures.gp PLOTS\n"
               "plots=ARG1\n"
               "out='force_position.png'; fit='linear fit, position over force'\n");
    panel(f, "a", &r[0]);
    panel(f, "b", &r[rows - 1]);
    fprintf(f,
        "load plots.'/force_position.gp'\nreset\n"
        "out='fall.png'; observe_s=%.9g\n",
        d->observe_s);
    list(f, "files", r, rows, item_file);
    list(f, "rates", r, rows, item_rate);
    list(f, "q_lims", r, rows, item_q_lim);
    list(f, "ks", r, rows, item_k);
    list(f, "bs", r, rows, item_b);
    list(f, "stiffnesses", r, rows, item_stiffness);
    fprintf(f, "load plots.'/fall.gp'\n");
    return outdir_finish(f, dir, "pictures.gp");
}
