/* SPDX-License-Identifier: MIT */
/* probe.h: what each motion finds on a string with known friction, and what stops it. */
#include "exhand/probe.h"

#include "exhand/error.h"

#include "check.h"

#define MA(i) EXH_Q(i, 1000, EXH_Q_CUR)
#define MM(l) EXH_Q(l, 1000, EXH_Q_POS)

/* 100 um a count, 1 kHz: a dwell of 10 ms is 10 ticks, 1 mm is 10 counts. */
static const struct exh_probe_scale scale = {EXH_Q(1, 10000, EXH_Q_STEP), {1, 1000}};
static const struct exh_probe_par par = {.step_A_q26 = MA(10),
    .end_A_q26 = MA(1000),
    .dwell_ms = 10,
    .time_ms = 5000,
    .move_m_q30 = MM(1) + 64,
    .travel_m_q30 = MM(50)};
static const struct exh_home_par home_par = {.cur_A_q26 = MA(100),
    .dwell_ms = 10,
    .time_ms = 2000,
    .move_m_q30 = MM(1) + 64,
    .least_m_q30 = MM(20) + 64,
    .most_m_q30 = MM(100)};

/* A string goes in above `in` and, with a weight, out below `out` (none: INT32_MIN). It moves 2
 * counts a tick, stops at its end, and sticks at `stuck`. way -1: the motor is wired with the wrong
 * polarity. A weight may rest on a support at `stand`. */
struct string {
    int32_t cnt, in_A_q26, out_A_q26, end_cnt, stuck_cnt, speed, way, stand_cnt;
};

static int32_t pull(struct string *s, int32_t cur_A_q26)
{
    int32_t v = cur_A_q26 > s->in_A_q26 ? -s->speed : cur_A_q26 < s->out_A_q26 ? s->speed : 0;
    v *= s->way;
    if (v > 0 && s->cnt >= s->stand_cnt) { v = 0; }
    if (v < 0 && (s->cnt <= s->end_cnt || s->cnt == s->stuck_cnt)) { v = 0; }
    s->cnt = exh_wrap_add(s->cnt, v);
    return s->cnt;
}

static struct string slack(int32_t in_A_q26)
{
    return (struct string){0, in_A_q26, INT32_MIN, INT32_MIN, INT32_MIN, 2, 1, INT32_MAX};
}

/* at the end of a motion */
struct found {
    unsigned result, ticks;
    int32_t cur_A_q26, most_A_q26;
};

static struct found probe(struct string *w, const struct exh_probe_par *p, int32_t from_A_q26)
{
    struct found f = {EXH_PROBE_BUSY, 0, 0, 0};
    struct exh_probe_cfg cfg;
    struct exh_probe s;
    CHECK_EQ_I64(exh_probe_setup(&cfg, p, scale), 0);
    exh_probe_start(&s, w->cnt, from_A_q26);
    while (f.result == EXH_PROBE_BUSY && f.ticks < 100000) {
        f.most_A_q26 = s.cur_A_q26 > f.most_A_q26 ? s.cur_A_q26 : f.most_A_q26;
        f.result = exh_probe_step(&s, &cfg, pull(w, s.cur_A_q26));
        f.ticks++;
    }
    f.cur_A_q26 = s.cur_A_q26;
    CHECK(exh_probe_step(&s, &cfg, w->cnt + 12345) == f.result, "the result stays");
    return f;
}

TEST(finds_the_current_that_moves_within_a_step)
{
    for (int32_t mA = 0; mA < 990; mA += 7) {
        struct string w = slack(MA(mA));
        const struct found f = probe(&w, &par, 0);
        CHECK(
            f.result == EXH_PROBE_DONE, "%" PRId32 " mA: %s", mA, exh_probe_result_text(f.result));
        CHECK(f.cur_A_q26 > MA(mA) && f.cur_A_q26 <= MA(mA) + MA(10) + 8,
            "%" PRId32 " mA: found %" PRId32, mA, f.cur_A_q26 / MA(1));
        CHECK(w.cnt <= -10 && w.cnt >= -20, "moved %" PRId32 " counts", w.cnt);
    }
}

