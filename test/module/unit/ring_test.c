/* SPDX-License-Identifier: MIT */
/* ring.h, and records in pieces (record.h): what it keeps, drops, and cannot hold. */
#include "exhand/record.h"
#include "exhand/ring.h"

#include "exhand/error.h"

#include "check.h"

#define CAP 400u /* parts of 50 */

static uint8_t mem[CAP];
static struct exh_ring ring;

static void open_ring(void)
{
    memset(mem, 0xA5, sizeof mem);
    CHECK_EQ_I64(exh_ring_setup(&ring, mem, sizeof mem), 0);
}

static int put(uint8_t type, uint32_t tick, uint32_t n)
{
    uint8_t payload[CAP];
    for (uint32_t i = 0; i < n; i++) { payload[i] = (uint8_t)(tick + i); }
    return exh_ring_put(&ring, type, tick, payload, n);
}

/* The first record, or a tick of UINT32_MAX. */
static struct exh_record first(uint8_t *to, uint32_t cap)
{
    struct exh_ring_place p = exh_ring_first(&ring);
    struct exh_record_out o;
    struct exh_record r = {0, 0, 0, 0, UINT32_MAX, NULL};
    if (exh_ring_next(&ring, &p, 7, &o) == 1) {
        const uint32_t n = exh_record_out(&o, to, cap);
        CHECK_EQ_I64(exh_record_decode(to, n, &r), n);
        CHECK_EQ_I64(r.seq, 7);
    }
    return r;
}

TEST(set_up_refuses_memory_that_is_none)
{
    CHECK_EQ_I64(exh_ring_setup(&ring, mem, EXH_RING_MIN_B - 1), -EXH_E_RANGE);
    CHECK_EQ_I64(exh_ring_setup(&ring, mem, (size_t)EXH_RING_MAX_B + 1), -EXH_E_RANGE);
    CHECK_EQ_I64(exh_ring_setup(&ring, mem, EXH_RING_MIN_B), 0);
    CHECK(exh_ring_due(&ring), "an empty ring wants a keyframe");
}

TEST(nothing_before_the_first_keyframe)
{
    uint8_t buf[CAP + 18];
    open_ring();
    CHECK_EQ_I64(put(EXH_RECORD_FRAME, 0, 5), 0);
    CHECK_EQ_I64(put(EXH_RECORD_EVENT, 0, 5), 0);
    CHECK_EQ_I64(ring.lost, 2);
    CHECK_EQ_I64(first(buf, sizeof buf).tick, UINT32_MAX);
    CHECK_EQ_I64(put(EXH_RECORD_KEYFRAME, 1, 5), 1);
    CHECK_EQ_I64(put(EXH_RECORD_FRAME, 1, 5), 1);
    CHECK_EQ_I64(first(buf, sizeof buf).type, EXH_RECORD_KEYFRAME);
    CHECK_EQ_I64(first(buf, sizeof buf).tick, 1);
    CHECK_EQ_I64(ring.lost, 2);
}

/* 12 bytes each: a keyframe is wanted when 50 are full, at the fifth. */
TEST(a_keyframe_is_wanted_when_a_part_is_long_enough)
{
    open_ring();
    CHECK_EQ_I64(put(EXH_RECORD_KEYFRAME, 0, 5), 1);
    for (uint32_t t = 0; t < 4; t++) {
        CHECK(!exh_ring_due(&ring), "after %" PRIu32 " records", t);
        CHECK_EQ_I64(put(EXH_RECORD_FRAME, t, 5), 1);
    }
    CHECK(exh_ring_due(&ring), "60 bytes of 50");
    CHECK_EQ_I64(put(EXH_RECORD_KEYFRAME, 4, 5), 1);
    CHECK(!exh_ring_due(&ring), "a new part");
}

