/* SPDX-License-Identifier: MIT */
/* Log of a run: writes header, frames, events and keyframes as records. */
#include "exhand/run/log.h"

#include "exhand/board.h"
#include "exhand/error.h"
#include "exhand/exhand.h"

#include "../num/pack.h"
#include "../num/params_save.h"

static const struct exh_scene *scene;
static uint8_t buf[EXH_LOG_RECORD_B];
static uint32_t seq;
static uint32_t lost;      /* records lost in all */
static uint32_t lost_here; /* lost since the last written record */
static const struct exh_log_tap *tap;
static const struct exh_log_way *way;
static int silent; /* this record, or all (alone), goes to the tap only */
static int alone;
static uint8_t type_now; /* of the record in buf */
static uint32_t tick_now;
static struct exh_record_header header;
static uint32_t table_crc; /* of the parameters; a header has no time for it */

static void pack_bytes(struct exh_bytes *c, const uint8_t *v, uint32_t n)
{
    uint8_t *const p = pack_room(c, n);
    if (p != NULL) { memcpy(p, v, n); }
    for (; p == NULL && n > 0; n--, v++) {
        uint8_t byte = *v;
        exh_bytes_u8(c, &byte);
    }
}

/* Outputs one record, whole or not at all. Counts lost records. */
static int put(struct exh_bytes *c)
{
    const uint32_t len = exh_record_end(c);
    EXH_ASSERT(len > 0);
    return way ? way->put(buf, len) : exh_board_log(buf, len) > 0;
}

static int put_count(uint8_t type, uint32_t tick, uint32_t count)
{
    struct exh_bytes c = exh_bytes_writer(buf, sizeof buf);
    exh_record_begin(&c, type, seq, tick);
    exh_bytes_u32(&c, &count);
    if (!put(&c)) { return 0; }
    seq++;
    lost_here = 0;
    return 1;
}

void exh_log_tap(const struct exh_log_tap *who, int is_alone)
{
    tap = who;
    silent = alone = is_alone;
}

void exh_log_by(const struct exh_log_way *who) { way = who; }

/* 1: the record comes later. */
static int later(uint8_t type, uint32_t tick)
{
    const int is = way && !tap && tick > 0 && way->begin(scene, type, tick, seq);
    seq += (uint32_t)is;
    return is;
}

static struct exh_bytes begin(uint8_t type, uint32_t tick)
{
    const uint32_t found_no_room = way ? way->lost() : 0;
    struct exh_bytes c;
    lost += found_no_room;
    lost_here += found_no_room;
    type_now = type;
    tick_now = tick;
    if (lost_here > 0 && !silent && !(way && way->waits())) {
        (void)put_count(EXH_RECORD_DROPPED, tick, lost_here);
    }
    c = exh_bytes_writer(buf, sizeof buf);
    exh_record_begin(&c, type, seq, tick);
    return c;
}

static void end(struct exh_bytes *c)
{
    EXH_ASSERT(exh_bytes_ok(c));
    if (tap) { tap->take(type_now, tick_now, buf + EXH_RECORD_HEAD_B, c->at - EXH_RECORD_HEAD_B); }
    if (silent) { return; }
    seq++; /* a lost record leaves a gap in the sequence */
    if (!put(c)) {
        lost++;
        lost_here++;
    }
}

static void event(uint32_t tick, struct exh_event e)
{
    struct exh_bytes c = begin(EXH_RECORD_EVENT, tick);
    exh_event_serialize(&c, &e);
    end(&c);
}

/* The state before tick, where a replay may start. */
static void keyframe(uint32_t tick)
{
    struct exh_bytes c;
    if (scene->state == NULL || later(EXH_RECORD_KEYFRAME, tick)) { return; }
    c = begin(EXH_RECORD_KEYFRAME, tick);
    exh_log_keyframe_serialize(&c, scene);
    end(&c);
}

static uint32_t signals(const struct exh_scene *sc)
{
    return sc->signals ? exh_signal_count(sc->signals) : 0;
}

static void copy_name(char to[16], const char *from)
{
    for (unsigned i = 0; i < 15 && from[i] != '\0'; i++) { to[i] = from[i]; }
}

void exh_log_header_serialize(struct exh_bytes *c)
{
    struct exh_record_header h = header;
    exh_record_header_serialize(c, &h);
    if (scene->params) {
        const uint32_t room = c->at < c->cap ? c->cap - c->at : 0;
        const int32_t n = exh_params_save_by(scene->params, table_crc, c->p + c->at, room);
        EXH_ASSERT(n > 0);
        c->at += (uint32_t)n;
    }
    for (unsigned i = 0; scene->calib && i < scene->calib->images; i++) {
        pack_bytes(c, scene->calib->image[i].byte, scene->calib->image[i].len_B);
    }
}

uint32_t exh_log_images_B(void)
{
    uint32_t n = 0;
    for (unsigned i = 0; scene->calib && i < scene->calib->images; i++) {
        n += scene->calib->image[i].len_B;
    }
    return n;
}