TEST(falling_finds_the_current_that_lets_go)
{
    struct exh_probe_par down = par;
    down.step_A_q26 = -MA(10);
    down.end_A_q26 = 0;
    for (int32_t mA = 10; mA < 800; mA += 7) {
        struct string w = {0, MA(850), MA(mA), INT32_MIN, INT32_MIN, 2, 1, INT32_MAX};
        const struct found f = probe(&w, &down, MA(900)); /* still rising at first */
        CHECK(
            f.result == EXH_PROBE_DONE, "%" PRId32 " mA: %s", mA, exh_probe_result_text(f.result));
        CHECK(f.cur_A_q26 < MA(mA) && f.cur_A_q26 >= MA(mA) - MA(10) - 64,
            "%" PRId32 " mA: found %" PRId32, mA, f.cur_A_q26 / MA(1));
    }
}

/* Slack at the first current is taken up before anything is judged. */
TEST(slack_is_taken_up_first)
{
    struct string w = slack(MA(20));
    struct found f;
    w.end_cnt = -200; /* 20 mm of slack, then something that does not move */
    f = probe(&w, &par, MA(50));
    CHECK(f.result == EXH_PROBE_STILL, "%s", exh_probe_result_text(f.result));
    CHECK(f.most_A_q26 <= MA(1000) && f.most_A_q26 > MA(989), "tried up to %" PRId32 " mA",
        f.most_A_q26 / MA(1));
    CHECK(f.cur_A_q26 == 0, "current stays on");
}

TEST(what_stops_a_probe)
{
    struct exh_probe_par slow = par;
    struct string w = slack(MA(100));
    struct found f;
    w.way = -1; /* reversed: caught in the dwell in which it moves, at the least current */
    f = probe(&w, &par, 0);
    CHECK(f.result == EXH_PROBE_WRONG_WAY, "%s", exh_probe_result_text(f.result));
    CHECK(f.most_A_q26 <= MA(110) + 8 && f.cur_A_q26 == 0, "%" PRId32, f.most_A_q26 / MA(1));
    CHECK(w.cnt <= 12, "went out %" PRId32, w.cnt);

    w = slack(MA(2000));
    f = probe(&w, &par, 0);
    CHECK(f.result == EXH_PROBE_STILL && f.cur_A_q26 == 0, "%s", exh_probe_result_text(f.result));
    CHECK(f.ticks == 10 * 101, "%u ticks", f.ticks);

    slow.time_ms = 100;
    w = slack(MA(2000));
    f = probe(&w, &slow, 0);
    CHECK(f.result == EXH_PROBE_TIME && f.cur_A_q26 == 0 && f.ticks == 100, "%s, %u ticks",
        exh_probe_result_text(f.result), f.ticks);

    w = slack(MA(10)); /* runs away at its first current */
    f = probe(&w, &par, MA(50));
    CHECK(f.result == EXH_PROBE_TRAVEL && f.cur_A_q26 == 0, "%s", exh_probe_result_text(f.result));
    CHECK(w.cnt >= -502, "%" PRId32, w.cnt);

    w = slack(MA(100));
    w.out_A_q26 = MA(90); /* pulled out before there is current */
    f = probe(&w, &par, 0);
    CHECK(f.result == EXH_PROBE_WRONG_WAY && f.most_A_q26 == 0, "%s",
        exh_probe_result_text(f.result));
}

