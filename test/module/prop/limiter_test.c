/* SPDX-License-Identifier: MIT */
/* limiter.h: for any command, measurement, failure and memory contents, nothing beyond its limits
 * is sent. Wider arithmetic judges it from the parameters alone. EXH_CASES=10000000 makes 10^7
 * steps. */
#include "exhand/limiter.h"

#include "check.h"

#define STEPS 500
#define UNIT  1000000

/* --- anything set-up takes --- */

/* Within 1 .. 2^bits, as likely small as large. */
static int32_t size(int bits)
{
    return (int32_t)(check_u64() >> 33 >> (check_u64() % (unsigned)bits)) + 1;
}

static int32_t at_most(int32_t v, int32_t most) { return v > most ? most : v; }

static void any_heat(struct exh_limiter_par *p)
{
    p->heat_peak = check_u64() % 3 ? at_most(size(24), 2000000000) : 0;
    p->heat_nominal = p->heat_peak / (int32_t)(1 + check_u64() % 20) + 1;
    p->heat_ms = at_most(size(28), 600000);
}

static struct exh_limiter_par any_par(void)
{
    struct exh_limiter_par p = {0};
    p.kind = (int32_t)(check_u64() % EXH_LIMITER_KINDS);
    p.uses = (int32_t)(check_u64() & EXH_LIMITER_USE_ALL) |
             (p.kind == EXH_LIMITER_EFFORT ? 0 : EXH_LIMITER_POS | EXH_LIMITER_VEL);
    p.rate_milli = 100000 + at_most(size(20), 19900000);
    p.effort_max = at_most(size(28), 2000000000);
    p.effort_up_milli = at_most(size(28), 2000000000);
    p.effort_down_milli = at_most(size(28), 2000000000);
    p.ramp_ms = 1 + (int32_t)(check_u64() % 64);
    p.release_ms = at_most(size(30), 1000);
    p.pos_min = check_i32_in(-500000000, 499999999) >> (check_u64() % 24);
    p.pos_max = check_i32_in(p.pos_min + 1, 500000000);
    p.pos_over = check_i32_in(0, 500000000) >> (check_u64() % 28);
    p.vel_max = at_most(size(28), 1000000000);
    p.acc_max_milli = at_most(size(28), 2000000000);
    p.first_max = check_i32_in(0, 1000000000);
    p.first = (int32_t)(check_u64() % 2);
    p.after = (int32_t)(check_u64() % 2);
    p.age_max_us = at_most(size(24), 10000000);
    p.gap_max_us = 20000 + at_most(size(24), 9000000);
    p.speed_max = p.uses & EXH_LIMITER_VEL ? at_most(size(24), 2000000000) : 0;
    p.speed_ms = (int32_t)(check_u64() % 100);
    p.stall_effort =
        p.uses & EXH_LIMITER_POS && check_u64() % 2 ? at_most(size(28), 2000000000) : 0;
    p.stall_move = check_i32_in(0, 1000000000);
    p.stall_ms = 1 + (int32_t)(check_u64() % 100);
    any_heat(&p);
    p.wall_below = (int32_t)(check_u64() % 2);
    p.wall_k_milli = check_i32_in(0, 1000000000) >> (check_u64() % 20);
    p.wall_b = check_i32_in(0, 1000000000) >> (check_u64() % 20);
    p.wall_f0 = check_i32_in(0, 100000000);
    return p;
}

/* One that is taken: of those that are not, the field that is named is made easy. */
static struct exh_limiter_cfg any_cfg(void)
{
    struct exh_limiter_cfg cfg;
    for (;;) {
        const struct exh_limiter_par p = any_par();
        const int err = exh_limiter_setup(&cfg, &p);
        if (err == 0) { return cfg; }
        CHECK(err < 0 && err >= -EXH_LIMITER_FIELDS, "%d", err);
    }
}

/* --- anything that comes in --- */

static uint32_t step_us(const struct exh_limiter_cfg *cfg)
{
    return (uint32_t)(INT64_C(1000000000) / cfg->par.rate_milli);
}

