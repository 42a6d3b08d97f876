/* SPDX-License-Identifier: MIT */
/* The simulator may skip the rest of a fall in which nothing changes any more. The result is then
 * the same, digit by digit, as that of a full run: with stable, marginal and unstable walls, little
 * and much friction, slow and fast rates. Where something would still happen after the mass has
 * come to rest, the rest is run. */
#include "check.h"

#include "box/table2.h"
#include "lab/drop/readings.h"
#include "drop/drop.h"
#include "posix.h"

#include "sim/still.h"

#include "exhand/board.h"

#include <string.h>

#define FALLS 2

static struct run_cfg config(double rate_Hz, double k_Npm, double b_Nspm)
{
    struct run_cfg c = {.rate_Hz = (uint32_t)rate_Hz, .k_Npm = k_Npm, .b_Nspm = b_Nspm};
    c.board = posix_config_default();
    c.board.falls = FALLS;
    return c;
}

static int sample_same(const struct fall_sample *a, const struct fall_sample *b)
{
    return a->t_s == b->t_s && a->q_m == b->q_m && a->qd_mps == b->qd_mps &&
           a->f_des_N == b->f_des_N && a->i_des_A == b->i_des_A && a->f_mon_N == b->f_mon_N &&
           a->c == b->c;
}

static void check_same(const struct run *all, const struct run *r, const struct run_cfg *c)
{
    CHECK(all->ticks == r->ticks && all->faults == r->faults && all->log.falls == r->log.falls &&
              all->log.samples == r->log.samples,
        "%u Hz, %g N/m, %g Ns/m: %" PRIu64 " and %" PRIu64 " ticks, faults %x and %x", c->rate_Hz,
        c->k_Npm, c->b_Nspm, all->ticks, r->ticks, all->faults, r->faults);
    for (size_t i = 0; i < all->log.falls; i++) {
        CHECK(all->log.start[i] == r->log.start[i], "fall %zu", i);
    }
    for (size_t i = 0; i < all->log.samples; i++) {
        CHECK(sample_same(&all->log.sample[i], &r->log.sample[i]),
            "%u Hz, %g N/m, %g Ns/m: sample %zu of %zu", c->rate_Hz, c->k_Npm, c->b_Nspm, i,
            all->log.samples);
    }
}

/* Run either way. Ticks that were known; *all of how many. The scene's memory and the plant are the
 * same at the end, too. */
static uint64_t both(struct run_cfg c, uint64_t *all)
{
    struct run r[2];
    struct drop end[2];
    struct plant plant[2];
    struct drop_cfg *cfg;
    uint64_t known;
    for (int i = 0; i < 2; i++) {
        c.all = i == 0;
        CHECK_EQ_I64(run_drop(&c, &r[i]), 0);
        memcpy(&end[i], drop_memory(&cfg), sizeof end[i]);
        memcpy(&plant[i], posix_plant(), sizeof plant[i]);
    }
    check_same(&r[0], &r[1], &c);
    CHECK(memcmp(&end[0], &end[1], sizeof end[0]) == 0, "another state at the end");
    CHECK(memcmp(&plant[0], &plant[1], sizeof plant[0]) == 0, "another plant at the end");
    CHECK(r[0].known == 0, "%" PRIu64, r[0].known);
    *all = r[0].ticks;
    known = r[1].known;
    run_free(&r[0]);
    run_free(&r[1]);
    return known;
}

static int verdicts_same(const struct table2_result *a, const struct table2_result *b)
{
    return a->falls == b->falls && a->oscillating == b->oscillating && a->buzzing == b->buzzing &&
           a->incomplete == b->incomplete && a->faults == b->faults && a->line == b->line &&
           a->b_Npm == b->b_Npm && a->a_Npm == b->a_Npm && a->r2 == b->r2 &&
           a->ci_low_Npm == b->ci_low_Npm && a->ci_high_Npm == b->ci_high_Npm &&
           a->b_same_Npm == b->b_same_Npm && a->a_same_Npm == b->a_same_Npm &&
           memcmp(a->reading_Npm, b->reading_Npm, sizeof a->reading_Npm) == 0;
}

static const struct {
    const char *name;
    double of; /* times what the device has */
} friction[] = {{"none", 0}, {"some", 1}, {"much", 3}};

static void rub(struct sim_device *d, double of)
{
    d->mu_motor *= of;
    d->mu_mass *= of;
    d->coulomb_n *= of;
}

