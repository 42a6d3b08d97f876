/* SPDX-License-Identifier: MIT */
/* motion.h: the speed limit, and an encoder that no longer counts. */
#include "exhand/motion.h"

#include "exhand/error.h"
#include "exhand/safety.h"

#include "check.h"

#define MPS    (1 << 27)
#define AMPERE (1 << 26)

static const struct exh_motion_par par = {3 * MPS, 20, 2000, AMPERE / 4};

static struct exh_motion_cfg cfg_of(const struct exh_motion_par *p, uint32_t rate_Hz)
{
    struct exh_motion_cfg c = {NULL, 0, 0};
    CHECK_EQ_I64(exh_motion_setup(&c, p, (struct exh_period){1, rate_Hz}), 0);
    return c;
}

TEST(velocity_is_held_within_the_limit)
{
    static const struct {
        int32_t v, want;
    } row[] = {{0, 0}, {3 * MPS, 3 * MPS}, {-3 * MPS, -3 * MPS}, {3 * MPS + 1, 3 * MPS},
        {-3 * MPS - 1, -3 * MPS}, {INT32_MAX, 3 * MPS}, {INT32_MIN, -3 * MPS}};
    const struct exh_motion_cfg cfg = cfg_of(&par, 1000);
    for (size_t i = 0; i < LEN(row); i++) {
        struct exh_motion s = {0, 0, 0};
        uint32_t limits = EXH_LIMIT_DAC;
        int32_t v = row[i].v;
        CHECK_EQ_I64(exh_motion_step(&s, &cfg, &v, &limits), 0);
        CHECK_EQ_I64(v, row[i].want);
        CHECK_EQ_I64(limits, EXH_LIMIT_DAC | (v != row[i].v ? EXH_LIMIT_SPEED : 0u));
    }
}

/* Reported after more than speed_time without a break at every rate, and not before. One slow tick
 * resets the time. */
TEST(too_fast_for_too_long)
{
    for (uint32_t rate_Hz = 1; rate_Hz <= 2000; rate_Hz++) {
        const struct exh_motion_cfg cfg = cfg_of(&par, rate_Hz);
        const uint32_t want = rate_Hz * 20 / 1000 + 1;
        struct exh_motion s = {0, 0, 0};
        uint32_t limits = 0;
        for (uint32_t k = 1; k < 3 * want; k++) {
            int32_t v = k == want ? MPS : -4 * MPS;
            const uint32_t faults = exh_motion_step(&s, &cfg, &v, &limits);
            CHECK(faults == (k >= 2 * want ? EXH_FAULT_SPEED : 0u), "%" PRIu32 " Hz, tick %" PRIu32,
                rate_Hz, k);
        }
    }
}

TEST(standing_while_pulled)
{
    const struct exh_motion_cfg cfg = cfg_of(&par, 1000);
    struct exh_motion s = {0, 0, 0};
    uint32_t limits = 0;
    for (int32_t k = 0; k < 10000; k++) {
        /* 0: it moves once a second. 1: too little current. 2: pushed, not pulled. 3: at rest. */
        const int kind = k / 2500;
        const int32_t cnt = kind == 0 ? k / 1000 : 2;
        const int32_t coded = kind == 1 ? AMPERE / 4 : kind == 2 ? -AMPERE : AMPERE / 4 + 1;
        int32_t v = 0;
        const uint32_t faults = exh_motion_step(&s, &cfg, &v, &limits);
        exh_motion_update(&s, &cfg, cnt, coded);
        CHECK(faults == (k > 7500 + 2000 ? EXH_FAULT_STUCK : 0u), "tick %" PRId32, k);
    }
}

TEST(off_is_never_stuck)
{
    struct exh_motion_par p = par;
    struct exh_motion_cfg cfg;
    struct exh_motion s = {0, 0, 0};
    uint32_t limits = 0;
    p.stuck_ms = 0;
    cfg = cfg_of(&p, 1000);
    for (int k = 0; k < 100000; k++) {
        int32_t v = 0;
        exh_motion_update(&s, &cfg, 0, 6 * AMPERE);
        CHECK_EQ_I64(exh_motion_step(&s, &cfg, &v, &limits), 0);
    }
}

TEST(setup_refuses_what_is_out_of_range)
{
    const struct exh_period T = {1, 1000}, none = {0, 1};
    for (size_t r = 0; r < EXH_MOTION_ROWS; r++) {
        const struct exh_signal *row = &exh_motion_rows[r];
        const int32_t v[] = {row->min, row->max, row->dflt, row->min - 1, row->max + 1};
        for (size_t k = 0; k < LEN(v); k++) {
            struct exh_motion_par p = par;
            struct exh_motion_cfg cfg;
            ((int32_t *)&p)[r] = v[k];
            CHECK_EQ_I64(exh_motion_setup(&cfg, &p, T), k < 3 ? 0 : -EXH_E_RANGE);
            CHECK_EQ_I64(exh_motion_setup(&cfg, &p, none), k < 3 ? -EXH_E_RATE : -EXH_E_RANGE);
        }
    }
    for (int32_t ms = 1; ms < 100; ms++) { /* shorter, a slow hand would be one */
        struct exh_motion_par p = par;
        struct exh_motion_cfg cfg;
        p.stuck_ms = ms;
        CHECK_EQ_I64(exh_motion_setup(&cfg, &p, T), -EXH_E_RANGE);
    }
}

TEST(state_round_trip)
{
    struct exh_motion s = {1, 2, -3}, back = {0, 0, 0};
    uint8_t buf[16];
    struct exh_bytes c = exh_bytes_writer(buf, sizeof buf);
    exh_motion_serialize(&c, &s);
    CHECK_EQ_I64(c.at, 12);
    c = exh_bytes_reader(buf, c.at);
    exh_motion_serialize(&c, &back);
    CHECK(back.fast_ticks == 1 && back.stuck_ticks == 2 && back.cnt == -3, "state");
}

/* Counts beyond those of a run: reported, and clamped. */
TEST(damaged_state)
{
    const struct exh_motion_cfg cfg = cfg_of(&par, 1000);
    struct exh_motion s = {UINT32_MAX, UINT32_MAX, 0};
    uint32_t limits = 0;
    int32_t v = 4 * MPS;
    CHECK_EQ_I64(exh_motion_step(&s, &cfg, &v, &limits), EXH_FAULT_SPEED | EXH_FAULT_STUCK);
    exh_motion_update(&s, &cfg, 0, AMPERE);
    CHECK(s.fast_ticks == cfg.speed_ticks && s.stuck_ticks == cfg.stuck_ticks, "brought back");
}

TEST_MAIN("unit/motion", velocity_is_held_within_the_limit, too_fast_for_too_long,
    standing_while_pulled, off_is_never_stuck, setup_refuses_what_is_out_of_range, state_round_trip,
    damaged_state);
