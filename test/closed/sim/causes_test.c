/* SPDX-License-Identifier: MIT */
/* Causes of faults of the box: supply, glove, link. Each is reported in time, not earlier, and not
 * at all if it is off. With one finger's scenes: supply, and memory that changed. */
#include "check.h"

#include "box/hand.h"

#include "guarded/guarded.h"

#include <string.h>

static struct {
    double from_s, until_s; /* the supply is at rail_V */
    int16_t rail_raw;
    double dead_s; /* the index knuckle's wire breaks */
} wrong;

static double at_s[EXH_FAULTS]; /* when a fault was first latched; < 0: never */

static void wires_in(struct exh_drive_in *in)
{
    const double t_s = posix_time_s();
    if (t_s >= wrong.from_s && t_s < wrong.until_s) { in->supply_raw = wrong.rail_raw; }
    if (wrong.dead_s > 0 && t_s >= wrong.dead_s) { posix_glove()->fault[4] = SIM_GLOVE_OPEN; }
}

static void begin(const struct exh_scene *sc, struct exh_scene_board board)
{
    (void)sc;
    (void)board;
}

/* Until it runs: before the first planes the link is a cause, if link_time is set. */
static void before(uint32_t tick, struct exh_scene_in *in)
{
    const struct bilateral_signals *sig = (const void *)exh_scene_signals(&exh_scene_bilateral);
    (void)tick;
    if (sig->box.state == EXH_STATE_OFF && posix_time_s() < 0.5) { in->command = EXH_CMD_RUN; }
}

static void after(uint32_t tick, const struct exh_scene_in *in, const struct exh_drive_out *out)
{
    const struct bilateral_signals *sig = (const void *)exh_scene_signals(&exh_scene_bilateral);
    (void)tick;
    (void)in;
    (void)out;
    for (unsigned k = 0; k < EXH_FAULTS; k++) {
        if (sig->box.faults >> k & 1 && at_s[k] < 0) { at_s[k] = posix_time_s(); }
    }
}

/* The faults of a run of 2.5 s with one finger that presses from 0.9 s on. */
static uint32_t faults(
    const char *name, double value, const char *name2, double value2, double quiet_s)
{
    static const struct exh_loop_hooks more = {begin, before, after};
    const struct run_setting set[] = {{"mat_f_max", 40}, {name, value}, {name2, value2}};
    struct bilateral_run_cfg c;
    struct bilateral_run r;
    memset(&c, 0, sizeof c);
    c.rate_Hz = 1000;
    c.board = posix_config_default();
    c.board.exo = sim_exo_default();
    c.board.exo.fingers = 1u << EXH_INDEX;
    c.board.exo.path[EXH_INDEX].first_s = 0.7;
    c.board.exo.path[EXH_INDEX].approaches = 1;
    c.board.max_ticks = 2500;
    c.board.wires_in = wires_in;
    c.setting = set;
    c.settings = LEN(set);
    c.k_Npm = 5000;
    c.b_Nspm = 20;
    c.at_m = 0.03;
    c.fps = 400;
    c.until_s = quiet_s;
    c.more = &more;
    for (unsigned k = 0; k < EXH_FAULTS; k++) { at_s[k] = -1; }
    CHECK_EQ_I64(bilateral_run(&c, &r), 0);
    bilateral_run_free(&r);
    return r.faults;
}

static void told_at(unsigned k, double lo_s, double hi_s)
{
    CHECK(at_s[k] >= lo_s && at_s[k] <= hi_s, "%s at %.4f s, want %.4f..%.4f", exh_fault_name(k),
        at_s[k], lo_s, hi_s);
}

static void all_is_well(void) { memset(&wrong, 0, sizeof wrong); }

TEST(a_supply_outside_its_limits_is_a_fault_where_it_is_judged)
{
    all_is_well();
    CHECK_EQ_I64(faults("supply_min", 20, "supply_max", 28, 1e30), 0);
    wrong.from_s = 1.2;
    wrong.until_s = 9;
    wrong.rail_raw = 14745; /* 18 V */
    CHECK_EQ_I64(faults("supply_min", 20, "supply_max", 28, 1e30), EXH_FAULT_SUPPLY);
    told_at(11, 1.210, 1.2115);
    wrong.rail_raw = 24576; /* 30 V */
    CHECK_EQ_I64(faults("supply_min", 20, "supply_max", 28, 1e30), EXH_FAULT_SUPPLY);
    wrong.until_s = 1.2095; /* a dip */
    CHECK_EQ_I64(faults("supply_min", 20, "supply_max", 28, 1e30), 0);
    wrong.until_s = 9;
    wrong.rail_raw = 0;
    CHECK_EQ_I64(faults("supply_min", 0, "supply_max", 28, 1e30), 0); /* no monitor */
}

/* The finger is let go alone, after doubt_max; the box stops later. */
TEST(a_sensor_that_is_not_believed_is_a_fault_after_its_time)
{
    all_is_well();
    wrong.dead_s = 1.2;
    CHECK_EQ_I64(faults("glove_time", 0.5 * 1000, "link_time", 0, 1e30), EXH_FAULT_GLOVE);
    told_at(8, 1.7015, 1.7025); /* its frame comes a tick later, and then 501 ticks */
    CHECK_EQ_I64(faults("glove_time", 0, "link_time", 0, 1e30), 0);    /* off */
    CHECK_EQ_I64(faults("glove_time", 5000, "link_time", 0, 1e30), 0); /* not yet */
}