/* Mostly sane, so that it runs for a while; now and then one thing is anything. */
static void next(const struct exh_limiter_cfg *cfg, struct exh_limiter_in *in)
{
    const uint64_t what = check_u64() % 1000;
    const int32_t spread = check_i32_in(0, 1 << 20);
    in->now_us += step_us(cfg);
    in->age_us = 0;
    in->run = in->deadman = 1;
    if (in->pos > cfg->par.pos_max || in->pos < cfg->par.pos_min) { in->pos = cfg->par.pos_min; }
    if (in->effort == EXH_LIMITER_NONE) { in->effort = 0; }
    if (in->command == EXH_LIMITER_NONE) { in->command = 0; }
    in->vel = 0;
    if (what < 20) { in->command = check_i32(); }
    if (what >= 20 && what < 200) {
        in->command = exh_sat32((int64_t)in->command + spread - (1 << 19));
    }
    if (what == 200) { in->command = EXH_LIMITER_NONE; }
    if (what == 201) { in->pos = check_i32(); }
    if (what == 202) { in->vel = check_i32(); }
    if (what == 203) { in->effort = check_i32(); }
    if (what == 204) { in->age_us = (uint32_t)check_i32(); }
    if (what == 205) { in->now_us = (uint32_t)check_i32(); }
    if (what == 206) { in->now_us -= step_us(cfg); }
    if (what >= 207 && what < 210) { in->run = 0; }
    if (what >= 210 && what < 220) { in->deadman = 0; }
    if (what >= 220 && what < 240) { in->pos = check_i32_in(cfg->par.pos_min, cfg->par.pos_max); }
    if (what >= 240 && what < 260) { in->vel = check_i32_in(-UNIT, UNIT); }
}

/* --- what must hold --- */

/* What was sent before, and how fast. */
struct past {
    struct exh_limiter_out out;
    int64_t v; /* of a position */
};

static int64_t size64(int64_t v) { return v < 0 ? -v : v; }

static int is_open(uint32_t state)
{
    return state == EXH_STATE_ARM || state == EXH_STATE_RUN || state == EXH_STATE_LIMIT;
}

/* Rates in units of 10^-6 / rate_milli, so that nothing is rounded. */
static void judge_effort(
    const struct exh_limiter_cfg *cfg, const struct past *was, const struct exh_limiter_out *now)
{
    const struct exh_limiter_par *p = &cfg->par;
    const int64_t a = size64(was->out.send), b = size64(now->send);
    const int through = (was->out.send < 0) != (now->send < 0) && a && b;
    CHECK(b <= p->effort_max, "%" PRId32 " of %" PRId32, now->send, p->effort_max);
    if (!is_open(now->state) && now->state != EXH_STATE_RELEASE) { CHECK_EQ_I64(now->send, 0); }
    if (now->state == EXH_STATE_RELEASE) { CHECK(b <= a && !through && (b < a || a == 0), "grew"); }
    if (is_open(now->state) && (b > a || through)) {
        CHECK((b - (through ? 0 : a) - 1) * p->rate_milli <= p->effort_up_milli * INT64_C(1000000),
            "%" PRId32 " after %" PRId32, now->send, was->out.send);
    }
    if (is_open(now->state) && (b < a || through)) {
        CHECK(
            (a + (through ? b : -b) - 1) * p->rate_milli <= p->effort_down_milli * INT64_C(1000000),
            "%" PRId32 " after %" PRId32, now->send, was->out.send);
    }
}

static void judge_place(
    const struct exh_limiter_cfg *cfg, struct past *was, const struct exh_limiter_out *now)
{
    const struct exh_limiter_par *p = &cfg->par;
    const int64_t v = (int64_t)now->send - was->out.send;
    const int64_t rate = p->rate_milli;
    const int inside = was->out.send >= p->pos_min && was->out.send <= p->pos_max;
    CHECK(now->send >= (int64_t)p->pos_min - p->pos_over &&
              now->send <= (int64_t)p->pos_max + p->pos_over,
        "%" PRId32, now->send);
    if (now->enable && was->out.enable) {
        CHECK((size64(v) - 1) * rate <= p->vel_max * INT64_C(1000), "%" PRId64, v);
        CHECK(!inside || (now->send >= p->pos_min && now->send <= p->pos_max), "%" PRId32 " left",
            now->send);
        CHECK(size64(v - was->v) - 2 <= p->acc_max_milli * INT64_C(1000000) / rate * 1000 / rate,
            "%" PRId64 " after %" PRId64, v, was->v);
    }
    was->v = now->enable && was->out.enable ? v : 0;
}

/* Causes that are visible in one step alone. */
static uint32_t plain_causes(
    const struct exh_limiter_cfg *cfg, const struct exh_limiter_in *in, uint32_t before_us)
{
    const struct exh_limiter_par *p = &cfg->par;
    const int none = in->command == INT32_MIN || (p->uses & 1 && in->pos == INT32_MIN) ||
                     (p->uses & 2 && in->vel == INT32_MIN) ||
                     (p->uses & 4 && in->effort == INT32_MIN);
    const int64_t off =
        in->pos > p->pos_max ? (int64_t)in->pos - p->pos_max : (int64_t)p->pos_min - in->pos;
    return (none ? EXH_LIMITER_NUMBER : 0u) |
           (in->now_us - before_us > (uint32_t)p->gap_max_us ? EXH_LIMITER_TIME : 0u) |
           (p->uses & 8 && !in->deadman ? EXH_LIMITER_RELEASED : 0u) |
           (in->age_us > (uint32_t)p->age_max_us ? EXH_LIMITER_STALE : 0u) |
           (!none && p->uses & 1 && off > p->pos_over ? EXH_LIMITER_RANGE : 0u);
}

