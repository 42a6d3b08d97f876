/* SPDX-License-Identifier: MIT */
#include "falls/scope.h"

#include "falls/dissect.h"

/* The first sample of the tail in which position stays within one count. */
static size_t stop_of(const struct fall_log *log, size_t fall, double step_m)
{
    size_t i = fall_end(log, fall) - 1;
    double lo = log->sample[i].q_m, hi = lo;
    for (; i > log->start[fall]; i--) {
        const double q = log->sample[i - 1].q_m;
        if (q < lo) { lo = q; }
        if (q > hi) { hi = q; }
        if (hi - lo > 1.25 * step_m) { break; }
    }
    return i;
}

static void keep_first(struct fall_contacts *c)
{
    size_t n = 0;
    for (size_t i = 0; i < c->n; i++) {
        if (n == 0 || c->at[i].fall != c->at[n - 1].fall) { c->at[n++] = c->at[i]; }
    }
    c->n = n;
}

static void keep_moving(const struct fall_log *log, double step_m, struct fall_contacts *c)
{
    size_t n = 0, stop = 0, fall = log->falls;
    for (size_t i = 0; i < c->n; i++) {
        struct fall_contact at = c->at[i];
        if (at.fall != fall) {
            fall = at.fall;
            stop = stop_of(log, fall, step_m);
        }
        if (at.first >= stop) { continue; }
        if (at.end > stop) { at.end = stop; }
        c->at[n++] = at;
    }
    c->n = n;
}

/* Falls without contact are left out, as in the other scopes. */
static void widen(const struct fall_log *log, struct fall_contacts *c)
{
    keep_first(c);
    for (size_t i = 0; i < c->n; i++) {
        c->at[i].first = log->start[c->at[i].fall];
        c->at[i].end = fall_end(log, c->at[i].fall);
        c->at[i].open = 1;
    }
}

enum fall_status fall_dissect_scope(
    const struct fall_log *log, const struct fall_opt *opt, struct fall_contacts *out)
{
    const enum fall_status status = fall_dissect(log, opt->min_samples, out);
    if (status != FALL_OK) { return status; }
    switch (opt->scope) {
    case FALL_SCOPE_FIRST: keep_first(out); break;
    case FALL_SCOPE_MOVES: keep_moving(log, opt->step_m, out); break;
    case FALL_SCOPE_WHOLE: widen(log, out); break;
    case FALL_SCOPE_ALL:
    case FALL_SCOPES: break;
    }
    return FALL_OK;
}