TEST(set_up_refuses_what_is_out_of_range)
{
    static const struct {
        int field;
        int32_t v;
    } row[] = {{0, 0}, {0, 66}, {0, -66}, {0, MA(501)}, {0, INT32_MIN}, {1, -1}, {1, MA(3301)},
        {2, 0}, {2, 10001}, {3, 0}, {3, 1000001}, {4, 0}, {4, INT32_MIN}, {5, MM(1)},
        {5, INT32_MAX}};
    struct exh_probe_cfg cfg;
    struct exh_home_cfg home;
    struct exh_weigh_cfg weigh;
    struct exh_probe_scale bad = scale;
    for (size_t i = 0; i < LEN(row); i++) {
        struct exh_probe_par p = par;
        struct exh_weigh_par wp = {par, 0, 100};
        int32_t *const field[] = {
            &p.step_A_q26, &p.end_A_q26, &p.dwell_ms, &p.time_ms, &p.move_m_q30, &p.travel_m_q30};
        *field[row[i].field] = row[i].v;
        CHECK(exh_probe_setup(&cfg, &p, scale) == -EXH_E_RANGE, "row %zu", i);
        wp.probe = p;
        CHECK(exh_weigh_setup(&weigh, &wp, scale) == -EXH_E_RANGE, "weigh, row %zu", i);
    }
    for (unsigned i = 0; i < 6; i++) {
        const int32_t v[] = {0, 0, 0, 0, -1, INT32_MAX};
        struct exh_home_par p = home_par;
        int32_t *const field[] = {
            &p.cur_A_q26, &p.dwell_ms, &p.time_ms, &p.move_m_q30, &p.least_m_q30, &p.most_m_q30};
        *field[i] = v[i];
        CHECK(exh_home_setup(&home, &p, scale) == -EXH_E_RANGE, "home, row %u", i);
    }
    for (unsigned i = 0; i < 5; i++) {
        struct exh_weigh_par p = {par, 0, 100};
        if (i == 0) { p.slack_A_q26 = -1; }
        if (i == 1) { p.slack_A_q26 = MA(1001); }
        if (i == 2) { p.hold_ms = 0; }
        if (i == 3) { p.hold_ms = 100001; }
        if (i == 4) { p.probe.step_A_q26 = -MA(10); }
        CHECK(exh_weigh_setup(&weigh, &p, scale) == -EXH_E_RANGE, "weigh, row %u", i);
    }
    for (unsigned i = 0; i < 2; i++) { /* no way at all, and one that would wrap */
        struct exh_probe_par p = par;
        struct exh_home_par h = home_par;
        p.travel_m_q30 = h.most_m_q30 = i ? EXH_Q(1, 1, EXH_Q_POS) : 1;
        p.move_m_q30 = h.move_m_q30 = 1;
        h.least_m_q30 = 0;
        bad.step_m_q42 = i ? 1 : scale.step_m_q42;
        CHECK(exh_probe_setup(&cfg, &p, bad) == -EXH_E_RANGE, "way %u", i);
        CHECK(exh_home_setup(&home, &h, bad) == -EXH_E_RANGE, "way %u", i);
    }
    bad.step_m_q42 = 0;
    CHECK_EQ_I64(exh_probe_setup(&cfg, &par, bad), -EXH_E_RANGE);
    bad = scale;
    bad.T.num = 0;
    CHECK_EQ_I64(exh_home_setup(&home, &home_par, bad), -EXH_E_RANGE);
    bad = scale;
    bad.step_m_q42 = INT32_MAX; /* 488 um a count: `move` is still two of them */
    CHECK_EQ_I64(exh_probe_setup(&cfg, &par, bad), 0);
    CHECK_EQ_I64(cfg.move_cnt, 2);
    CHECK_EQ_I64(
        exh_probe_setup(&cfg, &par, (struct exh_probe_scale){1, {1, 20000}}), -EXH_E_RANGE);
    CHECK_EQ_I64(exh_home_setup(&home, &home_par, (struct exh_probe_scale){100, {1, 1000}}),
        -EXH_E_RANGE); /* 4.4 * 10^9 counts to the limit: beyond any counter */
    CHECK_EQ_I64(exh_probe_setup(&cfg, &par, (struct exh_probe_scale){1000, {1, 1}}), 0);
    CHECK(cfg.dwell_ticks == 2 && cfg.ticks == 5, "1 Hz");
}

/* --- home --- */

