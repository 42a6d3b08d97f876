/* SPDX-License-Identifier: MIT */
/* limiter.h: each cause is raised, latched and named. Each limit acts and is reported. Only a hand
 * starts it. Set-up names what it refuses. */
#define EXH_LIMITER_FLOAT
#include "exhand/limiter.h"

#include "check.h"

#define UNIT 1000000

/* 1 kHz, 5 units of effort, 100 units/s up, 200 down; ramp 100 ms, release 10 ms. */
static const struct exh_limiter_par effort_par = {
    .kind = EXH_LIMITER_EFFORT,
    .uses = EXH_LIMITER_USE_ALL,
    .rate_milli = 1000000,
    .effort_max = 5 * UNIT,
    .effort_up_milli = 100000,
    .effort_down_milli = 200000,
    .ramp_ms = 100,
    .release_ms = 10,
    .pos_min = -UNIT,
    .pos_max = UNIT,
    .pos_over = UNIT / 10,
    .vel_max = UNIT,
    .acc_max_milli = 10000,
    .first_max = UNIT / 10,
    .age_max_us = 50000,
    .gap_max_us = 20000,
    .speed_max = 20 * UNIT,
    .speed_ms = 10,
    .stall_effort = 4 * UNIT,
    .stall_move = 1000,
    .stall_ms = 500,
    .heat_nominal = 2 * UNIT,
    .heat_peak = 5 * UNIT,
    .heat_ms = 1000,
};

/* A limiter and its inputs. */
static struct rig {
    struct exh_limiter_cfg cfg;
    struct exh_limiter s;
    struct exh_limiter_in in;
    struct exh_limiter_out out;
} r;

static void step(void)
{
    r.in.now_us += 1000;
    exh_limiter_step(&r.s, &r.cfg, &r.in, &r.out);
}

static void steps(int n)
{
    for (int i = 0; i < n; i++) {
        r.in.pos ^= 4096; /* it lives: no stall */
        step();
    }
}

/* Set up, with the switch open. */
static void rest(struct exh_limiter_par par)
{
    const struct exh_limiter_in none = {0, 0, 0, 0, 0, 0, 0, 0};
    static const struct exh_limiter zero;
    CHECK_EQ_I64(exh_limiter_setup(&r.cfg, &par), 0);
    r.in = none;
    r.s = zero;
    step();
}

/* And taken; runs. */
static void run(struct exh_limiter_par par)
{
    rest(par);
    r.in.run = r.in.deadman = 1;
    if (par.kind == EXH_LIMITER_WALL) { r.in.command = par.wall_below ? -UNIT : UNIT; }
    steps(110);
    CHECK_EQ_I64(r.out.state, EXH_STATE_RUN);
    CHECK_EQ_I64(r.out.enable, 1);
}

static struct exh_limiter_par with(int32_t kind)
{
    struct exh_limiter_par p = effort_par;
    p.kind = kind;
    if (kind == EXH_LIMITER_WALL) {
        p.wall_k_milli = 10000000; /* 10 kN/m */
        p.wall_b = UNIT;
        p.wall_f0 = UNIT / 2;
        p.first_max = 2 * UNIT;
        p.speed_max = 10 * UNIT;
        p.heat_peak = 0;
    }
    return p;
}

/* --- set-up --- */

