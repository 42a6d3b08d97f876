/* SPDX-License-Identifier: MIT */
/* regs.h: the binary32 mirror against exact arithmetic; every register there and back; whatever
 * is asked, the map keeps its promises. */
#include "exhand/regs.h"

#include "exhand/error.h"

#include "check.h"

#include "../../wide.h"

/* --- binary32 --- */

/* v 2^n, n within -64 .. 62. The caller ensures that the result fits. */
static struct wide scaled(struct wide v, int32_t n)
{
    for (; n > 0; n--) { v = wide_add(v, v); }
    return v;
}

/* A finite binary32 as mant * 2^e, e >= -149. */
static int64_t mant_of(uint32_t bits, int32_t *e)
{
    const uint32_t field = bits >> 23 & 0xFFu;
    const int64_t m = (int64_t)(bits & 0x7FFFFFu) + (field ? INT64_C(1) << 23 : 0);
    *e = (int32_t)(field ? field : 1) - 150;
    return bits >> 31 ? -m : m;
}

static int compare(struct wide a, struct wide b)
{
    const struct wide d = wide_sub(a, b);
    return wide_negative(d) ? -1 : (d.hi | d.lo) != 0;
}

/* |bits - raw 2^-frac| is at most that of both its neighbours, and where it is as much the last bit
 * is 0. All three in units of 2^(e-1), whichever e: exact. */
static void nearest(uint32_t bits, int32_t raw, unsigned frac)
{
    int32_t e;
    int64_t m = mant_of(bits, &e);
    const int32_t to = e + (int32_t)frac; /* m 2^to is compared with raw */
    struct wide exact = wide_of(raw), got = wide_of(m), half;
    if (raw == 0) {
        CHECK(bits == 0, "0 of %u: %" PRIx32, frac, bits);
        return;
    }
    if (to <= 0) { /* 24 bits hold it: exact */
        CHECK(to > -32 && compare(got, scaled(exact, -to)) == 0, "%" PRId32 " of %u: %" PRIx32, raw,
            frac, bits);
        return;
    }
    got = scaled(got, to);
    half = scaled(wide_of(1), to - 1);
    {
        const int far = compare(wide_abs(wide_sub(got, exact)), half);
        CHECK(far < 0 || (far == 0 && (bits & 1u) == 0), "%" PRId32 " of %u: %" PRIx32, raw, frac,
            bits);
    }
}

TEST(raw_to_float_is_the_nearest)
{
    for (unsigned frac = 0; frac <= 126; frac++) {
        for (unsigned i = 0; i < CHECK_CORNERS; i++) {
            nearest(exh_float_from_raw(check_corner[i], frac), check_corner[i], frac);
        }
        for (int32_t k = 0; k < 31; k++) { /* ties, and one beside, at every size */
            for (int32_t d = -1; d <= 1; d++) {
                const int32_t raw =
                    (int32_t)((INT64_C(1) << k) + (k > 24 ? INT64_C(1) << (k - 24) : 0) + d);
                nearest(exh_float_from_raw(raw, frac), raw, frac);
                nearest(exh_float_from_raw(-raw, frac), -raw, frac);
            }
        }
    }
    while (check_case(1)) {
        const int32_t raw = check_i32();
        const unsigned frac = (unsigned)check_i32_in(0, 126);
        nearest(exh_float_from_raw(raw, frac), raw, frac);
    }
}

/* floor(m 2^-n), n within 1 .. 70, and where the rest lies: -1 below a half, 0 on it, 1 above. */
static int64_t halves(int64_t m, int32_t n, int *rest)
{
    const int64_t low = n > 62 ? 0 : m >> n;
    const int64_t r = n > 62 ? m : m - low * (INT64_C(1) << n);
    const int64_t half = n > 62 ? INT64_MAX : INT64_C(1) << (n - 1);
    *rest = r < half ? -1 : r > half;
    return low;
}

/* m >= 0, by another way than the library: sums of whole 64-bit numbers. */
static int oracle(uint32_t bits, unsigned frac, int64_t *raw)
{
    int32_t e;
    int64_t m = mant_of(bits & 0x7FFFFFFFu, &e);
    int32_t up = e + (int32_t)frac;
    if ((bits >> 23 & 0xFFu) == 0xFFu) { return -1; }
    for (; up > 0 && m <= INT64_C(0x100000000) && m != 0; up--) { m += m; }
    if (up < 0) {
        int rest = -1;
        m = up < -62 ? 0 : halves(m, -up, &rest);
        m += rest > 0 || (rest == 0 && (m & 1));
    }
    *raw = bits >> 31 ? -m : m;
    return *raw < INT32_MIN || *raw > INT32_MAX ? -1 : 0;
}

static void agrees(uint32_t bits, unsigned frac)
{
    int64_t want = 0;
    int32_t got = 0x5A5A5A5A;
    const int good = oracle(bits, frac, &want) == 0;
    const int err = exh_float_to_raw(bits, frac, &got);
    if (good) {
        CHECK(err == 0 && got == want, "%" PRIx32 " of %u: %d, %" PRId32 ", want %" PRId64, bits,
            frac, err, got, want);
    } else {
        CHECK(err == -EXH_E_RANGE && got == 0x5A5A5A5A, "%" PRIx32 " of %u: %d, %" PRId32, bits,
            frac, err, got);
    }
}

