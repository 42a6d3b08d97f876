/* SPDX-License-Identifier: MIT */
/* velocity.h: the five estimators on movements whose velocity is known exactly.
 * The acceptance test of foaw against brute force is in test/module/prop/velocity_test.c. */
#include "exhand/velocity.h"

#include "exhand/error.h"

#include "check.h"
#include "wide.h"

/* 15.7 um a count (10 mm pulley, 4000 counts a turn); 1/2000 s. */
static const struct exh_velocity_scale scale_2k = {69049330, {1, 2000}};
/* A rate that divides nothing: 8254 timer, divisor 65. */
static const struct exh_velocity_scale scale_pit = {7000001, {65, 1193182}};

/* One estimator behind one face, so that each claim is written once. */
struct any {
    enum kind { WINDOW, POLE, FOAW, TRACK } kind;
    uint32_t arg; /* p, tau_us, n, tf_us */
    struct exh_velocity_window_cfg window_cfg;
    struct exh_velocity_window window;
    struct exh_velocity_pole_cfg pole_cfg;
    struct exh_velocity_pole pole;
    struct exh_velocity_foaw_cfg foaw_cfg;
    struct exh_velocity_foaw foaw;
    struct exh_velocity_track_cfg track_cfg;
    struct exh_velocity_track track;
};

static int any_setup(struct any *e, enum kind kind, uint32_t arg, struct exh_velocity_scale s)
{
    static const struct any zero;
    const struct exh_velocity_par par = {(int32_t)arg};
    *e = zero;
    e->kind = kind;
    e->arg = arg;
    switch (kind) {
    case WINDOW: return exh_velocity_window_setup(&e->window_cfg, s, &par);
    case POLE: return exh_velocity_pole_setup(&e->pole_cfg, s, arg);
    case FOAW: return exh_velocity_foaw_setup(&e->foaw_cfg, s, arg, 1);
    case TRACK: break;
    }
    return exh_velocity_track_setup(&e->track_cfg, s, arg);
}

static int32_t any_step(struct any *e, int32_t cnt)
{
    switch (e->kind) {
    case WINDOW: return exh_velocity_window_step(&e->window, &e->window_cfg, cnt);
    case POLE: return exh_velocity_pole_step(&e->pole, &e->pole_cfg, cnt);
    case FOAW: return exh_velocity_foaw_step(&e->foaw, &e->foaw_cfg, cnt);
    case TRACK: break;
    }
    return exh_velocity_track_step(&e->track, &e->track_cfg, cnt);
}

static const struct {
    enum kind kind;
    uint32_t arg;
    int settle; /* ticks after which it is constant */
} every[] = {
    {WINDOW, 0, 2},
    {WINDOW, 1, 3},
    {WINDOW, 2, 5},
    {WINDOW, 3, 9},
    {WINDOW, 4, 17},
    {POLE, 0, 3},
    {POLE, 500, 80},
    {POLE, 5000, 600},
    {FOAW, 1, 3},
    {FOAW, 16, 20},
    {TRACK, 0, 4},
    {TRACK, 500, 90},
    {TRACK, 5000, 900},
};

/* |got - num/den counts per tick| <= slack_num/den counts per tick + lsb, exactly:
 * one count per tick is step * T.den / (T.num * 2^15) LSB. */
static int near(int32_t got, struct exh_velocity_scale s, int64_t num, int64_t den,
    int64_t slack_num, int64_t lsb)
{
    const int64_t unit = (int64_t)s.T.num * 32768 * den;
    const int64_t per_count = (int64_t)s.step_m_q42 * s.T.den;
    const struct wide err = wide_sub(wide_mul(got, unit), wide_mul(per_count, num));
    return wide_within(err, wide_add(wide_mul(per_count, slack_num), wide_mul(unit, lsb)));
}

/* Signed counter arithmetic modulo 2^32 for the inputs. */
static int32_t wrapped(int64_t v)
{
    return (int32_t)(((v + 2147483648) & UINT32_MAX) - 2147483648);
}

TEST(first_call_returns_zero)
{
    for (size_t i = 0; i < LEN(every); i++) {
        for (size_t k = 0; k < CHECK_CORNERS; k++) {
            struct any e;
            CHECK_EQ_I64(any_setup(&e, every[i].kind, every[i].arg, scale_2k), 0);
            CHECK(any_step(&e, check_corner[k]) == 0, "row %zu starts with a jump", i);
            CHECK(any_step(&e, check_corner[k]) == 0, "row %zu moves at rest", i);
        }
    }
}

/* A whole number of counts a tick: no quantisation, so no error beyond rounding;
 * the count wraps in mid-run both ways. */