static struct found home(struct string *w, int32_t *home_cnt)
{
    struct found f = {EXH_PROBE_BUSY, 0, 0, 0};
    struct exh_home_cfg cfg;
    struct exh_home s;
    CHECK_EQ_I64(exh_home_setup(&cfg, &home_par, scale), 0);
    exh_home_start(&s, w->cnt);
    while (f.result == EXH_PROBE_BUSY && f.ticks < 100000) {
        f.most_A_q26 = s.cur_A_q26 > f.most_A_q26 ? s.cur_A_q26 : f.most_A_q26;
        f.result = exh_home_step(&s, &cfg, pull(w, s.cur_A_q26));
        f.ticks++;
    }
    f.cur_A_q26 = s.cur_A_q26;
    if (home_cnt != NULL) { *home_cnt = s.home_cnt; }
    CHECK(f.most_A_q26 <= MA(100) && f.cur_A_q26 == 0, "current %" PRId32, f.most_A_q26);
    CHECK(exh_home_step(&s, &cfg, w->cnt + 12345) == f.result, "the result stays");
    return f;
}

TEST(home_is_the_end_of_the_string)
{
    static const struct {
        int32_t end_cnt;
        unsigned result;
    } row[] = {{-500, EXH_PROBE_DONE}, {-202, EXH_PROBE_DONE}, {-990, EXH_PROBE_DONE},
        {-198, EXH_PROBE_JAM}, {0, EXH_PROBE_JAM}, {-20, EXH_PROBE_JAM}, {-1100, EXH_PROBE_TRAVEL},
        {INT32_MIN, EXH_PROBE_TRAVEL}};
    for (size_t i = 0; i < LEN(row); i++) {
        struct string w = slack(MA(20));
        struct found f;
        int32_t at;
        w.end_cnt = row[i].end_cnt;
        f = home(&w, &at);
        CHECK(f.result == row[i].result, "row %zu: %s", i, exh_probe_result_text(f.result));
        CHECK(f.result != EXH_PROBE_DONE || at == row[i].end_cnt, "row %zu: %" PRId32, i, at);
        CHECK(w.cnt >= -1004, "row %zu: ran to %" PRId32, i, w.cnt);
    }
}

TEST(what_stops_homing)
{
    struct string w = slack(MA(20));
    struct found f;
    w.way = -1;
    f = home(&w, NULL);
    CHECK(f.result == EXH_PROBE_WRONG_WAY && w.cnt <= 12 && f.ticks < 10, "%s, %" PRId32,
        exh_probe_result_text(f.result), w.cnt);
    w = slack(MA(20));
    w.stuck_cnt = -100; /* half way to where an end may be */
    f = home(&w, NULL);
    CHECK(f.result == EXH_PROBE_JAM && f.ticks < 100, "%s", exh_probe_result_text(f.result));
    w = slack(MA(20));
    w.speed = 0;
    f = home(&w, NULL);
    CHECK(f.result == EXH_PROBE_JAM && f.ticks == 10, "%s", exh_probe_result_text(f.result));
}

TEST(homing_takes_no_longer_than_allowed)
{
    struct exh_home_par p = home_par;
    struct exh_home_cfg cfg;
    struct exh_home s;
    unsigned n = 0;
    p.time_ms = 100;
    CHECK_EQ_I64(exh_home_setup(&cfg, &p, scale), 0);
    exh_home_start(&s, 0);
    while (exh_home_step(&s, &cfg, -2 * (int32_t)n) == EXH_PROBE_BUSY && n < 1000) { n++; }
    CHECK(
        s.result == EXH_PROBE_TIME && n == 99, "%s, %u ticks", exh_probe_result_text(s.result), n);
}

