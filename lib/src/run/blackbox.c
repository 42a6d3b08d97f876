/* SPDX-License-Identifier: MIT */
/* Black box: keeps the newest records in memory and freezes them at a fault. */
#include "exhand/run/blackbox.h"

#include "exhand/error.h"
#include "exhand/fix.h"
#include "exhand/ring.h"

#define KEYFRAMES_MIN 8u

enum stage { HEADER, RECORDS, FROZE, END, DONE };

static uint8_t *memory; /* payload of the header, then the ring */
static uint32_t memory_B, header_B;
static int alone;
static const struct exh_scene *scene;
static struct exh_ring ring;
static uint32_t after_ticks;
static int32_t faults_at; /* index of the scene's signal; < 0: none */

static struct exh_blackbox_is is;
static uint32_t seen;      /* faults of the last tick */
static uint32_t left;      /* ticks to the freeze */
static uint32_t last_tick; /* last recorded tick */

/* The parameters in the payload of the header. After a fault each tick updates a few of them: all
 * in one tick would cost as much as a dozen ticks. Layout as by exh_params_save(). */
static struct {
    uint32_t header_B; /* of the header's payload */
    uint32_t end_B;    /* to the end of the parameters; calibrations follow */
    uint32_t n, at;    /* number of values; index of the next */
    uint32_t slice;    /* values per tick */
    uint32_t crc;
} image;

static struct {
    enum stage stage;
    struct exh_ring_place place;
    struct exh_record_out out;
    uint32_t seq;
    uint8_t small[10];
} dump;

void exh_blackbox_memory(void *mem, size_t len_B, int is_alone)
{
    memory = mem;
    memory_B = mem == NULL ? 0 : len_B < EXH_RING_MAX_B ? (uint32_t)len_B : EXH_RING_MAX_B;
    alone = is_alone;
}

struct exh_blackbox_is exh_blackbox_is(void)
{
    struct exh_blackbox_is now = is;
    now.held_B = header_B + exh_ring_first(&ring).left_B;
    return now;
}

/* --- recording --- */

static int recording(void)
{
    return is.state == EXH_BLACKBOX_RECORDS || is.state == EXH_BLACKBOX_RUNS_ON;
}

static int empty(void) { return exh_ring_first(&ring).left_B == 0; }

static void take(uint8_t type, uint32_t tick, const uint8_t *payload, uint32_t len_B)
{
    if (!recording() || type == EXH_RECORD_HEADER) { return; }
    if (empty() && type != EXH_RECORD_KEYFRAME) { return; } /* begins with a keyframe */
    (void)exh_ring_put(&ring, type, tick, payload, len_B);
}

static int due(void) { return recording() && exh_ring_due(&ring); }

/* --- start --- */

static int same_text(const char *a, const char *b)
{
    while (*a != '\0' && *a == *b) {
        a++;
        b++;
    }
    return *a == *b;
}

static int32_t signal_named(const struct exh_scene *sc, const char *name)
{
    const uint32_t n = sc->signals ? exh_signal_count(sc->signals) : 0;
    for (uint32_t i = 0; i < n; i++) {
        if (same_text(exh_signal_at(sc->signals, i, NULL)->name, name)) { return (int32_t)i; }
    }
    return -1;
}

static uint32_t ticks_after(struct exh_period T)
{
    const uint64_t n =
        exh_udiv64((uint64_t)T.den * EXH_BLACKBOX_AFTER_MS, UINT64_C(1000) * T.num, NULL) + 1;
    return n > EXH_BLACKBOX_AFTER_TICKS ? (uint32_t)n : EXH_BLACKBOX_AFTER_TICKS;
}

void exh_blackbox_clear(void)
{
    if (is.state == EXH_BLACKBOX_OFF) { return; }
    (void)exh_ring_setup(&ring, memory + header_B, memory_B - header_B);
    is = (struct exh_blackbox_is){.state = EXH_BLACKBOX_RECORDS};
}