TEST(set_up_names_the_first_wrong_field)
{
    static const struct {
        int field;
        int32_t v;
        const char *name;
    } row[] = {{0, 3, "kind"}, {0, -1, "kind"}, {1, 16, "uses"}, {2, 0, "rate_milli"},
        {2, 20000001, "rate_milli"}, {3, 0, "effort_max"}, {3, INT32_MAX, "effort_max"},
        {4, 0, "effort_up_milli"}, {5, -5, "effort_down_milli"}, {6, 10001, "ramp_ms"},
        {7, 0, "release_ms"}, {8, -500000001, "pos_min"}, {9, 500000001, "pos_max"},
        {9, -UNIT, "pos_max"}, {10, -1, "pos_over"}, {11, 1000000001, "vel_max"},
        {12, -1, "acc_max_milli"}, {13, 1000000001, "first_max"}, {14, 2, "first"},
        {15, 2, "after"}, {16, 0, "age_max_us"}, {17, 10000001, "gap_max_us"},
        {17, 1999, "gap_max_us"}, {18, -1, "speed_max"}, {19, 1001, "speed_ms"},
        {20, -1, "stall_effort"}, {21, -1, "stall_move"}, {22, 60001, "stall_ms"},
        {23, 5 * UNIT, "heat_nominal"}, {23, 0, "heat_nominal"}, {24, -1, "heat_peak"},
        {25, 63, "heat_ms"}, {26, 2, "wall_below"}, {27, 1000000001, "wall_k_milli"},
        {28, -1, "wall_b"}, {29, 100000001, "wall_f0"}};
    for (size_t i = 0; i < LEN(row); i++) {
        struct exh_limiter_par p = effort_par;
        int32_t v[EXH_LIMITER_FIELDS];
        int err;
        memcpy(v, &p, sizeof v);
        v[row[i].field] = row[i].v;
        memcpy(&p, v, sizeof v);
        err = exh_limiter_setup(&r.cfg, &p);
        CHECK(err == -1 - row[i].field, "%s = %" PRId32 ": %d", row[i].name, row[i].v, err);
        CHECK(check_same_text(exh_limiter_field_name((unsigned)row[i].field), row[i].name), "%s",
            row[i].name);
    }
}

/* What a kind or a watch needs and does not measure. */
TEST(what_is_not_measured_is_not_watched)
{
    static const struct {
        int32_t kind, uses;
        int field; /* -1: it is taken */
    } row[] = {{EXH_LIMITER_EFFORT, 15, -1}, {EXH_LIMITER_EFFORT, 15 - EXH_LIMITER_VEL, 18},
        {EXH_LIMITER_EFFORT, 15 - EXH_LIMITER_POS, 20},
        {EXH_LIMITER_EFFORT, 15 - EXH_LIMITER_MEASURED, -1},
        {EXH_LIMITER_EFFORT, 15 - EXH_LIMITER_DEADMAN, -1},
        {EXH_LIMITER_POSITION, 15 - EXH_LIMITER_MEASURED, 1}, {EXH_LIMITER_POSITION, 15, -1},
        {EXH_LIMITER_WALL, 15, -1}, {EXH_LIMITER_WALL, 15 - EXH_LIMITER_VEL, 18}};
    for (size_t i = 0; i < LEN(row); i++) {
        struct exh_limiter_par p = with(row[i].kind);
        p.uses = row[i].uses;
        CHECK(exh_limiter_setup(&r.cfg, &p) == (row[i].field < 0 ? 0 : -1 - row[i].field), "row %d",
            (int)i);
    }
    {
        struct exh_limiter_par p = with(EXH_LIMITER_POSITION);
        p.uses = 0;
        p.speed_max = p.stall_effort = p.heat_peak = 0;
        CHECK_EQ_I64(exh_limiter_setup(&r.cfg, &p), -2); /* a position sent begins at one */
        p = with(EXH_LIMITER_WALL);
        p.speed_max = 0;
        CHECK_EQ_I64(exh_limiter_setup(&r.cfg, &p), -19);
        p = effort_par;
        p.stall_ms = 0;
        CHECK_EQ_I64(exh_limiter_setup(&r.cfg, &p), -23);
    }
}

TEST(what_has_no_room_is_refused)
{
    struct exh_limiter_par p = with(EXH_LIMITER_WALL);
    p.wall_k_milli = 1000000000;
    CHECK_EQ_I64(exh_limiter_setup(&r.cfg, &p), 0); /* 10^6 N/m over 1.1 m */
    p.pos_max = 3 * UNIT;
    CHECK_EQ_I64(exh_limiter_setup(&r.cfg, &p), -28);
    p = with(EXH_LIMITER_WALL);
    p.wall_b = 1000000000;
    CHECK_EQ_I64(exh_limiter_setup(&r.cfg, &p), 0); /* 1000 Ns/m to 10 m/s */
    p.speed_max = 40 * UNIT;
    CHECK_EQ_I64(exh_limiter_setup(&r.cfg, &p), -29);
    p = with(EXH_LIMITER_POSITION);
    p.vel_max = 1;
    p.rate_milli = 20000000;
    CHECK_EQ_I64(exh_limiter_setup(&r.cfg, &p), -12);
    p.vel_max = UNIT;
    p.acc_max_milli = 1;
    CHECK_EQ_I64(exh_limiter_setup(&r.cfg, &p), -13);
}