TEST(constant_velocity_is_exact_across_the_wrap)
{
    static const int64_t counts[] = {0, 1, -1, 3, -7, 100, -200};
    for (size_t i = 0; i < LEN(every) * LEN(counts); i++) {
        const size_t row = i / LEN(counts);
        const int64_t v = counts[i % LEN(counts)];
        const int64_t wrap = v < 0 ? INT32_MIN : INT32_MAX;
        const int64_t start = wrap - v * (every[row].settle + 20);
        struct any e;
        (void)any_setup(&e, every[row].kind, every[row].arg, scale_2k);
        for (int64_t k = 0; k < every[row].settle + 60; k++) {
            const int32_t got = any_step(&e, wrapped(start + v * k));
            CHECK(k < every[row].settle || near(got, scale_2k, v, 1, 0, 2),
                "row %zu, %" PRId64 " counts a tick, tick %" PRId64 ": %" PRId32, row, v, k, got);
        }
    }
}

/* theory: |error| < D/(nT) at any constant velocity, also one that is no whole
 * number of counts. n is 1 for the difference, the pole and foaw's worst case. */
TEST(quantisation_error_stays_in_its_bound)
{
    static const struct {
        int64_t num, den; /* counts per tick */
    } speed[] = {{1, 31}, {-1, 31}, {2, 7}, {-9, 10}, {355, 113}, {-1000, 333}, {99999, 1000}};
    for (size_t i = 0; i < LEN(every) * LEN(speed); i++) {
        const size_t row = i / LEN(speed);
        const int64_t num = speed[i % LEN(speed)].num, den = speed[i % LEN(speed)].den;
        const int64_t n = every[row].kind == WINDOW ? 1 << every[row].arg : 1;
        struct any e;
        (void)any_setup(&e, every[row].kind, every[row].arg, scale_pit);
        for (int64_t k = 0; k < every[row].settle + 400; k++) {
            const int64_t scaled = num * k + 1000000 * den;
            const int32_t got = any_step(&e, (int32_t)(scaled / den));
            CHECK(k < 10 * every[row].settle || near(got, scale_pit, num * n, den * n, den, 2),
                "row %zu, %" PRId64 "/%" PRId64 " tick %" PRId64 ": %" PRId32, row, num, den, k,
                got);
        }
    }
}

/* Constant acceleration, y = A k^2: the estimate is that of `lag` ticks ago. */
TEST(lag_is_the_documented_one)
{
    static const struct {
        enum kind kind;
        uint32_t arg;
        int64_t lag_x10; /* tenths of a tick */
    } row[] = {
        {WINDOW, 0, 5},
        {WINDOW, 2, 20},
        {WINDOW, 4, 80},
        {POLE, 0, 5},
        {POLE, 500, 15},
        {POLE, 5000, 105},
        {TRACK, 0, 5},
        {TRACK, 500, 25},
        {TRACK, 5000, 205},
    };
    /* Fine counts, 0.157 um, so that 400 ticks of 8 counts per tick^2 reach 1 m/s. */
    const struct exh_velocity_scale s = {690493, {1, 2000}};
    const int64_t a = 4, last = 400;
    for (size_t i = 0; i < LEN(row); i++) {
        struct any e;
        int32_t got = 0;
        (void)any_setup(&e, row[i].kind, row[i].arg, s);
        for (int64_t k = 0; k <= last; k++) { got = any_step(&e, (int32_t)(a * k * k)); }
        CHECK(near(got, s, 2 * a * (10 * last - row[i].lag_x10), 10, 0, 8), "row %zu: %" PRId32, i,
            got);
    }
}

TEST(saturates_with_the_right_sign)
{
    for (size_t i = 0; i < LEN(every); i++) {
        for (int sign = -1; sign <= 1; sign += 2) {
            struct any e;
            int32_t got = 0;
            (void)any_setup(&e, every[i].kind, every[i].arg, scale_2k);
            for (int64_t k = 0; k < every[i].settle + 50; k++) {
                got = any_step(&e, wrapped(sign * k * 1000000)); /* 31 km/s */
            }
            CHECK(got == (sign > 0 ? INT32_MAX : INT32_MIN), "row %zu: %" PRId32, i, got);
        }
    }
}

/* After any commotion rest is 0: exactly, but for the observer, whose rounding
 * leaves at most (T_f/T + 1) * 2^-32 counts a tick: below 1 LSB here. */
TEST(rest_returns_to_zero)
{
    for (size_t i = 0; i < LEN(every); i++) {
        struct any e;
        int32_t got = 1;
        int32_t cnt = 0;
        (void)any_setup(&e, every[i].kind, every[i].arg, scale_2k);
        for (int k = 0; k < 200; k++) { (void)any_step(&e, cnt = check_i32_in(-3000, 3000)); }
        for (int k = 0; k < 40 * every[i].settle + 40; k++) { got = any_step(&e, cnt); }
        CHECK(got == 0, "row %zu: %" PRId32 " at rest", i, got);
    }
}

