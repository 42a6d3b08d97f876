/* SPDX-License-Identifier: MIT */
/* chatter.h reports fast cycles of current that drive the string in time, and nothing else. */
#include "exhand/chatter.h"

#include "exhand/error.h"
#include "exhand/safety.h"

#include "check.h"

#define CA     (AMPERE / 100) /* 1/100 A */
#define AMPERE (1 << 26)
/* 0.1 mm a count and 3 N/A: a count at 1/100 A is so much. */
#define CA_CNT_nJ 3000

static struct exh_knot knot[2] = {
    {0, 0, {0, 0}}, {EXH_Q(18, 1, EXH_Q_FORCE), EXH_Q(6, 1, EXH_Q_CUR), {0, 0}}};
static const struct exh_chatter_par par = {EXH_Q(15, 100, 20), EXH_Q(3, 100, 24)};

static int setup(struct exh_chatter_cfg *c, const struct exh_chatter_par *p, struct exh_period T)
{
    struct exh_drive_cfg drive = {0};
    const struct exh_velocity_scale scale = {EXH_Q(1, 10000, EXH_Q_STEP), T};
    drive.force_to_cur = (struct exh_table){knot, 2};
    return exh_chatter_setup(c, p, &drive, scale);
}

static struct exh_chatter_cfg cfg_of(const struct exh_chatter_par *p, uint32_t rate_Hz)
{
    struct exh_chatter_cfg c;
    CHECK_EQ_I64(setup(&c, p, (struct exh_period){1, rate_Hz}), 0);
    return c;
}

/* Half a cycle at high, in which the string moves by way_cnt, half at low, in which it moves back.
 * Microseconds until the fault, or -1: none in `cycles`. */
static int64_t buzz_us(const struct exh_chatter_par *p, uint32_t rate_Hz, uint32_t cycle_ticks,
    const int32_t *level_cA, int32_t way_cnt, uint32_t cycles)
{
    const struct exh_chatter_cfg cfg = cfg_of(p, rate_Hz);
    const uint32_t half = cycle_ticks / 2;
    struct exh_chatter s = {0};
    int32_t cnt = 1000;
    for (uint32_t k = 0; k < cycles * cycle_ticks; k++) {
        const int high = k % cycle_ticks < half;
        if (k % cycle_ticks == 1) { cnt += way_cnt; }
        if (k % cycle_ticks == half + 1) { cnt -= way_cnt; }
        if (exh_chatter_step(&s, &cfg)) { return (int64_t)k * 1000000 / rate_Hz; }
        exh_chatter_update(&s, &cfg, cnt, level_cA[!high] * CA);
    }
    return -1;
}

/* Two-sided: no sooner than energy over all that is given out. No later than energy over the part
 * beyond power, and two cycles. */
TEST(cycles_that_drive_the_string)
{
    static const uint32_t rate_Hz[] = {90, 500, 1000, 2000, 20000};
    static const int32_t level_cA[] = {200, 50};
    for (size_t i = 0; i < sizeof rate_Hz / sizeof rate_Hz[0]; i++) {
        for (int32_t way = 1; way < 100; way++) {
            const int64_t give_uW = INT64_C(150) * way * CA_CNT_nJ * rate_Hz[i] / 8000;
            const int64_t got_us = buzz_us(&par, rate_Hz[i], 8, level_cA, -way, 3000);
            const int64_t two_us = 16000000 / rate_Hz[i];
            if (give_uW < 149000) {
                CHECK(got_us < 0, "%d Hz, %d uW: told", (int)rate_Hz[i], (int)give_uW);
            } else if (give_uW > 160000) {
                CHECK(got_us >= INT64_C(30000000000) / give_uW &&
                          got_us <= INT64_C(30100000000) / (give_uW - 150000) + two_us,
                    "%d Hz, %d uW: after %d us", (int)rate_Hz[i], (int)give_uW, (int)got_us);
            }
        }
    }
}