/* With a least way of 0 an immediate end is valid. The whole way is allowed, and no more. */
TEST(homing_from_the_end_and_all_the_way)
{
    struct exh_home_par p = home_par;
    struct exh_home_cfg cfg;
    struct exh_home s;
    unsigned n = 0;
    p.least_m_q30 = 0;
    CHECK_EQ_I64(exh_home_setup(&cfg, &p, scale), 0);
    exh_home_start(&s, 500);
    while (exh_home_step(&s, &cfg, 500) == EXH_PROBE_BUSY && n < 1000) { n++; }
    CHECK(s.result == EXH_PROBE_DONE && s.home_cnt == 500, "%s", exh_probe_result_text(s.result));
    exh_home_start(&s, 0);
    CHECK_EQ_I64(exh_home_step(&s, &cfg, -cfg.most_cnt), EXH_PROBE_BUSY);
    CHECK_EQ_I64(exh_home_step(&s, &cfg, -cfg.most_cnt - 1), EXH_PROBE_TRAVEL);
}

/* --- weigh --- */

static struct found weigh(struct string *w, struct exh_calib_point *p, int32_t mon_A_q26)
{
    const struct exh_weigh_par wp = {.probe = par, .slack_A_q26 = MA(20), .hold_ms = 100};
    struct found f = {EXH_PROBE_BUSY, 0, 0, 0};
    struct exh_weigh_cfg cfg;
    struct exh_weigh s;
    CHECK_EQ_I64(exh_weigh_setup(&cfg, &wp, scale), 0);
    exh_weigh_start(&s, &cfg, w->cnt);
    while (f.result == EXH_PROBE_BUSY && f.ticks < 1000000) {
        const int32_t cur = s.cur_A_q26;
        f.most_A_q26 = cur > f.most_A_q26 ? cur : f.most_A_q26;
        f.result = exh_weigh_step(&s, &cfg, pull(w, cur), cur, cur + mon_A_q26);
        f.ticks++;
    }
    f.cur_A_q26 = s.cur_A_q26;
    CHECK(f.cur_A_q26 == 0, "current stays on");
    *p = exh_weigh_point(&s, 77);
    return f;
}

/* Middle and half-width of a friction band, whatever they are, within a step. */
TEST(weighing_brackets_friction)
{
    for (int32_t sink = 30; sink < 700; sink += 37) {
        for (int32_t band = 12; band < 290; band += 31) {
            struct string w = {0, MA(sink + band), MA(sink), INT32_MIN, INT32_MIN, 2, 1, INT32_MAX};
            struct exh_calib_point p;
            struct found f;
            int32_t off, half;
            w.stand_cnt = 0;
            f = weigh(&w, &p, MA(1));
            CHECK(f.result == EXH_PROBE_DONE, "%" PRId32 "+%" PRId32 " mA: %s", sink, band,
                exh_probe_result_text(f.result));
            off = p.cur_A_q26 - MA(2 * sink + band) / 2;
            half = p.friction_A_q26 - MA(band) / 2;
            CHECK(off <= MA(6) && off >= -MA(6),
                "%" PRId32 "+%" PRId32 " mA: middle off by %" PRId32 " uA", sink, band,
                off / (MA(1) / 1000));
            CHECK(half >= 0 && half <= MA(11),
                "%" PRId32 "+%" PRId32 " mA: friction off by %" PRId32, sink, band,
                half / (MA(1) / 1000));
            CHECK(p.mon_A_q26 == p.cur_A_q26 + MA(1) && p.force_N_q20 == 77, "monitor");
        }
    }
}

TEST(what_stops_weighing)
{
    struct exh_calib_point p;
    struct string w = slack(MA(10)); /* no mass on it */
    struct found f = weigh(&w, &p, 0);
    CHECK(f.result == EXH_PROBE_TRAVEL && w.cnt >= -504, "%s", exh_probe_result_text(f.result));
    w = slack(MA(2000)); /* too heavy */
    f = weigh(&w, &p, 0);
    CHECK(f.result == EXH_PROBE_STILL && f.most_A_q26 <= MA(1000), "%s",
        exh_probe_result_text(f.result));
    w = slack(MA(500)); /* lifted, and never comes down again */
    f = weigh(&w, &p, 0);
    CHECK(f.result == EXH_PROBE_STILL && f.most_A_q26 <= MA(520), "%s",
        exh_probe_result_text(f.result));
    w = (struct string){
        0, MA(500), MA(499), INT32_MIN, INT32_MIN, 2, 1, INT32_MAX}; /* out from tick 1 */
    f = weigh(&w, &p, 0);
    CHECK(f.result == EXH_PROBE_WRONG_WAY && f.most_A_q26 <= MA(20), "%s",
        exh_probe_result_text(f.result));
}