/* --- arming --- */

/* Zeros are OFF; the switch has to be open once, then taken; limits rise from 0. */
TEST(a_hand_arms_and_limits_rise)
{
    int32_t last = 0;
    rest(effort_par);
    r.s.opened = 0; /* as at power-on, the switch jammed closed */
    r.in.run = r.in.deadman = 1;
    r.in.command = UNIT / 10;
    steps(50);
    CHECK_EQ_I64(r.out.state, EXH_STATE_OFF);
    CHECK_EQ_I64(r.out.send, 0);
    CHECK_EQ_I64(r.out.enable, 0);
    CHECK_EQ_I64(r.out.limits, EXH_LIMITER_BY_STATE);
    r.in.deadman = 0;
    step();
    CHECK_EQ_I64(r.out.present, EXH_LIMITER_RELEASED);
    r.in.deadman = 1;
    step();
    CHECK_EQ_I64(r.out.state, EXH_STATE_ARM);
    CHECK_EQ_I64(r.out.send, 0);
    r.in.command = UNIT / 10;
    step();
    r.in.command = 5 * UNIT; /* the first was small */
    while (r.out.state == EXH_STATE_ARM) {
        CHECK(r.out.send >= last && r.out.send <= last + 100000, "%" PRId32, r.out.send);
        CHECK(
            r.out.limits & EXH_LIMITER_BY_RAMP || last > 49 * UNIT / 10, "%" PRIx32, r.out.limits);
        last = r.out.send;
        steps(1);
    }
    CHECK_EQ_I64(r.out.state, EXH_STATE_LIMIT - 1);
    CHECK(last > 49 * UNIT / 10 - 100000, "%" PRId32, last);
}

TEST(without_a_switch_run_is_taken_anew)
{
    struct exh_limiter_par p = effort_par;
    p.uses &= ~(int32_t)EXH_LIMITER_DEADMAN;
    rest(p);
    r.s.opened = 0;
    r.in.run = 1;
    steps(5);
    CHECK_EQ_I64(r.out.state, EXH_STATE_OFF);
    r.in.run = 0;
    steps(1);
    r.in.run = 1;
    steps(1);
    CHECK_EQ_I64(r.out.state, EXH_STATE_ARM);
}

/* Off by `run`: the effort goes in equal steps, and there is no cause. */
TEST(off_lets_go)
{
    run(effort_par);
    r.in.command = UNIT;
    steps(20);
    CHECK_EQ_I64(r.out.send, UNIT);
    r.in.run = 0;
    for (int i = 1; i <= 10; i++) {
        step();
        CHECK_EQ_I64(r.out.state, EXH_STATE_RELEASE);
        CHECK_EQ_I64(r.out.limits, EXH_LIMITER_BY_RELEASE);
        CHECK_EQ_I64(r.out.enable, 1);
        CHECK(r.out.send <= UNIT - i * (UNIT / 10) && r.out.send >= UNIT - i * (UNIT / 10 + 2),
            "%d: %" PRId32, i, r.out.send);
    }
    CHECK_EQ_I64(r.out.send, 0);
    step();
    CHECK_EQ_I64(r.out.state, EXH_STATE_OFF);
    CHECK_EQ_I64(r.out.causes, 0);
    CHECK_EQ_I64(r.out.enable, 0);
}

/* --- causes --- */

