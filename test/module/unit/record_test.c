/* SPDX-License-Identifier: MIT */
/* record.h: records come out as they were written. Damage is noticed, and reading goes on. */
#include "exhand/record.h"

#include "exhand/error.h"

#include "check.h"

static const uint8_t all_types[] = {EXH_RECORD_HEADER, EXH_RECORD_FRAME, EXH_RECORD_EVENT,
    EXH_RECORD_KEYFRAME, EXH_RECORD_DROPPED, EXH_RECORD_END};

/* A record with n payload bytes 1, 2, 3 …; its size. */
static uint32_t make(uint8_t *buf, size_t cap, uint8_t type, uint32_t seq, uint32_t n)
{
    struct exh_bytes c = exh_bytes_writer(buf, cap);
    exh_record_begin(&c, type, seq, seq * 3);
    for (uint32_t i = 0; i < n; i++) {
        uint8_t b = (uint8_t)(i + 1);
        exh_bytes_u8(&c, &b);
    }
    return exh_record_end(&c);
}

TEST(layout_by_hand)
{
    static const uint8_t want[16] = {
        0x45, 0x58, EXH_RECORD_EVENT, EXH_RECORD_VERSION, 2, 0, 4, 3, 2, 1, 12, 9, 6, 3, 1, 2};
    uint8_t buf[20] = {0};
    struct exh_bytes c = exh_bytes_reader(buf + 16, 4);
    uint32_t crc = 0;
    CHECK_EQ_I64(make(buf, sizeof buf, EXH_RECORD_EVENT, 0x01020304, 2), 20);
    CHECK(memcmp(buf, want, sizeof want) == 0, "head or payload");
    exh_bytes_u32(&c, &crc);
    CHECK(crc == exh_crc32(0, buf, 16), "CRC %08" PRIx32, crc);
}

TEST(round_trip_of_every_type_and_size)
{
    static uint8_t buf[700];
    for (uint32_t n = 0; n < 600; n = n < 40 ? n + 1 : n * 2) {
        for (size_t t = 0; t < LEN(all_types); t++) {
            const uint32_t seq = n * 0x01010101u;
            struct exh_record r = {0, 0, 0, 0, 0, NULL};
            const uint32_t size = make(buf, sizeof buf, all_types[t], seq, n);
            CHECK_EQ_I64(size, n + EXH_RECORD_OVERHEAD);
            CHECK_EQ_I64(exh_record_decode(buf, size, &r), size);
            CHECK_EQ_I64(exh_record_decode(buf, sizeof buf, &r), size);
            CHECK(r.type == all_types[t] && r.version == EXH_RECORD_VERSION, "type %zu", t);
            CHECK(r.len_B == n && r.seq == seq && r.tick == seq * 3, "size %" PRIu32, n);
            for (uint32_t i = 0; i < n; i++) {
                CHECK(r.payload[i] == (uint8_t)(i + 1), "payload byte %" PRIu32, i);
            }
        }
    }
}

TEST(largest_payload_and_one_more)
{
    static uint8_t buf[65535 + EXH_RECORD_OVERHEAD + 1];
    struct exh_record r;
    CHECK_EQ_I64(make(buf, sizeof buf, EXH_RECORD_KEYFRAME, 1, 65535), 65535 + EXH_RECORD_OVERHEAD);
    CHECK_EQ_I64(exh_record_decode(buf, sizeof buf, &r), 65535 + EXH_RECORD_OVERHEAD);
    CHECK_EQ_I64(r.len_B, 65535);
    CHECK_EQ_I64(make(buf, sizeof buf, EXH_RECORD_KEYFRAME, 1, 65536), 0);
}

TEST(does_not_fit_at_any_size)
{
    for (size_t cap = 0; cap < 25 + EXH_RECORD_OVERHEAD; cap++) {
        uint8_t buf[25 + EXH_RECORD_OVERHEAD];
        memset(buf, 0xAA, sizeof buf);
        CHECK(make(buf, cap, EXH_RECORD_FRAME, 7, 25) == 0, "cap %zu", cap);
        for (size_t i = cap; i < sizeof buf; i++) {
            CHECK(buf[i] == 0xAA, "cap %zu wrote byte %zu", cap, i);
        }
    }
}

