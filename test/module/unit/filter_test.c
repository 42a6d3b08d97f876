/* SPDX-License-Identifier: MIT */
/* filter.h: what is refused, a constant input, steps, full scale, a change of cut-off. */
#include "exhand/filter.h"

#include "exhand/error.h"

#include "check.h"

static const struct exh_filter_cfg *tuned(int32_t order, int32_t fc_Hz_q16, uint32_t rate_Hz)
{
    static struct exh_filter_cfg cfg;
    const struct exh_filter_par par = {order, fc_Hz_q16};
    CHECK(exh_filter_setup(&cfg, &par, (struct exh_period){1, rate_Hz}) == 0,
        "order %" PRId32 " fc %" PRId32 " rate %" PRIu32, order, fc_Hz_q16, rate_Hz);
    return &cfg;
}

static int32_t one(struct exh_filter *s, const struct exh_filter_cfg *cfg, int32_t x)
{
    int32_t y;
    exh_filter_step(s, cfg, &x, &y, 1);
    return y;
}

/* Rates and cut-offs: theory's table, and the four ratios of the comparison. */
static const struct {
    uint32_t rate_Hz;
    int32_t fc_Hz_q16;
} tune[] = {
    {1000, 5 << 16},
    {2000, 5 << 16},
    {20000, 5 << 16},
    {2000, 50 << 16},
    {20000, 50 << 16},
    {1000, 20 << 16},
    {1000, 100 << 16},
    {1000, 10 << 16},
    {1000, 1 << 16},
    {10000, 1 << 16},
    {90, 20 << 16},
    {100, 49 << 16},
    {200, 50 << 16},
    {1, 32000},
    {1, 655},
    {1000, 106 << 16},
    {1000, 105 << 16},
    {2000, 999 << 16},
};

TEST(refusals_by_name)
{
    static const struct {
        int32_t order, fc;
        struct exh_period T;
        int want;
    } row[] = {
        {2, 50 << 16, {1, 90}, -EXH_E_CUTOFF},
        {2, 45 << 16, {1, 90}, -EXH_E_CUTOFF},
        {2, (45 << 16) - 1, {1, 90}, 0},
        {1, 45 << 16, {1, 90}, -EXH_E_CUTOFF},
        {1, (45 << 16) - 1, {1, 90}, 0},
        {2, INT32_MAX, {1, 20000}, -EXH_E_CUTOFF},
        {2, INT32_MAX, {UINT32_MAX, 1}, -EXH_E_CUTOFF},
        {2, 655, {1, 20000}, 0},
        {1, 655, {1, 20000}, 0},
        {2, 624, {1, 20000}, -EXH_E_RANGE},
        {2, 0, {1, 1000}, -EXH_E_RANGE},
        {2, -1, {1, 1000}, -EXH_E_RANGE},
        {0, 65536, {1, 1000}, -EXH_E_RANGE},
        {3, 65536, {1, 1000}, -EXH_E_RANGE},
        {2, 65536, {0, 1000}, -EXH_E_RATE},
        {2, 65536, {1, 0}, -EXH_E_RATE},
        {2, 65536, {1000, 2001}, 0},
        {2, 65536, {1000, 2000}, -EXH_E_CUTOFF},
    };
    for (size_t i = 0; i < LEN(row); i++) {
        const struct exh_filter_par par = {row[i].order, row[i].fc};
        struct exh_filter_cfg cfg;
        const int rc = exh_filter_setup(&cfg, &par, row[i].T);
        CHECK(rc == row[i].want, "row %zu: %d", i, rc);
    }
}

