/* SPDX-License-Identifier: MIT */
/* Every fault in every state of the box, at several rates. */
#include "lab/faults/part.h"

#include "base/jobs.h"
#include "base/option.h"
#include "posix.h"

#include <inttypes.h>
#include <string.h>

#define RATES_MAX 3
static uint32_t rate_Hz[RATES_MAX] = {90, 1000, 2000};
static size_t rates = RATES_MAX;
#define SOURCES   (FAULTS_SOURCES - 2) /* without FAULTS_NOTHING and FAULTS_OFF */
#define PASSES    4
#define GIVE_UP_S 8u /* it never presses */
#define WELL_S    0.25

struct cell {
    uint8_t tried, right;
    uint8_t before, state, end; /* enum exh_state: before it was seen, then, in the end */
    uint8_t refused;
    uint16_t bad;
    uint32_t latched;
    int32_t seen_ticks, zero_ticks;
};

/* of one source at one rate */
struct row {
    int32_t err;
    struct cell in[FAULTS_INS];
};

struct plan {
    struct faults_base base;
    uint8_t source;
    int pass;
    uint32_t press_for;          /* consecutive ticks in the state that the finger presses in */
    int32_t latency[FAULTS_INS]; /* < 0: not known */
    uint32_t small_at, ramp_at;  /* of the pass before; 0: not known */
    uint32_t press_at[2];        /* of the pass before, too: a limit holds, none does */
    struct row *row;
};

static unsigned source_of(unsigned row) { return row + 1 < FAULTS_OFF ? row + 1 : row + 2; }

/* --- when --- */

/* A tick in OFF, before any command. The link is up. */
static uint32_t early(const struct plan *p) { return 2 + p->base.rate_Hz * 3 / 100; }

/* Ticks in the state until then: what is left of the impact. */
static uint32_t pressed_for(const struct plan *p) { return 5 + p->base.rate_Hz / 16; }

static int state_of(unsigned in)
{
    static const int state[FAULTS_INS] = {EXH_STATE_OFF, EXH_STATE_OFF, EXH_STATE_ARM,
        EXH_STATE_ARM, EXH_STATE_RUN, EXH_STATE_LIMIT, EXH_STATE_RELEASE, EXH_STATE_FAULT};
    return state[in];
}

/* Until it is reported, the fault may lead from RUN to LIMIT, and back. */
static int is_in(int state, unsigned in, int32_t seen_ticks)
{
    const int runs = state == EXH_STATE_RUN || state == EXH_STATE_LIMIT;
    const int running = in == FAULTS_IN_RUN || in == FAULTS_IN_LIMIT;
    return state == state_of(in) || (runs && running && seen_ticks > 0);
}

static int sees(const struct plan *p, unsigned in)
{
    return faults_spec_of(p->source)->in >> in & 1;
}

static uint32_t latency(const struct plan *p, unsigned in)
{
    return sees(p, in) && p->latency[in] >= 0 ? (uint32_t)p->latency[in] : 0;
}

/* While it arms: the cause is to be seen d ticks after RUN is commanded, and one; fork at F, RUN
 * in R. 0: not in this tick. */
static int when_arming(const struct plan *p, unsigned in, uint32_t tick, struct faults_case *c)
{
    const uint32_t target =
        in == FAULTS_IN_SMALL ? p->small_at + 1 : p->ramp_at + (p->ramp_at - p->small_at) / 2 + 2;
    const uint32_t d = target - faults_run_tick(), late = latency(p, in);
    if (target - 1 >= late + early(p) && target - late >= early(p)) { /* the base's own command */
        c->run_tick = tick < faults_run_tick() ? faults_run_tick() : 0;
        return tick == target - late;
    }
    c->run_tick = early(p) + late - d;
    return tick == early(p);
}

static uint32_t how_of(unsigned source) { return source == FAULTS_PAR ? 8u * 4u * 40u + 3u : 0; }

/* RELEASE and FAULT are come to on the way. */
static void come_to(const struct plan *p, unsigned in, struct faults_case *c)
{
    const uint32_t late = latency(p, in);
    struct faults_what *first = &c->what[1];
    first->source = FAULTS_OFF;
    if (in == FAULTS_IN_FAULT) { /* there it stays */
        first->source = p->source == FAULTS_DEADMAN ? FAULTS_DRIVE : FAULTS_DEADMAN;
        c->what[0].after_ticks = faults_release_ticks(p->base.rate_Hz) + 3;
    } else if (late >= 1) {
        first->after_ticks = late - 1;
    } else {
        c->what[0].after_ticks = 1;
    }
}

