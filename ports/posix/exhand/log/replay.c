/* SPDX-License-Identifier: MIT */
/* Replay: the recorded inputs through the scene again; every output must come out
 * bit for bit, and every keyframe on the way must equal our state. */
#include "base/cli.h"

#include "base/logfile.h"
#include "base/names.h"
#include "base/option.h"
#include "base/param.h"
#include "log/timeline.h"

#include "exhand/run/log.h"

#include "exhand/error.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct replay {
    struct logfile log;
    struct exh_scene_in in; /* what crosses inward at the coming tick */
    struct exh_drive_out out;
    int running;         /* a start (tick 0 or a keyframe) was reached */
    uint64_t from;       /* first tick wanted; 0: from the beginning */
    uint64_t last_tick;  /* of the last frame in the file, or of a keyframe behind `from` */
    int32_t faults_at;   /* index of the signal; < 0: the scene has none */
    uint32_t faults;     /* of the last frame */
    uint32_t fault;      /* the first to come, */
    uint64_t fault_tick; /* and when */
    int foretold;        /* by the black box: this much before its end */
    uint32_t foretold_cause;
    uint64_t foretold_tick;
    uint64_t start; /* the last keyframe not after it */
    uint64_t first_tick, expect_tick;
    uint64_t ticks, keyframes;
    uint32_t digest;          /* CRC of all outputs */
    int32_t *recorded, *ours; /* signals of one frame */
    uint8_t *bytes;           /* a keyframe of ours */
};

static int start_scene(struct replay *p)
{
    const struct exh_scene *sc = p->log.scene;
    uint32_t bad = 0;
    int err = 0;
    if (sc->params != NULL) {
        sc->defaults();
        err = exh_params_restore(sc->params, p->log.params, p->log.params_len, &bad);
        if (err < 0) {
            const struct exh_signal *row = exh_signal_at(sc->params->table, bad, NULL);
            cli_complain("%s: parameter image: %s%s%s", p->log.path, exh_error_text(err),
                err == -EXH_E_RANGE ? ": " : "", err == -EXH_E_RANGE ? row->name : "");
            return 2;
        }
        exh_params_apply(sc->params);
    }
    if (logfile_calibrations(&p->log)) { return 2; }
    err = sc->setup((struct exh_scene_board){p->log.header.T, (uint8_t)p->log.header.enc_bits});
    if (err < 0) {
        const char *what = sc->calib && sc->calib->refused ? sc->calib->what : "set-up";
        cli_complain("%s: %s: %s", p->log.path, what, exh_error_text(err));
        return 2;
    }
    if (sc->params != NULL) { sc->params->locked = 1; }
    return 0;
}

static int differs(const struct replay *p, const char *what, double recorded, double ours)
{
    printf(
        "tick %" PRIu64 ": %s: recorded %.9g, replayed %.9g\n", p->log.tick, what, recorded, ours);
    return 1;
}

/* The recorded frame against ours; 1 at the first difference. */
static int compare(const struct replay *p, const struct exh_drive_out *rec)
{
    const struct exh_signal_table *t = p->log.scene->signals;
    const uint32_t n = exh_signal_count(t);
    for (unsigned i = 0; i < p->log.scene->fingers; i++) {
        if (rec->dac_raw[i] != p->out.dac_raw[i]) {
            return differs(p, "dac_raw", rec->dac_raw[i], p->out.dac_raw[i]);
        }
    }
    if (rec->enable != p->out.enable) { return differs(p, "enable", rec->enable, p->out.enable); }
    if (rec->alive != p->out.alive) { return differs(p, "alive", rec->alive, p->out.alive); }
    for (uint32_t i = 0; i < n; i++) {
        if (p->recorded[i] != p->ours[i]) {
            const struct exh_signal *r = exh_signal_at(t, i, NULL);
            return differs(
                p, r->name, cli_signal_value(r, p->recorded[i]), cli_signal_value(r, p->ours[i]));
        }
    }
    return 0;
}

static void note_fault(struct replay *p)
{
    const uint32_t now = p->faults_at < 0 ? 0 : (uint32_t)p->ours[p->faults_at];
    const uint32_t fresh = now & ~p->faults;
    if (p->foretold && p->log.tick == p->foretold_tick && fresh == p->foretold_cause) {
        p->foretold = 0;
    }
    if (p->ticks > 0 && fresh && !p->fault) {
        p->fault = fresh;
        p->fault_tick = p->log.tick;
    }
    p->faults = now;
}

