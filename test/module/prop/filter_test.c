/* SPDX-License-Identifier: MIT */
/* filter.h against its definition in wider arithmetic; settling and changes of cut-off at
 * any rate. */
#include "exhand/filter.h"

#include "exhand/fix.h"

#include "check.h"
#include "wide.h"

static int64_t floor_shr(int64_t v, unsigned n)
{
    return wide_sat64(wide_shr_floor(wide_of(v), n));
}

/* Any cut-off at any rate; low: so far below it that the kind is low. */
static struct exh_filter_cfg any(int32_t order, int low)
{
    struct exh_filter_cfg cfg = {0, 0, 0, 0, 0};
    int rc = -1;
    while (rc < 0) {
        const uint32_t rate_Hz = (uint32_t)check_i32_in(1, 20000);
        const int64_t half_q16 = (int64_t)rate_Hz << 15;
        const int64_t most = low ? half_q16 / 5 : half_q16;
        const struct exh_filter_par par = {
            order, check_i32_in(1, (int32_t)(most < INT32_MAX ? most : INT32_MAX))};
        rc = exh_filter_setup(&cfg, &par, (struct exh_period){1, rate_Hz});
    }
    return cfg;
}

static int is_low(const struct exh_filter_cfg *cfg)
{
    return cfg->kind == EXH_FILTER_LOW1 || cfg->kind == EXH_FILTER_LOW2;
}

/* --- the step as NUMERICS.md defines it --- */

static int32_t define_low(struct exh_filter *s, const struct exh_filter_cfg *cfg, int32_t x)
{
    const int64_t e = x - floor_shr(s->pos, 31);
    int64_t move, low;
    if (cfg->kind == EXH_FILTER_LOW1) {
        move = wide_sat64(wide_shr_floor(wide_mul(e, cfg->a), cfg->shift));
    } else {
        const struct wide acc =
            wide_sub(wide_mul(e, cfg->a), wide_mul(floor_shr(s->vel, 32), cfg->b));
        const int64_t v = wide_sat64(wide_shr_floor(acc, cfg->shift));
        const int64_t p = exh_wrap_add64(s->vel, v);
        move = wide_sat64(wide_mul(floor_shr(p, 32), cfg->c));
        s->vel = exh_wrap_add64(p, v);
    }
    low = exh_wrap_add64(s->pos, move);
    s->pos = exh_wrap_add64(low, move);
    if (low > INT64_C(5) << 60 || low < -(INT64_C(5) << 60)) {
        const int32_t rail = low < 0 ? INT32_MIN : INT32_MAX;
        exh_filter_reset(s, &rail, 1);
    }
    return wide_sat32(wide_of(floor_shr(low, 31)));
}

static int32_t define_high(struct exh_filter *s, const struct exh_filter_cfg *cfg, int32_t x)
{
    const int two = cfg->kind == EXH_FILTER_HIGH2;
    int64_t e, move, before, twice;
    int32_t y;
    if (!s->wide) {
        s->pos = floor_shr(s->pos, 9);
        s->wide = 1;
    }
    before = s->pos;
    e = exh_wrap_diff64((int64_t)x * (1 << 22) + (1 << 21), before);
    move = wide_sat64(
        wide_shr_floor(wide_add(wide_mul(e, cfg->a), wide_mul(s->vel, two ? cfg->b : 0)), 32));
    move = exh_from_u64(4 * (uint64_t)move);
    s->pos = exh_wrap_add64(before, move);
    if (two) { s->vel = exh_wrap_diff64(move, s->vel); }
    twice = exh_wrap_add64(before, s->pos);
    y = wide_sat32(wide_of(floor_shr(twice, 23)));
    if (twice > INT64_C(1) << 56 || twice < -(INT64_C(1) << 56)) { exh_filter_reset(s, &y, 1); }
    return y;
}

/* From states an input can cause and beyond, with inputs far from them and at every corner. */
TEST(step_is_its_definition)
{
    while (check_case(20)) {
        const struct exh_filter_cfg cfg = any(check_i32_in(1, 2), check_i32_in(0, 1));
        const int low = is_low(&cfg);
        struct exh_filter s, want;
        for (int t = 0; t < 60; t++) {
            const int32_t x = check_i32();
            int32_t y, y_want;
            if (t % 3 == 0) {
                s.wide = (uint8_t)(low ? 0 : check_i32_in(0, 1));
                s.pos =
                    floor_shr((int64_t)check_u64(), (unsigned)(s.wide ? check_i32_in(1, 9) : 1));
                s.vel = floor_shr((int64_t)check_u64(), (unsigned)check_i32_in(1, 9));
                want = s;
            }
            y_want = low ? define_low(&want, &cfg, x) : define_high(&want, &cfg, x);
            exh_filter_step(&s, &cfg, &x, &y, 1);
            CHECK(y == y_want, "kind %d: %" PRId32 ", want %" PRId32, cfg.kind, y, y_want);
            CHECK(s.pos == want.pos && s.vel == want.vel && s.wide == want.wide, "kind %d: state",
                cfg.kind);
        }
    }
}

