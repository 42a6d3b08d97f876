/* SPDX-License-Identifier: MIT */
/* Arming that does not come to RUN: every step of it that does not hold, and which one the box
 * names. */
#include "lab/faults/part.h"

#include "base/jobs.h"
#include "base/names.h"
#include "posix.h"

#include <inttypes.h>
#include <string.h>

#define RATES     3
#define WELL_S    0.25
#define GIVE_UP_S 4u /* it never comes to that */

enum when {
    ASKED,  /* in OFF, before RUN is commanded */
    INSIDE, /* in OFF, RUN commanded while a finger is inside a wall */
    RISING  /* while the force limit rises */
};

static const struct row {
    uint8_t step, loses; /* enum exh_arm: which is named; which does not hold in memory */
    uint8_t source;      /* or the fault, enum faults_source */
    uint8_t when;
    const char *what;
} step[] = {
    {EXH_ARM_SELFTEST, EXH_ARM_SELFTEST, 0, ASKED, "a self-test gives a wrong answer"},
    {EXH_ARM_CALIBRATION, 0, 0, ASKED, "no calibration is loaded, and none is waived"},
    {EXH_ARM_POLARITY, EXH_ARM_POLARITY, 0, ASKED, "it is not confirmed"},
    {EXH_ARM_ENCODER, 0, FAULTS_JUMP, ASKED, "the position is lost"},
    {EXH_ARM_DEADMAN, 0, FAULTS_DEADMAN, ASKED, "not held"},
    {EXH_ARM_DEADMAN, 0, FAULTS_ESTOP, ASKED, "held, and another cause: e-stop"},
    {EXH_ARM_SMALL_FORCE, 0, 0, INSIDE, "a finger inside a wall"},
    {0, EXH_ARM_POLARITY, 0, RISING, "an earlier step fails"},
};
#define ROWS (sizeof step / sizeof step[0])

struct refused {
    int32_t err;
    uint8_t tried, right;
    uint8_t end, named, opened, released; /* results */
    uint32_t bad, faults;
    int32_t zero_ticks;
};

struct plan {
    struct faults_base base;
    const struct row *row;
    uint32_t rises_for;
    struct refused *to;
};

struct asked {
    uint32_t rate_Hz[RATES];
    int rates;
};

static int is_due(struct plan *p, uint32_t tick, const struct faults_view *v)
{
    p->rises_for += v->state == EXH_STATE_ARM && v->open;
    switch (p->row->when) {
    case ASKED: return tick == 2 + p->base.rate_Hz * 3 / 100;
    case INSIDE: return v->state == EXH_STATE_OFF && (v->limits & EXH_LIMIT_FORCE);
    default: return p->rises_for == p->base.rate_Hz / 10;
    }
}

static void keep(struct refused *r, const struct row *row, const struct faults_seen *s)
{
    const int rising = row->when == RISING;
    r->tried = 1;
    r->end = (uint8_t)s->end.state;
    r->named = (uint8_t)s->end.refused;
    r->opened = s->opened;
    r->released = s->released;
    r->bad = s->bad;
    r->faults = s->end.faults;
    r->zero_ticks = s->zero_ticks;
    r->right = s->bad == 0 && !s->ended && r->end == EXH_STATE_OFF && r->faults == 0 &&
               r->named == row->step && !s->end.open && r->released == rising &&
               (rising || !r->opened);
}

static void at(void *ctx, uint32_t tick, const struct faults_view *v)
{
    struct plan *p = ctx;
    struct faults_case c;
    struct faults_seen s;
    if (is_due(p, tick, v)) {
        memset(&c, 0, sizeof c);
        c.what[0].source = p->row->source;
        c.loses = p->row->loses;
        c.run_tick = p->row->when == ASKED    ? tick + p->base.rate_Hz / 50 + 2
                     : p->row->when == INSIDE ? tick + 1
                                              : 0;
        c.follow_ticks = (uint32_t)(WELL_S * p->base.rate_Hz);
        if (faults_branch(&p->base, &c, tick, v, &s)) { return; }
        keep(p->to, p->row, &s);
        posix_stop();
    }
    if (tick > GIVE_UP_S * p->base.rate_Hz) { posix_stop(); }
}

static void work(const void *ctx, int i, void *result)
{
    static struct plan p;
    const struct asked *a = ctx;
    memset(&p, 0, sizeof p);
    memset(result, 0, sizeof *p.to);
    p.to = result;
    p.row = &step[i / a->rates];
    p.base = (struct faults_base){.scene = FAULTS_BILATERAL, .cards = 1, .gentle = 1, .seed = 7};
    p.base.rate_Hz = a->rate_Hz[i % a->rates];
    p.base.not_run = p.row->when == INSIDE;
    p.base.not_waived = p.row->step == EXH_ARM_CALIBRATION;
    p.to->err = faults_run(&p.base, at, &p);
}

static const char *name_of(uint32_t bit)
{
    unsigned k = 0;
    while (bit >> k > 1) { k++; }
    return bit ? names_word(&names_arm, k) : "–";
}

static void print_row(FILE *f, const struct row *w, const struct refused *r, int rates)
{
    fprintf(f, "| %s | %s |", w->when == RISING ? "ramp" : name_of(w->step), w->what);
    if (w->when == RISING) {
        fprintf(f, " release ");
        for (int k = 0; k < rates; k++) { fprintf(f, "%s%" PRId32, k ? "/" : "", r[k].zero_ticks); }
        fprintf(f, ", OFF |");
    } else {
        fprintf(f, " OFF |");
    }
    fprintf(f, " %s |", name_of(r[0].named));
    for (int k = 0; k < rates; k++) {
        if (r[k].err || !r[k].right) {
            fprintf(f,
                " **WRONG**: err %" PRId32
                ", tried %d, end %d, named %#x, opened %d, released %d, bad %#" PRIx32
                ", latched %#" PRIx32,
                r[k].err, r[k].tried, r[k].end, r[k].named, r[k].opened, r[k].released, r[k].bad,
                r[k].faults);
        }
    }
    fprintf(f, "\n");
}

int faults_refusals(FILE *f, uint32_t at_Hz, int parallel)
{
    static struct refused r[ROWS * RATES];
    struct asked a = {{90, 1000, 2000}, RATES};
    struct jobs jobs = {0, parallel, sizeof r[0], r, work, &a, "refusals", posix_interrupt};
    int wrong = 0, err;
    if (at_Hz) {
        a.rate_Hz[0] = at_Hz;
        a.rates = 1;
    }
    jobs.n = (int)ROWS * a.rates;
    fflush(f); /* or each process would say again what is said by now */
    err = jobs_run(&jobs);
    if (err) { return err; }
    fprintf(f, "\nRUN is requested while a step of arming fails, in the same box at the same "
               "rates. The gate stays closed and nothing is latched.\n\n"
               "| step | cause | ends in | `arm_step` |\n|---|---|---|---|\n");
    for (size_t i = 0; i < ROWS; i++) {
        const struct refused *at_rates = &r[i * (size_t)a.rates];
        print_row(f, &step[i], at_rates, a.rates);
        for (int k = 0; k < a.rates; k++) { wrong += at_rates[k].err || !at_rates[k].right; }
    }
    fprintf(f, "\n%d refusals, each at %d rate%s: %d wrong.\n", (int)ROWS, a.rates,
        a.rates > 1 ? "s" : "", wrong);
    return wrong ? 1 : 0;
}