/* No chatter: damped cycles, cycles of a hand, small swings, no swing, and a limit of 0. */
TEST(what_is_none)
{
    static const int32_t big[] = {200, 50}, small[] = {220, 196}, still[] = {200, 200};
    struct exh_chatter_par never = par;
    never.energy_J_q24 = 0;
    CHECK(buzz_us(&par, 2000, 8, big, -40, 300) > 0, "driven");
    CHECK(buzz_us(&par, 2000, 8, big, 40, 300) < 0, "damped");
    CHECK(buzz_us(&par, 2000, 90, big, -400, 300) > 0, "45 ms");
    CHECK(buzz_us(&par, 2000, 104, big, -400, 300) < 0, "52 ms");
    CHECK(buzz_us(&par, 2000, 8, small, -400, 300) < 0, "0.24 A");
    CHECK(buzz_us(&par, 2000, 8, still, -400, 300) < 0, "no swing");
    CHECK(buzz_us(&never, 2000, 8, big, -40, 300) < 0, "never");
}

/* Of a ripple on a spring that is pressed and let go, two cycles take in and two give it back. */
TEST(what_was_taken_in_is_not_given_out)
{
    const struct exh_chatter_cfg cfg = cfg_of(&par, 2000);
    struct exh_chatter s = {0};
    int32_t cnt = 0;
    for (int k = 0; k < 8000; k++) {
        const int32_t way_cnt = k / 16 % 2 ? -30 : 30;
        cnt += k % 8 == 1 ? way_cnt : k % 8 == 5 ? -way_cnt : 0;
        CHECK(exh_chatter_step(&s, &cfg) == 0, "tick %d", k);
        exh_chatter_update(&s, &cfg, cnt, k % 8 < 4 ? 2 * AMPERE : AMPERE / 2);
    }
}

/* Before it can give out, a tap has taken in: 0.1 kg at 3 m/s onto 2 kN/m, and its bounces, which
 * lose little. In nm, nm/s, uN. */
TEST(taps_are_none)
{
    const struct exh_chatter_cfg cfg = cfg_of(&par, 2000);
    struct exh_chatter s = {0};
    int64_t v = INT64_C(3000000000), q = 0;
    for (int k = 0; k < 20000; k++) {
        const int64_t asked = q > 0 ? 2 * q + (v > 0 ? 300000 : 0) : 0;
        const int64_t force = asked < 18000000 ? asked : 18000000;
        CHECK(exh_chatter_step(&s, &cfg) == 0, "tick %d", k);
        exh_chatter_update(
            &s, &cfg, (int32_t)(q / 100000 + 1000), (int32_t)(force * 67 / 3)); /* A q26 */
        v += 5 * (1000000 - force) - (q > 0 ? v / 10000 : 0);
        q += v / 2000;
        if (k % 4000 == 3999) { v = INT64_C(3000000000); }
    }
}

/* Behind it the force is let go, and the cause is gone as the power takes it down. */
TEST(it_goes_away)
{
    const struct exh_chatter_cfg cfg = cfg_of(&par, 2000);
    struct exh_chatter s = {0};
    uint32_t ticks = 0;
    s.net_Acnt_q20 = cfg.energy_Acnt_q20;
    CHECK_EQ_I64(exh_chatter_step(&s, &cfg), EXH_FAULT_CHATTER);
    for (; s.net_Acnt_q20 > 0 && ticks < 1000; ticks++) { exh_chatter_update(&s, &cfg, 0, 0); }
    CHECK(ticks >= 399 && ticks <= 401, "%d ticks for 0.2 s", (int)ticks);
}

TEST(setup_refuses_what_is_out_of_range)
{
    const struct exh_period T = {1, 1000}, none = {0, 1};
    struct exh_chatter_par p = par;
    struct exh_chatter_cfg c;
    CHECK_EQ_I64(setup(&c, &par, none), -EXH_E_RATE);
    for (size_t r = 0; r < EXH_CHATTER_ROWS; r++) {
        const struct exh_signal *row = &exh_chatter_rows[r];
        const int32_t v[] = {row->min, row->max, row->dflt, row->min - 1, row->max + 1};
        for (size_t k = 0; k < 5; k++) {
            p = par;
            ((int32_t *)&p)[r] = v[k];
            CHECK_EQ_I64(setup(&c, &p, T), k < 3 ? 0 : -EXH_E_RANGE);
        }
    }
    p.power_W_q20 = par.power_W_q20;
    p.energy_J_q24 = EXH_Q(1, 1100, 24);
    CHECK_EQ_I64(setup(&c, &p, T), -EXH_E_RANGE);
    knot[1].y = 0;
    CHECK_EQ_I64(setup(&c, &par, T), -EXH_E_RANGE);
    knot[1].y = EXH_Q(6, 1, EXH_Q_CUR);
}

