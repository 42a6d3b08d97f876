/* SPDX-License-Identifier: MIT */
#include "lab/drop/reading.h"

#include <string.h>

#define LAGS 2

#define SCOPES(name, direction, lag) \
    {name "-all", direction, lag, FALL_SCOPE_ALL}, \
        {name "-first", direction, lag, FALL_SCOPE_FIRST}, \
        {name "-moves", direction, lag, FALL_SCOPE_MOVES}, \
    { \
        name "-whole", direction, lag, FALL_SCOPE_WHOLE \
    }

const struct reading reading_table[READINGS] = {
    SCOPES("a-same", FALL_A, 0),
    SCOPES("a-aligned", FALL_A, 1),
    SCOPES("b-same", FALL_B, 0),
    SCOPES("b-aligned", FALL_B, 1),
};

int reading_find(const char *name)
{
    for (int i = 0; i < READINGS; i++) {
        if (strcmp(reading_table[i].name, name) == 0) { return i; }
    }
    return -1;
}

/* fall_stiffness() without the interval and the lists. */
static enum fall_status line(const struct fall_log *log, const struct fall_contacts *contacts,
    const struct fall_opt *o, struct fall_fit *out)
{
    struct fall_pairs raw = {NULL, 0}, band = {NULL, 0}, averaged = {NULL, 0};
    enum fall_status status = fall_pool(log, contacts, o->lag, &raw);
    if (status == FALL_OK) { status = fall_band(&raw, o->band_lo_N, o->band_hi_N, &band); }
    if (status == FALL_OK) { status = fall_average(&band, o->force, &averaged); }
    if (status == FALL_OK) { fall_fit_line(&averaged, out); }
    fall_pairs_free(&raw);
    fall_pairs_free(&band);
    fall_pairs_free(&averaged);
    return status;
}

enum fall_status reading_all(
    const struct fall_log *log, double step_m, double stiffness_Npm[READINGS])
{
    struct fall_fit fit[FALL_SCOPES][LAGS];
    struct fall_opt opt = fall_opt_default;
    enum fall_status status = FALL_OK;

    memset(fit, 0, sizeof fit);
    opt.step_m = step_m;
    for (int scope = 0; status == FALL_OK && scope < FALL_SCOPES; scope++) {
        struct fall_contacts contacts;
        opt.scope = (enum fall_scope)scope;
        status = fall_dissect_scope(log, &opt, &contacts);
        for (opt.lag = 0; status == FALL_OK && opt.lag < LAGS; opt.lag++) {
            status = line(log, &contacts, &opt, &fit[scope][opt.lag]);
        }
        fall_contacts_free(&contacts);
    }
    for (int i = 0; i < READINGS; i++) {
        const struct reading *r = &reading_table[i];
        const struct fall_fit *f = &fit[r->scope][r->lag];
        const double slope = r->direction == FALL_A ? f->a_Npm : f->b_Npm;
        stiffness_Npm[i] = status == FALL_OK && f->status == FALL_OK ? slope : 0;
    }
    return status;
}