TEST(what_is_not_run_is_what_running_gives)
{
    static const double rate_Hz[] = {90, 466, 500, 2414, 6178};
    static const double part[] = {0.2, 0.7, 1, 1.3, 2.5}; /* of Table II's gains */
    int stable = 0, unstable = 0, marginal = 0;
    uint64_t all = 0, known = 0;
    for (size_t i = 0; i < LEN(rate_Hz) * LEN(part) * LEN(friction); i++) {
        const struct table2_row *row = table2_gains(rate_Hz[i % LEN(rate_Hz)]);
        const double of = part[i / LEN(rate_Hz) % LEN(part)];
        struct run_cfg c = config(rate_Hz[i % LEN(rate_Hz)], of * row->k_Npm, of * row->b_Nspm);
        struct table2_result r[2];
        uint64_t ticks, not_run;
        rub(&c.board.device, friction[i / LEN(rate_Hz) / LEN(part)].of);
        not_run = both(c, &ticks);
        for (c.all = 0; c.all < 2; c.all++) {
            r[c.all] = table2_measure_more(&c, NULL, TABLE2_SAME, readings_judge);
        }
        CHECK(r[0].done && r[1].done && verdicts_same(&r[0], &r[1]), "%u Hz, %g N/m, friction %s",
            c.rate_Hz, c.k_Npm, friction[i / LEN(rate_Hz) / LEN(part)].name);
        if (r[0].oscillating == r[0].falls) {
            CHECK(not_run == 0, "%u Hz, %g N/m: %" PRIu64, c.rate_Hz, c.k_Npm, not_run);
        }
        unstable += r[0].oscillating == r[0].falls;
        stable += r[0].oscillating == 0;
        marginal += r[0].oscillating > 0 && r[0].oscillating < r[0].falls;
        if (r[0].oscillating == 0 && friction[i / LEN(rate_Hz) / LEN(part)].of > 0) {
            all += ticks;
            known += not_run;
        }
    }
    CHECK(stable > 20 && unstable > 15, "%d stable, %d unstable", stable, unstable);
    CHECK(10 * known > 6 * all, "%" PRIu64 " of %" PRIu64, known, all);
    check_note("%d walls stable, %d unstable, %d at times: the same either way; of the ticks of "
               "stable ones with friction "
               "%.0f %% need not be run",
        stable, unstable, marginal, 100.0 * (double)known / (double)all);
}

/* A mass at rest while a hidden process goes on, or a controller that does more than usual. */
TEST(what_still_happens_at_rest_is_run)
{
    static const struct {
        const char *name;
        double rate_Hz, k_Npm, b_Nspm, noise_A, delay_s;
        struct run_setting set[2];
        unsigned faults;
    } row[] = {
        {"I2t takes current away, unfelt as yet", 20000, 5000, 30, 0.0472, 10e-3,
            {{"i_cont", 1.35}, {"peak_time", 300}}, 0},
        {"I2t lets the mass go", 2000, 5000, 30, 0.0472, 0, {{"i_cont", 1.0}, {"peak_time", 1000}},
            0},
        {"not one count for a second is a fault", 2000, 5000, 30, 0.0472, 0,
            {{"stuck_time", 1000}, {"f0", 0.107}}, EXH_FAULT_STUCK},
        {"noise adds up to a fault of tracking", 2000, 5000, 30, 0.6, 0,
            {{"track_tol", 0.1}, {"track_time", 1}}, EXH_FAULT_TRACKING},
        {"at the force limit", 2000, 5000, 0, 0.0472, 0, {{"f_max", 4.6}, {"f0", 0.107}}, 0},
    };
    for (size_t i = 0; i < LEN(row); i++) {
        struct run_cfg c = config(row[i].rate_Hz, row[i].k_Npm, row[i].b_Nspm);
        struct run r;
        uint64_t all;
        c.board.device.mon_noise_a = row[i].noise_A;
        if (row[i].delay_s > 0) { c.board.device.delay_s = row[i].delay_s; }
        c.setting = row[i].set;
        c.settings = 2;
        if (row[i].faults) { c.board.falls = 1; }
        (void)both(c, &all);
        CHECK_EQ_I64(run_drop(&c, &r), 0);
        CHECK((r.faults & row[i].faults) == row[i].faults, "%s: faults %x", row[i].name, r.faults);
        check_note("%s: %.0f %% of the ticks known", row[i].name,
            100.0 * (double)r.known / (double)r.ticks);
        run_free(&r);
    }
}

/* A count that went by and came back within the window of the velocity: the state is the same for a
 * tick, and then not. */
TEST(a_velocity_still_on_its_way_is_run)
{
    static const struct run_setting set[] = {{"vel_p", 4}, {"f0", 0}};
    uint64_t known = 0;
    for (int i = 0; i < 40; i++) {
        struct run_cfg c = config(500, 1000 + 100 * i, 0);
        uint64_t all;
        c.board.device.step_m = 480e-6;
        c.setting = set;
        c.settings = 2;
        known += both(c, &all);
    }
    CHECK(known > 20000, "%" PRIu64, known);
}

/* ---- The device alone ------------------------------------------------------------- */

static double any(struct sim_random *r, double low, double high)
{
    return low + (high - low) * sim_random_unit(r);
}