/* Coefficients of NUMERICS.md, each from its formula in 80 digits. */
TEST(coefficients_by_hand)
{
    static const struct {
        struct exh_filter_par par;
        struct exh_period T;
        struct exh_filter_cfg want;
    } row[] = {
        {{2, 65536}, {1, 10}, {620285858, 1550717162, 1003029618, 0, 0}},
        {{2, 65536}, {1, 100}, {718520852, 1493163400, 97013127, 3, 0}},
        {{2, 65536}, {1, 1000}, {598072389, 1218541453, 9698153, 6, 0}},
        {{2, 65536}, {1, 10000}, {960746812, 1953566575, 969812, 10, 0}},
        {{2, 655}, {1, 20000}, {614862168, 1249872031, 4846, 17, 0}},
        {{1, 655}, {1, 20000}, {883792582, 0, 0, 18, 1}},
        {{2, 327680}, {1, 2000}, {742637699, 1518116586, 24245801, 5, 0}},
        {{2, 1310720}, {597, 1193182}, {718991869, 1494164500, 97079679, 3, 0}},
        {{1, 1310720}, {1, 1000}, {1016888549, 0, 0, 3, 1}},
        {{1, 65536}, {1, 4}, {1073741824, 0, 0, 0, 3}},
        {{2, 65536}, {1, 4}, {628983398, 628983398, 0, 0, 2}},
        {{2, 2949120}, {1, 100}, {1719259095, 43128699, 0, 0, 2}},
        {{2, 7470900}, {1, 1000}, {180197325, 1286396810, 0, 0, 2}},
        {{2, 32767}, {1, 1}, {2147338069, 5, 0, 0, 2}},
        {{1, 32767}, {1, 1}, {2147380709, 0, 0, 0, 3}},
        {{1, 16384000}, {1, 20000}, {649480731, 0, 0, 3, 1}},
        /* A hair below half the rate g/(1 + g) is nearer to 1 than to any coefficient. */
        {{1, (1 << 23) - 1}, {(1 << 23) + 1, UINT32_C(1) << 31}, {INT32_MAX, 0, 0, 0, 3}},
        {{2, (1 << 23) - 1}, {(1 << 23) + 1, UINT32_C(1) << 31}, {INT32_MAX, 0, 0, 0, 2}},
        /* 0.05 and 0.0002 below a power of two, which is one more than fits. */
        {{1, 65536}, {30648, 299249}, {(1 << 30) - 1, 0, 0, 1, 1}},
        {{2, 65536}, {127646, 1976091}, {922174212, INT32_MAX, 635195518, 1, 0}},
        /* tan(pi fc T) times 2^32 is 11 * 2^27 - 0.004, + 0.1 and + 2.1. */
        {{2, 65536}, {48190, 457249}, {640190372, 1617807560, 1061158912, 0, 0}},
        {{1, 65536}, {33759, 320321}, {549356282, 0, 0, 0, 1}},
        {{2, 65536}, {4897, 46465}, {158172036, 1338579867, 0, 0, 2}},
    };
    for (size_t i = 0; i < LEN(row); i++) {
        const struct exh_filter_cfg *w = &row[i].want;
        struct exh_filter_cfg c;
        CHECK_EQ_I64(exh_filter_setup(&c, &row[i].par, row[i].T), 0);
        CHECK(c.a == w->a && c.b == w->b && c.c == w->c && c.shift == w->shift && c.kind == w->kind,
            "row %zu: %" PRId32 " %" PRId32 " %" PRId32 " %d %d", i, c.a, c.b, c.c, c.shift,
            c.kind);
    }
}

/* Long enough for all but the slowest decay of the highest cut-offs. */
static int32_t settling(size_t i)
{
    const int64_t rate_q16 = (int64_t)tune[i].rate_Hz << 16;
    const int64_t left_q16 = rate_q16 / 2 - tune[i].fc_Hz_q16;
    return (int32_t)(12 * rate_q16 / tune[i].fc_Hz_q16 + 12 * rate_q16 / left_q16) + 100;
}

TEST(a_constant_input_comes_out_exactly)
{
    static const int32_t level[] = {795000000, -795000000, 1, -1, 0, 21474836, -21474836, INT32_MAX,
        2104533974, INT32_MIN, 10923 << 16, 0};
    for (size_t i = 0; i < LEN(tune); i++) {
        for (int32_t order = 1; order <= 2; order++) {
            const struct exh_filter_cfg *cfg = tuned(order, tune[i].fc_Hz_q16, tune[i].rate_Hz);
            struct exh_filter s;
            exh_filter_reset(&s, &level[4], 1);
            for (size_t k = 0; k < LEN(level); k++) {
                for (int32_t t = settling(i); t > 0; t--) { (void)one(&s, cfg, level[k]); }
                for (int32_t t = 0; t < 100; t++) {
                    const int32_t y = one(&s, cfg, level[k]);
                    CHECK(y == level[k], "order %" PRId32 " tune %zu level %" PRId32 ": %" PRId32,
                        order, i, level[k], y);
                }
            }
        }
    }
}

