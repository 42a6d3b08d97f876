/* SPDX-License-Identifier: MIT */
/* polarity.h: what a pull reports, tick by tick. The ramp of arming waits for it. */
#include "exhand/polarity.h"

#include "exhand/error.h"

#include "check.h"

#define STEP EXH_Q(1, 10000, EXH_Q_STEP) /* 0.1 mm a count */
#define PULL EXH_Q(3, 10, EXH_Q_FORCE)

static const struct exh_period kHz = {1, 1000};
static const struct exh_polarity_par par = {PULL, 400, EXH_Q(3, 10000, EXH_Q_POS)};

static struct exh_polarity_cfg config(void)
{
    struct exh_polarity_cfg cfg;
    CHECK_EQ_I64(exh_polarity_setup(&cfg, &par, STEP, kHz), 0);
    return cfg;
}

TEST(set_up)
{
    static const struct exh_polarity_par bad[] = {{-1, 400, 322123},
        {EXH_Q(1, 1, EXH_Q_FORCE) + 1, 400, 322123}, {PULL, 49, 322123}, {PULL, 5001, 322123},
        {PULL, 400, EXH_Q(5, 100000, EXH_Q_POS) - 1}, {PULL, 400, EXH_Q(20, 1000, EXH_Q_POS) + 1}};
    static const struct exh_period none = {0, 1};
    struct exh_polarity_cfg cfg = config();
    CHECK_EQ_I64(cfg.rest_ticks, 100);
    CHECK_EQ_I64(cfg.ticks, 400);
    CHECK(cfg.move_cnt == 2 || cfg.move_cnt == 3, "%d", (int)cfg.move_cnt);
    CHECK(100 * (int64_t)cfg.rise_N_q20 >= PULL && 99 * (int64_t)cfg.rise_N_q20 < PULL, "%d",
        (int)cfg.rise_N_q20);
    for (size_t i = 0; i < LEN(bad); i++) {
        CHECK(exh_polarity_setup(&cfg, &bad[i], STEP, kHz) == -EXH_E_RANGE, "row %zu", i);
    }
    for (size_t r = 0; r < EXH_POLARITY_ROWS; r++) {
        const int32_t end[] = {exh_polarity_rows[r].min, exh_polarity_rows[r].max};
        for (size_t k = 0; k < LEN(end); k++) {
            struct exh_polarity_par p = par;
            ((int32_t *)&p)[r] = end[k];
            CHECK(exh_polarity_setup(&cfg, &p, STEP, kHz) == 0, "row %zu: %d", r, (int)end[k]);
        }
    }
    for (int32_t pull = 999; pull <= 1001;
         pull++) { /* rounded up: there in a quarter of the time */
        struct exh_polarity_par p = par;
        p.pull_N_q20 = pull;
        CHECK_EQ_I64(exh_polarity_setup(&cfg, &p, STEP / 10, kHz), 0);
        CHECK(cfg.rise_N_q20 == (pull > 1000 ? 11 : 10), "%d", (int)cfg.rise_N_q20);
        CHECK(cfg.move_cnt == 29 || cfg.move_cnt == 30, "%d", (int)cfg.move_cnt);
    }
    CHECK_EQ_I64(exh_polarity_setup(&cfg, &par, 1, kHz), 0);
    CHECK_EQ_I64(exh_polarity_setup(&cfg, &par, 0, kHz), -EXH_E_RANGE);
    CHECK_EQ_I64(exh_polarity_setup(&cfg, &par, STEP, none), -EXH_E_RATE);
    CHECK_EQ_I64(exh_polarity_setup(&cfg, &par, STEP, (struct exh_period){1, 1}), 0);
    CHECK(cfg.rest_ticks == 4 && cfg.ticks == 16, "a slow loop");
    CHECK_EQ_I64(exh_polarity_setup(&cfg, &par, INT32_MAX, kHz), 0);
    CHECK_EQ_I64(cfg.move_cnt, 2);
}

