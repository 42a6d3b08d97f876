/* SPDX-License-Identifier: MIT */
/* filter_cheap.h against its definition in wider arithmetic, and against filter.h, which is within
 * 6 LSB of ideal, from 10^-5 to 0.45 of the rate; settling at any. */
#include "exhand/filter_cheap.h"

#include "exhand/fix.h"

#include "check.h"
#include "wide.h"

#define PER 1000000 /* fc / rate is counted in these */

static struct exh_filter_par par = {2, 1 << 16};

/* fc is ppm 10^-6 of the rate. */
static void tune(struct exh_filter_cheap_cfg *cfg, int32_t ppm)
{
    const struct exh_period T = {(uint32_t)ppm, PER};
    CHECK(exh_filter_cheap_setup(cfg, &par, T) == 0, "%" PRId32 " ppm", ppm);
}

static int32_t one(struct exh_filter_cheap *s, const struct exh_filter_cheap_cfg *cfg, int32_t x)
{
    int32_t y;
    exh_filter_cheap_step(s, cfg, &x, &y, 1);
    return y;
}

/* --- the step as NUMERICS.md defines it --- */

static int32_t high_word(int64_t v) { return (int32_t)(v >> 32); }

static int32_t define_low(
    struct exh_filter_cheap *s, const struct exh_filter_cheap_cfg *cfg, int32_t x)
{
    const int32_t at = high_word(s->pos);
    const int64_t u = (int64_t)x + 2 * (int64_t)s->in1 + s->in2 - 4 * (int64_t)at;
    struct wide to;
    s->vel = wide_sat64(wide_add(
        wide_of(s->vel), wide_add(wide_mul(high_word(s->vel), cfg->a), wide_mul(u, cfg->b))));
    to = wide_add(wide_of(s->pos), wide_mul(high_word(s->vel), cfg->c));
    s->pos = wide_sat64(to);
    if (wide_cmp(to, wide_of(s->pos)) != 0) {
        s->pos = (s->pos < 0 ? INT32_MIN : INT32_MAX) * (INT64_C(1) << 32) + (INT64_C(1) << 31);
        s->vel = 0;
    }
    s->in2 = s->in1;
    s->in1 = x;
    return high_word(s->pos);
}

static int32_t define_high(
    struct exh_filter_cheap *s, const struct exh_filter_cheap_cfg *cfg, int32_t x)
{
    const int64_t one_q29 = INT64_C(1) << 29;
    const int64_t u = (int64_t)x + 2 * (int64_t)s->in1 + s->in2;
    const int64_t left = (int64_t)((uint64_t)s->pos % (uint64_t)one_q29), edge = one_q29 / 8 * 3;
    struct wide sum = wide_of(cfg->a > edge    ? left
                              : cfg->a < -edge ? one_q29 - 1 - left
                                               : one_q29 / 2);
    int32_t y;
    sum = wide_add(sum, wide_mul(high_word(s->pos), cfg->a));
    sum = wide_add(sum, wide_mul(high_word(s->vel), cfg->c));
    sum = wide_add(sum, wide_mul(u, cfg->b));
    y = wide_sat32(wide_shr_floor(sum, 29));
    s->vel = high_word(s->pos) * (INT64_C(1) << 32);
    s->pos = y * (INT64_C(1) << 32) + (int64_t)(sum.lo % (uint64_t)one_q29);
    s->in2 = s->in1;
    s->in1 = x;
    return y;
}

/* From states that an input can cause. */
TEST(step_is_its_definition)
{
    while (check_case(20)) {
        struct exh_filter_cheap_cfg cfg;
        struct exh_filter_cheap s = {0, 0, 0, 0}, want = s;
        tune(&cfg, check_i32_in(1, PER / 2 - 1));
        for (int t = 0; t < 60; t++) {
            const int32_t x = check_i32();
            int32_t y, y_want;
            if (t % 3 == 0) {
                s.pos = check_i64();
                s.vel = check_i64() >> 1;
                s.in1 = check_i32();
                s.in2 = check_i32();
                want = s;
            }
            y_want = cfg.high ? define_high(&want, &cfg, x) : define_low(&want, &cfg, x);
            y = one(&s, &cfg, x);
            CHECK(y == y_want, "a %" PRId32 ": %" PRId32 ", want %" PRId32, cfg.a, y, y_want);
            CHECK(s.pos == want.pos && s.vel == want.vel && s.in1 == want.in1 && s.in2 == want.in2,
                "a %" PRId32 ": state", cfg.a);
        }
    }
}

/* --- beside the exact kind --- */

/* LSB between both, where neither is at a rail; header's bound and that of filter.h. */
static int64_t bound(int32_t ppm) { return ppm < 68400 ? 8 + 6 + PER / (16 * ppm) : 80 + 6; }