#define STEP EXH_Q(1, 10000, EXH_Q_STEP)

/* Of a table or a step that no device has: no gain, or sums that would not fit. */
TEST(setup_refuses_what_no_device_has)
{
    static const struct {
        int32_t x, y, step_m_q42;
        uint8_t n;
        int err;
    } row[] = {
        {EXH_Q(18, 1, EXH_Q_FORCE), EXH_Q(6, 1, EXH_Q_CUR), STEP, 2, 0},
        {EXH_Q(18, 1, EXH_Q_FORCE), EXH_Q(6, 1, EXH_Q_CUR), 0, 2, -EXH_E_RANGE},
        {EXH_Q(18, 1, EXH_Q_FORCE), EXH_Q(6, 1, EXH_Q_CUR), STEP, 1, -EXH_E_RANGE},
        {0, EXH_Q(6, 1, EXH_Q_CUR), STEP, 2, -EXH_E_RANGE},
        {1, INT32_MAX, 1, 2, -EXH_E_RANGE},             /* no gain */
        {1, (1 << 30) - 1, INT32_MAX, 2, -EXH_E_RANGE}, /* 2^58.3 in a second */
    };
    for (size_t i = 0; i < sizeof row / sizeof row[0]; i++) {
        const struct exh_chatter_par p = {EXH_Q(10, 1, 20), EXH_Q(1, 1, 24)};
        struct exh_knot at[2] = {{0, 0, {0, 0}}, {row[i].x, row[i].y, {0, 0}}};
        struct exh_drive_cfg drive = {0};
        struct exh_chatter_cfg c;
        int err;
        drive.force_to_cur = (struct exh_table){at, row[i].n};
        err = exh_chatter_setup(
            &c, &p, &drive, (struct exh_velocity_scale){row[i].step_m_q42, {1, 1000}});
        CHECK(err == row[i].err, "row %zu: %d", i, err);
    }
}

/* Any bytes: within what a sum takes, and the next valley brings it back. */
TEST(damaged_state)
{
    const struct exh_chatter_cfg cfg = cfg_of(&par, 2000);
    for (int n = 0; n < 2000; n++) {
        struct exh_chatter s = {0}, back = {0};
        uint8_t buf[33];
        struct exh_bytes c;
        for (size_t i = 0; i < sizeof buf; i++) { buf[i] = (uint8_t)check_u64(); }
        c = exh_bytes_reader(buf, sizeof buf);
        exh_chatter_serialize(&c, &s);
        CHECK_EQ_I64(c.at, sizeof buf);
        c = exh_bytes_writer(buf, sizeof buf);
        exh_chatter_serialize(&c, &s);
        c = exh_bytes_reader(buf, sizeof buf);
        exh_chatter_serialize(&c, &back);
        CHECK(s.net_Acnt_q20 == back.net_Acnt_q20 && s.cycle_Acnt_q20 == back.cycle_Acnt_q20 &&
                  s.held_A_q26 == back.held_A_q26 && s.end_A_q26 == back.end_A_q26 &&
                  s.cnt == back.cnt && s.ticks == back.ticks && s.rises == back.rises,
            "round trip");
        for (int k = 0; k < 10; k++) {
            exh_chatter_update(&s, &cfg, (int32_t)check_u64(), (int32_t)check_u64());
        }
        for (int k = 0; k < 4; k++) { exh_chatter_update(&s, &cfg, 0, k & 1 ? AMPERE : 0); }
        CHECK(s.net_Acnt_q20 <= cfg.energy_Acnt_q20 && s.net_Acnt_q20 >= -cfg.energy_Acnt_q20,
            "out of bounds");
    }
}

TEST_MAIN("unit/chatter", cycles_that_drive_the_string, what_is_none,
    what_was_taken_in_is_not_given_out, taps_are_none, it_goes_away,
    setup_refuses_what_is_out_of_range, setup_refuses_what_no_device_has, damaged_state);