/* 1 if memory suffices for the header, the keyframes, and twice the ticks after a fault. So it
 * contains a fault and its cause. */
static int fits(const struct exh_scene *sc)
{
    struct exh_bytes key = exh_bytes_measure(), frame = exh_bytes_measure();
    struct exh_scene_in in = {.missed = 0};
    struct exh_drive_out out = {.enable = 0};
    uint64_t need;
    if (memory_B < 2 * EXH_LOG_RECORD_B || sc->state == NULL) { return 0; }
    exh_log_keyframe_serialize(&key, sc);
    exh_log_frame_serialize(&frame, sc, &in, &out, sc->values);
    need = KEYFRAMES_MIN * (key.at + EXH_RING_HEAD_B) +
           UINT64_C(2) * after_ticks * (frame.at + EXH_RING_HEAD_B);
    return memory_B - EXH_LOG_RECORD_B >= need + need / (EXH_RING_PARTS - 1);
}

static void first_image(void)
{
    struct exh_bytes c = exh_bytes_writer(memory, header_B);
    exh_log_header_serialize(&c);
    image.header_B = c.at;
    image.end_B = c.at - exh_log_images_B();
    image.n = scene->params ? exh_signal_count(scene->params->table) : 0;
    image.slice = (uint32_t)exh_udiv64(image.n, after_ticks, NULL) + 1;
}

void exh_blackbox_start(const struct exh_scene *sc, struct exh_scene_board board)
{
    static const struct exh_log_tap tap = {take, due};
    scene = sc;
    is.state = EXH_BLACKBOX_OFF;
    header_B = 0;
    seen = 0;
    faults_at = signal_named(sc, "faults");
    after_ticks = ticks_after(board.T);
    if (fits(sc)) {
        is.state = EXH_BLACKBOX_RECORDS;
        header_B = EXH_LOG_RECORD_B;
        exh_blackbox_clear();
    }
    exh_log_tap(is.state == EXH_BLACKBOX_OFF ? NULL : &tap, alone);
    if (!alone || is.state != EXH_BLACKBOX_OFF) { exh_log_start(sc, board); }
    if (is.state != EXH_BLACKBOX_OFF) { first_image(); }
}

/* --- ticks --- */

#define IMAGE_HEAD_B 12u

static uint8_t *value_at(uint32_t i) { return memory + image.end_B - 4 - 4 * (image.n - i); }

static void begin_image(void)
{
    image.at = 0;
    image.crc = image.n ? exh_crc32(0, value_at(0) - IMAGE_HEAD_B, IMAGE_HEAD_B) : 0;
}

static void go_on_image(uint32_t values)
{
    for (; values > 0 && image.at < image.n; values--) {
        struct exh_bytes c = exh_bytes_writer(value_at(image.at), 4);
        int32_t v = scene->params->staged[image.at];
        exh_bytes_i32(&c, &v);
        image.crc = exh_crc32(image.crc, value_at(image.at), 4);
        image.at++;
    }
}

static void end_image(void)
{
    struct exh_bytes c = exh_bytes_writer(value_at(image.n), 4);
    go_on_image(image.n);
    if (image.n > 0) { exh_bytes_u32(&c, &image.crc); }
}

static void begin_dump(void)
{
    end_image();
    dump.place = exh_ring_first(&ring);
    dump.seq = 0;
    dump.stage = HEADER;
    exh_record_out_begin(&dump.out, EXH_RECORD_HEADER, dump.seq++, 0,
        (struct exh_record_place){memory, header_B, 0, (uint16_t)image.header_B});
}

static void freeze(void)
{
    is.state = EXH_BLACKBOX_FROZEN;
    begin_dump();
}

static uint32_t ones(uint32_t bits)
{
    uint32_t n = 0;
    for (; bits; bits &= bits - 1) { n++; }
    return n;
}