static int on_frame(struct replay *p, const struct exh_record *r)
{
    const struct exh_scene *sc = p->log.scene;
    struct exh_bytes c = exh_bytes_reader(r->payload, r->len_B);
    struct exh_drive_out rec;
    if (!p->running) { return 0; }
    if (p->ticks > 0 && p->log.tick < p->expect_tick) {
        printf("tick %" PRIu64
               ": a frame of it or of a later tick came before: the log is damaged\n",
            p->log.tick);
        return 1;
    }
    if (p->ticks > 0 && p->log.tick > p->expect_tick) {
        printf("tick %" PRIu64 ": %" PRIu64 " frames are missing before it: start behind them with "
               "--from\n",
            p->log.tick, p->log.tick - p->expect_tick);
        return 1;
    }
    exh_log_frame_serialize(&c, sc, &p->in, &rec, p->recorded);
    if (!exh_bytes_ok(&c) || c.at != r->len_B) {
        return differs(p, "frame length", r->len_B, c.at);
    }
    if (sc->params != NULL) { exh_params_apply(sc->params); }
    if (sc->answered) { sc->answered(p->recorded); }
    sc->tick(&p->in, &p->out);
    if (sc->link) {
        sc->link->write();
        sc->link->in->packets = 0;
    }
    memcpy(p->ours, exh_scene_signals(sc), exh_signal_count(sc->signals) * sizeof(int32_t));
    p->digest = exh_crc32(p->digest, r->payload, r->len_B);
    note_fault(p);
    if (p->ticks++ == 0) { p->first_tick = p->log.tick; }
    p->expect_tick = p->log.tick + 1;
    memset(&p->in, 0, sizeof p->in);
    return compare(p, &rec);
}

/* It waits for the frame of its tick. */
static int on_packet(struct replay *p, const struct exh_record *r)
{
    struct exh_scene_mail *in = p->log.scene->link ? p->log.scene->link->in : NULL;
    if (!p->running) { return 0; }
    if (in == NULL || in->packets == EXH_SCENE_PACKETS || r->len_B > EXH_SCENE_PACKET_B) {
        printf("tick %" PRIu64 ": a packet that the scene could not have got: the log is damaged\n",
            p->log.tick);
        return 1;
    }
    in->len_B[in->packets] = r->len_B;
    memcpy(in->byte[in->packets++], r->payload, r->len_B);
    return 0;
}

static int on_keyframe(struct replay *p, const struct exh_record *r)
{
    if (p->running) {
        struct exh_bytes c = exh_bytes_writer(p->bytes, EXH_LOG_RECORD_B);
        exh_log_keyframe_serialize(&c, p->log.scene);
        p->keyframes++;
        if (c.at != r->len_B || memcmp(p->bytes, r->payload, r->len_B) != 0) {
            return differs(p, "state (bytes of a keyframe)", r->len_B, c.at);
        }
    } else if (p->log.tick == p->start) {
        struct exh_bytes c = exh_bytes_reader(r->payload, r->len_B);
        exh_log_keyframe_serialize(&c, p->log.scene);
        if (!exh_bytes_ok(&c) || c.at != r->len_B) {
            return differs(p, "keyframe length", r->len_B, c.at);
        }
        p->running = 1;
    }
    return 0;
}

static int on_event(struct replay *p, const struct exh_record *r)
{
    struct exh_bytes c = exh_bytes_reader(r->payload, r->len_B);
    struct exh_event e;
    int err = 0;
    exh_event_serialize(&c, &e);
    if (!p->running) { return 0; }
    if (!exh_bytes_ok(&c) || c.at != r->len_B) {
        return differs(p, "event length", r->len_B, c.at);
    }
    if (e.type == EXH_EVENT_COMMAND) { p->in.command = (uint8_t)e.value; }
    if (e.type == EXH_EVENT_MISSED) { p->in.missed = (uint32_t)e.value; }
    if (e.type == EXH_EVENT_PARAM && p->log.scene->params != NULL) {
        err = exh_params_stage(p->log.scene->params, e.id, e.instance, e.value);
    }
    if (err < 0) {
        printf("tick %" PRIu64 ": parameter %u: %s\n", p->log.tick, e.id, exh_error_text(err));
        return 1;
    }
    return 0;
}

/* Reads the summary at the end of a black box dump. 1: it is one. */
static int foretell(struct replay *p, const struct exh_record *r)
{
    struct exh_bytes c = exh_bytes_reader(r->payload, r->len_B);
    struct exh_event e;
    exh_event_serialize(&c, &e);
    if (!exh_bytes_ok(&c) || e.type != EXH_EVENT_FROZE) { return 0; }
    if (e.value != 0 && e.instance < UINT16_MAX) {
        p->foretold = 1;
        p->foretold_cause = (uint32_t)e.value;
        p->foretold_tick = p->log.tick - 1 - e.instance;
    }
    return 1;
}

/* For a start tick: finds the last keyframe not after it and keeps its position. Does not read
 * beyond the next one. 0: none. */
static int find_from(struct replay *p)
{
    struct logfile_place here, found;
    struct exh_record r;
    int is_found = 0;
    logfile_place(&p->log, &here);
    while (logfile_next(&p->log, &r)) {
        if (r.type == EXH_RECORD_KEYFRAME) {
            p->last_tick = p->log.tick;
            if (p->log.tick > p->from) { break; }
            p->start = p->log.tick;
            found = here;
            is_found = 1;
        }
        if (r.type == EXH_RECORD_FRAME) { p->last_tick = p->log.tick; }
        logfile_place(&p->log, &here);
    }
    if (is_found) { logfile_go(&p->log, &found); }
    return is_found;
}