/* --- settling --- */

static int32_t move(
    struct exh_filter *s, const struct exh_filter_cfg *cfg, int32_t x, int32_t ticks)
{
    int32_t y = 0;
    for (int32_t t = 0; t < ticks; t++) { exh_filter_step(s, cfg, &x, &y, 1); }
    return y;
}

/* Moved about, then left at any level: exactly there in the end, and there it stays. */
TEST(a_constant_input_is_reached_exactly)
{
    while (check_case(2000)) {
        const int32_t ticks = check_i32_in(3, 400), tenths = check_i32_in(21, 40);
        const struct exh_filter_par par = {check_i32_in(1, 2), 65536};
        const struct exh_period T = {(uint32_t)tenths, 20 * (uint32_t)ticks};
        const int32_t level = check_i32(), settling = 40 * ticks + 400;
        struct exh_filter_cfg cfg;
        struct exh_filter s;
        if (exh_filter_setup(&cfg, &par, T) < 0) { continue; }
        exh_filter_reset(&s, &level, 1);
        for (int k = 0; k < 5; k++) {
            (void)move(&s, &cfg, check_i32(), check_i32_in(0, 2 * ticks));
        }
        (void)move(&s, &cfg, level, settling);
        for (int t = 0; t < 100; t++) {
            const int32_t y = move(&s, &cfg, level, 1);
            CHECK(y == level,
                "order %" PRId32 ", T fc = %" PRIu32 "/%" PRIu32 ": %" PRId32 " at %" PRId32,
                par.order, T.num, T.den, y, level);
        }
    }
}

/* From a few LSB away, at any speed, no cycle keeps the filter from rest. Such cycles exist in
 * narrow ranges of fc (docs/NUMERICS.md, "Choices"), so many cut-offs are tried. These are all of
 * the upper half of a low kind, and those of a high kind whose state settles within 2^-17 LSB of
 * rest. */
TEST(no_cycle_around_rest)
{
    while (check_case(100)) {
        const int low = check_i32_in(0, 1);
        const struct exh_filter_par par = {
            2, check_i32_in((low ? 30 : 106) << 16, ((low ? 106 : 489) << 16) - 1)};
        const int32_t level = check_i32();
        struct exh_filter_cfg cfg;
        CHECK_EQ_I64(exh_filter_setup(&cfg, &par, (struct exh_period){1, 1000}), 0);
        for (int k = 0; k < 10; k++) {
            struct exh_filter s;
            exh_filter_reset(&s, &level, 1);
            s.pos += floor_shr((int64_t)check_u64(), (unsigned)check_i32_in(29, 32));
            s.vel += floor_shr((int64_t)check_u64(), (unsigned)check_i32_in(29, 32));
            (void)move(&s, &cfg, level, 600);
            for (int t = 0; t < 30; t++) {
                const int32_t y = move(&s, &cfg, level, 1);
                CHECK(
                    y == level, "fc %" PRId32 ": %" PRId32 " at %" PRId32, par.fc_Hz_q16, y, level);
            }
            CHECK(
                !s.wide || floor_shr(s.pos - ((int64_t)level * (1 << 22) + (1 << 21)) + 32, 6) == 0,
                "fc %" PRId32 ": the state is at %" PRId64, par.fc_Hz_q16, s.pos);
        }
    }
}

/* --- a change of cut-off --- */

/* Rail to rail and retuned all the time: no tick moves the output farther than either set of
 * coefficients may (filter.h), and no state wraps. */
TEST(a_change_of_cut_off_does_not_bump)
{
    while (check_case(200)) {
        struct exh_filter_cfg now = any(2, 1);
        struct exh_filter s;
        int32_t x = check_i32(), before = x;
        exh_filter_reset(&s, &x, 1);
        for (int t = 0; t < 300; t++) {
            const struct exh_filter_cfg was = now;
            int64_t moved;
            int32_t y;
            if (check_i32_in(0, 19) == 0) { x = check_i32(); }
            if (check_i32_in(0, 9) == 0) {
                now = any(2, 1);
                if (now.kind != EXH_FILTER_LOW2) { now = was; }
                exh_filter_retune(&s, &was, &now, 1);
            }
            exh_filter_step(&s, &now, &x, &y, 1);
            moved = (int64_t)y - before;
            CHECK(moved <= (int64_t)was.c + now.c && -moved <= (int64_t)was.c + now.c,
                "moved %" PRId64 " at c %" PRId32 ", %" PRId32, moved, was.c, now.c);
            before = y;
        }
    }
}

TEST_MAIN("prop/filter", step_is_its_definition, a_constant_input_is_reached_exactly,
    no_cycle_around_rest, a_change_of_cut_off_does_not_bump);
