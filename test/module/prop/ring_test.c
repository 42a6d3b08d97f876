/* SPDX-License-Identifier: MIT */
/* ring.h against a plain list of everything that was ever put. */
#include "exhand/record.h"
#include "exhand/ring.h"

#include "exhand/error.h"

#include "check.h"

#define CAP_MAX 700u
#define LIST    600u
#define LONGEST 40u

struct put {
    uint32_t tick, len_B;
    uint8_t type;
    uint8_t payload[LONGEST];
};
static struct put every[LIST];
static uint32_t listed;
static uint8_t mem[CAP_MAX + 2];
static struct exh_ring ring;

static uint32_t up_to(uint32_t n) { return (uint32_t)(check_u64() % (n + 1)); }

static void put(uint8_t type, uint32_t tick, uint32_t len_B)
{
    struct put *p = &every[listed++];
    p->type = type;
    p->tick = tick;
    p->len_B = len_B;
    for (uint32_t i = 0; i < len_B; i++) { p->payload[i] = (uint8_t)(check_u64() & 0xFF); }
    CHECK_EQ_I64(exh_ring_put(&ring, type, tick, p->payload, len_B), 1);
}

/* The ring's content must be the end of the list and begin with a keyframe. It must have the
 * promised length: 7/8 of the memory less a tick's frames, packets and events, and less two
 * keyframes. */
static void compare(uint32_t tick_B)
{
    struct exh_ring_place p = exh_ring_first(&ring);
    const uint32_t promised_B = ring.cap_B - ring.cap_B / EXH_RING_PARTS - tick_B;
    uint32_t stored_B = 0, from = listed, records = 0, held_B = 0;
    struct exh_record_out o;
    struct exh_ring_place count = p;
    while (exh_ring_next(&ring, &count, 0, &o)) { records++; }
    CHECK(records > 0 && records <= listed, "%" PRIu32 " records of %" PRIu32, records, listed);
    if (records > listed) { return; }
    from = listed - records;
    CHECK_EQ_I64(every[from].type, EXH_RECORD_KEYFRAME);
    for (uint32_t i = 0; i < listed; i++) { stored_B += EXH_RING_HEAD_B + every[i].len_B; }
    for (uint32_t i = from; exh_ring_next(&ring, &p, i - from, &o); i++) {
        uint8_t buf[LONGEST + EXH_RECORD_OVERHEAD];
        struct exh_record r = {0, 0, 0, 0, 0, NULL};
        const uint32_t n = exh_record_out(&o, buf, sizeof buf);
        CHECK_EQ_I64(exh_record_decode(buf, n, &r), n);
        CHECK(r.type == every[i].type && r.tick == every[i].tick && r.len_B == every[i].len_B &&
                  r.seq == i - from && memcmp(r.payload, every[i].payload, r.len_B) == 0,
            "record %" PRIu32 " of %" PRIu32, i, listed);
        held_B += EXH_RING_HEAD_B + every[i].len_B;
    }
    CHECK(from == 0 || held_B >= promised_B,
        "%" PRIu32 " bytes held of %" PRIu32 ", promised %" PRIu32, held_B, stored_B, promised_B);
}

/* Every size of memory, so that records and their heads wrap at every place. */
TEST(it_holds_the_end_of_the_list)
{
    while (check_case(200)) {
        const uint32_t key_B = up_to(LONGEST), frame_B = up_to(LONGEST / 2), others = up_to(3);
        const uint32_t tick_B =
            2 * (EXH_RING_HEAD_B + key_B) + (1 + others) * (EXH_RING_HEAD_B + frame_B);
        const uint32_t least_B = 4 * tick_B > EXH_RING_MIN_B ? 4 * tick_B : EXH_RING_MIN_B;
        const uint32_t cap_B = least_B + up_to(least_B < CAP_MAX ? CAP_MAX - least_B : 0);
        if (cap_B > CAP_MAX) { continue; }
        memset(mem, 0x5A, sizeof mem);
        CHECK_EQ_I64(exh_ring_setup(&ring, mem + 1, cap_B), 0);
        listed = 0;
        for (uint32_t tick = 0; listed + others + 3 < LIST && tick < 150; tick++) {
            if (exh_ring_due(&ring)) { put(EXH_RECORD_KEYFRAME, tick, key_B); }
            for (uint32_t i = up_to(others); i > 0; i--) {
                put(EXH_RECORD_PACKET, tick, up_to(frame_B));
            }
            put(EXH_RECORD_FRAME, tick, frame_B);
            if (tick % 16 == 5) { compare(tick_B); }
        }
        compare(tick_B);
        CHECK_EQ_I64(ring.lost, 0);
        CHECK(mem[0] == 0x5A && mem[cap_B + 1] == 0x5A, "written beside its memory");
    }
}

/* Keyframes at any time, and sizes that break the rule: still whole records from a keyframe on. */
TEST(who_breaks_the_rule_loses_records_and_no_more)
{
    while (check_case(200)) {
        const uint32_t cap_B = EXH_RING_MIN_B + up_to(120);
        uint32_t lost = 0;
        CHECK_EQ_I64(exh_ring_setup(&ring, mem, cap_B), 0);
        for (uint32_t tick = 0; tick < 100; tick++) {
            uint8_t payload[200];
            const uint32_t len_B = up_to(sizeof payload);
            const uint8_t type = check_u64() % 4 ? EXH_RECORD_FRAME : EXH_RECORD_KEYFRAME;
            struct exh_ring_place p;
            struct exh_record_out o;
            uint32_t next = UINT32_MAX;
            memset(payload, (int)(tick & 0xFF), sizeof payload);
            lost += !exh_ring_put(&ring, type, tick, payload, len_B);
            p = exh_ring_first(&ring);
            while (exh_ring_next(&ring, &p, 0, &o)) {
                uint8_t buf[sizeof payload + EXH_RECORD_OVERHEAD];
                struct exh_record r = {0, 0, 0, 0, 0, NULL};
                const uint32_t n = exh_record_out(&o, buf, sizeof buf);
                CHECK_EQ_I64(exh_record_decode(buf, n, &r), n);
                CHECK(next != UINT32_MAX || r.type == EXH_RECORD_KEYFRAME, "begins with type %d",
                    r.type);
                CHECK(next == UINT32_MAX || r.tick > next, "tick %" PRIu32 " after %" PRIu32,
                    r.tick, next);
                CHECK(
                    r.len_B == 0 || r.payload[r.len_B - 1] == (r.tick & 0xFF), "another's payload");
                next = r.tick;
            }
            CHECK(p.left_B == 0, "%" PRIu32 " bytes that are no record", p.left_B);
        }
        CHECK_EQ_I64(ring.lost, lost);
    }
}

TEST_MAIN("prop/ring", it_holds_the_end_of_the_list, who_breaks_the_rule_loses_records_and_no_more);