TEST(truncated_at_every_byte)
{
    uint8_t buf[64];
    const uint32_t size = make(buf, sizeof buf, EXH_RECORD_FRAME, 9, 30);
    for (uint32_t len = 0; len < size; len++) {
        struct exh_record r;
        uint8_t cut[64]; /* its own array, so that a sanitizer sees a read beyond */
        memset(cut, 0, sizeof cut);
        memcpy(cut, buf, len);
        CHECK(exh_record_decode(cut, len, &r) == -EXH_E_SHORT, "length %" PRIu32, len);
    }
}

/* In the middle of a stream, so that a longer length finds bytes to read. */
TEST(every_flipped_bit_is_detected)
{
    static uint8_t buf[66000];
    const uint32_t size = make(buf, sizeof buf, EXH_RECORD_FRAME, 9, 30);
    for (uint32_t i = size; i < sizeof buf; i++) { buf[i] = (uint8_t)(check_u64() & 0xFF); }
    for (uint32_t bit = 0; bit < 8 * size; bit++) {
        struct exh_record r;
        int32_t got;
        buf[bit / 8] ^= (uint8_t)(1u << bit % 8);
        got = exh_record_decode(buf, sizeof buf, &r);
        buf[bit / 8] ^= (uint8_t)(1u << bit % 8);
        CHECK(got < 0, "bit %" PRIu32 " passed as %" PRId32 " bytes", bit, got);
        CHECK(
            got == (bit < 16 ? -EXH_E_UNKNOWN : -EXH_E_CRC), "bit %" PRIu32 ": %" PRId32, bit, got);
    }
}

TEST(another_version_is_named)
{
    uint8_t buf[32];
    const uint32_t size = make(buf, sizeof buf, EXH_RECORD_FRAME, 9, 4);
    struct exh_bytes c = exh_bytes_writer(buf, sizeof buf);
    struct exh_record r;
    uint32_t crc;
    buf[3] = EXH_RECORD_VERSION + 1;
    crc = exh_crc32(0, buf, size - 4);
    c.at = size - 4;
    exh_bytes_u32(&c, &crc);
    CHECK_EQ_I64(exh_record_decode(buf, size, &r), -EXH_E_VERSION);
}

/* Rubbish, sync-like rubbish, a damaged record, then good ones: all good ones are
 * found, by going on one byte further each time, and nothing else. */
TEST(resync_after_damage)
{
    while (check_case(2000)) {
        uint8_t buf[600];
        uint32_t at = (uint32_t)(check_u64() % 50), good = 0, found = 0;
        for (size_t i = 0; i < sizeof buf; i++) {
            const uint64_t u = check_u64();
            buf[i] = (uint8_t)(u % 4 == 0 ? 0x45 : u % 4 == 1 ? 0x58 : u >> 8 & 0xFF);
        }
        for (uint32_t k = 0; k < 6; k++) {
            const uint32_t size =
                make(buf + at, sizeof buf - at, EXH_RECORD_FRAME, k, (uint32_t)(check_u64() % 40));
            if (k == 3) { buf[at + check_u64() % size] ^= 0x10; }
            good += k != 3;
            at += size + (uint32_t)(check_u64() % 20);
        }
        for (uint32_t i = 0; i < sizeof buf;) {
            struct exh_record r;
            const int32_t n = exh_record_decode(buf + i, (uint32_t)sizeof buf - i, &r);
            CHECK(n <= (int32_t)(sizeof buf - i), "runs past the end");
            if (n > 0) { CHECK(r.seq != 3, "the damaged one passed"); }
            found += n > 0;
            i += n > 0 ? (uint32_t)n : 1;
        }
        CHECK(found == good, "%" PRIu32 " of %" PRIu32 " found", found, good);
    }
}

TEST(any_bytes_are_safe_to_read)
{
    while (check_case(10)) {
        uint8_t buf[40];
        struct exh_record r;
        const uint32_t len = (uint32_t)(check_u64() % (sizeof buf + 1));
        int32_t n;
        for (size_t i = 0; i < sizeof buf; i++) { buf[i] = (uint8_t)(check_u64() & 0xFF); }
        buf[0] = 0x45;
        buf[1] = 0x58;
        n = exh_record_decode(buf, len, &r);
        CHECK(n < 0, "random bytes passed: %" PRId32, n);
    }
}

