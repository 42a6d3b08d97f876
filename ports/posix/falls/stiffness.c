/* SPDX-License-Identifier: MIT */
#include "falls/stiffness.h"

#include "falls/dissect.h"
#include "falls/pairs.h"
#include "falls/scope.h"

#include "base/outfile.h"

#include <stdio.h>
#include <string.h>

static int opt_ok(const struct fall_opt *opt)
{
    return fall_sane(opt->band_lo_N) && fall_sane(opt->band_hi_N) &&
           opt->band_lo_N <= opt->band_hi_N && opt->scope < FALL_SCOPES && opt->step_m >= 0 &&
           fall_sane(opt->step_m);
}

enum fall_status fall_stiffness(
    const struct fall_log *log, const struct fall_opt *opt, struct fall_stiffness *out)
{
    struct fall_contacts contacts;

    memset(out, 0, sizeof *out);
    out->raw.at = out->band.at = out->averaged.at = NULL;
    if (!opt_ok(opt)) { return FALL_BAD_OPT; }
    enum fall_status status = fall_dissect_scope(log, opt, &contacts);
    if (status == FALL_OK) { status = fall_pool(log, &contacts, opt->lag, &out->raw); }
    if (status == FALL_OK) {
        status = fall_band(&out->raw, opt->band_lo_N, opt->band_hi_N, &out->band);
    }
    if (status == FALL_OK) { status = fall_average(&out->band, opt->force, &out->averaged); }
    if (status == FALL_OK) {
        out->contacts = contacts.n;
        fall_fit_line(&out->averaged, &out->fit);
        status = fall_jackknife(&out->band, log->falls, opt->force, &out->a, &out->b);
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

/* --- files --- */

static enum fall_status write_pairs(const char *path, const struct fall_pair *at, size_t n)
{
    FILE *f = outfile_open("out", path);

    if (!f) { return FALL_IO; }
    fputs("q_m,f_mon_n\n", f);
    for (size_t i = 0; i < n; i++) { fprintf(f, "%.9g,%.9g\n", at[i].q_m, at[i].f_N); }
    return outfile_close(f) ? FALL_IO : FALL_OK;
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
