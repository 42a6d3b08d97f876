/* SPDX-License-Identifier: MIT */
#include "log/timeline.h"

#include "base/names.h"
#include "base/option.h"
#include "base/param.h"

#include "exhand/run/log.h"

#include "exhand/safety.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#define GAP_MS      20 /* what is on again so soon was never off for a person */
#define LIMITS      32
#define FINGERS_MAX EXH_FINGERS

struct walk {
    struct logfile *log;
    struct timeline_notes notes;
    struct exh_scene_in in;
    struct exh_drive_out out;
    int32_t *now, *before; /* signals of this frame and the last */
    int begun;
    int frames;     /* 1: there was one, */
    uint64_t first; /* at this tick */
    uint32_t din;
    uint64_t gap;
    uint32_t command; /* at this tick, enum exh_command + 1 */
    struct timeline_span contact[FINGERS_MAX], limit[FINGERS_MAX][LIMITS], missed, lost;
    int32_t state, faults, present, arm, lost_at, glove; /* signals by index; < 0: none */
    int32_t c[FINGERS_MAX], limits[FINGERS_MAX], force[FINGERS_MAX];
};

/* --- which signals there are --- */

static int32_t index_of(const struct exh_scene *sc, const char *name, unsigned instance)
{
    const uint32_t n = exh_signal_count(sc->signals);
    for (uint32_t i = 0; i < n; i++) {
        uint16_t k;
        const struct exh_signal *row = exh_signal_at(sc->signals, i, &k);
        if (k == instance && strcmp(row->name, name) == 0) { return (int32_t)i; }
    }
    return -1;
}

static void find_signals(struct walk *w)
{
    const struct exh_scene *sc = w->log->scene;
    w->state = index_of(sc, "state", 0);
    w->faults = index_of(sc, "faults", 0);
    w->present = index_of(sc, "present", 0);
    w->arm = index_of(sc, "arm_step", 0);
    w->lost_at = index_of(sc, "missing", 0);
    w->glove = index_of(sc, "glove_faults", 0);
    for (unsigned f = 0; f < FINGERS_MAX; f++) {
        w->c[f] = index_of(sc, "c", f);
        w->limits[f] = index_of(sc, "limits", f);
        w->force[f] = index_of(sc, "f_des", f);
    }
}

static int32_t of(const int32_t *v, int32_t i) { return i < 0 ? 0 : v[i]; }

static double newton(const struct walk *w, unsigned f)
{
    if (w->force[f] < 0) { return 0; }
    return cli_signal_value(
        exh_signal_at(w->log->scene->signals, (uint32_t)w->force[f], NULL), w->now[w->force[f]]);
}

/* "index: ", or nothing where there is one finger alone. */
static const char *whose(const struct walk *w, unsigned f)
{
    static char text[24];
    if (w->log->scene->fingers < 2) { return ""; }
    snprintf(text, sizeof text, "%s: ", names_word(&names_finger, f));
    return text;
}

/* --- what was on and is off --- */

static double ms(const struct walk *w, uint64_t ticks)
{
    return 1e3 * (double)ticks * w->log->header.T.num / w->log->header.T.den;
}

static void say_span(
    struct walk *w, const struct timeline_span *s, const char *who, const char *what, int still)
{
    char often[40] = "";
    if (s->times > 1) { snprintf(often, sizeof often, ", %" PRIu32 " times", s->times); }
    if (s->begin == s->last && !still) {
        timeline_say(&w->notes, s->begin, "%s%s for one tick, at %.2f N", who, what, s->peak);
        return;
    }
    timeline_say(&w->notes, s->begin, "%s%s %s", who, what,
        s->begin == w->first ? "is there already" : "begins");
    timeline_say(&w->notes, s->last + !still, "%s%s %s: %.1f ms%s, force at most %.2f N", who, what,
        still ? "goes on at the end" : "ends", ms(w, s->last + 1 - s->begin), often, s->peak);
}

