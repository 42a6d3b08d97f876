/* SPDX-License-Identifier: MIT */
/* bytes.h: one list of fields, three directions; a CRC that finds every flip. */
#include "exhand/bytes.h"

#include "check.h"

/* The one that images link which have 4 KiB to spare. */
#define exh_crc32 crc32_by_table
uint32_t crc32_by_table(uint32_t crc, const void *buf, size_t len_B);
#include "../../../lib/src/num/pack.h"
#include "../../../lib/src/run/crc_table.c"
#undef exh_crc32

struct all {
    uint8_t u8;
    uint16_t u16;
    int16_t i16;
    uint32_t u32;
    int32_t i32;
    int64_t i64;
};
#define ALL_B 21u

static void all_bytes(struct exh_bytes *c, struct all *v)
{
    exh_bytes_u8(c, &v->u8);
    exh_bytes_u16(c, &v->u16);
    exh_bytes_i16(c, &v->i16);
    exh_bytes_u32(c, &v->u32);
    exh_bytes_i32(c, &v->i32);
    exh_bytes_i64(c, &v->i64);
}

static int same(const struct all *a, const struct all *b)
{
    return a->u8 == b->u8 && a->u16 == b->u16 && a->i16 == b->i16 && a->u32 == b->u32 &&
           a->i32 == b->i32 && a->i64 == b->i64;
}

TEST(layout_is_little_endian)
{
    static const uint8_t want[ALL_B] = {0xA1, 0x02, 0x01, 0xFE, 0xFF, 0x04, 0x03, 0x02, 0x01, 0xFD,
        0xFF, 0xFF, 0xFF, 0x08, 0x07, 0x06, 0x05, 0x04, 0x03, 0x02, 0x81};
    struct all v = {0xA1, 0x0102, -2, 0x01020304, -3, INT64_C(0x0102030405060708)};
    uint8_t buf[ALL_B];
    struct exh_bytes c = exh_bytes_writer(buf, sizeof buf);
    v.i64 -= INT64_MAX;
    v.i64 -= 1; /* top bit set */
    all_bytes(&c, &v);
    CHECK(exh_bytes_ok(&c) && c.at == ALL_B, "at %" PRIu32, c.at);
    CHECK(memcmp(buf, want, sizeof want) == 0, "layout differs");
}

TEST(round_trip_of_extremes_and_random)
{
    static const struct all row[] = {
        {0, 0, 0, 0, 0, 0},
        {UINT8_MAX, UINT16_MAX, INT16_MIN, UINT32_MAX, INT32_MIN, INT64_MIN},
        {1, 0x8000, INT16_MAX, 0x80000000u, INT32_MAX, INT64_MAX},
        {0x80, 1, -1, 1, -1, -1},
    };
    for (size_t i = 0; i < 1000; i++) {
        struct all in, back;
        uint8_t buf[ALL_B];
        struct exh_bytes c = exh_bytes_writer(buf, sizeof buf);
        if (i < sizeof row / sizeof row[0]) {
            in = row[i];
        } else {
            in.u8 = (uint8_t)(check_u64() & 0xFF);
            in.u16 = (uint16_t)(check_u64() & 0xFFFF);
            in.i16 = (int16_t)check_i32_in(INT16_MIN, INT16_MAX);
            in.u32 = (uint32_t)(check_u64() & UINT32_MAX);
            in.i32 = check_i32();
            in.i64 = check_i64();
        }
        back = in;
        all_bytes(&c, &back);
        CHECK(same(&in, &back), "writing changed the value, row %zu", i);
        memset(&back, 0x55, sizeof back);
        c = exh_bytes_reader(buf, sizeof buf);
        all_bytes(&c, &back);
        CHECK(exh_bytes_ok(&c) && same(&in, &back), "row %zu", i);
    }
}

TEST(measuring_needs_no_buffer)
{
    struct all v = {1, 2, 3, 4, 5, 6};
    const struct all before = v;
    struct exh_bytes c = exh_bytes_measure();
    all_bytes(&c, &v);
    all_bytes(&c, &v);
    CHECK(c.at == 2 * ALL_B && exh_bytes_ok(&c), "at %" PRIu32, c.at);
    CHECK(same(&v, &before), "measuring changed a value");
}

/* A cursor made by hand, with room. */
TEST(measuring_leaves_a_buffer)
{
    uint8_t buf[ALL_B] = {0};
    struct all v = {1, 2, 3, 4, 5, 6};
    struct exh_bytes c = {buf, ALL_B, 0, EXH_BYTES_MEASURE};
    all_bytes(&c, &v);
    CHECK(c.at == ALL_B, "at %" PRIu32, c.at);
    for (unsigned i = 0; i < ALL_B; i++) { CHECK(buf[i] == 0, "byte %u", i); }
}

