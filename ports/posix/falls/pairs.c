/* SPDX-License-Identifier: MIT */
#include "falls/pairs.h"

#include <stdlib.h>
#include <string.h>

enum fall_status fall_pairs_alloc(struct fall_pairs *p, size_t cap)
{
    p->n = 0;
    p->at = fall_alloc(cap, sizeof *p->at);
    return p->at ? FALL_OK : FALL_NO_MEMORY;
}

void fall_pairs_free(struct fall_pairs *pairs)
{
    free(pairs->at);
    *pairs = (struct fall_pairs){NULL, 0};
}

enum fall_status fall_pool(const struct fall_log *log, const struct fall_contacts *contacts,
    size_t lag, struct fall_pairs *out)
{
    size_t n = 0;

    for (size_t i = 0; i < contacts->n; i++) {
        const size_t len = contacts->at[i].end - contacts->at[i].first;
        n += len > lag ? len - lag : 0;
    }
    if (fall_pairs_alloc(out, n) != FALL_OK) { return FALL_NO_MEMORY; }
    for (size_t i = 0; i < contacts->n; i++) {
        const struct fall_contact *c = &contacts->at[i];
        for (size_t q = c->first; lag < c->end - q; q++) {
            out->at[out->n].q_m = log->sample[q].q_m;
            out->at[out->n].f_N = log->sample[q + lag].f_mon_N;
            out->at[out->n].fall = c->fall;
            out->n++;
        }
    }
    return FALL_OK;
}

/* Merges [lo, mid) and [mid, hi). Of two equal forces the left one goes first, so the sort is
 * stable. The choice is a number, not a branch: it cannot be predicted. */
static void merge(
    const struct fall_pair *from, struct fall_pair *to, size_t lo, size_t mid, size_t hi)
{
    const struct fall_pair *left = from + lo, *right = from + mid;
    const struct fall_pair *const left_end = right, *const right_end = from + hi;

    for (to += lo; left < left_end && right < right_end; to++) {
        const int is_left = left->f_N <= right->f_N;
        *to = *(is_left ? left : right);
        left += is_left;
        right += !is_left;
    }
    memcpy(to, left, (size_t)(left_end - left) * sizeof *to);
    memcpy(to + (left_end - left), right, (size_t)(right_end - right) * sizeof *to);
}

static enum fall_status sort_by_force(struct fall_pairs *p)
{
    struct fall_pairs tmp;

    if (fall_pairs_alloc(&tmp, p->n) != FALL_OK) { return FALL_NO_MEMORY; }
    for (size_t run = 1; run < p->n; run *= 2) {
        for (size_t lo = 0; lo < p->n; lo += 2 * run) {
            const size_t mid = run < p->n - lo ? lo + run : p->n;
            const size_t hi = run < p->n - mid ? mid + run : p->n;
            merge(p->at, tmp.at, lo, mid, hi);
        }
        struct fall_pair *swap = p->at;
        p->at = tmp.at;
        tmp.at = swap;
    }
    fall_pairs_free(&tmp);
    return FALL_OK;
}

enum fall_status fall_band(
    const struct fall_pairs *in, double lo_N, double hi_N, struct fall_pairs *out)
{
    if (fall_pairs_alloc(out, in->n) != FALL_OK) { return FALL_NO_MEMORY; }
    for (size_t i = 0; i < in->n; i++) {
        if (in->at[i].f_N >= lo_N && in->at[i].f_N <= hi_N) { out->at[out->n++] = in->at[i]; }
    }
    return sort_by_force(out);
}

/* --- averages --- */

/* Each window is summed afresh, oldest first: no error is carried along, and equal
 * positions give equal averages to the last bit. */
static struct fall_pair window(const struct fall_pair *first, enum fall_force force)
{
    struct fall_pair out = first[FALL_WINDOW / 2];
    double q = 0.0, f = 0.0;

    for (size_t i = 0; i < FALL_WINDOW; i++) { q += first[i].q_m; }
    out.q_m = q / FALL_WINDOW;
    if (force == FALL_FORCE_NEWEST) { out.f_N = first[FALL_WINDOW - 1].f_N; }
    if (force == FALL_FORCE_MEAN) {
        for (size_t i = 0; i < FALL_WINDOW; i++) { f += first[i].f_N; }
        out.f_N = f / FALL_WINDOW;
    }
    return out;
}

/* `out` has room for as many pairs as `sorted` holds. */
void fall_average_into(
    const struct fall_pairs *sorted, enum fall_force force, struct fall_pairs *out)
{
    out->n = sorted->n < FALL_WINDOW ? 0 : sorted->n - (FALL_WINDOW - 1);
    for (size_t i = 0; i < out->n; i++) { out->at[i] = window(&sorted->at[i], force); }
}

enum fall_status fall_average(
    const struct fall_pairs *sorted, enum fall_force force, struct fall_pairs *out)
{
    if (fall_pairs_alloc(out, sorted->n) != FALL_OK) { return FALL_NO_MEMORY; }
    fall_average_into(sorted, force, out);
    return FALL_OK;
}