TEST(the_oldest_part_goes)
{
    uint8_t buf[CAP + 18];
    uint32_t t = 0;
    open_ring();
    for (; t < 100; t++) {
        if (exh_ring_due(&ring)) { CHECK_EQ_I64(put(EXH_RECORD_KEYFRAME, t, 5), 1); }
        CHECK_EQ_I64(put(EXH_RECORD_FRAME, t, 5), 1);
    }
    /* 399 bytes are 33 records, of five a part: at least 28 of them, so 22 frames. */
    CHECK_EQ_I64(first(buf, sizeof buf).type, EXH_RECORD_KEYFRAME);
    CHECK(t - first(buf, sizeof buf).tick >= 22, "from %" PRIu32, first(buf, sizeof buf).tick);
    CHECK(t - first(buf, sizeof buf).tick <= 28, "from %" PRIu32, first(buf, sizeof buf).tick);
    CHECK_EQ_I64(ring.lost, 0);
}

/* 50 of 50 bytes are a part, 49 are none: a dump is no coarser than promised. */
TEST(a_part_ends_on_its_very_byte)
{
    open_ring();
    CHECK_EQ_I64(put(EXH_RECORD_KEYFRAME, 0, 25 - EXH_RING_HEAD_B), 1);
    CHECK_EQ_I64(put(EXH_RECORD_FRAME, 0, 24 - EXH_RING_HEAD_B), 1);
    CHECK(!exh_ring_due(&ring), "49 bytes of 50");
    open_ring();
    CHECK_EQ_I64(put(EXH_RECORD_KEYFRAME, 0, 25 - EXH_RING_HEAD_B), 1);
    CHECK_EQ_I64(put(EXH_RECORD_FRAME, 0, 25 - EXH_RING_HEAD_B), 1);
    CHECK(exh_ring_due(&ring), "50 bytes of 50");
}

/* A count that began anew would say that nothing is missing. */
TEST(losses_do_not_wrap)
{
    open_ring();
    ring.lost = UINT32_MAX - 1;
    CHECK_EQ_I64(put(EXH_RECORD_FRAME, 0, 5), 0);
    CHECK_EQ_I64(ring.lost, UINT32_MAX);
    CHECK_EQ_I64(put(EXH_RECORD_FRAME, 0, 5), 0);
    CHECK_EQ_I64(ring.lost, UINT32_MAX);
}

TEST(what_is_too_long_is_lost_and_harms_nothing)
{
    static uint8_t all[65536];
    uint8_t buf[CAP + 18];
    open_ring();
    CHECK_EQ_I64(put(EXH_RECORD_KEYFRAME, 3, 5), 1);
    CHECK_EQ_I64(put(EXH_RECORD_FRAME, 3, CAP - EXH_RING_HEAD_B), 0);
    CHECK_EQ_I64(exh_ring_put(&ring, EXH_RECORD_FRAME, 3, all, sizeof all), 0);
    CHECK_EQ_I64(exh_ring_put(&ring, EXH_RECORD_FRAME, 3, all, UINT32_MAX), 0);
    CHECK_EQ_I64(ring.lost, 3);
    CHECK_EQ_I64(first(buf, sizeof buf).tick, 3);
}

/* A writer that puts no keyframe when one is due loses all older records. */
TEST(without_keyframes_there_is_nothing_to_begin_with)
{
    uint8_t buf[CAP + 18];
    open_ring();
    CHECK_EQ_I64(put(EXH_RECORD_KEYFRAME, 0, 5), 1);
    for (uint32_t t = 0; t < 32; t++) { CHECK_EQ_I64(put(EXH_RECORD_FRAME, t, 5), 1); }
    CHECK_EQ_I64(put(EXH_RECORD_FRAME, 32, 5), 0);
    CHECK_EQ_I64(first(buf, sizeof buf).tick, UINT32_MAX);
    CHECK_EQ_I64(put(EXH_RECORD_KEYFRAME, 33, CAP - 1 - EXH_RING_HEAD_B), 1);
    CHECK_EQ_I64(first(buf, sizeof buf).tick, 33);
    CHECK_EQ_I64(put(EXH_RECORD_KEYFRAME, 34, 1), 1); /* the one before makes room */
    CHECK_EQ_I64(first(buf, sizeof buf).tick, 34);
}