TEST(reset_is_settled)
{
    for (size_t i = 0; i < LEN(tune); i++) {
        const struct exh_filter_cfg *cfg = tuned(2, tune[i].fc_Hz_q16, tune[i].rate_Hz);
        for (size_t k = 0; k < CHECK_CORNERS; k++) {
            struct exh_filter s;
            exh_filter_reset(&s, &check_corner[k], 1);
            for (int t = 0; t < 100; t++) {
                CHECK_EQ_I64(one(&s, cfg, check_corner[k]), check_corner[k]);
            }
        }
    }
}

/* Overshoot 4.32 % where the tick is short; at full scale it clips, on the right side. */
TEST(a_step_rises_once_and_overshoots)
{
    const struct exh_filter_cfg *cfg = tuned(2, 1 << 16, 1000);
    struct exh_filter s;
    const int32_t zero = 0, x = 1000000000;
    int32_t before = 0, peak = 0, turns = 0, rising = 1;
    exh_filter_reset(&s, &zero, 1);
    for (int t = 0; t < 20000; t++) {
        const int32_t y = one(&s, cfg, x);
        if (rising ? y < before : y > before) {
            rising = !rising;
            turns++;
        }
        peak = y > peak ? y : peak;
        before = y;
    }
    CHECK(peak > 1043100000 && peak < 1043300000, "peak %" PRId32, peak);
    /* each overshoot is 0.0432 of the one before; the seventh is below an LSB */
    CHECK(turns == 6, "%" PRId32 " turns", turns);
}

TEST(full_scale_does_not_latch)
{
    static const int32_t high[] = {2104533974, INT32_MAX}; /* 0.98, 1 */
    for (size_t i = 0; i < LEN(tune); i++) {
        const struct exh_filter_cfg *cfg = tuned(2, tune[i].fc_Hz_q16, tune[i].rate_Hz);
        for (size_t k = 0; k < LEN(high); k++) {
            struct exh_filter s;
            const int32_t zero = 0;
            int32_t y = 0;
            exh_filter_reset(&s, &zero, 1);
            for (int half = 0; half < 6; half++) { /* a square between both rails */
                const int32_t x = half & 1 ? -high[k] : high[k];
                for (int32_t t = settling(i); t > 0; t--) {
                    const int32_t was = y;
                    y = one(&s, cfg, x);
                    /* wrapped: from one rail to the other against the input */
                    CHECK(!(x > 0 && was > 1000000000 && y < 0), "tune %zu wraps", i);
                    CHECK(!(x < 0 && was < -1000000000 && y > 0), "tune %zu wraps", i);
                }
                CHECK(y == x, "tune %zu: %" PRId32 " at %" PRId32, i, y, x);
            }
        }
    }
}

/* A sine at fc, 24, 12, 8 and 4 samples a period, of a quarter of the range: half its power
 * comes through, to 10^-7. Sums over a period, squares in units that fit. */
TEST(half_the_power_at_the_cut_off)
{
    /* sin of k/24 of a turn, q30 */
    static const int32_t sine[7] = {
        0, 277904834, 536870912, 759250125, 929887697, 1037154959, 1073741824};
    static const uint32_t step[] = {1, 2, 3, 6};
    for (size_t i = 0; i < 2 * LEN(step); i++) {
        const uint32_t by = step[i / 2];
        const struct exh_filter_cfg *cfg = tuned(1 + (int32_t)(i % 2), 1 << 16, 24 / by);
        const int32_t zero = 0;
        struct exh_filter s;
        int64_t in_phase = 0, across = 0, power, half;
        exh_filter_reset(&s, &zero, 1);
        for (uint32_t t = 0; t < 24 * 100; t += by) {
            const uint32_t k = t % 24, c = (t + 6) % 24;
            const int32_t x = (k < 12 ? 1 : -1) * sine[k % 12 <= 6 ? k % 12 : 12 - k % 12];
            const int32_t xc = (c < 12 ? 1 : -1) * sine[c % 12 <= 6 ? c % 12 : 12 - c % 12];
            const int32_t y = one(&s, cfg, x);
            if (t >= 24 * 99) {
                in_phase += (int64_t)y * (x / 64);
                across += (int64_t)y * (xc / 64);
            }
        }
        /* each is 2^30 * 2^24 * 12/by times the cosine or sine of the phase */
        in_phase = in_phase / (12 / by) / (1 << 26);
        across = across / (12 / by) / (1 << 26);
        power = in_phase * in_phase + across * across;
        half = INT64_C(1) << 55;
        CHECK(power - half < half / 10000000 && half - power < half / 10000000,
            "%" PRIu32 " samples a period: %" PRId64 " of %" PRId64, 24 / by, power, half);
    }
}