/* Each by its way in; how it is raised and taken back. */
static void none(int on) { r.in.pos = on ? EXH_LIMITER_NONE : 0; }
static void none_command(int on) { r.in.command = on ? EXH_LIMITER_NONE : UNIT; }
static void none_vel(int on) { r.in.vel = on ? EXH_LIMITER_NONE : 0; }
static void none_effort(int on) { r.in.effort = on ? EXH_LIMITER_NONE : 0; }
static void back(int on) { r.in.now_us -= on ? 3000 : 0; }
static void gap(int on) { r.in.now_us += on ? 20000 : 0; }
static void stands(int on) { r.in.now_us -= on ? 1000 : 0; }
static void released(int on) { r.in.deadman = !on; }
static void stale(int on) { r.in.age_us = on ? 50001 : 0; }
static void never(int on) { r.in.age_us = on ? UINT32_MAX : 0; }
static void range(int on) { r.in.pos = on ? UNIT * 11 / 10 + 1 : 0; }
static void below(int on) { r.in.pos = on ? -UNIT * 11 / 10 - 1 : 0; }
static void fast(int on) { r.in.vel = on ? -20 * UNIT - 1 : 0; }
static void stall(int on)
{
    r.in.effort = on ? -4 * UNIT - 1 : 0;
    r.in.pos = on ? r.in.pos == 0 ? 1000 : 0 : r.in.pos + 2000 * (r.in.pos < UNIT ? 1 : -1);
}
static void heat(int on)
{
    r.in.effort = on ? 5 * UNIT : 0;
    r.in.pos ^= 4096;
}

static const struct {
    void (*way)(int on);
    uint32_t cause;
    int after; /* steps until it is raised */
    const char *name;
} ways[] = {{none, EXH_LIMITER_NUMBER, 1, "not_a_number"},
    {none_command, EXH_LIMITER_NUMBER, 1, "not_a_number"},
    {none_vel, EXH_LIMITER_NUMBER, 1, "not_a_number"},
    {none_effort, EXH_LIMITER_NUMBER, 1, "not_a_number"}, {back, EXH_LIMITER_TIME, 1, "time"},
    {gap, EXH_LIMITER_TIME, 1, "time"}, {stands, EXH_LIMITER_TIME, 20, "time"},
    {released, EXH_LIMITER_RELEASED, 1, "deadman"}, {stale, EXH_LIMITER_STALE, 1, "stale"},
    {never, EXH_LIMITER_STALE, 1, "stale"}, {range, EXH_LIMITER_RANGE, 1, "range"},
    {below, EXH_LIMITER_RANGE, 1, "range"}, {fast, EXH_LIMITER_SPEED, 11, "speed"},
    {stall, EXH_LIMITER_STALL, 502, "stall"}, {heat, EXH_LIMITER_HEAT, 1251, "heat"}};

TEST(each_cause_is_raised_latched_and_cleared_by_hand)
{
    for (size_t i = 0; i < LEN(ways); i++) {
        unsigned k = 0;
        int n = 0;
        run(effort_par);
        r.in.command = UNIT;
        steps(20);
        do {
            ways[i].way(1);
            step();
            n++;
        } while (r.out.causes == 0 && n < 3000);
        CHECK(n <= ways[i].after && n >= ways[i].after - 3 - ways[i].after / 100,
            "%s: after %d steps", ways[i].name, n);
        CHECK_EQ_I64(r.out.causes, ways[i].cause);
        CHECK_EQ_I64(r.out.first, ways[i].cause);
        CHECK_EQ_I64(r.out.present, ways[i].cause);
        CHECK_EQ_I64(r.out.state, EXH_STATE_RELEASE);
        while (!(r.out.first >> k & 1)) { k++; }
        CHECK(check_same_text(exh_limiter_cause_name(k), ways[i].name), "%s", ways[i].name);
        for (int j = 0; j < 700; j++) { /* it is gone, and the switch is held on, or open */
            if (ways[i].cause != EXH_LIMITER_RELEASED) { ways[i].way(0); }
            step();
        }
        CHECK_EQ_I64(r.out.state, EXH_STATE_FAULT);
        CHECK_EQ_I64(r.out.present, ways[i].cause & EXH_LIMITER_RELEASED);
        CHECK_EQ_I64(r.out.send, 0);
        CHECK_EQ_I64(r.out.enable, 0);
        CHECK_EQ_I64(r.out.first, ways[i].cause);
        r.in.command = 0;
        r.in.deadman = 0;
        step();
        CHECK_EQ_I64(r.out.state, EXH_STATE_FAULT);
        r.in.deadman = 1;
        step();
        CHECK_EQ_I64(r.out.state, EXH_STATE_OFF);
        CHECK_EQ_I64(r.out.causes, 0);
        CHECK_EQ_I64(r.out.first, ways[i].cause); /* reported until it arms */
        step();
        CHECK_EQ_I64(r.out.state, EXH_STATE_ARM);
        CHECK_EQ_I64(r.out.first, 0);
    }
}