/* Byte by byte, in threes or in one piece: the same bytes as exh_record_end() makes. */
TEST(a_record_in_pieces_is_the_record)
{
    for (uint32_t piece = 1; piece < 60; piece++) {
        for (uint32_t at = 0; at < 12; at++) {
            uint8_t wrapped[12], want[40], got[64];
            struct exh_bytes c = exh_bytes_writer(want, sizeof want);
            struct exh_record_out o;
            uint32_t n = 0, k, size;
            exh_record_begin(&c, EXH_RECORD_EVENT, 0x01020304, 0x99887766);
            for (uint32_t i = 0; i < 10; i++) {
                uint8_t b = (uint8_t)(3 * i + 1);
                wrapped[(at + i) % sizeof wrapped] = b;
                exh_bytes_u8(&c, &b);
            }
            size = exh_record_end(&c);
            exh_record_out_begin(&o, EXH_RECORD_EVENT, 0x01020304, 0x99887766,
                (struct exh_record_place){wrapped, sizeof wrapped, at, 10});
            while (n < sizeof want && (k = exh_record_out(&o, got + n, piece)) > 0) {
                CHECK(k <= piece, "%" PRIu32 " of %" PRIu32, k, piece);
                n += k;
            }
            CHECK_EQ_I64(n, size);
            CHECK(memcmp(got, want, size) == 0, "pieces of %" PRIu32 " from %" PRIu32, piece, at);
        }
    }
}

/* Its own headers damaged: what is read may be nonsense, never beyond the memory, and it ends. */
TEST(damaged_memory_is_safe_to_read)
{
    while (check_case(1000)) {
        struct exh_ring_place p;
        struct exh_record_out o;
        uint8_t buf[64];
        uint32_t records = 0;
        open_ring();
        for (uint32_t t = 0; t < 60; t++) {
            if (exh_ring_due(&ring)) { (void)put(EXH_RECORD_KEYFRAME, t, 9); }
            (void)put(EXH_RECORD_FRAME, t, (uint32_t)(check_u64() % 9));
        }
        for (unsigned i = 0; i < 20; i++) {
            mem[check_u64() % CAP] = (uint8_t)(check_u64() & 0xFF);
        }
        p = exh_ring_first(&ring);
        while (exh_ring_next(&ring, &p, records, &o)) {
            while (exh_record_out(&o, buf, sizeof buf) > 0) {}
            records++;
            CHECK(records <= CAP / EXH_RING_HEAD_B, "endless");
            if (records > CAP) { return; }
        }
    }
}

/* Only damage makes as many parts as there is room for their beginnings: the oldest goes. */
TEST(beginnings_have_their_room)
{
    const uint32_t slots = EXH_RING_PARTS + 2;
    for (int begins = 0; begins < 2; begins++) {
        open_ring();
        CHECK_EQ_I64(put(EXH_RECORD_KEYFRAME, 0, 50), 1);
        for (uint32_t i = 0; i < slots; i++) { ring.start[i] = 0; }
        ring.live = slots;
        CHECK_EQ_I64(put(begins ? EXH_RECORD_KEYFRAME : EXH_RECORD_FRAME, 1, 5), 1);
        CHECK_EQ_I64(ring.live & 0xFF, slots);
        CHECK_EQ_I64(ring.live >> 8, begins);
        CHECK_EQ_I64(ring.start[0], begins ? 50 + EXH_RING_HEAD_B : 0);
    }
}

TEST_MAIN("unit/ring", set_up_refuses_memory_that_is_none, nothing_before_the_first_keyframe,
    a_keyframe_is_wanted_when_a_part_is_long_enough, the_oldest_part_goes,
    what_is_too_long_is_lost_and_harms_nothing, a_part_ends_on_its_very_byte, losses_do_not_wrap,
    without_keyframes_there_is_nothing_to_begin_with, a_record_in_pieces_is_the_record,
    damaged_memory_is_safe_to_read, beginnings_have_their_room);