static int is_due(struct plan *p, unsigned in, uint32_t tick, struct faults_case *c)
{
    /* A fault with a long latency begins so much earlier that it is seen while the finger
     * presses. */
    const int early_on = faults_is_memory(p->source) && in != FAULTS_IN_FAULT;
    const int pressed = early_on
                            ? p->pass > 0 && tick == p->press_at[p->base.gentle] - latency(p, in)
                            : p->press_for == pressed_for(p);
    memset(c, 0, sizeof *c);
    c->what[0].source = p->source;
    c->what[0].how = how_of(p->source);
    c->follow_ticks = (uint32_t)(WELL_S * p->base.rate_Hz);
    if (sees(p, in)) {
        c->follow_ticks += 20 + 2 * faults_seen_within(p->base.scene, p->source, p->base.rate_Hz);
    }
    if (faults_is_memory(p->source)) {
        c->what[0].place = in == FAULTS_IN_OFF || in == FAULTS_IN_ASKED || in == FAULTS_IN_FAULT
                               ? FAULTS_PASSED
                               : FAULTS_AHEAD;
    }
    switch (in) {
    case FAULTS_IN_OFF: return tick == early(p);
    case FAULTS_IN_ASKED:
        c->run_tick = early(p) + faults_seen_within(p->base.scene, p->source, p->base.rate_Hz) + 2;
        return tick == early(p);
    case FAULTS_IN_SMALL:
    case FAULTS_IN_RAMP: return p->pass > 0 && when_arming(p, in, tick, c);
    case FAULTS_IN_RUN: return p->base.gentle && pressed;
    case FAULTS_IN_LIMIT: return !p->base.gentle && pressed;
    default:
        if (p->pass > 0) { come_to(p, in, c); }
        return p->pass > 0 && p->base.gentle && pressed;
    }
}

/* --- results --- */

static void keep(struct plan *p, unsigned in, const struct faults_seen *s)
{
    const struct faults_spec *spec = faults_spec_of(p->source);
    const struct faults_view *before = s->seen_ticks[0] >= 0 ? &s->before[0] : &s->from;
    struct cell *c = &p->row->in[in];
    const int expects = sees(p, in), seen = s->seen_ticks[0] >= 0;
    memset(c, 0, sizeof *c);
    c->tried = 1;
    c->before = (uint8_t)before->state;
    c->state = (uint8_t)s->state[0];
    c->end = (uint8_t)s->end.state;
    c->bad = (uint16_t)s->bad;
    c->latched = s->end.faults;
    c->refused = (uint8_t)s->end.refused;
    c->seen_ticks = s->seen_ticks[0];
    c->zero_ticks = s->after_ticks;
    c->right = s->bad == 0 && seen == expects;
    if (seen && expects) {
        c->right &= is_in(before->state, in, s->seen_ticks[0]) &&
                    (in != FAULTS_IN_RAMP || before->open) &&
                    (in != FAULTS_IN_SMALL || !before->open);
        c->right &= (uint32_t)s->seen_ticks[0] <=
                    faults_seen_within(p->base.scene, p->source, p->base.rate_Hz);
        c->right &= s->state[0] == faults_next(p->source, before->state, before->open);
        c->right &= s->end.state == faults_end(p->source, before->state, before->open);
        c->right &= s->end.state == EXH_STATE_FAULT ? (s->end.faults & spec->bits) != 0
                                                    : s->end.faults == 0;
        c->right &=
            in != FAULTS_IN_ASKED || p->source == FAULTS_CARD /* the run has ended */ ||
            s->end.state == EXH_STATE_FAULT ||
            s->end.refused == (spec->bits & EXH_FAULT_ENCODER ? EXH_ARM_ENCODER : EXH_ARM_DEADMAN);
    }
    if (s->seen_ticks[0] >= 0) { p->latency[in] = s->seen_ticks[0]; }
    if (p->pass == 0 && in == FAULTS_IN_RUN) {
        for (unsigned k = 0; k < FAULTS_INS; k++) { p->latency[k] = s->seen_ticks[0]; }
    }
}

/* Where there is time before it for what is seen late. */
static uint32_t least(const struct plan *p)
{
    return faults_is_memory(p->source) ? latency(p, FAULTS_IN_RUN) + early(p) : 0;
}