/* Without a tick wanted, the replay begins at the log's beginning. For a dump, and for a log that
 * begins later, it begins at the first keyframe: a dump's header has the parameters of its end. */
static void find_begin(struct replay *p)
{
    struct exh_record r;
    int frames = 0, first = 0, dump = 0;
    while (logfile_next(&p->log, &r)) {
        if (r.type == EXH_RECORD_EVENT) { dump |= foretell(p, &r); }
        frames |= r.type == EXH_RECORD_FRAME;
        if (r.type != EXH_RECORD_KEYFRAME || first || frames) { continue; }
        first = 1;
        p->start = p->log.tick;
    }
    logfile_rewind(&p->log);
    p->running = !(first && (dump || p->start > 0));
}

static int replay(struct replay *p)
{
    struct exh_record r;
    int err = start_scene(p);
    if (err == 0 && p->from == 0) { find_begin(p); }
    if (err == 0 && p->from != 0 && !find_from(p)) {
        cli_complain("%s: no keyframe at or before tick %" PRIu64 ": choose a later --from",
            p->log.path, p->from);
        return 2;
    }
    if (err == 0 && p->from > p->last_tick) {
        cli_complain("--from: %" PRIu64 ": %s ends at tick %" PRIu64 ": choose an earlier one",
            p->from, p->log.path, p->last_tick);
        return 2;
    }
    while (err == 0 && logfile_next(&p->log, &r)) {
        switch (r.type) {
        case EXH_RECORD_FRAME: err = on_frame(p, &r); break;
        case EXH_RECORD_KEYFRAME: err = on_keyframe(p, &r); break;
        case EXH_RECORD_EVENT: err = on_event(p, &r); break;
        case EXH_RECORD_PACKET: err = on_packet(p, &r); break;
        default: break;
        }
    }
    if (err == 0 && p->ticks == 0) {
        cli_complain("%s: holds no frame", p->log.path);
        err = 2;
    }
    return err;
}

/* What the black box froze for must have come again, in that tick. */
static int judge_fault(const struct replay *p)
{
    char what[NAMES_B];
    if (p->foretold && p->from == 0) {
        names_faults(what, sizeof what, p->foretold_cause);
        printf("tick %" PRIu64 ": the fault that the black box froze for, %s, did not come\n",
            p->foretold_tick, what);
        return 1;
    }
    if (p->fault) {
        names_faults(what, sizeof what, p->fault);
        printf("%s: fault %s at tick %" PRIu64 ", as recorded\n", p->log.path, what, p->fault_tick);
    }
    return 0;
}

static int32_t find_faults(const struct exh_signal_table *t)
{
    uint32_t i;
    return cli_signal_find(t, "faults", &i) ? (int32_t)i : -1;
}

int cli_replay(int argc, char **argv)
{
    int64_t from = 0;
    int timeline = 0;
    const struct cli_option option[] = {
        {"from", CLI_INT, &from, 0, 1e15, "TICK",
            "start at the last keyframe not after it (0: the beginning)"},
        {"timeline", CLI_FLAG, &timeline, 0, 0, NULL, "first print what happened, in words"},
    };
    const struct cli_command c = {"replay", "LOG [--from TICK] [--timeline]",
        "Runs the recorded inputs again and compares every output bit. A dump of a black box\n"
        "starts at its first keyframe, and must give its fault again in the same tick.",
        option, (int)(sizeof option / sizeof option[0]), 1};
    struct replay p;
    const char *path = NULL;
    int err = cli_parse(&c, argc, argv, &path);

    if (err) { return err == 1 ? 0 : err; }
    memset(&p, 0, sizeof p);
    p.from = (uint64_t)from;
    err = logfile_open(&p.log, path);
    p.log.shows = !timeline;
    if (err == 0 && timeline) {
        err = timeline_print(&p.log, stdout);
        logfile_rewind(&p.log);
    }
    if (err == 0) {
        p.faults_at = find_faults(p.log.scene->signals);
        const uint32_t n = exh_signal_count(p.log.scene->signals);
        p.recorded = calloc(n, sizeof *p.recorded);
        p.ours = calloc(n, sizeof *p.ours);
        p.bytes = malloc(EXH_LOG_RECORD_B);
        err = p.recorded && p.ours && p.bytes ? replay(&p) : 1;
        if (err == 0) { err = judge_fault(&p); }
        if (err == 0) {
            printf("%s: %" PRIu64 " ticks from tick %" PRIu64 " and %" PRIu64
                   " keyframes identical, digest %08lx\n",
                path, p.ticks, p.first_tick, p.keyframes, (unsigned long)p.digest);
        }
        if (err == 0) { err = logfile_complain(&p.log); }
    }
    free(p.recorded);
    free(p.ours);
    free(p.bytes);
    logfile_close(&p.log);
    return err;
}