/* --- the tests --- */

TEST(nothing_beyond_its_limits_is_sent)
{
    uint64_t ran[EXH_STATES] = {0}, faults = 0;
    while (check_case(STEPS)) {
        const struct exh_limiter_cfg cfg = any_cfg();
        const uint32_t simple = EXH_LIMITER_NUMBER | EXH_LIMITER_TIME | EXH_LIMITER_RELEASED |
                                EXH_LIMITER_STALE | EXH_LIMITER_RANGE;
        struct exh_limiter s = {0};
        struct exh_limiter_in in = {0, 0, 0, 0, 0, 0, 0, 0};
        struct past was = {{0, 0, 0, 0, 0, 0, 0}, 0};
        int taken = 0; /* the switch, or run, was open since it was closed last */
        for (int n = 0; n < STEPS; n++) {
            struct exh_limiter_out out;
            uint32_t before = in.now_us, causes;
            next(&cfg, &in);
            if (n == 0) { in.run = in.deadman = 0; }
            causes = plain_causes(&cfg, &in, n == 0 ? in.now_us : before);
            exh_limiter_step(&s, &cfg, &in, &out);
            CHECK((out.present & simple & ~causes) == 0 || s.still_steps, "%" PRIx32, out.present);
            CHECK((causes & ~out.present) == 0, "%" PRIx32 " of %" PRIx32, out.present, causes);
            CHECK(out.state < EXH_STATES, "%" PRIu32, out.state);
            CHECK(!(out.present && is_open(out.state)), "open with %" PRIx32, out.present);
            CHECK((out.state == EXH_STATE_FAULT) <= (out.causes != 0), "no cause");
            if (out.state == EXH_STATE_ARM && was.out.state != EXH_STATE_ARM) {
                CHECK(taken, "armed by itself");
                taken = 0;
            }
            if (!(cfg.par.uses & EXH_LIMITER_DEADMAN ? in.deadman : in.run)) { taken = 1; }
            if (cfg.par.kind == EXH_LIMITER_POSITION) {
                judge_place(&cfg, &was, &out);
            } else {
                judge_effort(&cfg, &was, &out);
            }
            ran[out.state]++;
            faults += out.state == EXH_STATE_FAULT && was.out.state != EXH_STATE_FAULT;
            was.out = out;
        }
    }
    check_note("steps off %" PRIu64 ", arm %" PRIu64 ", run %" PRIu64 ", limit %" PRIu64
               ", release %" PRIu64 ", fault %" PRIu64 "; %" PRIu64 " faults",
        ran[0], ran[1], ran[2], ran[3], ran[4], ran[5], faults);
}

/* Memory with anything in it: no undefined behaviour, and the output keeps its bounds. */
TEST(nor_is_it_by_any_state)
{
    while (check_case(8)) {
        const struct exh_limiter_cfg cfg = any_cfg();
        const struct exh_limiter_par *p = &cfg.par;
        struct exh_limiter s;
        struct exh_limiter_in in;
        struct exh_limiter_out out;
        uint8_t *b = (uint8_t *)&s;
        for (size_t i = 0; i < sizeof s; i++) { b[i] = (uint8_t)check_u64(); }
        s.state = (uint8_t)(check_u64() % 8);
        b = (uint8_t *)&in;
        for (size_t i = 0; i < sizeof in; i++) { b[i] = (uint8_t)check_u64(); }
        if (check_u64() % 4) { next(&cfg, &in); }
        exh_limiter_step(&s, &cfg, &in, &out);
        CHECK(out.state < EXH_STATES, "%" PRIu32, out.state);
        if (p->kind == EXH_LIMITER_POSITION) {
            CHECK(out.send >= (int64_t)p->pos_min - p->pos_over &&
                      out.send <= (int64_t)p->pos_max + p->pos_over,
                "%" PRId32, out.send);
        } else {
            CHECK(size64(out.send) <= p->effort_max, "%" PRId32, out.send);
        }
    }
}

TEST_MAIN("limiter laws", nothing_beyond_its_limits_is_sent, nor_is_it_by_any_state);
