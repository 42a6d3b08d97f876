/* SPDX-License-Identifier: MIT */
#include "falls/rest.h"

#include "falls/dissect.h"

const struct fall_rest_opt fall_rest_opt_default = {
    .observe_s = 5.0,
    .window_s = 0.5,
    .travel_m = 0.25e-3,
    .force_N = 4.0,
    .encoder_step_m = 0.0,
    .range_m = 1.99,
};

const char *fall_rest_text(enum fall_rest_class rest)
{
    switch (rest) {
    case FALL_AT_REST: return "rest";
    case FALL_BUZZ: return "buzz";
    case FALL_OSCILLATES: return "oscillates";
    case FALL_INCOMPLETE: return "incomplete";
    case FALL_REST_CLASSES: break;
    }
    return "unknown";
}

struct span {
    double q_lo, q_hi, f_lo, f_hi;
    size_t n, touching;
};

static void span_add(struct span *w, const struct fall_sample *s)
{
    if (w->n == 0 || s->q_m < w->q_lo) { w->q_lo = s->q_m; }
    if (w->n == 0 || s->q_m > w->q_hi) { w->q_hi = s->q_m; }
    if (w->n == 0 || s->f_mon_N < w->f_lo) { w->f_lo = s->f_mon_N; }
    if (w->n == 0 || s->f_mon_N > w->f_hi) { w->f_hi = s->f_mon_N; }
    w->touching += s->c != 0;
    w->n++;
}

/* Counts in the log are rounded: a quarter of a step distinguishes 2 from 3 counts, and 1 from
 * none. */
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
    struct span w = {0.0, 0.0, 0.0, 0.0, 0, 0};

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
    /* A constant position at the end of its range gives no information about the mass, nor does a
     * slack string: the mass may be in flight. */
    if (rest != FALL_OSCILLATES &&
        (w.q_lo <= -opt->range_m || w.q_hi >= opt->range_m || w.touching == 0)) {
        return;
    }
    out->travel_m = w.q_hi - w.q_lo;
    out->force_N = w.f_hi - w.f_lo;
    out->rest = rest;
}

static int rest_opt_ok(const struct fall_rest_opt *o)
{
    return o->window_s > 0.0 && o->window_s <= o->observe_s && fall_sane(o->observe_s) &&
           o->travel_m >= 0.0 && fall_sane(o->travel_m) && o->force_N >= 0.0 &&
           fall_sane(o->force_N) && o->encoder_step_m >= 0.0 && fall_sane(o->encoder_step_m) &&
           o->range_m > 0.0 && fall_sane(o->range_m);
}

enum fall_status fall_rest(const struct fall_log *log, const struct fall_contacts *contacts,
    const struct fall_rest_opt *opt, struct fall_rest *out)
{
    const enum fall_status status = fall_check_log(log);

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
