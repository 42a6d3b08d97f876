/* SPDX-License-Identifier: MIT */
/* Any fault at any tick: random times in closed loop, two causes, contacts that close again, RUN
 * commanded in every tick. */
#include "lab/faults/part.h"

#include "base/jobs.h"
#include "base/option.h"
#include "posix.h"

#include "sim/random.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

static const uint32_t rate_Hz[] = {90, 200, 400, 500, 1000, 2000};
#define RATES     (sizeof rate_Hz / sizeof rate_Hz[0])
#define CASES_MAX 400 /* of one run */
#define CONTROL   32  /* one of so many has no fault */
#define UNTIL_S   2.2
#define QUIET_S   0.25 /* the gate may not open without a command for so long */

struct one {
    uint32_t tick;
    struct faults_case c;
};

struct plan {
    struct faults_base base;
    struct one at[CASES_MAX];
    int n, next;
    uint32_t run;
    struct faults_random *sum;
};

struct asked {
    int total, jobs, first; /* times in all, number of runs, first run to do */
    uint64_t seed;
};

/* --- what to try --- */

static uint8_t some_source(struct sim_random *r, uint8_t scene)
{
    uint8_t source;
    do {
        source = (uint8_t)(1 + sim_random_u64(r) % FAULTS_OFF);
    } while (!faults_has(scene, source));
    return source;
}

static struct faults_what some(struct sim_random *r, uint8_t scene)
{
    struct faults_what w = {some_source(r, scene), 0, 0, 0, FAULTS_ANYWHERE};
    w.how = (uint32_t)sim_random_u64(r) | 0x10000u;
    if (sim_random_u64(r) & 1) { w.for_ticks = 1 + (uint32_t)(sim_random_u64(r) % 40); }
    if (faults_is_memory(w.source)) { w.for_ticks = 0; } /* no bit turns back */
    return w;
}

/* Time to see both, to release, and then some. */
static uint32_t follow(const struct faults_case *c, unsigned scene, uint32_t rate)
{
    uint32_t n = (uint32_t)((QUIET_S + 0.02) * rate) + 8;
    for (int k = 0; k < 2; k++) {
        n += c->what[k].after_ticks + faults_seen_within(scene, c->what[k].source, rate);
    }
    return n;
}

static int by_tick(const void *a, const void *b)
{
    const struct one *x = a, *y = b;
    return (x->tick > y->tick) - (x->tick < y->tick);
}

static void plan_of(struct plan *p, const struct asked *a, int job)
{
    struct sim_random r = {a->seed ^ (uint64_t)job * UINT64_C(0xD1B54A32D192ED03)};
    const int rest = a->total % a->jobs;
    memset(p, 0, sizeof *p);
    p->run = (uint32_t)job;
    p->base.rate_Hz = rate_Hz[(size_t)job % RATES];
    p->base.scene = (uint8_t)((size_t)job / RATES % FAULTS_SCENES);
    p->base.cards = sim_random_u64(&r) & 1;
    p->base.gentle = sim_random_u64(&r) % 3 != 0;
    p->base.seed = (uint32_t)sim_random_u64(&r);
    p->n = a->total / a->jobs + (job < rest);
    for (int i = 0; i < p->n; i++) {
        struct one *o = &p->at[i];
        o->tick = (uint32_t)(sim_random_unit(&r) * UNTIL_S * p->base.rate_Hz);
        o->c.what[0] = some(&r, p->base.scene);
        if (i % CONTROL == 0) { o->c.what[0].source = FAULTS_NOTHING; }
        if (i % CONTROL && sim_random_u64(&r) & 1) {
            do {
                o->c.what[1] = some(&r, p->base.scene);
            } while (
                faults_is_memory(o->c.what[0].source) &&
                o->c.what[1].source == o->c.what[0].source); /* one bit, which may be the same */
            o->c.what[1].after_ticks = 1 + (uint32_t)(sim_random_unit(&r) * 0.03 * p->base.rate_Hz);
        }
        o->c.eager = sim_random_u64(&r) % 4 == 0;
        o->c.follow_ticks = follow(&o->c, p->base.scene, p->base.rate_Hz);
    }
    qsort(p->at, (size_t)p->n, sizeof p->at[0], by_tick);
}