/* Frames end; their age of 16 bits ends at tick 65534, the time goes on. */
TEST(a_glove_that_is_silent_for_longer_than_an_age_can_tell)
{
    static struct bilateral_par par;
    static struct bilateral_cfg cfg;
    static struct bilateral s;
    static const struct exh_scene_in in;
    uint32_t want, n = 0;
    memset(&par, 0, sizeof par);
    par.own.glove_ms = 60000;
    par.supply.max_V_q20 = par.supply.scale_V_q30 = par.supply.time_ms = 1;
    cfg.par = &par;
    cfg.n = s.frame.places = 1;
    CHECK_EQ_I64(bilateral_cause_setup(&cfg, (struct exh_period){1, 2000}), 0);
    want = 120001;
    do {
        s.glove_age_ticks = n < UINT16_MAX ? n : UINT32_MAX;
        n++;
        CHECK(n <= want + 1, "not told");
    } while (!(bilateral_causes(&s, &cfg, &in) & EXH_FAULT_GLOVE));
    CHECK_EQ_I64(n - 1, want);
    s.glove_age_ticks = 3;
    CHECK_EQ_I64(bilateral_causes(&s, &cfg, &in), 0);
    CHECK_EQ_I64(s.unsure_ticks, 3);
}

/* A silent world is no fault, because contacts are local. link_time makes it one. */
TEST(a_silent_link_is_a_fault_where_it_is_asked_for)
{
    all_is_well();
    CHECK_EQ_I64(faults("glove_time", 1000, "link_time", 0, 1.2), 0);
    CHECK_EQ_I64(faults("glove_time", 1000, "link_time", 300, 1e30), 0);
    CHECK_EQ_I64(faults("glove_time", 1000, "link_time", 300, 1.2), EXH_FAULT_LINK);
    told_at(10, 1.49, 1.51);
}

/* --- scenes of one finger, tick by tick --- */

static void power_on(const struct exh_scene *sc, int32_t least_V_q20)
{
    const struct exh_scene_board board = {{1, 1000}, 24};
    sc->defaults();
    CHECK_EQ_I64(exh_params_stage(sc->params, exh_supply_rows[0].id, 0, least_V_q20), 0);
    CHECK_EQ_I64(
        exh_params_stage(sc->params, exh_calib_set_rows[2].id, 0, 1), 0); /* uncalibrated */
    CHECK_EQ_I64(exh_params_apply(sc->params), 1);
    CHECK_EQ_I64(sc->setup(board), 0);
}

static void ticks(
    const struct exh_scene *sc, uint32_t n, int16_t supply_raw, enum exh_command command)
{
    struct exh_scene_in in = {.command = (uint8_t)command};
    struct exh_drive_out out;
    in.drive.din = 0x1F0F;
    in.drive.supply_raw = supply_raw;
    for (uint32_t k = 0; k < n; k++) { sc->tick(&in, &out); }
}

/* 24 V through 1:4 is 19661. */
TEST(one_finger_judges_its_supply_likewise)
{
    static const struct exh_scene *const scene[] = {&exh_scene_drop, &exh_scene_guarded};
    for (size_t i = 0; i < LEN(scene); i++) {
        const struct exh_scene *sc = scene[i];
        power_on(sc, 20 << EXH_Q_SUPPLY);
        ticks(sc, 1, 19661, EXH_CMD_RUN);
        ticks(sc, 1000, 19661, EXH_CMD_NONE);
        CHECK(sc->safety->state == EXH_STATE_RUN, "%s: state %d", sc->name, sc->safety->state);
        ticks(sc, 10, 14745, EXH_CMD_NONE);
        CHECK_EQ_I64(sc->safety->faults, 0);
        ticks(sc, 1, 14745, EXH_CMD_NONE);
        CHECK_EQ_I64(sc->safety->faults, EXH_FAULT_SUPPLY);
        power_on(sc, 0);
        ticks(sc, 1, 0, EXH_CMD_RUN);
        ticks(sc, 1000, 0, EXH_CMD_NONE);
        CHECK(sc->safety->state == EXH_STATE_RUN, "%s: state %d", sc->name, sc->safety->state);
    }
}

/* Any byte of passivity's table, in the round in which it changed or the next. */
TEST(memory_of_guarded_that_changes_is_told)
{
    struct guarded_cfg *cfg;
    const struct guarded *s = guarded_memory(&cfg);
    const uint32_t round = (sizeof *cfg + EXH_INTEGRITY_B - 1) / EXH_INTEGRITY_B;
    uint8_t *byte = (uint8_t *)cfg->held;
    for (size_t at = 0; at < sizeof cfg->held; at++) {
        power_on(&exh_scene_guarded, 0);
        ticks(&exh_scene_guarded, (uint32_t)at % round, 0, EXH_CMD_NONE);
        CHECK_EQ_I64(s->drop.safety.present, 0);
        byte[at] ^= (uint8_t)(1u << at % 8);
        ticks(&exh_scene_guarded, 1, 0, EXH_CMD_RUN);
        ticks(&exh_scene_guarded, 2 * round, 0, EXH_CMD_NONE);
        CHECK(s->drop.safety.present == EXH_FAULT_CONFIG, "byte %zu: %x", at,
            (unsigned)s->drop.safety.present);
        CHECK(s->drop.safety.state == EXH_STATE_OFF || s->drop.safety.state == EXH_STATE_FAULT,
            "byte %zu: state %d", at, s->drop.safety.state);
    }
}

TEST_MAIN("causes", a_supply_outside_its_limits_is_a_fault_where_it_is_judged,
    a_sensor_that_is_not_believed_is_a_fault_after_its_time,
    a_glove_that_is_silent_for_longer_than_an_age_can_tell,
    a_silent_link_is_a_fault_where_it_is_asked_for, one_finger_judges_its_supply_likewise,
    memory_of_guarded_that_changes_is_told);
