/* SPDX-License-Identifier: MIT */
#include "falls/dissect.h"

#include <stdlib.h>

static int sample_sane(const struct fall_sample *s)
{
    return fall_sane(s->t_s) && fall_sane(s->q_m) && fall_sane(s->qd_mps) &&
           fall_sane(s->f_des_N) && fall_sane(s->i_des_A) && fall_sane(s->f_mon_N);
}

size_t fall_end(const struct fall_log *log, size_t fall)
{
    return fall + 1 < log->falls ? log->start[fall + 1] : log->samples;
}

enum fall_status fall_check_log(const struct fall_log *log)
{
    if (log->falls == 0) { return FALL_BAD_LOG; }
    for (size_t f = 0; f < log->falls; f++) {
        const size_t end = fall_end(log, f);
        if (log->start[f] >= end || end > log->samples) { return FALL_BAD_LOG; }
        for (size_t i = log->start[f]; i < end; i++) {
            const struct fall_sample *s = &log->sample[i];
            if (!sample_sane(s)) { return FALL_BAD_LOG; }
            if (i > log->start[f] && !(s->t_s > s[-1].t_s)) { return FALL_BAD_LOG; }
        }
    }
    return FALL_OK;
}

/* The next contact of a fall at or after `from`; 0: none. */
static int next_contact(
    const struct fall_log *log, size_t fall, size_t from, struct fall_contact *out)
{
    const size_t end = fall_end(log, fall);
    size_t i = from;

    while (i < end && !log->sample[i].c) { i++; }
    if (i == end) { return 0; }
    out->first = i;
    while (i < end && log->sample[i].c) { i++; }
    out->end = i;
    out->fall = fall;
    out->open = i == end;
    return 1;
}

/* Counts the contacts; keeps them too when `at` is there. */
static size_t scan(const struct fall_log *log, size_t min_samples, struct fall_contact *at)
{
    struct fall_contact c;
    size_t n = 0;

    for (size_t f = 0; f < log->falls; f++) {
        for (size_t from = log->start[f]; next_contact(log, f, from, &c); from = c.end) {
            if (c.end - c.first < min_samples) { continue; }
            if (at) { at[n] = c; }
            n++;
        }
    }
    return n;
}

enum fall_status fall_dissect(
    const struct fall_log *log, size_t min_samples, struct fall_contacts *out)
{
    *out = (struct fall_contacts){NULL, 0};
    const enum fall_status status = fall_check_log(log);
    if (status != FALL_OK) { return status; }

    const size_t n = scan(log, min_samples, NULL);
    out->at = fall_alloc(n, sizeof *out->at);
    if (!out->at) { return FALL_NO_MEMORY; }
    out->n = scan(log, min_samples, out->at);
    return FALL_OK;
}

void fall_contacts_free(struct fall_contacts *contacts)
{
    free(contacts->at);
    *contacts = (struct fall_contacts){NULL, 0};
}