TEST(channels_do_not_touch)
{
    const struct exh_filter_cfg *cfg = tuned(2, 20 << 16, 1000);
    struct exh_filter many[22], alone[22];
    int32_t x[22], y[22];
    for (int i = 0; i < 22; i++) { x[i] = check_i32(); }
    exh_filter_reset(many, x, 22);
    memcpy(alone, many, sizeof many);
    for (int t = 0; t < 1000; t++) {
        for (int i = 0; i < 22; i++) { x[i] = check_i32(); }
        exh_filter_step(many, cfg, x, y, 22);
        for (int i = 0; i < 22; i++) { CHECK_EQ_I64(one(&alone[i], cfg, x[i]), y[i]); }
        exh_filter_step(many, cfg, x, x, 22); /* in place */
        for (int i = 0; i < 22; i++) { alone[i] = many[i]; }
    }
}

TEST(retune_keeps_what_is_settled)
{
    for (size_t i = 0; i < LEN(tune) * LEN(tune); i++) {
        const size_t from = i / LEN(tune), to = i % LEN(tune);
        for (int32_t order = 0; order < 4; order++) {
            const struct exh_filter_cfg a =
                *tuned(1 + order / 2, tune[from].fc_Hz_q16, tune[from].rate_Hz);
            const struct exh_filter_cfg b =
                *tuned(1 + order % 2, tune[to].fc_Hz_q16, tune[to].rate_Hz);
            struct exh_filter s;
            const int32_t x = check_i32();
            exh_filter_reset(&s, &x, 1);
            for (int t = 0; t < 20; t++) {
                CHECK_EQ_I64(one(&s, t & 1 ? &b : &a, x), x);
                exh_filter_retune(&s, t & 1 ? &b : &a, t & 1 ? &a : &b, 1);
            }
        }
    }
}

/* Order 1 has no speed, and gives none to order 2 after it. */
TEST(a_change_of_order_drops_the_speed)
{
    const struct exh_filter_cfg second = *tuned(2, 1 << 16, 100), first = *tuned(1, 1 << 16, 100);
    struct exh_filter s;
    const int32_t zero = 0;
    exh_filter_reset(&s, &zero, 1);
    for (int t = 0; t < 10; t++) { (void)one(&s, &second, INT32_MAX); }
    CHECK(s.vel > 0, "no speed to drop");
    exh_filter_retune(&s, &second, &second, 1);
    CHECK(s.vel > 0, "dropped without need");
    exh_filter_retune(&s, &second, &first, 1);
    CHECK_EQ_I64(s.vel, 0);
}

/* 1.4 of full scale: after one tick at the rail, at rest. */
TEST(a_state_beyond_any_input_starts_anew)
{
    const struct exh_filter_cfg *cfg = tuned(2, 1 << 16, 1000);
    for (int sign = -1; sign <= 1; sign += 2) {
        const int32_t rail = sign < 0 ? INT32_MIN : INT32_MAX;
        const int64_t far = INT64_C(7) << 60;
        struct exh_filter s = {sign < 0 ? -far : far, 12345, 0}, fresh;
        exh_filter_reset(&fresh, &rail, 1);
        CHECK_EQ_I64(one(&s, cfg, 0), rail);
        CHECK(s.pos == fresh.pos && s.vel == fresh.vel && s.wide == fresh.wide, "not at rest");
    }
}