/* The slowest observer that set-up accepts: its residual has a bound, too. */
TEST(slow_observer_rests_within_its_residual)
{
    static const struct {
        uint32_t tf_us, rate_Hz;
    } row[] = {{1000000, 2000}, {1000000, 20000}, {100000, 20000}};
    for (size_t i = 0; i < LEN(row); i++) {
        const struct exh_velocity_scale s = {69049330, {1, row[i].rate_Hz}};
        const int64_t ticks = (int64_t)row[i].tf_us * row[i].rate_Hz / 1000000;
        struct any e;
        int32_t got = 0;
        (void)any_setup(&e, TRACK, row[i].tf_us, s);
        for (int64_t k = 0; k < 2 * ticks; k++) { (void)any_step(&e, (int32_t)(k / 3)); }
        for (int64_t k = 0; k < 40 * ticks; k++) { got = any_step(&e, (int32_t)(2 * ticks / 3)); }
        CHECK(near(got, s, 0, INT64_C(1) << 32, ticks + 1, 1), "row %zu: %" PRId32 " LSB at rest",
            i, got);
    }
}

/* foaw, by hand: a step inside the window ends it, small noise does not. */
TEST(foaw_acceptance_by_hand)
{
    struct any e;
    int32_t got = 0;
    (void)any_setup(&e, FOAW, 16, scale_2k);
    for (int k = 0; k < 40; k++) { got = any_step(&e, 1000); }
    got = any_step(&e, 1500); /* only n = 1 fits */
    CHECK(near(got, scale_2k, 500, 1, 0, 1), "after a step: %" PRId32, got);
    got = any_step(&e, 2000); /* 1000 1500 2000: n = 2 fits exactly */
    CHECK(near(got, scale_2k, 500, 1, 0, 1), "on the ramp: %" PRId32, got);
    for (int k = 0; k < 40; k++) { got = any_step(&e, k & 1); }
    CHECK(near(got, scale_2k, 0, 1, 1, 0), "noise of one count: %" PRId32, got);
    CHECK(!near(got, scale_2k, 1, 1, 0, 1), "noise of one count taken for a step");
}

TEST(setup_refuses)
{
    static const struct {
        enum kind kind;
        uint32_t arg;
        struct exh_velocity_scale s;
    } bad[] = {
        {WINDOW, 5, {69049330, {1, 2000}}},
        {WINDOW, UINT32_MAX, {69049330, {1, 2000}}},
        {WINDOW, 0, {0, {1, 2000}}},
        {WINDOW, 0, {-1, {1, 2000}}},
        {POLE, 1000001, {69049330, {1, 2000}}},
        {POLE, 0, {0, {1, 2000}}},
        {FOAW, 0, {69049330, {1, 2000}}},
        {FOAW, 17, {69049330, {1, 2000}}},
        {FOAW, 16, {0, {1, 2000}}},
        {TRACK, 1000001, {69049330, {1, 2000}}},
        {TRACK, 0, {-5, {1, 2000}}},
    };
    static const struct exh_period no_period[] = {{0, 2000}, {1, 0}, {1, 40000}, {2, 1}};
    struct any e;
    struct exh_velocity_foaw_cfg foaw;
    for (size_t i = 0; i < LEN(bad); i++) {
        CHECK(any_setup(&e, bad[i].kind, bad[i].arg, bad[i].s) == -EXH_E_RANGE, "row %zu", i);
    }
    for (size_t i = 0; i < LEN(no_period); i++) {
        const struct exh_velocity_scale s = {69049330, no_period[i]};
        CHECK(any_setup(&e, WINDOW, 0, s) == -EXH_E_RATE, "window, period %zu", i);
        CHECK(any_setup(&e, POLE, 1000, s) == -EXH_E_RATE, "pole, period %zu", i);
        CHECK(any_setup(&e, FOAW, 4, s) == -EXH_E_RATE, "foaw, period %zu", i);
        CHECK(any_setup(&e, TRACK, 1000, s) == -EXH_E_RATE, "track, period %zu", i);
    }
    CHECK_EQ_I64(exh_velocity_foaw_setup(&foaw, scale_2k, 16, 0), -EXH_E_RANGE);
    CHECK_EQ_I64(exh_velocity_foaw_setup(&foaw, scale_2k, 16, 256), -EXH_E_RANGE);
    CHECK_EQ_I64(exh_velocity_foaw_setup(&foaw, scale_2k, 16, 255), 0);
}

static void any_bytes(struct exh_bytes *c, struct any *e)
{
    switch (e->kind) {
    case WINDOW: exh_velocity_window_serialize(c, &e->window); break;
    case POLE: exh_velocity_pole_serialize(c, &e->pole); break;
    case FOAW: exh_velocity_foaw_serialize(c, &e->foaw); break;
    case TRACK: exh_velocity_track_serialize(c, &e->track); break;
    }
}