/* The switch that was let go while the cause was there does not count. */
TEST(nobody_clears_what_goes_on)
{
    run(effort_par);
    r.in.age_us = 60000;
    steps(20);
    CHECK_EQ_I64(r.out.state, EXH_STATE_FAULT);
    r.in.deadman = 0;
    steps(3);
    r.in.deadman = 1;
    steps(3);
    r.in.age_us = 0;
    steps(3);
    CHECK_EQ_I64(r.out.state, EXH_STATE_FAULT);
    r.in.deadman = 0;
    steps(1);
    r.in.deadman = 1;
    steps(1);
    CHECK_EQ_I64(r.out.state, EXH_STATE_OFF);
}

/* The first cause stays the first, and all are reported. */
TEST(the_first_cause_stays)
{
    run(effort_par);
    r.in.age_us = 60000;
    r.in.pos = 2 * UNIT;
    step();
    CHECK_EQ_I64(r.out.first, EXH_LIMITER_STALE); /* of two in one tick the first in order */
    r.in.deadman = 0;
    r.in.command = EXH_LIMITER_NONE;
    step();
    CHECK_EQ_I64(r.out.first, EXH_LIMITER_STALE);
    CHECK_EQ_I64(r.out.causes,
        EXH_LIMITER_STALE | EXH_LIMITER_RANGE | EXH_LIMITER_RELEASED | EXH_LIMITER_NUMBER);
}

TEST(what_is_not_used_is_not_read)
{
    struct exh_limiter_par p = effort_par;
    p.uses = 0;
    p.speed_max = p.stall_effort = 0;
    rest(p);
    r.in.run = 1;
    r.in.pos = r.in.vel = r.in.effort = EXH_LIMITER_NONE;
    for (int i = 0; i < 300; i++) { step(); }
    CHECK_EQ_I64(r.out.state, EXH_STATE_RUN);
    CHECK_EQ_I64(r.out.present, 0);
}

TEST(a_clock_may_wrap)
{
    run(effort_par);
    r.in.now_us = (uint32_t)-5000;
    r.s.now_us = (uint32_t)-5500;
    steps(10);
    CHECK_EQ_I64(r.out.present, 0);
    CHECK_EQ_I64(r.out.state, EXH_STATE_RUN);
}

TEST(damage_is_a_cause)
{
    run(effort_par);
    r.s.state = 77;
    step();
    CHECK_EQ_I64(r.out.state, EXH_STATE_FAULT);
    CHECK_EQ_I64(r.out.first & r.out.causes, EXH_LIMITER_LOGIC);
    CHECK_EQ_I64(r.out.send, 0);
    run(effort_par);
    r.s.state = EXH_STATE_FAULT;
    step();
    CHECK_EQ_I64(r.out.causes, EXH_LIMITER_LOGIC);
}

/* --- far off --- */