/* The force rises, is never above its limit, and ends with the verdict. */
TEST(what_moves_is_what_is_told)
{
    static const struct {
        int32_t a_tick; /* counts in 16 ticks of pull */
        uint8_t result;
    } row[] = {{-1, EXH_POLARITY_SEEN}, {1, EXH_POLARITY_WRONG}, {0, EXH_POLARITY_STILL}};
    const struct exh_polarity_cfg cfg = config();
    for (size_t i = 0; i < LEN(row); i++) {
        struct exh_polarity s = {0, 0, 0, 0, 0};
        int32_t cnt = INT32_MAX - 1, last = 0, most = 0; /* the count wraps */
        uint32_t ticks = 0, n = 0;
        CHECK_EQ_I64(exh_polarity_step(&s, &cfg, 0, cnt), EXH_POLARITY_BUSY);
        while (exh_polarity_step(&s, &cfg, 1, cnt) == EXH_POLARITY_BUSY && ticks < 1000) {
            const int32_t force = exh_polarity_force_N_q20(&s, &cfg);
            CHECK(ticks < 100 ? force == 0 : force >= last, "tick %u: %d", (unsigned)ticks,
                (int)force);
            last = force;
            if (force > most) { most = force; }
            if (force > 0 && ++n % 16 == 0) { cnt = exh_wrap_add(cnt, row[i].a_tick); }
            ticks++;
        }
        CHECK(s.result == row[i].result, "row %zu: %u after %u", i, s.result, (unsigned)ticks);
        CHECK(
            ticks < 400 && (row[i].a_tick != 0 || ticks == 399), "row %zu: %u", i, (unsigned)ticks);
        CHECK(most <= PULL && (row[i].a_tick != 0 || most == PULL), "row %zu: %d", i, (int)most);
        CHECK_EQ_I64(exh_polarity_force_N_q20(&s, &cfg), 0);
        CHECK_EQ_I64(exh_polarity_step(&s, &cfg, 1, exh_wrap_add(cnt, 1000)), row[i].result);
        CHECK_EQ_I64(exh_polarity_step(&s, &cfg, 0, cnt), EXH_POLARITY_BUSY); /* anew */
        CHECK(s.tick == 0 && s.rest == 0 && s.pulled == 0, "not anew");
    }
}

/* Pulls this count for n ticks; BUSY in each but the last. */
static uint8_t pulls(struct exh_polarity *s, const struct exh_polarity_cfg *cfg, int32_t cnt, int n)
{
    uint8_t r = EXH_POLARITY_BUSY;
    for (int k = 0; k < n; k++) {
        CHECK(r == EXH_POLARITY_BUSY, "%u after %d of %d ticks", r, k, n);
        r = exh_polarity_step(s, cfg, 1, cnt);
    }
    return r;
}

/* Exactly a hundred ticks at rest, and again after each movement. Then the force rises in steps. A
 * movement counts from where the rest ended, to the count. */
TEST(edges_of_rest_and_movement)
{
    const struct exh_polarity_cfg cfg = config();
    const int32_t move = cfg.move_cnt, rise = cfg.rise_N_q20;
    for (int way = -1; way <= 1; way += 2) {
        struct exh_polarity s = {0, 0, 0, 0, 0};
        (void)exh_polarity_step(&s, &cfg, 0, 0);
        (void)pulls(&s, &cfg, 0, 49);
        (void)pulls(&s, &cfg, way * move, 1);
        (void)pulls(&s, &cfg, way * move, 99);
        (void)pulls(&s, &cfg, way * (2 * move - 1), 1); /* no movement, and at rest */
        CHECK_EQ_I64(exh_polarity_force_N_q20(&s, &cfg), 0);
        for (int k = 1; k <= 3; k++) {
            (void)pulls(&s, &cfg, way * (3 * move - 2), 1);
            CHECK_EQ_I64(exh_polarity_force_N_q20(&s, &cfg), k * rise);
        }
        CHECK_EQ_I64(pulls(&s, &cfg, way * (3 * move - 1), 1),
            way < 0 ? EXH_POLARITY_SEEN : EXH_POLARITY_WRONG);
        CHECK_EQ_I64(s.tick, 154);
    }
}

/* Slowly, too: a count a tick is no rest. */
TEST(a_hand_that_drifts_is_not_pulled)
{
    const struct exh_polarity_cfg cfg = config();
    struct exh_polarity s = {0, 0, 0, 0, 0};
    for (int32_t k = 0; k < 398; k++) {
        (void)pulls(&s, &cfg, k, 1);
        CHECK(exh_polarity_force_N_q20(&s, &cfg) == 0, "tick %d", (int)k);
    }
}

/* A hand that moves is not pulled, and no verdict comes of its movement. */
TEST(no_pull_before_it_was_at_rest)
{
    const struct exh_polarity_cfg cfg = config();
    for (int way = -1; way <= 1; way += 2) {
        struct exh_polarity s = {0, 0, 0, 0, 0};
        int32_t cnt = 0;
        uint8_t r = EXH_POLARITY_BUSY;
        for (int n = 0; n < 399; n++) {
            r = exh_polarity_step(&s, &cfg, 1, cnt);
            CHECK(r == EXH_POLARITY_BUSY && exh_polarity_force_N_q20(&s, &cfg) == 0, "tick %d", n);
            if (n % 30 == 0) { cnt += 3 * way; }
        }
        CHECK_EQ_I64(exh_polarity_step(&s, &cfg, 1, cnt), EXH_POLARITY_STILL);
    }
}