static void spans(struct walk *w, unsigned f, uint64_t tick, int end)
{
    const uint64_t gap = end ? 0 : w->gap;
    const uint32_t acting = (uint32_t)of(w->now, w->limits[f]);
    struct timeline_span was;
    if (timeline_span(
            &w->contact[f], !end && of(w->now, w->c[f]) != 0, tick, gap, newton(w, f), &was)) {
        say_span(w, &was, whose(w, f), "contact", end && was.last + 1 == tick);
    }
    for (unsigned i = 0; i < LIMITS; i++) {
        char what[80];
        if (!timeline_span(
                &w->limit[f][i], !end && acting >> i & 1, tick, gap, newton(w, f), &was)) {
            continue;
        }
        snprintf(what, sizeof what, "limit %s (%s)", names_word(&names_limit, i),
            names_says(&names_limit, i));
        say_span(w, &was, whose(w, f), what, end && was.last + 1 == tick);
    }
}

static void count(struct walk *w, struct timeline_span *s, double n, uint64_t tick,
    const char *what, uint64_t gap)
{
    struct timeline_span was;
    const double sum = s->open ? s->peak + n : n; /* the peak of a growing sum is the sum */
    if (timeline_span(s, n > 0, tick, gap, sum, &was)) {
        if (was.begin == was.last) {
            timeline_say(&w->notes, was.begin, "%.0f %s", was.peak, what);
        } else {
            timeline_say(
                &w->notes, was.begin, "%.0f %s, until tick %" PRIu64, was.peak, what, was.last);
        }
        if (n > 0) { s->peak = n; }
    }
}

/* --- changes from frame to frame --- */

static void said_inputs(struct walk *w, uint64_t tick)
{
    static const char *const good[][2] = {{"open", "closed"}, {"let go", "held"},
        {"fired", "quiet"}, {"failed", "healthy"}, {"not ready", "ready"}};
    const uint32_t changed = w->frames ? w->in.drive.din ^ w->din : 0;
    for (unsigned i = 0; i < names_din.n; i++) {
        if (changed >> i & 1 && names_din.says[i]) {
            timeline_say(&w->notes, tick, "%s: %s", names_din.says[i],
                good[i < 4 ? i : 4][w->in.drive.din >> i & 1]);
        }
    }
    w->din = w->in.drive.din;
}

static int runs(int32_t state) { return state == EXH_STATE_RUN || state == EXH_STATE_LIMIT; }

/* RUN and LIMIT alternate as limits act; the limits are printed instead. */
static void said_state(struct walk *w, uint64_t tick)
{
    const int32_t from = of(w->before, w->state), to = of(w->now, w->state);
    if (w->state < 0) { return; }
    if (!w->frames) {
        timeline_say(&w->notes, tick, "state: %s", names_word(&names_state, (unsigned)to));
    } else if (from != to && !(runs(from) && runs(to))) {
        timeline_say(&w->notes, tick, "state: %s -> %s (%s)",
            names_word(&names_state, (unsigned)from), names_word(&names_state, (unsigned)to),
            names_says(&names_state, (unsigned)to));
    } else if (from == to && (w->command == EXH_CMD_CLEAR + 1 ? of(w->now, w->faults) != 0
                                                              : w->command == EXH_CMD_RUN + 1)) {
        char why[NAMES_B];
        names_faults(why, sizeof why, (uint32_t)of(w->now, w->present));
        timeline_say(&w->notes, tick, "nothing follows it; present: %s", why);
    }
}

/* The signal says on which step arming is, and in another state by which it was refused at last. */
static void said_arming(struct walk *w, uint64_t tick)
{
    const uint32_t step = (uint32_t)of(w->now, w->arm),
                   was = w->frames ? (uint32_t)of(w->before, w->arm) : 0;
    const int arms = of(w->now, w->state) == EXH_STATE_ARM;
    const int armed = w->frames && of(w->before, w->state) == EXH_STATE_ARM;
    char what[NAMES_B];
    unsigned i = 0;
    if (step == 0) { return; }
    while (!(step >> i & 1)) { i++; }
    snprintf(what, sizeof what, "%s (%s)", names_word(&names_arm, i), names_says(&names_arm, i));
    if (arms && (step != was || !armed)) { timeline_say(&w->notes, tick, "arming: %s", what); }
    if (!arms && ((armed && !runs(of(w->now, w->state))) || (step != was && w->frames))) {
        timeline_say(&w->notes, tick, "arming is refused by its step %s", what);
    }
}