TEST(a_first_command_that_is_far_is_refused_or_approached)
{
    for (int32_t kind = 0; kind < EXH_LIMITER_KINDS; kind++) {
        for (int32_t first = 0; first < 2; first++) {
            struct exh_limiter_par p = with(kind);
            p.first = first;
            rest(p);
            r.in.run = r.in.deadman = 1;
            r.in.command = kind == EXH_LIMITER_WALL     ? -3000
                           : kind == EXH_LIMITER_EFFORT ? -UNIT / 9
                                                        : UNIT / 9;
            step();
            CHECK_EQ_I64(r.out.state, EXH_STATE_ARM);
            step();
            CHECK_EQ_I64(r.out.first, first == EXH_LIMITER_REFUSE ? EXH_LIMITER_FAR : 0);
            for (int i = 0; i < 12; i++) { step(); }
            CHECK_EQ_I64(
                r.out.state, first == EXH_LIMITER_REFUSE ? EXH_STATE_FAULT : EXH_STATE_ARM);
            CHECK((r.out.send != 0) == (first == EXH_LIMITER_APPROACH), "%" PRId32, r.out.send);
        }
    }
}

TEST(a_first_command_that_is_near_is_taken)
{
    for (int32_t kind = 0; kind < EXH_LIMITER_KINDS; kind++) {
        rest(with(kind));
        r.in.run = r.in.deadman = 1;
        r.in.command = kind == EXH_LIMITER_WALL ? -200 : UNIT / 10;
        for (int i = 0; i < 105; i++) { step(); }
        CHECK(
            r.out.state == EXH_STATE_RUN || r.out.state == EXH_STATE_LIMIT, "kind %" PRId32, kind);
    }
}

/* --- limits of effort --- */

TEST(effort_slew_and_heat_are_held)
{
    struct exh_limiter_par p = effort_par;
    p.heat_peak = 0;
    run(p);
    r.in.command = 6 * UNIT;
    step();
    CHECK_EQ_I64(r.out.send, 100000);
    CHECK_EQ_I64(r.out.limits, EXH_LIMITER_BY_EFFORT | EXH_LIMITER_BY_RISE);
    step();
    CHECK_EQ_I64(r.out.state, EXH_STATE_LIMIT);
    steps(50);
    CHECK_EQ_I64(r.out.send, 5 * UNIT);
    CHECK_EQ_I64(r.out.limits, EXH_LIMITER_BY_EFFORT);
    r.in.command = -INT32_MAX;
    step();
    CHECK_EQ_I64(r.out.send, 4800000);
    steps(24);
    CHECK_EQ_I64(r.out.send, 0);
    step();
    CHECK_EQ_I64(r.out.send, -100000);
    r.in.command = 50000;
    step();
    CHECK_EQ_I64(r.out.send, 50000); /* through 0 by up at most */
    CHECK_EQ_I64(r.out.limits, 0);
    run(effort_par);
    r.in.command = 5 * UNIT;
    r.in.effort = 5 * UNIT;
    steps(60);
    CHECK_EQ_I64(r.out.send, 5 * UNIT);
    for (int i = 0; i < 900; i++) {
        r.in.effort = r.out.send;
        steps(1);
    }
    CHECK(r.out.limits & EXH_LIMITER_BY_HEAT, "%" PRIx32, r.out.limits);
    for (int i = 0; i < 20000; i++) {
        r.in.effort = r.out.send;
        steps(1);
    }
    CHECK(r.out.send >= 2 * UNIT && r.out.send < 2 * UNIT + 20000, "%" PRId32, r.out.send);
    CHECK_EQ_I64(r.out.causes, 0);
}

/* F = b v + k (x - wall) + F0, pushing out, on either side. */
TEST(a_wall_pushes_out)
{
    for (int32_t below = 0; below < 2; below++) {
        const int32_t side = below ? -1 : 1;
        struct exh_limiter_par p = with(EXH_LIMITER_WALL);
        p.wall_below = below;
        p.effort_up_milli = p.effort_down_milli = 2000000000;
        run(p);
        r.in.command = side * 10000;
        r.in.pos = side * 10100;
        r.in.vel = side * UNIT / 2;
        step();
        CHECK_EQ_I64(r.out.send, -side * (1000000 + 500000));
        r.in.vel = -side * UNIT / 10;
        step();
        CHECK_EQ_I64(r.out.send, -side * (1000000 - 100000 + 500000));
        r.in.pos = side * 9999;
        step();
        CHECK_EQ_I64(r.out.send, -side * 500000);
        r.in.vel = 0;
        step();
        CHECK_EQ_I64(r.out.send, 0);
        r.in.command = INT32_MAX * side;
        step();
        CHECK_EQ_I64(r.out.send, 0);
    }
}