/* --- with the box --- */

#define ALL_IN UINT32_MAX

static struct exh_permit tick(
    struct exh_safety *s, const struct exh_safety_cfg *cfg, int command, unsigned ready)
{
    const struct exh_safety_in in = {ALL_IN, 0, 0, (uint8_t)command, 1, (uint8_t)ready};
    return exh_safety_step(s, cfg, in);
}

TEST(the_ramp_waits_and_a_failed_pull_is_named)
{
    static const struct exh_safety_par box = {1, EXH_Q(1, 1, EXH_Q_FORCE), 50, 500, 15};
    static const struct exh_safety off;
    struct exh_safety_cfg cfg;
    CHECK_EQ_I64(exh_safety_setup(&cfg, &box, kHz), 0);
    for (int failed = 0; failed < 2; failed++) {
        struct exh_safety s = off;
        int32_t share = 0;
        (void)tick(&s, &cfg, EXH_CMD_RUN, EXH_ARM_ALL | EXH_ARM_WAIT);
        for (int n = 0; n < 3000; n++) { /* for as long as it takes */
            const struct exh_permit p = tick(&s, &cfg, 0, EXH_ARM_ALL | EXH_ARM_WAIT);
            CHECK(s.state == EXH_STATE_ARM && p.share_q30 <= cfg.ramp_q30, "tick %d", n);
            CHECK(exh_safety_pulls(&s) == (p.mode == EXH_PERMIT_OPEN), "tick %d", n);
            share = p.share_q30;
        }
        CHECK_EQ_I64(share, cfg.ramp_q30);
        if (failed) {
            const unsigned ready = (EXH_ARM_ALL & ~(unsigned)EXH_ARM_POLARITY) | EXH_ARM_WAIT;
            (void)tick(&s, &cfg, 0, ready);
            CHECK(s.state == EXH_STATE_RELEASE && s.refused == EXH_ARM_POLARITY && s.refusals == 1,
                "state %d, %d", s.state, s.refused);
            for (int n = 0; n < 100; n++) { (void)tick(&s, &cfg, 0, EXH_ARM_ALL | EXH_ARM_WAIT); }
            CHECK(!exh_safety_pulls(&s), "OFF pulls");
            CHECK(s.state == EXH_STATE_OFF && exh_safety_arm_step(&s) == EXH_ARM_POLARITY &&
                      s.refusals == 1 && s.faults == 0,
                "state %d", s.state);
        } else {
            const unsigned still = (EXH_ARM_ALL & ~(unsigned)EXH_ARM_POLARITY) | EXH_ARM_WAIT;
            int n = 0;
            for (; s.state == EXH_STATE_ARM && n < 3000; n++) {
                (void)tick(&s, &cfg, 0, EXH_ARM_ALL);
            }
            CHECK(s.state == EXH_STATE_RUN && n >= 495 && n <= 505, "%d ticks", n);
            (void)tick(&s, &cfg, EXH_CMD_OFF, still); /* no pull: no refusal */
            CHECK_EQ_I64(s.refusals, 0);
        }
    }
}

TEST(serialised_it_goes_on)
{
    struct exh_polarity s = {-5, 6, 7, 8, EXH_POLARITY_WRONG}, back = {0, 0, 0, 0, 0};
    uint8_t buf[17];
    struct exh_bytes c = exh_bytes_writer(buf, sizeof buf);
    exh_polarity_serialize(&c, &s);
    CHECK(exh_bytes_ok(&c) && c.at == sizeof buf, "%u bytes", (unsigned)c.at);
    c = exh_bytes_reader(buf, sizeof buf);
    exh_polarity_serialize(&c, &back);
    CHECK(back.from_cnt == -5 && back.tick == 6 && back.rest == 7 && back.pulled == 8 &&
              back.result == EXH_POLARITY_WRONG,
        "not as it was");
}

TEST_MAIN("unit/polarity", set_up, what_moves_is_what_is_told, edges_of_rest_and_movement,
    a_hand_that_drifts_is_not_pulled, no_pull_before_it_was_at_rest,
    the_ramp_waits_and_a_failed_pull_is_named, serialised_it_goes_on);