/* An eager user may have RUN in OFF, and may clear by letting go of the dead-man and taking it
 * again. So these cases are not eager. A fault that is gone before arming is no cause, so it
 * stays. */
static void fit(struct faults_case *c, const struct faults_view *v)
{
    for (int k = 0; k < 2; k++) {
        const uint8_t s = c->what[k].source;
        if (s == FAULTS_DEADMAN || s == FAULTS_OFF) { c->eager = 0; }
        if (!v->open && v->state != EXH_STATE_FAULT) { c->what[k].for_ticks = 0; }
    }
    if (!v->open) { c->eager = 0; }
}

/* --- results --- */

/* 1 if a cause was to be seen and was not. */
static int unseen(const struct plan *p, const struct one *o, const struct faults_seen *s, int k)
{
    const struct faults_what *w = &o->c.what[k], *other = &o->c.what[!k];
    const struct faults_spec *spec = faults_spec_of(w->source);
    const struct faults_spec *beside = faults_spec_of(other->source);
    const uint32_t within =
        faults_seen_beside(p->base.scene, w->source, other->source, p->base.rate_Hz);
    const int gone = w->for_ticks && w->for_ticks <= within; /* before it had to be seen */
    if (w->source == FAULTS_NOTHING || spec->bits == 0 || spec->may) { return 0; }
    /* A report after the second fault has begun may be the second's. */
    if (k == 0 && gone && (beside->bits | beside->also) & spec->bits &&
        s->seen_ticks[0] >= (int32_t)other->after_ticks) {
        return 0;
    }
    if (s->seen_ticks[k] >= 0) { return s->seen_ticks[k] > (int32_t)within; }
    if (gone) { return 0; }
    return !s->ended;
}

static void note(
    struct faults_wrong *w, const struct plan *p, const struct one *o, const struct faults_seen *s)
{
    memset(w, 0, sizeof *w);
    w->run = p->run;
    w->tick = o->tick;
    w->eager = o->c.eager;
    w->cards = p->base.cards;
    w->bad = s->bad;
    for (int k = 0; k < 2; k++) {
        w->what[k] = o->c.what[k];
        w->seen_ticks[k] = s->seen_ticks[k];
        w->state[k] = s->state[k];
    }
}

static void count(struct plan *p, const struct one *o, const struct faults_seen *s)
{
    struct faults_random *r = p->sum;
    struct faults_count *c = &r->by[o->c.what[0].source];
    const int late = unseen(p, o, s, 0) || unseen(p, o, s, 1);
    const int released = s->slope > 0;
    const int dead =
        o->c.what[0].source == FAULTS_DEAD_LOOP || o->c.what[1].source == FAULTS_DEAD_LOOP;
    r->n++;
    r->open += s->from.open != 0;
    c->n++;
    if (s->seen_ticks[0] >= 0) {
        c->seen++;
        if (s->seen_ticks[0] > c->seen_ticks) { c->seen_ticks = s->seen_ticks[0]; }
    }
    r->late += late;
    if (s->bad || late) {
        c->bad++;
        for (int k = 0; k < FAULTS_BADS; k++) { r->kinds[k] += (int32_t)(s->bad >> k & 1); }
        if (r->bad < FAULTS_WRONGS) { note(&r->wrong[r->bad], p, o, s); }
        r->bad++;
    }
    /* A loop that is dead codes nothing: there it is the motor's current that counts. */
    if (s->from.open && !dead && s->zero_ticks > r->zero_ticks) { r->zero_ticks = s->zero_ticks; }
    if (s->from.open && released && s->zero_s > r->zero_s) { r->zero_s = s->zero_s; }
    if (s->slope > r->slope) { r->slope = s->slope; }
    if (s->force_N > r->force_N) { r->force_N = s->force_N; }
    r->released += released;
    if (released && s->jerk_mps3 > r->jerk_mps3) { r->jerk_mps3 = s->jerk_mps3; }
    if (released && s->back_mps > r->back_mps) { r->back_mps = s->back_mps; }
    if (!released && s->force_N > 0 && s->jerk_mps3 > r->cut_jerk_mps3) {
        r->cut_jerk_mps3 = s->jerk_mps3;
    }
    if (!released && s->force_N > 0 && s->back_mps > r->cut_back_mps) {
        r->cut_back_mps = s->back_mps;
    }
}

