/* SPDX-License-Identifier: MIT */
#include "drop/outdir.h"

#include "base/option.h"
#include "base/outfile.h"
#include "drop/print.h"

#include <string.h>

#define NAME_B 64 /* room for the longest name of a file in the directory */

/* The pictures, which gnuplot makes. */
static const char *const made[] = {"force_position.png", "fall.png"};
#define PICTURES (sizeof made / sizeof made[0])

static void path(char to[TABLE2_PATH_B], const char *dir, const char *name)
{
    snprintf(to, TABLE2_PATH_B, "%s/%s", dir, name);
}

void outdir_clear(const char *dir)
{
    char p[TABLE2_PATH_B];
    for (size_t i = 0; i < PICTURES; i++) {
        path(p, dir, made[i]);
        (void)remove(p);
    }
}

int outdir_open(const char *dir)
{
    char p[TABLE2_PATH_B];
    const struct outfile_option first = {"out", p};
    int err;
    if (strlen(dir) + NAME_B > TABLE2_PATH_B) {
        cli_complain("--out: %.40s...: longer than %d bytes: choose a shorter path", dir,
            TABLE2_PATH_B - NAME_B);
        return 2;
    }
    path(p, dir, "table2.csv");
    err = outfile_dir(dir, made[0]);
    return err ? err : outfile_try(&first, 1);
}

void outdir_path(char to[TABLE2_PATH_B], const char *dir, double rate_Hz, const char *suffix)
{
    snprintf(to, TABLE2_PATH_B, "%s/drop_%gHz%s", dir, rate_Hz, suffix);
}

int outdir_table(const char *dir, const struct table2_runs *r, int rows)
{
    FILE *f = outfile_in(dir, "table2.csv");
    if (f == NULL) { return 1; }
    table2_csv_header(f);
    for (int i = 0; i < rows; i++) { table2_csv_line(f, &r[i]); }
    return outfile_close(f);
}

int outdir_runs(const char *dir, const struct table2_result *r, int n)
{
    FILE *f = outfile_in(dir, "runs.csv");
    if (f == NULL) { return 1; }
    table2_runs_csv_header(f);
    for (int i = 0; i < n; i++) {
        if (r[i].done) { table2_runs_csv_line(f, &r[i]); }
    }
    return outfile_close(f);
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
    FILE *f = outfile_in(dir, "pictures.gp");
    if (f == NULL) { return 1; }
    outfile_pictures(f, "drop");
    fprintf(f, "out='force_position.png'; fit='linear fit, position over force'\n");
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
    return outfile_close(f);
}