/* A state saved in mid-run goes on as if nothing had happened. */
TEST(state_survives_a_round_trip)
{
    for (size_t i = 0; i < LEN(every); i++) {
        struct any a, b;
        uint8_t buf[128];
        struct exh_bytes c = exh_bytes_writer(buf, sizeof buf);
        (void)any_setup(&a, every[i].kind, every[i].arg, scale_2k);
        (void)any_setup(&b, every[i].kind, every[i].arg, scale_2k);
        for (int k = 0; k < 37; k++) { (void)any_step(&a, check_i32_in(-50, 50)); }
        any_bytes(&c, &a);
        CHECK(exh_bytes_ok(&c) && c.at > 0, "row %zu: %" PRIu32 " bytes", i, c.at);
        c = exh_bytes_reader(buf, c.at);
        any_bytes(&c, &b);
        for (int k = 0; k < 37; k++) {
            const int32_t cnt = check_i32_in(-50, 50);
            const int32_t want = any_step(&a, cnt);
            CHECK(any_step(&b, cnt) == want, "row %zu tick %d", i, k);
        }
    }
}

/* Bytes of any content leave a state that no index, sum or shift runs out of. */
TEST(damaged_state_is_harmless)
{
    for (size_t i = 0; i < LEN(every); i++) {
        for (int n = 0; n < 200; n++) {
            struct any a;
            uint8_t buf[128];
            struct exh_bytes c = exh_bytes_reader(buf, sizeof buf);
            for (size_t k = 0; k < sizeof buf; k++) {
                buf[k] = n == 0 ? 0xFF : n == 1 ? 0x7F : (uint8_t)(check_u64() & 0xFF);
            }
            (void)any_setup(&a, every[i].kind, every[i].arg, scale_2k);
            any_bytes(&c, &a);
            for (int k = 0; k < 40; k++) { (void)any_step(&a, check_i32()); }
        }
    }
}

/* 2.4 m/s a count of a second: sums beyond 32 bits times a gain of 0.6, which saturate nothing. */
TEST(sums_beyond_32_bits_are_exact)
{
    static const struct exh_velocity_scale s = {78643, {1, 1}};
    for (int sign = -1; sign <= 1; sign += 2) {
        const int32_t d = sign * 700000000;
        int64_t cnt = 0;
        int32_t got = 0;
        struct any e;
        CHECK_EQ_I64(any_setup(&e, FOAW, 2, s), 0);
        for (int k = 0; k < 6; k++) {
            got = any_step(&e, wrapped(cnt));
            cnt += d;
        }
        CHECK(near(got, s, d, 1, 0, 1), "%" PRId32, got);
    }
}

/* The least share of a pole, at 20 kHz and 1 s; and what bytes may leave in a state, to the bit. */
TEST(ends_to_the_bit)
{
    const int64_t most = INT64_C(16) << 55;
    struct exh_velocity_pole_cfg cfg;
    CHECK_EQ_I64(
        exh_velocity_pole_setup(&cfg, (struct exh_velocity_scale){1, {1, 20000}}, 1000000), 0);
    CHECK_EQ_I64(cfg.a_q31, 107369); /* 2^31 / 20001, rounded */
    for (int64_t more = -1; more <= 1; more++) {
        for (int sign = -1; sign <= 1; sign += 2) {
            struct exh_velocity_pole s = {sign * (most + more), 5, 1};
            uint8_t buf[13];
            struct exh_bytes c = exh_bytes_writer(buf, sizeof buf);
            exh_bytes_i64(&c, &s.v_mps_q55);
            c = exh_bytes_reader(buf, sizeof buf);
            exh_velocity_pole_serialize(&c, &s);
            CHECK_EQ_I64(s.v_mps_q55, sign * (most + (more < 0 ? more : 0)));
        }
    }
    for (unsigned at = EXH_VELOCITY_N - 2; at <= UINT8_MAX; at++) { /* the index wraps */
        const struct exh_velocity_foaw_cfg foaw = {0};
        struct exh_velocity_foaw s = {{0}, (uint8_t)at, 0};
        (void)exh_velocity_foaw_step(&s, &foaw, 7);
        CHECK(s.at == (at + 1) % EXH_VELOCITY_N && s.cnt[s.at] == 7, "%u: %u", at, (unsigned)s.at);
    }
}

TEST_MAIN("unit/velocity", first_call_returns_zero, constant_velocity_is_exact_across_the_wrap,
    quantisation_error_stays_in_its_bound, lag_is_the_documented_one, saturates_with_the_right_sign,
    rest_returns_to_zero, slow_observer_rests_within_its_residual, foaw_acceptance_by_hand,
    setup_refuses, state_survives_a_round_trip, damaged_state_is_harmless,
    sums_beyond_32_bits_are_exact, ends_to_the_bit);