/* Counts by script: how far the string goes in each phase. The limits are of all phases
 * together, and of the last one too. */
struct script {
    struct exh_weigh_cfg cfg;
    struct exh_weigh s;
    int32_t cnt;
};

static void script(struct script *w)
{
    const struct exh_weigh_par wp = {.probe = par, .slack_A_q26 = MA(20), .hold_ms = 100};
    w->cnt = 0;
    CHECK_EQ_I64(exh_weigh_setup(&w->cfg, &wp, scale), 0);
    exh_weigh_start(&w->s, &w->cfg, 0);
}

static uint8_t move(struct script *w, int32_t by, unsigned ticks)
{
    uint8_t r = w->s.result;
    for (unsigned n = 0; n < ticks && r == EXH_PROBE_BUSY; n++) {
        w->cnt += by;
        r = exh_weigh_step(&w->s, &w->cfg, w->cnt, 0, 0);
    }
    return r;
}

static void lifted(struct script *w, int32_t slack_cnt)
{
    script(w);
    CHECK_EQ_I64(move(w, -2, (unsigned)slack_cnt / 2), EXH_PROBE_BUSY);
    CHECK_EQ_I64(move(w, 0, 400), EXH_PROBE_BUSY);
    CHECK_EQ_I64(move(w, -2, 6), EXH_PROBE_BUSY);
    CHECK_EQ_I64(w->s.phase, 1);
}

TEST(travel_is_of_all_phases_together)
{
    struct script w;
    lifted(&w, 300);
    CHECK_EQ_I64(move(&w, -2, 1000), EXH_PROBE_TRAVEL);
    CHECK(w.cnt >= -502, "%" PRId32, w.cnt);
    for (int way = -2; way <= 2; way += 4) { /* while it should be held */
        lifted(&w, 300);
        CHECK_EQ_I64(move(&w, 2, 6), EXH_PROBE_BUSY);
        CHECK_EQ_I64(w.s.phase, 2);
        CHECK_EQ_I64(move(&w, way, 2000), EXH_PROBE_TRAVEL);
        CHECK(w.cnt >= -502 && w.cnt <= 502 && w.s.cur_A_q26 == 0, "%" PRId32, w.cnt);
    }
}

TEST(a_mass_that_swings_is_not_waited_for)
{
    struct script w;
    unsigned n = 0;
    lifted(&w, 0);
    CHECK_EQ_I64(move(&w, 2, 6), EXH_PROBE_BUSY);
    while (move(&w, n % 20 < 10 ? 2 : -2, 1) == EXH_PROBE_BUSY && n < 100000) { n++; }
    CHECK(w.s.result == EXH_PROBE_TIME && w.s.cur_A_q26 == 0 && n < 5000, "%s after %u ticks",
        exh_probe_result_text(w.s.result), n);
}

/* A movement while the means are taken: what was taken before it is not of this rest. */
TEST(means_begin_anew_after_a_movement)
{
    struct script w;
    struct exh_calib_point p;
    uint8_t r = EXH_PROBE_BUSY;
    int moved = 0;
    lifted(&w, 0);
    CHECK_EQ_I64(move(&w, 2, 6), EXH_PROBE_BUSY);
    CHECK_EQ_I64(w.s.phase, 2);
    for (int n = 0; n < 3000 && r == EXH_PROBE_BUSY; n++) {
        if (w.s.coded.n == 20 && !moved) {
            moved = 1;
            w.cnt += 10;
        }
        r = exh_weigh_step(
            &w.s, &w.cfg, w.cnt, moved ? MA(200) : MA(100), moved ? MA(220) : MA(110));
    }
    CHECK(r == EXH_PROBE_DONE && moved, "%s", exh_probe_result_text(r));
    p = exh_weigh_point(&w.s, 1);
    CHECK(p.cur_A_q26 == MA(200) && p.mon_A_q26 == MA(220), "%" PRId32 ", %" PRId32, p.cur_A_q26,
        p.mon_A_q26);
}

