/* SPDX-License-Identifier: MIT */
/* Faults at random times, as tables: the worst of each rate, every kind, what was wrong. */
#include "lab/faults/part.h"

#include "exhand/error.h"

#include <inttypes.h>

/* In at least so many cases the force must have fallen nearly as fast as the law. If no fall or
 * only slower ones were seen, the test did not see the release. */
#define ENOUGH 100
#define NEAR   0.99

static const char *const scene_name[FAULTS_SCENES] = {"a mass falls", "a finger presses"};

static void print_what(FILE *f, const struct faults_wrong *w, int k)
{
    const struct faults_what *a = &w->what[k];
    const struct faults_spec *spec = faults_spec_of(a->source);
    if (a->source == FAULTS_NOTHING) { return; }
    fprintf(f, "%s %s (%s) how %#" PRIx32, k ? ", then" : ":", spec->name, spec->what, a->how);
    if (k) { fprintf(f, " after %" PRIu32, a->after_ticks); }
    if (a->for_ticks) { fprintf(f, " for %" PRIu32, a->for_ticks); }
    fprintf(f, ": seen in %" PRId32 " in state %" PRId32, w->seen_ticks[k], w->state[k]);
}

/* The first of each run. */
void faults_print_wrong(FILE *f, const struct faults_random *r, int n)
{
    for (int i = 0; i < n; i++) {
        for (int k = 0; k < r[i].bad && k < FAULTS_WRONGS; k++) {
            const struct faults_wrong *w = &r[i].wrong[k];
            fprintf(f, "WRONG at %" PRIu32 " Hz, %s, --run %" PRIu32 ", tick %" PRIu32 "%s%s",
                r[i].rate_Hz, scene_name[r[i].scene], w->run, w->tick, w->cards ? ", cards" : "",
                w->eager ? ", eager" : "");
            print_what(f, w, 0);
            print_what(f, w, 1);
            fprintf(f, ": bad %#" PRIx32 "\n", w->bad);
        }
    }
}

/* Each kind of fault in a row. */
static void print_kinds(FILE *f, const struct faults_random *r, int n)
{
    fprintf(f, "\n| fault that came first | what happens | times | seen | wrong "
               "|\n|---|---|---|---|---|\n");
    for (unsigned s = 1; s <= FAULTS_OFF; s++) {
        struct faults_count c = {0, 0, 0, 0};
        for (int i = 0; i < n; i++) {
            c.n += r[i].by[s].n;
            c.seen += r[i].by[s].seen;
            c.bad += r[i].by[s].bad;
        }
        fprintf(f, "| %s | %s | %" PRId32 " | %" PRId32 " | %" PRId32 " |\n",
            faults_spec_of(s)->name, faults_spec_of(s)->what, c.n, c.seen, c.bad);
    }
}

static void print_rules(FILE *f, const struct faults_random *r, int n)
{
    static const char *const rule[FAULTS_BADS] = {"force rose", "fell too fast", "not zero in time",
        "not cut", "still enabled", "opened again", "code too far", "current in the motor",
        "branch lost", "not the same from its bytes"};
    int32_t late = 0;
    fprintf(f, "\n| rule broken | times |\n|---|---|\n");
    for (int k = 0; k < FAULTS_BADS; k++) {
        int32_t sum = 0;
        for (int i = 0; i < n; i++) { sum += r[i].kinds[k]; }
        fprintf(f, "| %s | %" PRId32 " |\n", rule[k], sum);
    }
    for (int i = 0; i < n; i++) { late += r[i].late; }
    fprintf(f, "| not seen in time | %" PRId32 " |\n", late);
}

static void print_rate(FILE *f, const struct faults_random *x)
{
    fprintf(f,
        "| %" PRIu32 " Hz | %s | %" PRId32 " | %" PRId32 " | %" PRId32 " | %" PRId32 " | %.1f ms ",
        x->rate_Hz, scene_name[x->scene], x->n, x->open, x->released, x->zero_ticks,
        1e3 * x->zero_s);
    fprintf(f, "| %.1f N | %.4f | %.2f m/s, %.0f m/s³ | %.2f m/s, %.0f m/s³ | %" PRId32 " |\n",
        x->force_N, x->slope, x->back_mps, x->jerk_mps3, x->cut_back_mps, x->cut_jerk_mps3, x->bad);
}

int faults_print_random(FILE *f, const struct faults_random *r, int n)
{
    int32_t all = 0, bad = 0;
    int err = 0;
    fprintf(f,
        "Each row has the worst case of a rate and a scene.\n\n"
        "- zero in: the first tick without force; the tick that saw the cause is 1\n"
        "- none in the motor after: time from that tick to a motor without current\n"
        "- fall over the law's: steepest fall of a tick over the law's force/R\n"
        "- released, cut: speed and jerk of finger or mass in the 50 ms after, tick to tick\n\n"
        "| rate | scene | times | gate open | released | zero in | none in the motor after | "
        "held | fall over the law's | released | cut | wrong |\n"
        "|---|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (int i = 0; i < n; i++) {
        if (r[i].rate_Hz) { print_rate(f, &r[i]); } /* one run is of one */
        all += r[i].n;
        bad += r[i].bad;
        err |= r[i].err != 0 || (r[i].n >= ENOUGH && r[i].slope < NEAR);
    }
    print_kinds(f, r, n);
    fprintf(f, "\n%" PRId32 " times: %" PRId32 " wrong.\n", all, bad);
    print_rules(f, r, n);
    for (int i = 0; i < n; i++) {
        if (r[i].err) {
            fprintf(f, "WRONG at %" PRIu32 " Hz, %s: %s\n", r[i].rate_Hz, scene_name[r[i].scene],
                exh_error_text(r[i].err));
        }
    }
    return bad || err || all == 0 ? 1 : 0;
}