static void said_faults(struct walk *w, uint64_t tick)
{
    const uint32_t was = w->frames ? (uint32_t)of(w->before, w->faults) : 0;
    const uint32_t is = (uint32_t)of(w->now, w->faults);
    for (unsigned i = 0; i < 32; i++) {
        if (!((is & ~was) >> i & 1)) { continue; }
        timeline_say(&w->notes, tick, "FAULT %s: %s", names_word(&names_fault, i),
            names_says(&names_fault, i));
        if (!w->notes.has_fault && w->frames) {
            w->notes.fault_tick = tick;
            w->notes.has_fault = 1;
        }
    }
    if (was && !is) { timeline_say(&w->notes, tick, "the fault is cleared"); }
}

static void said_glove(struct walk *w, uint64_t tick)
{
    const int32_t was = w->frames ? of(w->before, w->glove) : 0, is = of(w->now, w->glove);
    if (!was == !is) { return; }
    timeline_say(&w->notes, tick,
        is ? "glove: sensors %#x are not believed" : "glove: all sensors are believed",
        (unsigned)is);
}

static void on_frame(struct walk *w, const struct exh_record *r)
{
    struct exh_bytes c = exh_bytes_reader(r->payload, r->len_B);
    const uint64_t tick = w->log->tick;
    int32_t *other = w->before;
    if (!w->frames) { w->first = tick; }
    memset(&w->in, 0, sizeof w->in);
    exh_log_frame_serialize(&c, w->log->scene, &w->in, &w->out, w->now);
    if (!exh_bytes_ok(&c) || c.at != r->len_B) {
        timeline_say(&w->notes, tick, "a frame of another length");
        return;
    }
    said_inputs(w, tick);
    said_faults(w, tick);
    said_state(w, tick);
    said_arming(w, tick);
    said_glove(w, tick);
    for (unsigned f = 0; f < w->log->scene->fingers && f < FINGERS_MAX; f++) {
        spans(w, f, tick, 0);
    }
    count(w, &w->lost, w->frames ? (double)of(w->now, w->lost_at) - of(w->before, w->lost_at) : 0,
        tick, "packets lost", w->gap);
    w->frames = 1;
    w->command = 0;
    w->before = w->now;
    w->now = other;
}

/* " by register" of its bits; "" of none. */
static void by_whom(char to[48], unsigned source)
{
    static const char *const name[EXH_SOURCES] = {"the person", "image", "register", "world"};
    size_t n = 0;
    to[0] = '\0';
    for (unsigned k = 0; k < EXH_SOURCES; k++) {
        if (source >> k & 1u) {
            n += (size_t)snprintf(to + n, 48 - n, "%s%s", n ? " or " : ", by ", name[k]);
        }
    }
}

static void said_param(struct walk *w, const struct exh_event *e)
{
    const struct exh_params *p = w->log->scene->params;
    const int32_t i = p ? exh_signal_find(p->table, e->id, e->instance) : -1;
    if (i >= 0) {
        const struct exh_signal *row = exh_signal_at(p->table, (uint32_t)i, NULL);
        char by[48];
        by_whom(by, e->source);
        timeline_say(&w->notes, w->log->tick, "parameter %s, instance %u: %.9g %s%s", row->name,
            e->instance, cli_signal_value(row, e->value), names_unit(row->unit), by);
    }
}

static void said_froze(struct walk *w, const struct exh_event *e)
{
    char what[NAMES_B];
    names_faults(what, sizeof what, (uint32_t)e->value);
    if (e->value) {
        timeline_say(&w->notes, w->log->tick,
            "the black box froze for %s, %u ticks behind it; %u causes came later", what,
            e->instance, e->id);
    } else {
        timeline_say(&w->notes, w->log->tick, "the box was halted: the black box ends here");
    }
}

