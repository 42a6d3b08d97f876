/* filter.h: what is refused, a constant input, steps, full scale, a change of cut-off. */
#include "exhand/filter.h"

#include "exhand/error.h"

#include "check.h"

#define LEN(a) (sizeof(a) / sizeof((a)[0]))

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
    {1000, 5 << 16},   {2000, 5 << 16},   {20000, 5 << 16},  {2000, 50 << 16}, {20000, 50 << 16},
    {1000, 20 << 16},  {1000, 100 << 16}, {1000, 10 << 16},  {1000, 1 << 16},  {10000, 1 << 16},
    {90, 20 << 16},    {100, 49 << 16},   {200, 50 << 16},   {1, 32000},       {1, 655},
    {1000, 114 << 16}, {1000, 113 << 16}, {2000, 999 << 16},
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
        {2, 65536, {0, 1000}, -EXH_E_RANGE},
        {2, 65536, {1, 0}, -EXH_E_RANGE},
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

/* Long enough for all but the slowest decay of the highest cut-offs. */
static int32_t settling(size_t i)
{
    const int64_t rate_q16 = (int64_t)tune[i].rate_Hz << 16;
    const int64_t left_q16 = rate_q16 / 2 - tune[i].fc_Hz_q16;
    return (int32_t)(12 * rate_q16 / tune[i].fc_Hz_q16 + 12 * rate_q16 / left_q16) + 100;
}

TEST(a_constant_input_comes_out_exactly)
{
    static const int32_t level[] = {795000000,  -795000000, 1,           -1,
                                    0,          21474836,   -21474836,   INT32_MAX,
                                    2104533974, INT32_MIN,  10923 << 16, 0};
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
                exh_filter_retune(&s, 1, t & 1 ? &b : &a, t & 1 ? &a : &b);
            }
        }
    }
}

TEST(state_round_trip)
{
    struct exh_filter s = {INT64_C(-0x123456789ABCDEF), INT64_C(0x7EDCBA9876543210), 1},
                      back = {0, 0, 0};
    uint8_t buf[32];
    struct exh_bytes c = exh_bytes_writer(buf, sizeof buf);
    exh_filter_bytes(&c, &s);
    CHECK_EQ_I64(c.at, 17);
    c = exh_bytes_reader(buf, c.at);
    exh_filter_bytes(&c, &back);
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
                CHECK(y == x, "order %" PRId32 " tune %zu: %" PRId32 " at %" PRId32, order, i, y,
                      x);
            }
        }
    }
}

TEST_MAIN("unit/filter", refusals_by_name, a_constant_input_comes_out_exactly, reset_is_settled,
          a_step_rises_once_and_overshoots, full_scale_does_not_latch, channels_do_not_touch,
          retune_keeps_what_is_settled, state_round_trip, recovers_from_any_state);