/* Levels held for a while, and a square of about fc, which is what moves it most. */
static int32_t next_input(int32_t x, int32_t most, int32_t t, int32_t hold, int square)
{
    if (t % hold != 0) { return x; }
    if (square) { return x > 0 ? -most : most; }
    return check_i32_in(-most, most);
}

TEST(it_is_as_near_as_said)
{
    while (check_case(1000)) {
        const int32_t least = check_i32_in(0, 3) == 0 ? 10 : 1000;
        const int32_t ppm = check_i32_in(least, 450000), ticks = PER / ppm;
        const int32_t most = INT32_MAX / 100 * (ppm < 200000 ? 80 : ppm < 300000 ? 70 : 48);
        const int square = check_i32_in(0, 1);
        const int32_t hold = check_i32_in(1, 1 + ticks), length = 200 + 8 * ticks, zero = 0;
        struct exh_filter_cheap_cfg cfg;
        struct exh_filter_cheap s;
        struct exh_filter_cfg exact_cfg;
        struct exh_filter exact;
        int32_t x = 0;
        tune(&cfg, ppm);
        CHECK_EQ_I64(
            exh_filter_setup(&exact_cfg, &par, (struct exh_period){(uint32_t)ppm, PER}), 0);
        exh_filter_reset(&exact, &zero, 1);
        exh_filter_cheap_reset(&s, &cfg, &zero, 1);
        for (int32_t t = 0; t < length && t < 400000; t++) {
            int64_t off;
            int32_t want;
            x = next_input(x, most, t, hold, square);
            exh_filter_step(&exact, &exact_cfg, &x, &want, 1);
            off = (int64_t)one(&s, &cfg, x) - want;
            CHECK(off <= bound(ppm) && off >= -bound(ppm),
                "%" PRId32 " ppm: %" PRId64 " LSB off, bound %" PRId64, ppm, off, bound(ppm));
        }
    }
}

/* Rail to rail, and whatever that reaches: the speed stays within its word, with room, and the
 * output within 0.11 of full scale. */
TEST(full_scale_bends_and_does_not_wrap)
{
    while (check_case(500)) {
        const int32_t ppm = check_i32_in(1000, 68000), ticks = PER / ppm, zero = 0;
        struct exh_filter_cheap_cfg cfg;
        struct exh_filter_cheap s;
        struct exh_filter_cfg exact_cfg;
        struct exh_filter exact;
        int32_t x = INT32_MAX;
        tune(&cfg, ppm);
        CHECK_EQ_I64(
            exh_filter_setup(&exact_cfg, &par, (struct exh_period){(uint32_t)ppm, PER}), 0);
        exh_filter_reset(&exact, &zero, 1);
        exh_filter_cheap_reset(&s, &cfg, &zero, 1);
        for (int32_t t = 0; t < 200 + 8 * ticks; t++) {
            int32_t y, want, v;
            if (check_i32_in(0, 1 + ticks / 2) == 0) { x = x < 0 ? INT32_MAX : INT32_MIN; }
            exh_filter_step(&exact, &exact_cfg, &x, &want, 1);
            y = one(&s, &cfg, x);
            v = high_word(s.vel);
            CHECK(v < 1850000000 && v > -1850000000, "%" PRId32 " ppm: speed %" PRId32, ppm, v);
            CHECK((int64_t)y - want < 236223201 && (int64_t)want - y < 236223201,
                "%" PRId32 " ppm: %" PRId32 ", ideal %" PRId32, ppm, y, want);
        }
    }
}

/* --- settling --- */

/* Moved about, or pushed by an LSB or two, then left at any level: exactly there in the end. */
TEST(a_constant_input_is_reached_exactly)
{
    while (check_case(200)) {
        const int32_t ppm = check_i32_in(800, 450000), ticks = PER / ppm, level = check_i32();
        const int32_t little = check_i32_in(0, 1);
        struct exh_filter_cheap_cfg cfg;
        struct exh_filter_cheap s;
        tune(&cfg, ppm);
        exh_filter_cheap_reset(&s, &cfg, &level, 1);
        for (int k = 0; k < 3; k++) {
            const int32_t x =
                little ? exh_sat32((int64_t)level + check_i32_in(-3, 3)) : check_i32();
            for (int32_t t = check_i32_in(1, 2 + 2 * ticks); t > 0; t--) { (void)one(&s, &cfg, x); }
        }
        for (int32_t t = 1200 + 30 * ticks; t > 0; t--) { (void)one(&s, &cfg, level); }
        for (int t = 0; t < 100; t++) {
            const int32_t y = one(&s, &cfg, level);
            CHECK(y == level, "%" PRId32 " ppm: %" PRId32 " at %" PRId32, ppm, y, level);
        }
    }
}

TEST_MAIN("prop/filter_cheap", step_is_its_definition, it_is_as_near_as_said,
    full_scale_bends_and_does_not_wrap, a_constant_input_is_reached_exactly);