/* A tick that was late once is no cause any more when RUN comes: then it may run. */
static int passes(const struct faults_case *c)
{
    return c->what[0].source == FAULTS_LATE || c->what[1].source == FAULTS_LATE;
}

static void at(void *ctx, uint32_t tick, const struct faults_view *v)
{
    struct plan *p = ctx;
    for (; p->next < p->n && p->at[p->next].tick <= tick; p->next++) {
        struct one *o = &p->at[p->next];
        struct faults_seen s;
        fit(&o->c, v);
        if (tick < faults_run_tick() && !passes(&o->c)) { o->c.run_tick = faults_run_tick(); }
        if (faults_branch(&p->base, &o->c, tick, v, &s)) { return; }
        if (o->c.what[0].source == FAULTS_NOTHING) {
            struct faults_seen whole;
            o->c.whole = 1;
            if (faults_branch(&p->base, &o->c, tick, v, &whole)) { return; }
            if (s.digest != whole.digest) { s.bad |= FAULTS_BAD_BYTES; }
        }
        count(p, o, &s);
    }
    if (p->next == p->n) { posix_stop(); }
}

static void work(const void *ctx, int i, void *result)
{
    static struct plan plan;
    const struct asked *a = ctx;
    struct faults_random *r = result;
    plan_of(&plan, a, a->first + i);
    memset(r, 0, sizeof *r);
    r->rate_Hz = plan.base.rate_Hz;
    r->scene = plan.base.scene;
    plan.sum = r;
    r->err = faults_run(&plan.base, at, &plan);
}

/* --- all of them --- */

#define WORST(field) \
    if (from->field > to->field) { to->field = from->field; }

static void add(struct faults_random *to, const struct faults_random *from)
{
    to->n += from->n;
    to->open += from->open;
    to->bad += from->bad;
    to->late += from->late;
    to->released += from->released;
    if (from->err) { to->err = from->err; }
    WORST(zero_ticks)
    WORST(zero_s)
    WORST(slope)
    WORST(force_N)
    WORST(jerk_mps3)
    WORST(back_mps)
    WORST(cut_jerk_mps3)
    WORST(cut_back_mps)
    for (int k = 0; k < FAULTS_BADS; k++) { to->kinds[k] += from->kinds[k]; }
    for (int k = 0; k < FAULTS_SOURCES; k++) {
        to->by[k].n += from->by[k].n;
        to->by[k].seen += from->by[k].seen;
        to->by[k].bad += from->by[k].bad;
        WORST(by[k].seen_ticks)
    }
}

/* A single run is the same as among all: --times gives how many cases each has. */
int faults_random(FILE *f, int total, uint64_t seed, int run, int parallel)
{
    const int groups = (int)RATES * FAULTS_SCENES;
    struct asked a = {total, groups, 0, seed};
    struct faults_random *r, sum[RATES][FAULTS_SCENES];
    struct jobs jobs = {0, parallel, sizeof *r, NULL, work, &a, "runs", posix_interrupt};
    int err;
    while (total > a.jobs * CASES_MAX) { a.jobs += groups; }
    if (run >= a.jobs) {
        cli_complain("no run %d: %d times are runs 0 to %d", run, total, a.jobs - 1);
        return 2;
    }
    jobs.n = run < 0 ? a.jobs : 1;
    a.first = run < 0 ? 0 : run;
    r = calloc((size_t)jobs.n, sizeof *r);
    if (r == NULL) {
        cli_complain("out of memory: fewer --times");
        return 1;
    }
    jobs.result = r;
    err = jobs_run(&jobs);
    memset(sum, 0, sizeof sum);
    for (int i = 0; i < jobs.n; i++) {
        const size_t k = (size_t)(a.first + i);
        struct faults_random *s = &sum[k % RATES][k / RATES % FAULTS_SCENES];
        s->rate_Hz = r[i].rate_Hz;
        s->scene = r[i].scene;
        add(s, &r[i]);
    }
    err = err ? err : faults_print_random(f, &sum[0][0], groups);
    faults_print_wrong(f, r, jobs.n);
    free(r);
    return err;
}