TEST(header_and_event_round_trip)
{
    struct exh_record_header h = {
        "drop", "posix-sim-16ch!", 0x000100, 0xDEADBEEF, {65, 1193182}, 5, 24, 40000};
    struct exh_record_header h2;
    struct exh_event e = {EXH_EVENT_PARAM, 0x0401, 4, INT32_MIN, 6}, e2;
    uint8_t buf[80];
    struct exh_bytes c = exh_bytes_writer(buf, sizeof buf);
    memset(&h2, 0xFF, sizeof h2);
    memset(&e2, 0xFF, sizeof e2);
    exh_record_header_serialize(&c, &h);
    CHECK_EQ_I64(c.at, 54);
    exh_event_serialize(&c, &e);
    CHECK_EQ_I64(c.at, 66);
    c = exh_bytes_reader(buf, c.at);
    exh_record_header_serialize(&c, &h2);
    exh_event_serialize(&c, &e2);
    CHECK(exh_bytes_ok(&c), "reader");
    CHECK(memcmp(h.scene, h2.scene, 16) == 0 && memcmp(h.board, h2.board, 16) == 0, "names");
    CHECK(h2.lib_version == h.lib_version && h2.signal_crc == h.signal_crc, "versions");
    CHECK(h2.T.num == 65 && h2.T.den == 1193182, "period");
    CHECK(h2.fingers == 5 && h2.enc_bits == 24 && h2.signals == 40000, "sizes");
    CHECK(e2.type == e.type && e2.id == e.id && e2.instance == 4, "event");
    CHECK_EQ_I64(e2.value, INT32_MIN);
}

/* Whether char has a sign or not. */
TEST(every_byte_of_a_name)
{
    for (unsigned first = 0; first < 256; first += 16) {
        struct exh_record_header h, h2;
        uint8_t buf[54];
        struct exh_bytes c = exh_bytes_writer(buf, sizeof buf);
        memset(&h, 0, sizeof h);
        memset(&h2, 0, sizeof h2);
        for (unsigned i = 0; i < 16; i++) {
            const uint8_t u = (uint8_t)(first + i);
            memcpy(&h.scene[i], &u, 1);
        }
        exh_record_header_serialize(&c, &h);
        for (unsigned i = 0; i < 16; i++) {
            CHECK(buf[i] == first + i, "written %u: %u", first + i, buf[i]);
        }
        c = exh_bytes_reader(buf, sizeof buf);
        exh_record_header_serialize(&c, &h2);
        CHECK(memcmp(h.scene, h2.scene, 16) == 0, "read from %u", first);
    }
}

/* A cursor that only measures has the size of a record, too. */
TEST(measuring_a_record)
{
    struct exh_bytes c = exh_bytes_measure();
    uint8_t b = 1;
    exh_record_begin(&c, EXH_RECORD_FRAME, 1, 2);
    exh_bytes_u8(&c, &b);
    CHECK_EQ_I64(exh_record_end(&c), 1 + EXH_RECORD_OVERHEAD);
}

TEST(what_was_not_begun_does_not_end)
{
    uint8_t buf[64];
    struct exh_bytes c = exh_bytes_writer(buf, sizeof buf);
    uint8_t b = 1;
    CHECK_EQ_I64(exh_record_end(&c), 0);
    for (unsigned i = 0; i < EXH_RECORD_HEAD_B - 1; i++) { exh_bytes_u8(&c, &b); }
    CHECK_EQ_I64(exh_record_end(&c), 0);
}

/* A record begins at the beginning of its buffer, whatever was there. */
TEST(begins_at_the_beginning)
{
    uint8_t buf[64];
    struct exh_bytes c = exh_bytes_writer(buf, sizeof buf);
    struct exh_record r;
    c.at = 17;
    exh_record_begin(&c, EXH_RECORD_END, 5, 6);
    CHECK_EQ_I64(exh_record_end(&c), EXH_RECORD_OVERHEAD);
    CHECK_EQ_I64(exh_record_decode(buf, EXH_RECORD_OVERHEAD, &r), EXH_RECORD_OVERHEAD);
    CHECK(r.type == EXH_RECORD_END && r.seq == 5 && r.tick == 6 && r.len_B == 0, "another one");
}

TEST_MAIN("unit/record", layout_by_hand, round_trip_of_every_type_and_size,
    largest_payload_and_one_more, does_not_fit_at_any_size, truncated_at_every_byte,
    every_flipped_bit_is_detected, another_version_is_named, resync_after_damage,
    any_bytes_are_safe_to_read, header_and_event_round_trip, measuring_a_record,
    what_was_not_begun_does_not_end, begins_at_the_beginning, every_byte_of_a_name);