static void watch(struct plan *p, uint32_t tick, const struct faults_view *v)
{
    const int state = p->base.gentle ? EXH_STATE_RUN : EXH_STATE_LIMIT;
    const int presses = v->state == state && tick >= least(p) &&
                        v->force_N_q20[faults_finger(p->base.scene)] > EXH_Q(3, 2, EXH_Q_FORCE);
    p->press_for = presses                          ? p->press_for + 1
                   : p->press_for >= pressed_for(p) ? pressed_for(p) + 1
                                                    : 0;
    if (p->press_for == pressed_for(p)) { p->press_at[p->base.gentle] = tick; }
    if (v->state == EXH_STATE_ARM && !v->open && p->small_at == 0) { p->small_at = tick; }
    if (v->state == EXH_STATE_ARM && v->open && p->ramp_at == 0) { p->ramp_at = tick; }
}

static void at(void *ctx, uint32_t tick, const struct faults_view *v)
{
    struct plan *p = ctx;
    watch(p, tick, v);
    for (unsigned in = 0; in < FAULTS_INS; in++) {
        struct faults_case c;
        struct faults_seen s;
        if (p->row->in[in].right || !is_due(p, in, tick, &c)) { continue; }
        if (faults_branch(&p->base, &c, tick, v, &s)) { return; }
        keep(p, in, &s);
    }
    if (p->press_for > pressed_for(p) || tick > GIVE_UP_S * p->base.rate_Hz) { posix_stop(); }
}

static int all_right(const struct row *r)
{
    int right = 1;
    for (unsigned in = 0; in < FAULTS_INS; in++) { right &= r->in[in].right; }
    return right;
}

static void work(const void *ctx, int i, void *result)
{
    static struct plan p;
    (void)ctx;
    memset(&p, 0, sizeof p);
    memset(result, 0, sizeof *p.row);
    p.row = result;
    p.base = (struct faults_base){.scene = FAULTS_BILATERAL, .cards = 1, .gentle = 1, .seed = 7};
    p.base.rate_Hz = rate_Hz[i % (int)rates];
    p.source = (uint8_t)source_of((unsigned)i / (unsigned)rates);
    p.base.chatter = p.source == FAULTS_CHATTER;
    if (p.source == FAULTS_STILL) {
        p.base.stuck_ms = 100;
    } /* its own hand is too still for that */
    for (unsigned k = 0; k < FAULTS_INS; k++) {
        p.latency[k] = -1;
        if (faults_is_memory(p.source)) {
            p.latency[k] = (int32_t)faults_source_ahead(p.base.scene, p.source, how_of(p.source));
        }
    }
    /* The finger waits until what is damaged before it arms can have been seen. */
    p.base.wait_ms = latency(&p, FAULTS_IN_RUN) * 1000 / p.base.rate_Hz;
    if (!faults_has(FAULTS_BILATERAL, p.source)) { return; }
    for (p.pass = 0; p.pass < PASSES && p.row->err == 0 && !all_right(p.row); p.pass++) {
        p.press_for = 0;
        p.base.gentle = 1;
        p.row->err = faults_run(&p.base, at, &p);
        p.base.gentle = 0;
        p.press_for = 0;
        if (p.row->err == 0 && !p.row->in[FAULTS_IN_LIMIT].right) {
            p.row->err = faults_run(&p.base, at, &p);
        }
    }
}

/* --- the table --- */

static const char *const title[FAULTS_INS] = {"OFF", "OFF, RUN asked for", "ARM, gate closed",
    "ARM, ramp", "RUN", "LIMIT", "RELEASE", "FAULT"};

/* "3/15/30", or one number where they are the same. */
static void print_ticks(FILE *f, const int32_t n[RATES_MAX])
{
    int same = 1;
    for (size_t r = 1; r < rates; r++) { same &= n[r] == n[0]; }
    for (size_t r = 0; r < (same ? 1 : rates); r++) {
        fprintf(f, "%s%" PRId32, r ? "/" : "", n[r]);
    }
}

static void print_wrong(FILE *f, const struct cell *c, uint32_t rate)
{
    fprintf(f,
        "**WRONG** at %" PRIu32 ": tried %d, before %d, then %d, end %d, bad %#x, latched %#" PRIx32
        ", refused %#x, seen %" PRId32 " ",
        rate, c->tried, c->before, c->state, c->end, c->bad, c->latched, c->refused, c->seen_ticks);
}