TEST(short_buffers_at_every_length)
{
    for (uint32_t cap = 0; cap <= ALL_B; cap++) {
        uint8_t buf[ALL_B + 1];
        struct all v = {0xFF, 0xFFFF, -1, UINT32_MAX, -1, -1};
        struct exh_bytes c = exh_bytes_writer(buf, cap);
        memset(buf, 0xAA, sizeof buf);
        all_bytes(&c, &v);
        CHECK(exh_bytes_ok(&c) == (cap == ALL_B), "cap %" PRIu32, cap);
        CHECK(cap == ALL_B || c.at > cap, "cap %" PRIu32 " at %" PRIu32, cap, c.at);
        for (uint32_t i = cap; i < sizeof buf; i++) {
            CHECK(buf[i] == 0xAA, "cap %" PRIu32 ": wrote byte %" PRIu32, cap, i);
        }
    }
}

TEST(short_reads_are_zeros)
{
    uint8_t buf[ALL_B];
    uint8_t keep[ALL_B];
    memset(buf, 0xFF, sizeof buf);
    memcpy(keep, buf, sizeof buf);
    for (uint32_t len = 0; len < ALL_B; len++) {
        struct all v = {1, 1, 1, 1, 1, 1};
        struct exh_bytes c = exh_bytes_reader(buf, len);
        all_bytes(&c, &v);
        CHECK(!exh_bytes_ok(&c), "length %" PRIu32, len);
        CHECK(v.i64 == 0, "length %" PRIu32 ": %" PRId64, len, v.i64);
        CHECK(len >= 1 || v.u8 == 0, "u8 at length %" PRIu32, len);
        CHECK(len >= 3 || v.u16 == 0, "u16 at length %" PRIu32, len);
        CHECK(len >= 5 || v.i16 == 0, "i16 at length %" PRIu32, len);
        CHECK(len >= 9 || v.u32 == 0, "u32 at length %" PRIu32, len);
        CHECK(len >= 13 || v.i32 == 0, "i32 at length %" PRIu32, len);
    }
    CHECK(memcmp(buf, keep, sizeof buf) == 0, "a reader wrote");
}

/* Once too short, never again all right, even if a later field is small. */
TEST(a_failed_cursor_stays_failed)
{
    uint8_t buf[6] = {0};
    uint32_t u32 = 7;
    uint8_t u8 = 7;
    struct exh_bytes c = exh_bytes_writer(buf, 5);
    exh_bytes_u32(&c, &u32);
    exh_bytes_u32(&c, &u32);
    exh_bytes_u8(&c, &u8);
    CHECK(!exh_bytes_ok(&c), "recovered at %" PRIu32, c.at);
    CHECK(buf[4] == 0 && buf[5] == 0, "wrote after the end");
}

/* at counts in 32 bits: at the very top it must not come round to "fits". */
TEST(counting_does_not_wrap)
{
    uint8_t buf[4] = {0};
    uint32_t u32 = 1;
    struct exh_bytes c = exh_bytes_reader(buf, UINT32_MAX - 1);
    c.at = UINT32_MAX - 2;
    exh_bytes_u32(&c, &u32);
    CHECK(!exh_bytes_ok(&c) && u32 == 0, "cap 2^32-2: at %" PRIu32, c.at);
    c = exh_bytes_measure();
    c.at = UINT32_MAX - 1;
    exh_bytes_u32(&c, &u32);
    CHECK(c.at == UINT32_MAX, "measure: at %" PRIu32, c.at);
    c = exh_bytes_reader(buf, UINT32_MAX);
    c.at = UINT32_MAX - 1;
    exh_bytes_u32(&c, &u32);
    CHECK(!exh_bytes_ok(&c), "cap 2^32-1: at %" PRIu32, c.at);
}

/* Three values through `one` call each or in one call, from position `at` of a buffer of cap_B. */
static struct exh_bytes several(
    enum exh_bytes_mode mode, int one, uint32_t at, uint8_t *buf, uint32_t cap_B, int32_t v[3])
{
    struct exh_bytes c = {buf, cap_B, at, (uint8_t)mode};
    if (one) {
        for (unsigned i = 0; i < 3; i++) { exh_bytes_i32(&c, &v[i]); }
    } else {
        exh_bytes_i32s(&c, v, 3);
    }
    return c;
}