/* --- positions --- */

TEST(a_position_is_reached_within_its_limits)
{
    static const int32_t to[] = {UNIT / 20, -UNIT / 2, 2 * UNIT, 0, 7, 6};
    int32_t last = 0, speed = 0;
    run(with(EXH_LIMITER_POSITION));
    last = r.out.send;
    for (size_t i = 0; i < LEN(to); i++) {
        const int32_t want = to[i] > UNIT ? UNIT : to[i];
        uint32_t seen = 0;
        int n = 0;
        r.in.command = to[i];
        for (; n < 4000 && (r.out.send != want || speed != 0); n++) {
            int32_t v;
            steps(1);
            v = r.out.send - last;
            CHECK(v <= 1001 && v >= -1001 && v - speed <= 11 && v - speed >= -11,
                "to %" PRId32 " step %d: %" PRId32 " after %" PRId32, to[i], n, v, speed);
            CHECK(r.out.send <= UNIT && r.out.send >= -UNIT, "%" PRId32, r.out.send);
            last = r.out.send;
            speed = v;
            seen |= r.out.limits;
        }
        CHECK(r.out.send == want && n < 3000, "to %" PRId32 ": %" PRId32, to[i], r.out.send);
        CHECK(!!(seen & EXH_LIMITER_BY_RANGE) == (to[i] != want), "%" PRIx32, seen);
        if (i == 1) {
            CHECK(seen & EXH_LIMITER_BY_VEL && seen & EXH_LIMITER_BY_ACC, "%" PRIx32, seen);
        }
    }
}

/* At rest it follows what is measured; a fault brakes it, and holds it if that is chosen. */
TEST(a_position_brakes_and_holds)
{
    for (int32_t after = 0; after < 2; after++) {
        struct exh_limiter_par p = with(EXH_LIMITER_POSITION);
        int32_t held;
        p.after = after;
        rest(p);
        r.in.pos = 12345;
        step();
        CHECK_EQ_I64(r.out.send, 12345);
        CHECK_EQ_I64(r.out.enable, 0);
        run(p);
        r.in.command = UNIT / 2;
        steps(200);
        CHECK_EQ_I64(r.s.vel >> r.cfg.frac, 1000);
        r.in.age_us = UINT32_MAX;
        held = r.out.send;
        steps(99);
        CHECK_EQ_I64(r.out.state, EXH_STATE_RELEASE);
        steps(3);
        CHECK_EQ_I64(r.out.state, EXH_STATE_FAULT);
        CHECK_EQ_I64(r.out.enable, (uint32_t)after);
        if (after) {
            CHECK(r.out.send - held > 49000 && r.out.send - held < 51000, "%" PRId32,
                r.out.send - held);
        } else {
            CHECK_EQ_I64(r.out.send, r.in.pos);
        }
        r.in.age_us = 0;
        r.in.deadman = 0;
        steps(1);
        r.in.deadman = 1;
        held = r.out.send;
        steps(2);
        CHECK_EQ_I64(r.out.state, EXH_STATE_ARM);
        if (after) {
            CHECK_EQ_I64(r.out.send, held);
            CHECK_EQ_I64(r.out.enable, 1);
            r.s.state = EXH_STATE_OFF; /* as if it were off in between */
            r.s.holds = 1;
            r.in.run = 0;
            step();
            CHECK_EQ_I64(r.out.enable, 0);
        }
    }
}

/* --- names and floats --- */