static void watch(uint32_t tick)
{
    const uint32_t now = faults_at < 0 ? 0 : (uint32_t)exh_scene_signals(scene)[faults_at];
    const uint32_t fresh = now & ~seen;
    seen = now;
    if (is.state == EXH_BLACKBOX_RECORDS && fresh) {
        is.state = EXH_BLACKBOX_RUNS_ON;
        is.cause = fresh;
        is.tick = tick;
        left = after_ticks;
        begin_image();
    } else if (is.state != EXH_BLACKBOX_RECORDS) {
        const uint32_t n = ones(fresh);
        is.later = n < UINT16_MAX - is.later ? is.later + n : UINT16_MAX;
    }
    if (is.state == EXH_BLACKBOX_RUNS_ON) {
        go_on_image(image.slice);
        if (left-- == 0) { freeze(); }
    }
}

void exh_blackbox_before(uint32_t tick, struct exh_scene_in *in)
{
    if (!alone || recording()) { exh_log_before(tick, in); }
}

void exh_blackbox_after(
    uint32_t tick, const struct exh_scene_in *in, const struct exh_drive_out *out)
{
    if (!alone || recording()) { exh_log_after(tick, in, out); }
    if (recording()) { last_tick = tick; }
    if (is.state != EXH_BLACKBOX_OFF) { watch(tick); }
}

void exh_blackbox_stop(int halted)
{
    if (is.state == EXH_BLACKBOX_RECORDS && halted && !empty()) {
        is.tick = last_tick;
        begin_image();
        freeze();
    }
    if (is.state == EXH_BLACKBOX_RUNS_ON) { freeze(); }
}

/* --- reading --- */

static uint16_t at_most(uint32_t v) { return v < UINT16_MAX ? (uint16_t)v : UINT16_MAX; }

static void begin_small(uint8_t type, const struct exh_bytes *payload)
{
    exh_record_out_begin(&dump.out, type, dump.seq++, last_tick + 1,
        (struct exh_record_place){dump.small, sizeof dump.small, 0, (uint16_t)payload->at});
}

static void begin_froze(void)
{
    struct exh_event e = {EXH_EVENT_FROZE, at_most(is.later), at_most(last_tick - is.tick),
        exh_from_u32(is.cause), 0};
    struct exh_bytes c = exh_bytes_writer(dump.small, sizeof dump.small);
    exh_event_serialize(&c, &e);
    begin_small(EXH_RECORD_EVENT, &c);
}

static void begin_end(void)
{
    struct exh_bytes c = exh_bytes_writer(dump.small, sizeof dump.small);
    uint32_t lost = ring.lost;
    exh_bytes_u32(&c, &lost);
    begin_small(EXH_RECORD_END, &c);
}

/* Prepares the next record. 0: none. */
static int next_record(void)
{
    if (dump.stage <= RECORDS) {
        dump.stage = RECORDS;
        if (exh_ring_next(&ring, &dump.place, dump.seq, &dump.out)) {
            dump.seq++;
            return 1;
        }
    }
    dump.stage = dump.stage == RECORDS ? FROZE : dump.stage == FROZE ? END : DONE;
    if (dump.stage == FROZE) { begin_froze(); }
    if (dump.stage == END) { begin_end(); }
    return dump.stage != DONE;
}

uint32_t exh_blackbox_read(uint8_t *to, uint32_t cap_B)
{
    uint32_t n = 0;
    if (is.state != EXH_BLACKBOX_FROZEN) { return 0; }
    while (n < cap_B) {
        n += exh_record_out(&dump.out, to + n, cap_B - n);
        if (n < cap_B && !next_record()) {
            if (n == 0) { exh_blackbox_clear(); }
            break;
        }
    }
    return n;
}

uint32_t exh_blackbox_rest(void)
{
    const uint32_t all = EXH_RECORD_OVERHEAD + (uint32_t)dump.out.len_B;
    return is.state == EXH_BLACKBOX_FROZEN && dump.out.done_B > 0 ? all - dump.out.done_B : 0;
}