/* --- whatever the counts do --- */

/* Never more current than the limit, an end within the time, no current after it, none in
 * the tick in which the travel limit is seen to be passed. */
TEST(any_counts_stay_within_the_bounds)
{
    while (check_case(100)) {
        struct exh_probe_par p = par;
        struct exh_weigh_par wp = {.slack_A_q26 = MA(20), .hold_ms = 50};
        struct exh_probe_cfg cfg;
        struct exh_home_cfg hcfg;
        struct exh_weigh_cfg wcfg;
        struct exh_probe s;
        struct exh_home h;
        struct exh_weigh w;
        const int32_t start = check_i32(), wild = check_i32_in(0, 30);
        int32_t cnt = start;
        p.time_ms = 300;
        wp.probe = p;
        CHECK_EQ_I64(exh_probe_setup(&cfg, &p, scale), 0);
        CHECK_EQ_I64(exh_home_setup(&hcfg, &home_par, scale), 0);
        CHECK_EQ_I64(exh_weigh_setup(&wcfg, &wp, scale), 0);
        exh_probe_start(&s, cnt, check_i32());
        exh_home_start(&h, cnt);
        exh_weigh_start(&w, &wcfg, cnt);
        for (int n = 0; n < 2500; n++) {
            const int32_t was = s.cur_A_q26;
            const int32_t jump =
                check_u64() % 512 ? check_i32_in(-1, 1) : check_i32_in(-wild, wild);
            int64_t far;
            cnt = exh_wrap_add(cnt, wild == 30 && check_u64() % 1024 == 0 ? check_i32() : jump);
            far = exh_wrap_diff(cnt, start);
            (void)exh_probe_step(&s, &cfg, cnt);
            (void)exh_home_step(&h, &hcfg, cnt);
            (void)exh_weigh_step(&w, &wcfg, cnt, check_i32(), check_i32());
            CHECK(s.cur_A_q26 >= 0 && (s.cur_A_q26 <= was || s.cur_A_q26 <= MA(1000)), "probe");
            CHECK(h.cur_A_q26 >= 0 && h.cur_A_q26 <= MA(100), "home");
            CHECK(w.cur_A_q26 >= 0 && w.cur_A_q26 <= MA(1000), "weigh");
            if (far > 502 || far < -502) { CHECK(s.result && w.result && !w.cur_A_q26, "travel"); }
            if (far > 1002 || far < -1002) { CHECK(h.result && !h.cur_A_q26, "home's travel"); }
            CHECK(s.result <= EXH_PROBE_DONE || s.cur_A_q26 == 0, "current after the end");
            CHECK(!h.result || h.cur_A_q26 == 0, "current after the end of homing");
            CHECK(!w.result || w.cur_A_q26 == 0, "current after the end of weighing");
        }
        CHECK(s.result && h.result && w.result, "no end: %d %d %d", s.result, h.result, w.result);
    }
}

TEST(every_result_has_its_text)
{
    for (unsigned i = 0; i <= EXH_PROBE_RESULTS; i++) {
        for (unsigned k = 0; k < i; k++) {
            CHECK(!check_same_text(exh_probe_result_text(i), exh_probe_result_text(k)), "%u and %u",
                i, k);
        }
    }
}