static void on_event(struct walk *w, const struct exh_record *r)
{
    struct exh_bytes c = exh_bytes_reader(r->payload, r->len_B);
    struct exh_event e;
    exh_event_serialize(&c, &e);
    if (!exh_bytes_ok(&c)) { return; }
    if (e.type == EXH_EVENT_COMMAND) {
        timeline_say(
            &w->notes, w->log->tick, "command: %s", names_says(&names_command, (unsigned)e.value));
        w->command = (uint32_t)e.value + 1;
    } else if (e.type == EXH_EVENT_MISSED) {
        count(w, &w->missed, e.value, w->log->tick, "ticks missed", w->gap);
    } else if (e.type == EXH_EVENT_MARK) {
        timeline_say(&w->notes, w->log->tick, "mark %" PRId32, e.value);
    } else if (e.type == EXH_EVENT_PARAM) {
        said_param(w, &e);
    } else if (e.type == EXH_EVENT_FROZE) {
        said_froze(w, &e);
    }
}

static void on_count(struct walk *w, const struct exh_record *r)
{
    struct exh_bytes c = exh_bytes_reader(r->payload, r->len_B);
    uint32_t n = 0;
    exh_bytes_u32(&c, &n);
    if (r->type == EXH_RECORD_DROPPED) {
        timeline_say(
            &w->notes, w->log->tick, "%" PRIu32 " records before this were lost by the writer", n);
    } else {
        timeline_say(&w->notes, w->log->tick, "end of the log, %" PRIu32 " records lost in all", n);
    }
}

static void walk(struct walk *w)
{
    const int looks = w->notes.to == NULL;
    struct exh_record r;
    uint64_t end = 0;
    while (!(looks && w->notes.has_fault) && logfile_next(w->log, &r)) {
        if (!w->begun) {
            w->begun = 1;
            timeline_say(&w->notes, w->log->tick, "the log begins%s",
                r.type == EXH_RECORD_KEYFRAME ? ", with a keyframe" : "");
        }
        if (r.type == EXH_RECORD_FRAME) {
            on_frame(w, &r);
            end = w->log->tick + 1;
        } else if (r.type == EXH_RECORD_EVENT) {
            on_event(w, &r);
        } else if (r.type == EXH_RECORD_DROPPED || r.type == EXH_RECORD_END) {
            on_count(w, &r);
        }
    }
    for (unsigned f = 0; f < w->log->scene->fingers && f < FINGERS_MAX; f++) {
        spans(w, f, end, 1);
    }
    count(w, &w->missed, 0, end, "ticks missed", 0);
    count(w, &w->lost, 0, end, "packets lost", 0);
}

/* All but the log, the signals' memory and the fault is of one walk. */
static void begin(struct walk *w, FILE *to)
{
    struct walk fresh = {.log = w->log,
        .now = w->now,
        .before = w->before,
        .notes = {.log = w->log,
            .to = to,
            .fault_tick = w->notes.fault_tick,
            .has_fault = w->notes.has_fault}};
    *w = fresh;
    w->gap = (uint64_t)GAP_MS * w->log->header.T.den / (1000 * (uint64_t)w->log->header.T.num);
    find_signals(w);
    logfile_rewind(w->log);
}

/* Two passes, since each line gives its distance to the first fault. */
int timeline_print(struct logfile *l, FILE *to)
{
    static struct walk w; /* too large for a stack to like */
    const uint32_t n = exh_signal_count(l->scene->signals);
    int bad;
    memset(&w, 0, sizeof w);
    w.log = l;
    if (l->scene->params) { l->scene->defaults(); } /* its table is there behind that alone */
    w.now = calloc(n + 1, sizeof *w.now);
    w.before = calloc(n + 1, sizeof *w.before);
    if (w.now != NULL && w.before != NULL) {
        begin(&w, NULL);
        walk(&w);
        begin(&w, to);
        fprintf(to, "scene %.16s on %.16s, a tick is %" PRIu32 "/%" PRIu32 " s\n", l->header.scene,
            l->header.board, l->header.T.num, l->header.T.den);
        timeline_head(&w.notes);
        walk(&w);
        timeline_out(&w.notes);
    }
    bad = w.now == NULL || w.before == NULL || w.notes.no_memory;
    free(w.now);
    free(w.before);
    if (bad) {
        cli_complain("out of memory: the timeline is not whole");
        return 1;
    }
    return 0;
}