TEST(float_to_raw_is_the_nearest)
{
    for (unsigned frac = 0; frac <= 126; frac++) {
        for (uint32_t field = 0; field < 256; field++) {
            static const uint32_t mant[] = {
                0, 1, 2, 3, 0x3FFFFF, 0x400000, 0x400001, 0x7FFFFE, 0x7FFFFF};
            for (unsigned i = 0; i < sizeof mant / sizeof mant[0]; i++) {
                agrees(field << 23 | mant[i], frac);
                agrees(UINT32_C(1) << 31 | field << 23 | mant[i], frac);
            }
        }
    }
    while (check_case(1)) {
        const unsigned frac = (unsigned)check_i32_in(0, 126);
        const uint32_t bits = (uint32_t)check_u64();
        const uint32_t field = (uint32_t)check_i32_in(118, 160) - (frac > 100 ? 100 : frac);
        agrees(bits, frac);
        agrees((bits & 0x807FFFFFu) | (field & 0xFFu) << 23, frac); /* where it matters */
    }
}

TEST(short_values_come_back)
{
    while (check_case(1)) {
        const unsigned frac = (unsigned)check_i32_in(0, 126);
        const int32_t raw = check_i32_in(-(1 << 24), 1 << 24);
        int32_t back = 1;
        CHECK(exh_float_to_raw(exh_float_from_raw(raw, frac), frac, &back) == 0 && back == raw,
            "%" PRId32 " of %u: %" PRId32, raw, frac, back);
    }
}

/* --- every register --- */

#define ROWS   6
#define VALUES (2 * 3 + 4 * 5)
static struct exh_signal row[ROWS];
static const struct exh_signal_group group[] = {{row, 2, 3}, {&row[2], 4, 5}};
static const struct exh_signal_table table = {group, 2};

struct map {
    struct exh_params p;
    struct exh_regs r;
    int32_t active[VALUES], wanted[VALUES + 1], staged[VALUES + 1];
    uint32_t touched[EXH_REGS_WORDS(VALUES) + 1];
};
static struct map g;

/* Rows of any range and format. */
static void make(void)
{
    memset(&g, 0, sizeof g);
    for (uint32_t i = 0; i < ROWS; i++) {
        const int32_t a = check_i32(), b = check_i32();
        row[i].id = (uint16_t)(0x7100 + i);
        row[i].frac = (uint8_t)check_i32_in(0, 60);
        row[i].when = check_i32_in(0, 2) ? EXH_WHEN_ANY : EXH_WHEN_SETUP;
        row[i].min = a < b ? a : b;
        row[i].max = a < b ? b : a;
        row[i].dflt = check_i32_in(row[i].min, row[i].max);
    }
    exh_params_setup(&g.p, &table, g.active, g.wanted);
    g.r.params = &table;
    g.r.active = g.active;
    g.r.wanted = g.wanted;
    g.r.staged = g.staged;
    g.r.touched = g.touched;
    g.r.may = EXH_REGS_MAY;
    g.wanted[VALUES] = g.staged[VALUES] = 0x5A5A;
    g.touched[EXH_REGS_WORDS(VALUES)] = 0x5A5A;
    CHECK_EQ_I64(exh_regs_setup(&g.r), 0);
}

/* Nothing staged outside its range, nothing outside the arrays; staged is what differs. */
static void sound(const char *when)
{
    for (uint32_t i = 0; i < VALUES; i++) {
        const struct exh_signal *s = exh_signal_at(&table, i, NULL);
        if (g.touched[i >> 5] >> (i & 31u) & 1u) {
            CHECK(g.staged[i] >= s->min && g.staged[i] <= s->max,
                "%s: value %" PRIu32 " staged %" PRId32, when, i, g.staged[i]);
            CHECK(g.staged[i] != g.wanted[i], "%s: value %" PRIu32 " staged as it is", when, i);
            CHECK(!g.r.locked || s->when != EXH_WHEN_SETUP,
                "%s: value %" PRIu32 " is of the set-up", when, i);
        }
    }
    CHECK(g.wanted[VALUES] == 0x5A5A && g.staged[VALUES] == 0x5A5A &&
              g.touched[EXH_REGS_WORDS(VALUES)] == 0x5A5A && g.touched[0] >> VALUES == 0,
        "%s: outside", when);
}

static uint32_t word32(const uint8_t *p)
{
    return (uint32_t)p[0] << 24 | (uint32_t)p[1] << 16 | (uint32_t)p[2] << 8 | p[3];
}

static void put32(uint8_t *p, uint32_t v)
{
    for (int i = 0; i < 4; i++) { p[i] = (uint8_t)(v >> (24 - 8 * i) & 0xFFu); }
}