TEST(many_at_once_are_as_many_calls)
{
    static const enum exh_bytes_mode mode[] = {EXH_BYTES_WRITE, EXH_BYTES_READ, EXH_BYTES_MEASURE};
    for (unsigned m = 0; m < 3; m++) {
        for (uint32_t cap_B = 0; cap_B <= 16; cap_B++) {
            for (uint32_t at = 0; at <= 17; at++) {
                uint8_t buf[2][16];
                int32_t v[2][3];
                struct exh_bytes c[2];
                for (unsigned i = 0; i < 16; i++) { buf[0][i] = (uint8_t)(check_u64() & 0xFF); }
                for (unsigned i = 0; i < 3; i++) { v[0][i] = check_i32(); }
                memcpy(buf[1], buf[0], sizeof buf[0]);
                memcpy(v[1], v[0], sizeof v[0]);
                for (unsigned k = 0; k < 2; k++) {
                    c[k] = several(
                        mode[m], (int)k, at == 17 ? UINT32_MAX - 5 : at, buf[k], cap_B, v[k]);
                }
                CHECK(c[0].at == c[1].at && memcmp(buf[0], buf[1], sizeof buf[0]) == 0 &&
                          memcmp(v[0], v[1], sizeof v[0]) == 0,
                    "mode %u, %" PRIu32 " bytes, from %" PRIu32, m, cap_B, at);
            }
        }
    }
}

TEST(packed_fields_are_as_many_calls)
{
    static const enum exh_bytes_mode mode[] = {EXH_BYTES_WRITE, EXH_BYTES_READ, EXH_BYTES_MEASURE};
    for (unsigned i = 0; i < 3 * 10 * 12; i++) {
        const uint32_t at = i / 30 == 11 ? UINT32_MAX - 2 : i / 30, cap_B = i / 3 % 10;
        uint8_t buf[2][10];
        int16_t v[2][3] = {{-2, 0x1234, INT16_MIN}, {-2, 0x1234, INT16_MIN}};
        struct exh_bytes one = {buf[0], cap_B, at, (uint8_t)mode[i % 3]};
        struct exh_bytes all = {buf[1], cap_B, at, (uint8_t)mode[i % 3]};
        memset(buf, 0x5A, sizeof buf);
        for (unsigned k = 0; k < 3; k++) { exh_bytes_i16(&one, &v[0][k]); }
        pack_i16s(&all, v[1], 3);
        CHECK(one.at == all.at && memcmp(buf[0], buf[1], sizeof buf[0]) == 0 &&
                  memcmp(v[0], v[1], sizeof v[0]) == 0,
            "case %u", i);
    }
}

/* The polynomial's definition, bit by bit. */
static uint32_t crc_bitwise(const uint8_t *p, size_t n)
{
    uint32_t crc = UINT32_MAX;
    for (size_t i = 0; i < n * 8; i++) {
        const uint32_t bit = (crc ^ (uint32_t)p[i / 8] >> i % 8) & 1;
        crc = crc >> 1 ^ (bit ? 0xEDB88320u : 0);
    }
    return ~crc;
}

TEST(crc_check_value_and_definition)
{
    uint8_t buf[300];
    CHECK(exh_crc32(0, "123456789", 9) == 0xCBF43926u, "check value");
    CHECK(exh_crc32(0, "", 0) == 0, "empty");
    for (size_t i = 0; i < sizeof buf; i++) { buf[i] = (uint8_t)(check_u64() & 0xFF); }
    for (size_t n = 0; n <= sizeof buf; n++) {
        const uint32_t whole = exh_crc32(0, buf, n);
        CHECK(whole == crc_bitwise(buf, n), "length %zu", n);
        CHECK(crc32_by_table(0, buf, n) == whole, "by table, length %zu", n);
        CHECK(crc32_by_table(crc32_by_table(0, buf, n / 3), buf + n / 3, n - n / 3) == whole,
            "by table in two pieces, length %zu", n);
        CHECK(exh_crc32(exh_crc32(0, buf, n / 3), buf + n / 3, n - n / 3) == whole,
            "in two pieces, length %zu", n);
    }
}

/* A buffer of more than 2^32 - 2 bytes is one of so many. */
TEST(the_largest_buffer)
{
    uint8_t buf[4] = {0};
    uint32_t v = 0x12345678u;
    struct exh_bytes c = exh_bytes_writer(buf, UINT32_MAX);
    CHECK_EQ_I64(c.cap, UINT32_MAX - 1);
    exh_bytes_u32(&c, &v);
    CHECK(exh_bytes_ok(&c) && buf[3] == 0x12, "not written");
    c = exh_bytes_writer(buf, UINT32_MAX - 1);
    CHECK_EQ_I64(c.cap, UINT32_MAX - 1);
    c = exh_bytes_writer(buf, UINT32_MAX - 2);
    CHECK_EQ_I64(c.cap, UINT32_MAX - 2);
}

TEST_MAIN("unit/bytes", packed_fields_are_as_many_calls, layout_is_little_endian,
    round_trip_of_extremes_and_random, measuring_needs_no_buffer, measuring_leaves_a_buffer,
    short_buffers_at_every_length, short_reads_are_zeros, a_failed_cursor_stays_failed,
    many_at_once_are_as_many_calls, crc_check_value_and_definition, counting_does_not_wrap,
    the_largest_buffer);
