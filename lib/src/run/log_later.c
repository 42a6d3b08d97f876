/* SPDX-License-Identifier: MIT */
/* Headers and keyframes over several ticks: bytes, CRC, output, then the records that waited.
 */
#include "exhand/run/log_later.h"

#include "exhand/board.h"
#include "exhand/error.h"

#include "../num/mem.h"
#include "../num/params_write.h"

#define CRC_PER_TICK_B  2048u
#define HELD_PER_TICK_B 1536u
#define LEN_AT          4u
#define LEN_B           2u

enum stage { IDLE, PARAMS, PARTS, CRC, OUT, HELD };

static const struct exh_log_later *mem;
static const struct exh_scene *scene;
static struct exh_params params; /* of the copy */
static enum stage stage;
static struct exh_bytes record;
static struct params_place place;
static unsigned part;
static uint32_t crc, crc_at;       /* of the bytes before crc_at */
static uint32_t held_put, held_at; /* a length, then a record */
static uint32_t no_room;

static int to_board(const void *rec, uint32_t len_B)
{
    const int taken = exh_board_log(rec, len_B) > 0;
    no_room += (uint32_t)!taken;
    return taken;
}

/* --- a stage each --- */

static int make_params(void)
{
    const uint32_t until = record.at + EXH_LOG_LATER_B;
    while (place.value < params.count && record.at < until) {
        record.at = (uint32_t)(params_write(record.p + record.at, &params, &place) - record.p);
    }
    return place.value == params.count;
}

static int make_parts(void)
{
    const uint32_t until = record.at + EXH_LOG_LATER_B;
    while (part < scene->later.parts && record.at < until) {
        scene->later.part(&record, mem->copy, part++);
    }
    return part == scene->later.parts;
}

/* The length is known by now. */
static int make_crc(void)
{
    const uint32_t left = record.at - crc_at, n = left < CRC_PER_TICK_B ? left : CRC_PER_TICK_B;
    if (crc_at == 0) {
        struct exh_bytes c = record;
        uint16_t len_B = (uint16_t)(record.at - EXH_RECORD_HEAD_B);
        c.at = LEN_AT;
        exh_bytes_u16(&c, &len_B);
    }
    crc = exh_crc32(crc, record.p + crc_at, n);
    crc_at += n;
    if (crc_at < record.at) { return 0; }
    exh_bytes_u32(&record, &crc);
    EXH_ASSERT(exh_bytes_ok(&record));
    return 1;
}

static int send(void)
{
    (void)to_board(record.p, record.at);
    return 1;
}

static int send_held(void)
{
    const uint32_t until = held_at + HELD_PER_TICK_B;
    while (held_at < held_put && held_at < until) {
        const uint8_t *const at = mem->held + held_at;
        const uint32_t len_B = at[0] | (uint32_t)at[1] << 8;
        (void)to_board(at + LEN_B, len_B);
        held_at += LEN_B + len_B;
    }
    return held_at == held_put;
}

/* 1: this stage is done. */
static int work(void)
{
    switch (stage) {
    case PARAMS: return make_params();
    case PARTS: return make_parts();
    case CRC: return make_crc();
    case OUT: return send();
    case HELD: return send_held();
    case IDLE:
    default: return 1;
    }
}

static void step(int all)
{
    while (stage != IDLE) {
        if (work()) { stage = stage == HELD ? IDLE : (enum stage)(stage + 1); }
        if (!all) { return; }
    }
}

/* --- the log's --- */

static int put(const void *rec, uint32_t len_B)
{
    if (stage != IDLE && len_B + LEN_B > mem->held_B - held_put) { step(1); }
    if (stage == IDLE) { return exh_board_log(rec, len_B) > 0; }
    mem->held[held_put] = (uint8_t)(len_B & 0xFF);
    mem->held[held_put + 1] = (uint8_t)(len_B >> 8);
    memcpy(mem->held + held_put + LEN_B, rec, len_B);
    held_put += LEN_B + len_B;
    return 1;
}

/* A copy is worth it only for what is serialized in parts. */
static int copy(const struct exh_scene *sc)
{
    const uint32_t state_B = (sc->later.memory_B + 7) & ~UINT32_C(7);
    const uint32_t half_B = sc->params ? 4 * sc->params->count : 0;
    if (sc->later.parts == 0 || state_B + 2 * half_B > mem->copy_B ||
        2 * half_B + EXH_RECORD_OVERHEAD > EXH_LOG_RECORD_B) {
        return 0;
    }
    memcpy(mem->copy, sc->later.memory, sc->later.memory_B);
    params.count = 0;
    if (half_B) {
        params = *sc->params;
        params.active = (int32_t *)(void *)(mem->copy + state_B);
        params.staged = params.active + params.count;
        memcpy(params.active, sc->params->active, half_B);
        memcpy(params.staged, sc->params->staged, half_B);
    }
    return 1;
}

static int begin(const struct exh_scene *sc, uint8_t type, uint32_t tick, uint32_t seq)
{
    const int keyframe = type == EXH_RECORD_KEYFRAME;
    if (stage != IDLE || (keyframe && !copy(sc))) { return 0; }
    scene = sc;
    place = (struct params_place){0, 0, 0};
    part = 0;
    crc = crc_at = held_put = held_at = 0;
    record = exh_bytes_writer(mem->record, EXH_LOG_RECORD_B);
    exh_record_begin(&record, type, seq, tick);
    if (!keyframe) { exh_log_header_serialize(&record); }
    stage = keyframe ? PARAMS : CRC;
    return 1;
}

static uint32_t lost(void)
{
    const uint32_t n = no_room;
    no_room = 0;
    return n;
}

static int waits(void) { return stage != IDLE; }

void exh_log_later(const struct exh_log_later *memory)
{
    static const struct exh_log_way here = {put, begin, step, lost, waits};
    mem = memory;
    stage = IDLE;
    no_room = 0;
    exh_log_by(memory ? &here : NULL);
}