static void put_header(uint32_t tick)
{
    struct exh_bytes c;
    if (later(EXH_RECORD_HEADER, tick)) { return; }
    c = begin(EXH_RECORD_HEADER, tick);
    exh_log_header_serialize(&c);
    end(&c);
}

void exh_log_start(const struct exh_scene *sc, struct exh_scene_board board)
{
    static const struct exh_record_header none;

    if (way) { /* what a log before this one has left */
        way->step(1);
        (void)way->lost();
    }
    scene = sc;
    seq = lost = lost_here = 0;
    header = none;
    header.lib_version = EXH_VERSION_NUMBER;
    header.T = board.T;
    header.enc_bits = board.enc_bits;
    header.signal_crc = sc->signals ? exh_signal_crc(sc->signals) : 0;
    header.signals = (uint16_t)signals(sc);
    header.fingers = sc->fingers;
    copy_name(header.scene, sc->name);
    copy_name(header.board, exh_board_info.name);
    table_crc = sc->params ? exh_signal_crc(sc->params->table) : 0;
    put_header(0);
    keyframe(0);
}

static void glove_bytes(struct exh_bytes *c, struct exh_scene_in *in)
{
    exh_bytes_u8(c, &in->glove_new);
    exh_bytes_u16(c, &in->glove.age_ticks);
    pack_i16s(c, in->glove.raw, EXH_GLOVE_SENSORS);
}

void exh_log_frame_serialize(struct exh_bytes *c, const struct exh_scene *sc,
    struct exh_scene_in *in, struct exh_drive_out *out, int32_t *signal)
{
    const uint32_t n = signals(sc);
    exh_drive_in_serialize(c, &in->drive, sc->fingers);
    if (sc->read_glove) { glove_bytes(c, in); }
    exh_drive_out_serialize(c, out, sc->fingers);
    exh_bytes_i32s(c, signal, n);
}

void exh_log_keyframe_serialize(struct exh_bytes *c, const struct exh_scene *sc)
{
    if (sc->params) { exh_params_serialize(c, sc->params); }
    if (c->mode != EXH_BYTES_READ || exh_bytes_ok(c)) { sc->state(c); }
}

void exh_log_mark(uint32_t tick, int32_t value)
{
    event(tick, (struct exh_event){EXH_EVENT_MARK, 0, 0, value, 0});
}

/* Logs staged parameters as events of the tick in which they act first. A value that still slews
 * may repeat; it is staged again with the same value. Staging the present value stops the slew, so
 * while any value slews, log all that may. */
static void log_params(uint32_t tick, const struct exh_params *p)
{
    const uint32_t n = exh_signal_count(p->table);
    for (uint32_t i = 0; i < n; i++) {
        uint16_t instance;
        const struct exh_signal *row = exh_signal_at(p->table, i, &instance);
        const int halts = p->moving && exh_signal_is_slewed(row);
        if (halts || p->staged[i] != p->active[i]) {
            event(
                tick, (struct exh_event){EXH_EVENT_PARAM, row->id, instance, p->staged[i], p->by});
        }
    }
}

void exh_log_before(uint32_t tick, struct exh_scene_in *in)
{
    if (scene->params && scene->params->pending) { log_params(tick, scene->params); }
    if (in->command != EXH_CMD_NONE) {
        event(tick, (struct exh_event){EXH_EVENT_COMMAND, 0, 0, in->command, 0});
    }
    if (in->missed != 0) {
        event(tick,
            (struct exh_event){EXH_EVENT_MISSED, 0, 0, exh_clamp(in->missed, 0, INT32_MAX), 0});
    }
}

static void packets(uint32_t tick, struct exh_scene_mail *in)
{
    for (unsigned i = 0; i < in->packets; i++) {
        struct exh_bytes c = begin(EXH_RECORD_PACKET, tick);
        pack_bytes(&c, in->byte[i], in->len_B[i]);
        end(&c);
    }
}

void exh_log_after(uint32_t tick, const struct exh_scene_in *in, const struct exh_drive_out *out)
{
    struct exh_scene_in i = *in; /* a cursor needs non-const fields */
    struct exh_drive_out o = *out;
    struct exh_bytes c;
    if (scene->link) { packets(tick, scene->link->in); }
    c = begin(EXH_RECORD_FRAME, tick);
    exh_log_frame_serialize(&c, scene, &i, &o, exh_scene_signals(scene));
    end(&c);
    /* Not in exh_log_before(), where it would delay the outputs. */
    silent = alone || (tick + 1) % EXH_LOG_KEYFRAME_TICKS != 0;
    if (!silent || (tap && tap->due())) { keyframe(tick + 1); }
    silent = alone;
    if (!alone && (tick + 1) % EXH_LOG_HEADER_TICKS == EXH_LOG_KEYFRAME_TICKS / 2) {
        put_header(tick + 1);
    }
    if (way) { way->step(0); }
}

uint32_t exh_log_end(uint32_t tick)
{
    if (way) {
        way->step(1);
        lost += way->lost();
    }
    return put_count(EXH_RECORD_END, tick, lost) ? lost : lost + 1;
}