/* A low kind settles anywhere within an LSB, not in its middle as after a reset. */
TEST(retune_keeps_every_settled_state)
{
    const struct exh_filter_cfg low = *tuned(2, 20 << 16, 1000);
    for (size_t i = 0; i < LEN(tune) * 4; i++) {
        const struct exh_filter_cfg to = *tuned(2, tune[i / 4].fc_Hz_q16, tune[i / 4].rate_Hz);
        const int32_t x = check_i32();
        struct exh_filter s = {x * (INT64_C(1) << 31), 0, 0};
        s.pos += i & 1 ? INT32_MAX : 0;
        s.vel += i & 2 ? UINT32_MAX : 0;
        for (int t = 0; t < 200; t++) {
            CHECK_EQ_I64(one(&s, t < 100 ? &low : &to, x), x);
            if (t == 99) { exh_filter_retune(&s, &low, &to, 1); }
        }
    }
}

TEST(state_round_trip)
{
    struct exh_filter s = {INT64_C(-0x123456789ABCDEF), INT64_C(0x7EDCBA9876543210), 1},
                      back = {0, 0, 0};
    uint8_t buf[32];
    struct exh_bytes c = exh_bytes_writer(buf, sizeof buf);
    exh_filter_serialize(&c, &s);
    CHECK_EQ_I64(c.at, 17);
    c = exh_bytes_reader(buf, c.at);
    exh_filter_serialize(&c, &back);
    CHECK(exh_bytes_ok(&c) && back.pos == s.pos && back.vel == s.vel && back.wide == s.wide,
        "state differs");
}

/* Whatever is restored: no undefined step, and the input again in the end. */
TEST(recovers_from_any_state)
{
    for (size_t i = 0; i < LEN(tune); i++) {
        for (int32_t order = 1; order <= 2; order++) {
            const struct exh_filter_cfg *cfg = tuned(order, tune[i].fc_Hz_q16, tune[i].rate_Hz);
            for (int k = 0; k < 20; k++) {
                struct exh_filter s;
                const int32_t x = check_i32();
                int32_t y = 0;
                s.pos = k < 4 ? (k & 1 ? INT64_MIN : INT64_MAX) : check_i64();
                s.wide = k >> 2 & 1;
                s.vel = k < 4 ? (k & 2 ? INT64_MIN : INT64_MAX) : check_i64();
                for (int32_t t = 2 * settling(i); t > 0; t--) { y = one(&s, cfg, x); }
                CHECK(
                    y == x, "order %" PRId32 " tune %zu: %" PRId32 " at %" PRId32, order, i, y, x);
            }
        }
    }
}

/* With a constant state: the output's ends, the saturation reports, and the last valid state. */
static void limits(const struct exh_filter_cfg *still, int64_t full, int64_t last, uint8_t wide)
{
    const struct {
        int64_t pos;
        int32_t y;
        int clips, anew;
    } row[] = {
        {full - 1, INT32_MAX, 0, 0},
        {full, INT32_MAX, 1, 0},
        {last, INT32_MAX, 1, 0},
        {last + 1, INT32_MAX, 1, 1},
        {-full, INT32_MIN, 0, 0},
        {-full - 1, INT32_MIN, 1, 0},
        {-last, INT32_MIN, 1, 0},
        {-last - 1, INT32_MIN, 1, 1},
    };
    for (size_t i = 0; i < LEN(row); i++) {
        const uint32_t before = check_saturations;
        struct exh_filter s = {row[i].pos, 0, wide}, fresh;
        exh_filter_reset(&fresh, &row[i].y, 1);
        CHECK_EQ_I64(one(&s, still, 0), row[i].y);
        CHECK((check_saturations != before) == row[i].clips, "row %zu: told %d", i, !row[i].clips);
        CHECK_EQ_I64(s.pos, row[i].anew ? fresh.pos : row[i].pos);
        CHECK_EQ_I64(s.wide, wide && !row[i].anew);
    }
}

/* A high kind has no limit but the output's: up to four times full scale each state goes on, an
 * output beyond starts anew. */
TEST(a_high_output_beyond_4_times_starts_anew)
{
    static const struct exh_filter_cfg still[] = {
        {0, 0, 0, 0, EXH_FILTER_HIGH1}, {0, INT32_MAX, 0, 0, EXH_FILTER_HIGH2}};
    const int64_t full = INT64_C(1) << (31 + 22);
    for (size_t i = 0; i < LEN(still); i++) { limits(&still[i], full, 4 * full, 1); }
}

