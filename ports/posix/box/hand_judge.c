/* SPDX-License-Identifier: MIT */
#include "box/hand_judge.h"

#include "exhand/units.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MISSED_M 1e-3
#define HELD_S   0.2 /* of the hold's end that is averaged */
#define PATH_B   1100

static double si(int32_t raw, int frac) { return (double)raw / (double)(INT64_C(1) << frac); }

struct fall_sample bilateral_si(const struct bilateral_sample *s, size_t tick, struct exh_period T)
{
    const struct fall_sample f = {
        .t_s = (double)tick * T.num / T.den,
        .q_m = si(s->raw.q_m_q30, EXH_Q_POS),
        .qd_mps = si(s->raw.qd_mps_q27, EXH_Q_VEL),
        .f_des_N = si(s->raw.f_des_N_q20, EXH_Q_FORCE),
        .i_des_A = si(s->raw.i_des_A_q26, EXH_Q_CUR),
        .f_mon_N = si(s->raw.f_mon_N_q20, EXH_Q_FORCE),
        .c = s->raw.c,
    };
    return f;
}

/* --- one contact --- */

/* Where the mean over the hold's end is taken. */
static size_t held_from(const struct bilateral_contact *c, struct exh_period T)
{
    const size_t most = (size_t)(HELD_S * T.den / T.num) + 1;
    return c->hold_end - c->first > most ? c->hold_end - most : c->first;
}

static int beyond(double v, double mean, double most) { return v - mean > most || mean - v > most; }

/* How long until all that follows stays in the bands. */
static double stays_s(const struct bilateral_track *t, const struct bilateral_contact *c,
    struct exh_period T, double force_N, double way_m)
{
    const size_t from = held_from(c, T);
    size_t last = c->first;
    double q_m = 0;
    for (size_t i = from; i < c->hold_end; i++) { q_m += si(t->at[i].raw.q_m_q30, EXH_Q_POS); }
    q_m /= (double)(c->hold_end - from);
    for (size_t i = c->first; i < c->hold_end; i++) {
        if (beyond(si(t->at[i].raw.f_mon_N_q20, EXH_Q_FORCE), c->held_N, force_N) ||
            beyond(si(t->at[i].raw.q_m_q30, EXH_Q_POS), q_m, way_m)) {
            last = i + 1;
        }
    }
    if (last >= c->hold_end || c->held_N <= 0) { return -1; }
    return (double)(last - c->first) * T.num / T.den;
}

static double rise_Nps(
    const struct bilateral_track *t, const struct bilateral_contact *c, struct exh_period T)
{
    const double rate_Hz = (double)T.den / T.num;
    const size_t ms = rate_Hz > 1000 ? (size_t)(rate_Hz / 1000) : 1;
    double most = 0;
    for (size_t i = c->first; i <= c->first + 2 * ms && i + ms < t->n; i++) {
        const double up_N = si(t->at[i + ms].raw.f_mon_N_q20, EXH_Q_FORCE) -
                            si(t->at[i].raw.f_mon_N_q20, EXH_Q_FORCE);
        if (up_N * rate_Hz / (double)ms > most) { most = up_N * rate_Hz / (double)ms; }
    }
    return most;
}

static void judge_contact(
    const struct bilateral_run *r, const struct bilateral_track *t, struct bilateral_contact *c)
{
    const struct bilateral_sample *s = &t->at[c->first];
    c->t_s = (double)c->first * r->T.num / r->T.den;
    c->speed_mps = si(s->raw.qd_mps_q27, EXH_Q_VEL);
    c->lim_m = si(s->raw.q_lim_m_q30, EXH_Q_POS);
    c->nothing = s->touch_m < 0;
    c->off_m = c->nothing
                   ? (double)NAN
                   : c->lim_m - s->touch_m + t->at[0].x_m - si(t->at[0].raw.q_m_q30, EXH_Q_POS);
    c->early = c->off_m < -EARLY_M;
    c->held_N = 0;
    for (size_t i = held_from(c, r->T); i < c->hold_end; i++) {
        c->held_N += si(t->at[i].raw.f_mon_N_q20, EXH_Q_FORCE);
    }
    c->held_N /= (double)(c->hold_end - held_from(c, r->T));
    c->settle_s = stays_s(t, c, r->T, SETTLED_BAND * c->held_N, 1);
    c->rise_Nps = rise_Nps(t, c, r->T);
    c->rest_s = stays_s(t, c, r->T, 1.5, 0.2e-3);
    c->stiffness_Npm = bilateral_stiffness(r, c->finger, c->approach, NULL).k_Npm;
}