/* One value, raw or float, whole: taken if and only if it may be, and then it reads so. */
TEST(a_value_is_taken_if_it_may_be)
{
    while (check_case(10)) {
        make();
        g.r.locked = check_i32_in(0, 1) != 0;
        for (int k = 0; k < 8; k++) {
            const uint32_t i = (uint32_t)check_i32_in(0, VALUES - 1);
            const struct exh_signal *s = exh_signal_at(&table, i, NULL);
            const int32_t raw = check_i32_in(0, 1) ? check_i32() : check_i32_in(s->min, s->max);
            const uint16_t at = (uint16_t)(EXH_REGS_PARAM_AT + 2 * i);
            const int may = raw >= s->min && raw <= s->max &&
                            !(g.r.locked && s->when == EXH_WHEN_SETUP && raw != g.wanted[i]);
            uint8_t b[4], back[4];
            put32(b, (uint32_t)raw);
            CHECK_EQ_I64(exh_regs_write(&g.r, at, 2, b), may ? 0 : EXH_MODBUS_VALUE);
            CHECK_EQ_I64(exh_regs_read(&g.r, EXH_REGS_HOLDING, at, 2, back), 0);
            if (may) { CHECK_EQ_I64(word32(back), word32(b)); }
            sound("raw");
        }
    }
}

/* The whole of the mirror written back as it was read: taken, and nothing changes. */
TEST(the_mirror_written_back_changes_nothing)
{
    while (check_case(20)) {
        uint8_t all[4 * VALUES], again[4 * VALUES];
        make();
        g.r.locked = 1;
        for (uint32_t i = 0; i < VALUES; i++) {
            const struct exh_signal *s = exh_signal_at(&table, i, NULL);
            g.wanted[i] = check_i32_in(s->min, s->max);
        }
        for (unsigned m = 0; m < 2; m++) {
            const uint16_t at = m ? EXH_REGS_PARAM_FLOAT_AT : EXH_REGS_PARAM_AT;
            CHECK_EQ_I64(exh_regs_read(&g.r, EXH_REGS_HOLDING, at, 2 * VALUES, all), 0);
            CHECK_EQ_I64(exh_regs_write(&g.r, at, 2 * VALUES, all), 0);
            CHECK_EQ_I64(exh_regs_read(&g.r, EXH_REGS_HOLDING, at, 2 * VALUES, again), 0);
            for (unsigned i = 0; i < sizeof all; i++) { CHECK(all[i] == again[i], "byte %u", i); }
            for (uint32_t i = 0; i < VALUES; i++) {
                CHECK(!(g.touched[0] >> i & 1u), "value %" PRIu32, i);
            }
            for (uint32_t i = 0; m == 1 && i < VALUES; i++) {
                CHECK_EQ_I64(word32(&all[4 * i]),
                    exh_float_from_raw(g.wanted[i], exh_signal_at(&table, i, NULL)->frac));
            }
        }
    }
}

/* Any span of registers reads as they do one by one; any write is taken whole or not at all. */
TEST(a_block_is_its_registers)
{
    while (check_case(20)) {
        make();
        for (int k = 0; k < 6; k++) {
            const uint16_t base = check_i32_in(0, 1) ? EXH_REGS_PARAM_FLOAT_AT : EXH_REGS_PARAM_AT;
            const uint32_t off = (uint32_t)check_i32_in(0, 2 * VALUES - 1);
            const uint16_t n = (uint16_t)check_i32_in(1, (int32_t)(2 * VALUES - off));
            const uint16_t at = (uint16_t)(base + off);
            uint8_t in[4 * VALUES], out[4 * VALUES], one[2];
            const struct map was = g;
            int err;
            CHECK_EQ_I64(exh_regs_read(&g.r, EXH_REGS_HOLDING, at, n, in), 0);
            for (uint32_t i = 0; i < n; i++) {
                CHECK_EQ_I64(exh_regs_read(&g.r, EXH_REGS_HOLDING, (uint16_t)(at + i), 1, one), 0);
                CHECK(one[0] == in[2 * i] && one[1] == in[2 * i + 1], "register %" PRIu32 " of %u",
                    i, n);
                if (check_i32_in(0, 7) == 0) { in[2 * i] = (uint8_t)(in[2 * i] ^ check_u64()); }
            }
            err = exh_regs_write(&g.r, at, n, in);
            sound("block");
            CHECK_EQ_I64(exh_regs_read(&g.r, EXH_REGS_HOLDING, at, n, out), 0);
            for (uint32_t i = 0; err == 0 && base == EXH_REGS_PARAM_AT && i < 2u * n; i++) {
                CHECK(in[i] == out[i], "byte %" PRIu32, i);
            }
            for (uint32_t w = 0; err != 0 && w < EXH_REGS_WORDS(VALUES); w++) {
                CHECK(g.touched[w] == was.touched[w], "refused by %d, and word %" PRIu32 " changed",
                    err, w);
            }
            for (uint32_t i = 0; err != 0 && i < VALUES; i++) {
                CHECK(g.staged[i] == was.staged[i], "value %" PRIu32, i);
            }
        }
    }
}

TEST_MAIN("modbus", raw_to_float_is_the_nearest, float_to_raw_is_the_nearest,
    short_values_come_back, a_value_is_taken_if_it_may_be, the_mirror_written_back_changes_nothing,
    a_block_is_its_registers);