/* 1 if it is wrong. */
static int print_cell(FILE *f, const struct row *row, unsigned source, unsigned in)
{
    const struct cell *c = &row[0].in[in];
    const uint32_t cuts = faults_spec_of(source)->cuts;
    int32_t zero[RATES_MAX];
    int wrong = 0;
    fprintf(f, " ");
    if (!faults_has(FAULTS_BILATERAL, source)) {
        fprintf(f, "to come |");
        return 0;
    }
    for (size_t r = 0; r < rates; r++) {
        zero[r] = row[r].in[in].zero_ticks;
        if (row[r].err || !row[r].in[in].right) {
            print_wrong(f, &row[r].in[in], rate_Hz[r]);
            wrong++;
        }
    }
    if (wrong == 0 && !(faults_spec_of(source)->in >> in & 1)) {
        fprintf(f, "–");
    } else if (wrong == 0 && in == FAULTS_IN_ASKED && c->refused) {
        fprintf(f, "refused");
    } else if (wrong == 0 && c->end == EXH_STATE_OFF) {
        fprintf(f, "off");
    } else if (wrong == 0) {
        fprintf(f, "%s",
            in == FAULTS_IN_FAULT                 ? "stays"
            : cuts || c->state == EXH_STATE_FAULT ? "**cut**"
                                                  : "release");
        if (in >= FAULTS_IN_RAMP && in < FAULTS_IN_FAULT) {
            fprintf(f, " ");
            print_ticks(f, zero);
        }
    }
    fprintf(f, " |");
    return wrong;
}

static void print_head(FILE *f)
{
    fprintf(f,
        "A finger presses against a wall in the full box, through drivers and emulated cards, at");
    for (size_t r = 0; r < rates; r++) {
        fprintf(f, "%s %" PRIu32, r ? r + 1 == rates ? " and" : "," : "", rate_Hz[r]);
    }
    fprintf(f,
        " Hz. Each fault begins at\nits source, so that the box sees it in the state of the "
        "column. "
        "Numbers are ticks, one for each rate where they differ.\n\n"
        "- seen: ticks from the first tick that could see it\n"
        "- **cut**: the tick that sees it (tick 1) goes to FAULT, without current, drives "
        "disabled\n"
        "- release: RELEASE, then FAULT; the force falls in equal steps and is zero in this tick\n"
        "- off: the box stays in OFF, or arming ends in OFF\n"
        "- refused: the box does not arm and names the step\n"
        "- stays: the box stays in FAULT and latches the cause with the others\n"
        "- –: there is nothing to see, and nothing happens\n\n"
        "| fault | what happens | seen |");
    for (unsigned in = 0; in < FAULTS_INS; in++) { fprintf(f, " %s |", title[in]); }
    fprintf(f, "\n|---|---|---|");
    for (unsigned in = 0; in < FAULTS_INS; in++) { fprintf(f, "---|"); }
    fprintf(f, "\n");
}

static void print_seen(FILE *f, const struct row *row, unsigned source)
{
    int32_t seen[RATES_MAX];
    if (faults_is_memory(source)) { /* how many ticks is the compiler's: it lays the area out */
        fprintf(f, source == FAULTS_PAR ? " within the guard's round |" : " within two rounds |");
        return;
    }
    for (size_t r = 0; r < rates; r++) {
        seen[r] = -1;
        for (unsigned in = 0; in < FAULTS_INS; in++) {
            if (row[r].in[in].seen_ticks > seen[r]) { seen[r] = row[r].in[in].seen_ticks; }
        }
    }
    fprintf(f, " ");
    print_ticks(f, seen);
    fprintf(f, " |");
}

int faults_matrix(FILE *f, uint32_t at_Hz, int parallel)
{
    static struct row row[SOURCES * RATES_MAX]; /* as many a source as there are rates */
    struct jobs jobs = {0, parallel, sizeof row[0], row, work, NULL, "rows", posix_interrupt};
    int wrong = 0, err;
    if (at_Hz) {
        rate_Hz[0] = at_Hz;
        rates = 1;
    }
    jobs.n = SOURCES * (int)rates;
    err = jobs_run(&jobs);
    if (err) { return err; }
    print_head(f);
    for (unsigned s = 0; s < SOURCES; s++) {
        const struct faults_spec *spec = faults_spec_of(source_of(s));
        fprintf(f, "| %s | %s |", spec->name, spec->what);
        print_seen(f, &row[s * rates], source_of(s));
        for (unsigned in = 0; in < FAULTS_INS; in++) {
            wrong += print_cell(f, &row[s * rates], source_of(s), in);
        }
        fprintf(f, "\n");
    }
    fprintf(f, "\n%d cells, each at %d rate%s: %d wrong.\n", SOURCES * FAULTS_INS, (int)rates,
        rates > 1 ? "s" : "", wrong);
    return wrong ? 1 : 0;
}