int bilateral_judge(const struct bilateral_run *r, unsigned f, struct bilateral_contact *c, int cap)
{
    const struct bilateral_track *t = &r->finger[f];
    int n = 0;
    for (size_t i = 0; i < t->n;) {
        struct bilateral_contact k = {
            .finger = f, .approach = t->at[i].approach, .settle_s = -1, .rest_s = -1};
        double deepest_m = -1;
        int touched = 0;
        for (; i < t->n && t->at[i].approach == k.approach; i++) {
            const struct bilateral_sample *s = &t->at[i];
            if (s->inside_m > deepest_m) { deepest_m = s->inside_m; }
            if (s->bits & EXH_PRECONTACT_FREEZE) { k.frozen = 1; }
            if (s->bits & EXH_PRECONTACT_AROUND) { k.around = 1; }
            if (s->holds) { k.hold_end = i + 1; }
            if (si(s->raw.f_des_N_q20, EXH_Q_FORCE) > k.f_max_N) {
                k.f_max_N = si(s->raw.f_des_N_q20, EXH_Q_FORCE);
            }
            if (s->raw.c && !touched) {
                touched = 1;
                k.first = i;
                k.late = (s->bits & EXH_PRECONTACT_LATE) != 0;
                k.late_m = si(s->raw.d_m_q30, EXH_Q_POS);
            }
        }
        if (k.approach == 0) { continue; }
        k.missed = !touched && deepest_m > MISSED_M;
        if (touched) {
            if (k.hold_end <= k.first) { k.hold_end = k.first + 1; }
            judge_contact(r, t, &k);
        }
        if (n < cap) { c[n] = k; }
        n++;
    }
    return n;
}

/* --- stiffness --- */

static struct bilateral_line line_of(const struct fall_log *log, const char *plot)
{
    struct fall_stiffness s;
    struct bilateral_line line = {0, 0, 0, 0};
    if (fall_stiffness(log, &fall_opt_default, &s) != FALL_OK) { return line; }
    if (s.fit.status == FALL_OK) {
        line = (struct bilateral_line){s.fit.b_Npm, s.b.lo_Npm, s.b.hi_Npm, s.fit.r2};
    }
    if (plot) {
        char raw[PATH_B], averaged[PATH_B], ends[PATH_B];
        const struct fall_plot_paths paths = {raw, averaged, ends};
        snprintf(raw, sizeof raw, "%s_raw.csv", plot);
        snprintf(averaged, sizeof averaged, "%s_avg.csv", plot);
        snprintf(ends, sizeof ends, "%s_line.csv", plot);
        (void)fall_write_plot(&s, FALL_B, &paths);
    }
    fall_stiffness_free(&s);
    return line;
}

/* Where each approach froze its q_lim is its own: positions are counted from there, or places that
 * differ would be read as softness. Before the freeze q_lim moves, and no pair is taken. */
static struct fall_sample past_lim(
    const struct bilateral_sample *s, size_t tick, struct exh_period T)
{
    struct fall_sample f = bilateral_si(s, tick, T);
    f.q_m -= si(s->raw.q_lim_m_q30, EXH_Q_POS);
    return f;
}

struct bilateral_line bilateral_stiffness(
    const struct bilateral_run *r, unsigned f, int approach, const char *plot)
{
    const struct bilateral_track *t = &r->finger[f];
    struct fall_sample *sample = calloc(t->n + 1, sizeof *sample);
    size_t *start = calloc(t->n + 1, sizeof *start);
    struct fall_log log = {sample, 0, start, 0};
    struct bilateral_line line = {0, 0, 0, 0};
    int now = 0;
    for (size_t i = 0; sample && start && i < t->n; i++) {
        const int which = t->at[i].approach;
        if (which == 0 || (approach && which != approach)) { continue; }
        if (which != now) { start[log.falls++] = log.samples; }
        now = which;
        sample[log.samples++] = past_lim(&t->at[i], i, r->T);
    }
    if (log.falls) { line = line_of(&log, plot); }
    free(sample);
    free(start);
    return line;
}

/* --- of several --- */

static int by_size(const void *a, const void *b)
{
    const double d = *(const double *)a - *(const double *)b;
    return d < 0 ? -1 : d > 0;
}

void bilateral_count(struct bilateral_count *to, const struct bilateral_contact *c, int n,
    struct bilateral_line line)
{
    double *settle = calloc((size_t)n + 1, sizeof *settle);
    memset(to, 0, sizeof *to);
    to->contacts = n;
    to->line = line;
    for (int i = 0; i < n; i++) {
        if (settle && c[i].settle_s >= 0) { settle[to->settled++] = c[i].settle_s; }
        to->missed += c[i].missed;
        to->early += c[i].early;
        to->late += c[i].late;
    }
    if (to->settled) {
        qsort(settle, (size_t)to->settled, sizeof settle[0], by_size);
        to->settle_s = settle[to->settled / 2];
    }
    free(settle);
}