/* What memory gives back, and what no sensor says, moves nothing. */
TEST(damage_and_no_number_at_rest_move_nothing)
{
    run(with(EXH_LIMITER_EFFORT));
    r.cfg.par.uses &= ~EXH_LIMITER_MEASURED;
    r.s.sent = INT32_MIN;
    step();
    CHECK(r.out.send >= -r.cfg.par.effort_max && r.out.send <= r.cfg.par.effort_max, "%ld",
        (long)r.out.send);
    rest(with(EXH_LIMITER_POSITION));
    r.in.pos = 1234;
    step();
    CHECK_EQ_I64(r.out.send, 1234);
    r.in.pos = EXH_LIMITER_NONE;
    step();
    CHECK_EQ_I64(r.out.send, 1234);
    CHECK_EQ_I64(r.out.enable, 0);
}

/* A command back to the place that it just left, at full speed: it brakes, and comes back. */
TEST(a_position_turns_within_its_limits)
{
    run(with(EXH_LIMITER_POSITION));
    for (int i = 0, was = 0, v = 0; i < 2000; i++) {
        r.in.command = i < 200 ? UNIT : r.in.command;
        if (i == 200) { r.in.command = r.out.send + 1; }
        r.in.pos = r.out.send;
        was = r.out.send;
        steps(1);
        if (i > 1) {
            CHECK(r.out.send - was - v <= 12 && r.out.send - was - v >= -12, "%d: %d behind %d", i,
                (int)r.out.send - was, v);
        }
        v = r.out.send - was;
    }
    CHECK_EQ_I64(r.out.send, r.in.command);
}

TEST(every_bit_has_a_name)
{
    for (unsigned k = 0; k < EXH_LIMITER_LIMITS; k++) {
        CHECK(exh_limiter_limit_name(k)[0], "limit %u", k);
    }
    for (unsigned k = 0; k < EXH_LIMITER_CAUSES; k++) {
        CHECK(exh_limiter_cause_name(k)[0], "cause %u", k);
    }
    CHECK(!exh_limiter_limit_name(EXH_LIMITER_LIMITS)[0], "one more");
    CHECK(!exh_limiter_cause_name(EXH_LIMITER_CAUSES)[0], "one more");
    CHECK(!exh_limiter_field_name(EXH_LIMITER_FIELDS)[0], "one more");
}

TEST(floats_become_millionths_or_none)
{
    static const double zero;
    static const struct {
        double x;
        int32_t want;
    } row[] = {{0, 0}, {1, 1000000}, {-1.5, -1500000}, {1e-6, 1}, {-4e-7, 0}, {6e-7, 1},
        {-6e-7, -1}, {2147.483646, 2147483646}, {2147.5, INT32_MAX}, {-1e300, -INT32_MAX},
        {1e308, INT32_MAX}, {4e-324, 0}};
    for (size_t i = 0; i < LEN(row); i++) {
        CHECK_EQ_I64(exh_limiter_micro(row[i].x), row[i].want);
    }
    CHECK_EQ_I64(exh_limiter_micro(1 / zero), EXH_LIMITER_NONE);
    CHECK_EQ_I64(exh_limiter_micro(-1 / zero), EXH_LIMITER_NONE);
    CHECK_EQ_I64(exh_limiter_micro(zero / zero), EXH_LIMITER_NONE);
    CHECK_EQ_I64(EXH_MICRO(35, 10), 3500000);
    CHECK_EQ_I64(EXH_MILLI(-1, 3), -333);
}

TEST_MAIN("limiter", set_up_names_the_first_wrong_field, what_is_not_measured_is_not_watched,
    what_has_no_room_is_refused, a_hand_arms_and_limits_rise, without_a_switch_run_is_taken_anew,
    off_lets_go, each_cause_is_raised_latched_and_cleared_by_hand, nobody_clears_what_goes_on,
    the_first_cause_stays, what_is_not_used_is_not_read, a_clock_may_wrap, damage_is_a_cause,
    a_first_command_that_is_far_is_refused_or_approached, a_first_command_that_is_near_is_taken,
    effort_slew_and_heat_are_held, a_wall_pushes_out, a_position_is_reached_within_its_limits,
    a_position_brakes_and_holds, damage_and_no_number_at_rest_move_nothing,
    a_position_turns_within_its_limits, every_bit_has_a_name, floats_become_millionths_or_none);