/* A mass on its string, friction near its end, currents some last digits from where they go. */
static struct sim_mass standing(struct sim_random *r)
{
    struct sim_device d = sim_device_default();
    struct sim_mass m;
    double T;
    if (sim_random_unit(r) < 0.2) { d.mon_lag_s = 0; }
    d.current_hz = any(r, 100, 5000);
    sim_mass_fall(&m, &d, sim_random_u64(r), 1, 1e-3);
    m.fall.phase = FALL_FREE;
    m.fall.contact_s = 0;
    m.fall.until_s = 1;
    T = d.mass_kg * SIM_GRAVITY * any(r, 0.85, 1.15);
    m.plant.q_m = any(r, 0, 0.1);
    m.plant.x_m = m.plant.q_m + T / d.cable_npm;
    m.ref_A = m.latched_A = T / d.kf_npa * any(r, 0.85, 1.15);
    m.plant.cur_A = m.ref_A * (1 + 2.3e-16 * (double)(int)any(r, -3, 3));
    m.plant.mon_A = m.ref_A * (1 + 2.3e-16 * (double)(int)any(r, -6, 6));
    if (sim_random_unit(r) < 0.1) { m.latched_A *= 1 + 1e-3; }
    return m;
}

TEST(what_is_called_still_does_not_move)
{
    struct sim_random r = {20261122};
    int still = 0, moved = 0;
    for (int i = 0; i < 20000; i++) {
        struct sim_mass m = standing(&r), passed = m;
        const struct plant was = m.plant;
        const double longest_s = any(&r, 5e-6, 250e-6);
        const int is = sim_mass_still(&m, longest_s);
        for (double t_s = longest_s; t_s < 40 * longest_s; t_s += longest_s * any(&r, 0, 1)) {
            sim_mass_advance(&m, t_s);
            CHECK(!is || sim_mass_pass(&passed, t_s), "%d: ended", i);
        }
        moved += memcmp(&m.plant, &was, sizeof was) != 0;
        still += is;
        if (!is) { continue; }
        CHECK(memcmp(&m.plant, &was, sizeof was) == 0, "%d: moved", i);
        CHECK(m.servo_s == passed.servo_s && m.now_s == passed.now_s && m.ref_A == passed.ref_A,
            "%d: another time", i);
        CHECK(!sim_mass_pass(&passed, 1), "%d: passed the fall's end", i);
    }
    CHECK(still > 1000 && moved > 2000, "%d still, %d moved", still, moved);
}

/* A late drive: a command on its way to the drive will move the mass at rest. */
static void one_output(uint16_t dac_raw)
{
    const struct exh_drive_out out = {.dac_raw = {dac_raw}, .enable = 1};
    struct exh_drive_in in;
    CHECK_EQ_I64(exh_board_wait(), 0);
    CHECK_EQ_I64(exh_board_read_drive(&in), 0);
    CHECK_EQ_I64(exh_board_write_drive(&out), 0);
}

TEST(an_output_on_its_way_is_waited_for)
{
    struct posix_config c = posix_config_default();
    const double weight_N = c.device.mass_kg * SIM_GRAVITY;
    const uint16_t code =
        (uint16_t)(c.device.dac_zero + c.device.dac_perA * weight_N / c.device.kf_npa);
    struct exh_period T;
    c.device.delay_s = 10e-3;
    c.from_here = 1;
    c.from_q_m = 0.01;
    c.from_x_m = c.from_q_m + weight_N / c.device.cable_npm;
    posix_configure(&c);
    CHECK_EQ_I64(exh_board_init(2000, &T), 0);
    for (int i = 0; i < 2000; i++) { one_output(code); }
    CHECK(posix_still(), "it does not stand");
    one_output((uint16_t)(code + 1));
    for (int i = 0; i < 40; i++) { /* for 20 of them it has not come */
        CHECK(!posix_still(), "%d ticks later", i);
        one_output((uint16_t)(code + 1));
    }
    for (int i = 0; i < 300; i++) { one_output((uint16_t)(code + 1)); }
    CHECK(posix_still(), "it does not stand again");
}

/* Each of these sees a tick, or puts something into it: all are run. */
static void seen(uint32_t tick, const struct exh_scene_in *in, const struct exh_drive_out *out)
{
    (void)tick, (void)in, (void)out;
}
static void given(uint32_t tick, struct exh_scene_in *in) { (void)tick, (void)in; }
static void begun(const struct exh_scene *sc, struct exh_scene_board board)
{
    (void)sc, (void)board;
}
static uint32_t in_time(uint64_t tick)
{
    (void)tick;
    return 0;
}

TEST(whoever_watches_sees_every_tick)
{
    static const struct exh_loop_hooks hooks = {begun, given, seen};
    for (int i = 0; i < 7; i++) {
        struct run_cfg c = config(500, 6000, 20);
        struct run r;
        c.board.falls = 1;
        if (i == 1) { c.more = &hooks; }
        if (i == 2) { c.scene = &exh_scene_guarded; }
        if (i == 3) { c.board.late = in_time; }
        if (i == 4) { c.board.enc_jitter_cnt = 1e-9; }
        if (i == 5) { c.board.let_go_s = 100; }
        if (i == 6) { c.board.max_ticks = 1000000; }
        CHECK_EQ_I64(run_drop(&c, &r), 0);
        CHECK((r.known == 0) == (i > 0), "%d: %" PRIu64, i, r.known);
        run_free(&r);
    }
}

TEST_MAIN("idle", what_is_not_run_is_what_running_gives, what_still_happens_at_rest_is_run,
    a_velocity_still_on_its_way_is_run, what_is_called_still_does_not_move,
    an_output_on_its_way_is_waited_for, whoever_watches_sees_every_tick);