/* 5/4 of full scale is the last a state may be at without starting anew. */
TEST(the_last_state_that_goes_on)
{
    const struct exh_filter_cfg *cfg = tuned(1, 1 << 16, 1000);
    const int64_t last = INT64_C(5) << 60;
    struct exh_filter s = {last, 0, 0}, more = {last + (INT64_C(1) << 55), 0, 0}, fresh;
    const int32_t rail = INT32_MAX;
    exh_filter_reset(&fresh, &rail, 1);
    CHECK_EQ_I64(one(&s, cfg, rail), rail);
    CHECK_EQ_I64(one(&more, cfg, rail), rail);
    CHECK(s.pos != fresh.pos, "started anew");
    CHECK(more.pos == fresh.pos, "went on");
}

TEST(limits_to_the_bit)
{
    static const struct exh_filter_cfg still = {0, 0, 0, 0, EXH_FILTER_LOW1};
    limits(&still, INT64_C(1) << 62, INT64_C(5) << 60, 0);
}

/* What a low kind takes over of a high one's state: full scale of either sign at most. */
TEST(retune_to_low_limits_the_state)
{
    const struct exh_filter_cfg high = *tuned(2, 400 << 16, 1000), low = *tuned(2, 1 << 16, 1000);
    const int64_t pos = INT64_C(1) << 53;
    static const int32_t more[] = {-1000, -1, 0, 1, 1000};
    for (size_t i = 0; i < 2 * LEN(more); i++) {
        const int64_t by = more[i / 2], sign = i & 1 ? -1 : 1;
        struct exh_filter s = {sign * (pos + by), sign * pos, 1};
        exh_filter_retune(&s, &high, &low, 1);
        CHECK_EQ_I64(s.pos, sign * (pos + (by < 0 ? by : 0)) * 512);
        CHECK_EQ_I64(s.vel, 0);
        CHECK_EQ_I64(s.wide, 0);
    }
}

/* A speed is of its kind's unit, and a slower filter of a high kind could not brake it. */
TEST(a_speed_stays_where_it_means_the_same)
{
    static const int32_t fc[] = {1, 100, 110, 400}; /* two of each kind, Hz at 1 kHz */
    for (int from = 0; from < 4; from++) {
        for (int to = 0; to < 4; to++) {
            const struct exh_filter_cfg a = *tuned(2, fc[from] << 16, 1000);
            const struct exh_filter_cfg b = *tuned(2, fc[to] << 16, 1000);
            struct exh_filter s = {0, 12345, from >= 2};
            const int stays = from < 2 ? to < 2 : to >= from;
            exh_filter_retune(&s, &a, &b, 1);
            CHECK_EQ_I64(s.vel, stays ? 12345 : 0);
        }
    }
}

/* 2^-21 of the rate is the lowest cut-off; none is below 2^-16 Hz. */
TEST(the_lowest_cut_off)
{
    static const struct {
        int32_t fc_Hz_q16;
        uint32_t rate_Hz;
        int err;
    } row[] = {{1, 1, 0}, {0, 1, -EXH_E_RANGE}, {-1, 1, -EXH_E_RANGE}, {1, 32, 0},
        {1, 64, -EXH_E_RANGE}, {2, 64, 0}};
    for (size_t i = 0; i < LEN(row); i++) {
        const struct exh_filter_par par = {1, row[i].fc_Hz_q16};
        struct exh_filter_cfg cfg;
        CHECK(exh_filter_setup(&cfg, &par, (struct exh_period){1, row[i].rate_Hz}) == row[i].err,
            "row %zu", i);
    }
}

TEST_MAIN("unit/filter", refusals_by_name, coefficients_by_hand, half_the_power_at_the_cut_off,
    a_constant_input_comes_out_exactly, reset_is_settled, a_step_rises_once_and_overshoots,
    full_scale_does_not_latch, channels_do_not_touch, retune_keeps_what_is_settled,
    retune_keeps_every_settled_state, a_change_of_order_drops_the_speed,
    a_state_beyond_any_input_starts_anew, state_round_trip, recovers_from_any_state,
    a_high_output_beyond_4_times_starts_anew, the_last_state_that_goes_on, limits_to_the_bit,
    retune_to_low_limits_the_state, a_speed_stays_where_it_means_the_same, the_lowest_cut_off);