/* A string that creeps out, in no dwell by as much as a movement. */
TEST(creeping_out_ends_at_the_travel)
{
    struct exh_probe_par p = par;
    struct exh_probe_cfg cfg;
    struct exh_probe s;
    int32_t cnt = 0;
    p.travel_m_q30 = MM(2) + 64; /* 20 counts; a movement is 10 */
    CHECK_EQ_I64(exh_probe_setup(&cfg, &p, scale), 0);
    exh_probe_start(&s, 0, 0);
    for (unsigned k = 0; k < 1000 && s.result == EXH_PROBE_BUSY; k++) {
        cnt += k % 10 == 0; /* one a dwell */
        (void)exh_probe_step(&s, &cfg, cnt);
    }
    CHECK(s.result == EXH_PROBE_TRAVEL && cnt == 21, "%s at %" PRId32,
        exh_probe_result_text(s.result), cnt);
    CHECK_EQ_I64(s.cur_A_q26, 0);
}

/* At rest with the mass, all of the way may be gone, either way, and no more. */
TEST(holding_stays_within_the_way)
{
    const struct exh_weigh_par wp = {.probe = par, .slack_A_q26 = MA(20), .hold_ms = 100};
    struct exh_weigh_cfg cfg;
    CHECK_EQ_I64(exh_weigh_setup(&cfg, &wp, scale), 0);
    for (int32_t way = -1; way <= 1; way += 2) {
        struct exh_weigh s = {.phase = 2, .result = EXH_PROBE_BUSY};
        CHECK_EQ_I64(exh_weigh_step(&s, &cfg, way * cfg.up.travel_cnt, 0, 0), EXH_PROBE_BUSY);
        CHECK_EQ_I64(
            exh_weigh_step(&s, &cfg, way * (cfg.up.travel_cnt + 1), 0, 0), EXH_PROBE_TRAVEL);
    }
    CHECK_EQ_I64(cfg.down.end_A_q26, 0);
}

/* The last current is tried too, from either side. A dwell lasts at least a tick. Steps of a count
 * keep their resolution. */
TEST(ends_to_the_bit)
{
    struct exh_probe_par p = par;
    struct exh_probe_cfg cfg;
    CHECK_EQ_I64(exh_probe_ticks(1, (struct exh_period){1, 90}), 1);
    p.move_m_q30 = 1;
    p.travel_m_q30 = 2;
    CHECK_EQ_I64(exh_probe_setup(&cfg, &p, (struct exh_probe_scale){1, scale.T}), 0);
    CHECK(cfg.move_cnt == 4096 && cfg.travel_cnt == 8192, "%" PRId32, cfg.travel_cnt);
    CHECK_EQ_I64(exh_probe_setup(&cfg, &p, (struct exh_probe_scale){0, scale.T}), -EXH_E_RANGE);
    for (int sign = -1; sign <= 1; sign += 2) {
        const int32_t from = INT32_C(1) << 22, step = sign * (INT32_C(1) << 20);
        int32_t last = from;
        unsigned tried = 0;
        struct exh_probe s;
        p = par;
        p.step_A_q26 = step;
        p.end_A_q26 = from + 3 * step;
        CHECK_EQ_I64(exh_probe_setup(&cfg, &p, scale), 0);
        exh_probe_start(&s, 0, from);
        while (exh_probe_step(&s, &cfg, 0) == EXH_PROBE_BUSY && tried < 9) {
            tried += s.cur_A_q26 != last;
            last = s.cur_A_q26;
        }
        CHECK(s.result == EXH_PROBE_STILL && tried == 3 && last == from + 3 * step,
            "%u, last %" PRId32, tried, last);
    }
}

TEST_MAIN("unit/probe", finds_the_current_that_moves_within_a_step,
    falling_finds_the_current_that_lets_go, slack_is_taken_up_first, what_stops_a_probe,
    set_up_refuses_what_is_out_of_range, home_is_the_end_of_the_string, what_stops_homing,
    homing_takes_no_longer_than_allowed, weighing_brackets_friction, what_stops_weighing,
    travel_is_of_all_phases_together, a_mass_that_swings_is_not_waited_for,
    means_begin_anew_after_a_movement, any_counts_stay_within_the_bounds, every_result_has_its_text,
    creeping_out_ends_at_the_travel, homing_from_the_end_and_all_the_way,
    holding_stays_within_the_way, ends_to_the_bit);
