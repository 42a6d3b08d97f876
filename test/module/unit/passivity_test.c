/* SPDX-License-Identifier: MIT */
/* passivity.h: what is observed, when force is taken away, how contacts begin and end, refusals. */
#include "exhand/passivity.h"

#include "exhand/error.h"
#include "exhand/fix.h"
#include "exhand/units.h"

#include "check.h"

#define NEWTON EXH_Q(1, 1, EXH_Q_FORCE)
#define AMPERE EXH_Q(1, 1, EXH_Q_CUR)
#define STEP   EXH_Q(1, 10000, EXH_Q_STEP) /* 0.1 mm */
#define SPEED  EXH_Q(3, 1, EXH_Q_VEL)

/* A drive of 4 N/A, up to 6 A; f_max 20 N. A tick of 1 ms at 3 m/s is 30 counts. */
static struct rig {
    struct exh_drive_par drive_par;
    struct exh_passivity_par par;
    struct exh_knot to_cur[2], held[2];
    struct exh_drive_cfg drive;
    struct exh_passivity_cfg cfg;
    struct exh_passivity s;
    struct exh_force_ledger f;
    struct exh_period T;
} rig;

static struct exh_table held(void) { return (struct exh_table){rig.held, 2}; }

static void start(int32_t on)
{
    static const struct rig none;
    rig = none;
    rig.T = (struct exh_period){1, 1000};
    for (unsigned i = 0; i < EXH_DRIVE_ROWS; i++) {
        ((int32_t *)(void *)&rig.drive_par)[i] = exh_drive_rows[i].dflt;
    }
    rig.drive_par.f_max_N_q20 = 20 * NEWTON;
    rig.par.on = on;
    rig.to_cur[1] = (struct exh_knot){24 * NEWTON, 6 * AMPERE, {0, 0}};
    CHECK_EQ_I64(exh_table_setup(rig.to_cur, 2), 0);
    CHECK_EQ_I64(exh_table_invert(rig.held, rig.to_cur, 2), 0);
    CHECK_EQ_I64(exh_drive_setup(&rig.drive, &rig.drive_par, rig.T,
                     (struct exh_table){rig.to_cur, 2}, (struct exh_table){NULL, 0}),
        0);
}

static int setup(void)
{
    const struct exh_velocity_scale scale = {STEP, rig.T};
    return exh_passivity_setup(&rig.cfg, &rig.par, &rig.drive, held(), scale, SPEED);
}

/* A tick: at cnt the law asks for a force, in 1/8 N; what is left of it is held, with nothing lost
 * in tables and codes. Returns it, in 1/8 N. */
static int32_t tick(int32_t cnt, int touching, int32_t spring, int32_t pull)
{
    const struct exh_force_ledger none = {.force_N_q20 = 0};
    int32_t force;
    rig.f = none;
    rig.f.spring_N_q20 = (int64_t)spring * (NEWTON / 8);
    rig.f.pullback_N_q20 = pull * (NEWTON / 8);
    (void)exh_passivity_step(&rig.s, &rig.cfg, cnt, touching, &rig.f);
    force = exh_clamp(rig.f.spring_N_q20 + rig.f.pullback_N_q20 + rig.f.passivity_N_q20, 0,
        rig.drive_par.f_max_N_q20);
    rig.f.force_N_q20 = force;
    exh_passivity_update(&rig.s, &rig.cfg, &rig.f, force * (AMPERE / NEWTON / 4));
    return force / (NEWTON / 8);
}

/* Newton counts, in eighths. */
static int64_t energy(void) { return rig.s.energy_Ncnt_q20 / (NEWTON / 8); }

TEST(what_is_held_times_what_moves)
{
    start(1);
    CHECK_EQ_I64(setup(), 0);
    CHECK_EQ_I64(rig.cfg.way_cnt, 31); /* 30, and one so that none is missed */
    (void)tick(-7, 0, 0, 0);
    (void)tick(0, 1, 8, 0); /* the way in front of the wall costs nothing */
    CHECK_EQ_I64(energy(), 0);
    (void)tick(3, 1, 16, 0);
    CHECK_EQ_I64(energy(), 8 * 3);
    (void)tick(5, 1, 24, 0);
    CHECK_EQ_I64(energy(), 8 * 3 + 16 * 2);
    (void)tick(1, 1, 8, 0); /* 24 * 4 are given back: 40 are owed */
    CHECK_EQ_I64(energy(), 8 * 3 + 16 * 2 - 24 * 4);
    CHECK_EQ_I64(exh_passivity_J_q24(&rig.s, &rig.cfg), -8389); /* 5 N of 0.1 mm: 0.5 mJ */
    (void)tick(-2, 0, 0, 0);                                    /* seen to its end */
    CHECK_EQ_I64(energy(), -40 - 8 * 3);
    (void)tick(-9, 0, 0, 0);
    CHECK_EQ_I64(energy(), 0);
}

/* 20 N - owed / way: 20 N * 31 counts may be owed. */
TEST(what_is_owed_lowers_the_limit)
{
    static const struct {
        int32_t owed;        /* N counts */
        int32_t asked, left; /* N/8 */
    } row[] = {{0, 160, 160}, {0, 1000, 160}, {31, 160, 152}, {31, 152, 152}, {31, 151, 151},
        {310, 160, 80}, {310, 79, 79}, {310, 1, 1}, {589, 160, 8}, {620, 160, 0}, {621, 160, 0},
        {99999, 160, 0}, {-31, 160, 160}};
    start(1);
    CHECK_EQ_I64(setup(), 0);
    for (size_t i = 0; i < LEN(row); i++) {
        int32_t left;
        rig.s = (struct exh_passivity){.energy_Ncnt_q20 = -(int64_t)row[i].owed * NEWTON,
            .held_N_q20 = 0,
            .touching = 1,
            .started = 1};
        (void)tick(0, 1, row[i].asked, 0);
        /* Never above; below by no more than 3 LSB. */
        left = (int32_t)exh_clamp(rig.f.spring_N_q20 + rig.f.passivity_N_q20, 0, 20 * NEWTON);
        CHECK(left <= row[i].left * (NEWTON / 8) && left > row[i].left * (NEWTON / 8) - 4,
            "row %zu: %" PRId32, i, left);
    }
}

TEST(the_bit_says_when_and_the_term_what)
{
    start(1);
    CHECK_EQ_I64(setup(), 0);
    rig.s = (struct exh_passivity){
        .energy_Ncnt_q20 = -(int64_t)310 * NEWTON, .touching = 1, .started = 1};
    rig.f.spring_N_q20 = 12 * NEWTON;
    rig.f.damper_N_q20 = -1 * NEWTON;
    rig.f.pullback_N_q20 = 5 * NEWTON; /* no part in it */
    CHECK_EQ_I64(exh_passivity_step(&rig.s, &rig.cfg, 0, 1, &rig.f), EXH_LIMIT_PASSIVITY);
    CHECK(rig.f.passivity_N_q20 <= -NEWTON && rig.f.passivity_N_q20 > -NEWTON - 4, "%" PRId64,
        rig.f.passivity_N_q20);
    rig.f.passivity_N_q20 = 0;
    rig.f.damper_N_q20 = -2 * NEWTON - 4;
    CHECK_EQ_I64(exh_passivity_step(&rig.s, &rig.cfg, 0, 1, &rig.f), 0);
    CHECK_EQ_I64(rig.f.passivity_N_q20, 0);
    rig.f.damper_N_q20 = 0;
    rig.par.on = 0; /* observes */
    CHECK_EQ_I64(exh_passivity_step(&rig.s, &rig.cfg, 0, 1, &rig.f), 0);
    CHECK_EQ_I64(rig.f.passivity_N_q20, 0);
    CHECK_EQ_I64(rig.s.energy_Ncnt_q20, -(int64_t)310 * NEWTON);
}

TEST(the_pull_back_is_not_the_contacts)
{
    start(1);
    CHECK_EQ_I64(setup(), 0);
    (void)tick(0, 1, 8, 4);
    CHECK_EQ_I64(rig.s.held_N_q20, NEWTON);
    (void)tick(10, 1, -2, 4); /* less than the pull-back is no force of the contact */
    CHECK_EQ_I64(energy(), 80);
    CHECK_EQ_I64(rig.s.held_N_q20, 0);
    (void)tick(-10, 1, 0, 4);
    CHECK_EQ_I64(energy(), 80);
    /* Half a code above the command still counts as the pull-back's. */
    exh_passivity_update(&rig.s, &rig.cfg, &rig.f, AMPERE);
    CHECK_EQ_I64(rig.s.held_N_q20, 0);
    /* Less than commanded, by any later limit. */
    rig.f.force_N_q20 = 9 * NEWTON;
    exh_passivity_update(&rig.s, &rig.cfg, &rig.f, AMPERE / 4);
    CHECK_EQ_I64(rig.s.held_N_q20, NEWTON / 2);
    exh_passivity_update(&rig.s, &rig.cfg, &rig.f, 0);
    CHECK_EQ_I64(rig.s.held_N_q20, 0);
}

/* Energy that went in is not lent to the next contact, nor is a debt. */
TEST(contacts_are_reckoned_one_by_one)
{
    start(1);
    CHECK_EQ_I64(setup(), 0);
    (void)tick(0, 1, 8, 0);
    (void)tick(10, 1, 0, 0); /* no force, but contact: kept */
    CHECK_EQ_I64(energy(), 80);
    (void)tick(12, 1, 8, 0);
    CHECK_EQ_I64(energy(), 80);
    (void)tick(10, 0, 0, 0); /* over, the last force was held up to here */
    CHECK_EQ_I64(energy(), 80 - 16);
    (void)tick(12, 1, 8, 0); /* a tick without was between: a new one */
    CHECK_EQ_I64(energy(), 0);
    (void)tick(2, 1, 8, 0);
    CHECK_EQ_I64(energy(), -80);
    (void)tick(2, 0, 8, 0); /* out of contact, but force: not over */
    CHECK_EQ_I64(energy(), -80);
    (void)tick(2, 0, 0, 0);
    (void)tick(2, 0, 0, 0);
    CHECK_EQ_I64(energy(), 0);
}

/* With outputs up to a tick late the worse of two forces counts, both ways. */
TEST(late_outputs_count_for_the_worse)
{
    start(2);
    CHECK_EQ_I64(setup(), 0);
    (void)tick(0, 1, 8, 0);
    (void)tick(10, 1, 24, 0); /* 8 may not have been there yet */
    CHECK_EQ_I64(energy(), 0);
    (void)tick(20, 1, 16, 0); /* 8 may still have been */
    CHECK_EQ_I64(energy(), 80);
    (void)tick(15, 1, 0, 0); /* going back, 24 may */
    CHECK_EQ_I64(energy(), 80 - 120);
    (void)tick(12, 0, 0, 0); /* nothing held, 16 may still act */
    CHECK_EQ_I64(energy(), 80 - 120 - 48);
    (void)tick(14, 1, 8, 0);
    CHECK_EQ_I64(energy(), 0); /* one tick without a force at all */
    (void)tick(24, 1, 8, 0);
    (void)tick(34, 1, 0, 0);
    CHECK_EQ_I64(energy(), 80);
    rig.s.energy_Ncnt_q20 = 5 * NEWTON;
    rig.s.late_N_q20 = NEWTON;
    rig.s.touching = 0;
    (void)tick(34, 1, 0, 0); /* a credit goes where a debt stays */
    CHECK_EQ_I64(energy(), 0);
    rig.s.energy_Ncnt_q20 = -5 * NEWTON;
    rig.s.late_N_q20 = NEWTON;
    rig.s.touching = 0;
    (void)tick(34, 1, 0, 0);
    CHECK_EQ_I64(energy(), -40);
}

TEST(counts_wrap)
{
    start(1);
    CHECK_EQ_I64(setup(), 0);
    (void)tick(INT32_MAX - 1, 1, 8, 0);
    (void)tick(INT32_MIN + 1, 1, 8, 0);
    CHECK_EQ_I64(energy(), 24);
}

TEST(what_cannot_be_proved_is_refused)
{
    const struct exh_velocity_scale scale = {STEP, {1, 1000}};
    start(1);
    CHECK_EQ_I64(setup(), 0);
#define SETUP(table, scale, speed) \
    exh_passivity_setup(&rig.cfg, &rig.par, &rig.drive, table, scale, speed)
    CHECK_EQ_I64(SETUP(held(), ((struct exh_velocity_scale){0, {1, 1000}}), SPEED), -EXH_E_RANGE);
    CHECK_EQ_I64(SETUP(held(), ((struct exh_velocity_scale){STEP, {0, 1000}}), SPEED), -EXH_E_RATE);
    CHECK_EQ_I64(SETUP(held(), ((struct exh_velocity_scale){STEP, {1, 0}}), SPEED), -EXH_E_RATE);
    CHECK_EQ_I64(
        SETUP(held(), ((struct exh_velocity_scale){STEP, {1, 30000}}), SPEED), -EXH_E_RATE);
    CHECK_EQ_I64(SETUP(held(), scale, EXH_Q(1, 10, EXH_Q_VEL) - 1), -EXH_E_RANGE);
    CHECK_EQ_I64(SETUP(held(), scale, EXH_Q(1, 10, EXH_Q_VEL)), 0);
    CHECK_EQ_I64(SETUP(((struct exh_table){NULL, 0}), scale, SPEED), -EXH_E_RANGE);
    CHECK_EQ_I64(SETUP(held(), ((struct exh_velocity_scale){1, {1, 1}}), SPEED), -EXH_E_RANGE);
    /* 10 m/s at 1 Hz and 1 um: inside. 0.5 um: not. */
    CHECK_EQ_I64(SETUP(held(), ((struct exh_velocity_scale){EXH_Q(1, 1000000, 42), {1, 1}}),
                     EXH_Q(10, 1, EXH_Q_VEL)),
        0);
    CHECK_EQ_I64(SETUP(held(), ((struct exh_velocity_scale){EXH_Q(1, 2000000, 42), {1, 1}}),
                     EXH_Q(10, 1, EXH_Q_VEL)),
        -EXH_E_RANGE);
    /* A count a tick is 2^-27 m/s: the longest way, and one count more. */
    CHECK_EQ_I64(SETUP(held(), ((struct exh_velocity_scale){1 << 15, {1, 1}}), (1 << 24) - 1), 0);
    CHECK_EQ_I64(rig.cfg.way_cnt, 1 << 24);
    CHECK_EQ_I64(
        SETUP(held(), ((struct exh_velocity_scale){1 << 15, {1, 1}}), 1 << 24), -EXH_E_RANGE);
    rig.held[0].y = 1; /* a force without a current */
    CHECK_EQ_I64(exh_table_setup(rig.held, 2), 0);
    CHECK_EQ_I64(setup(), -EXH_E_RANGE);
#undef SETUP
}

/* 24 N, what the table ends at, in one tick of 1 ms; 20 kHz needs 480 kN/s. */
TEST(force_has_to_be_able_to_fall_in_one_tick)
{
    start(1);
    rig.drive_par.slew_down_Nps = 24000;
    CHECK_EQ_I64(setup(), 0);
    rig.drive_par.slew_down_Nps = 23999;
    CHECK_EQ_I64(setup(), -EXH_E_RANGE);
}

TEST(bytes_come_back)
{
    uint8_t buf[64];
    struct exh_passivity s = {-123456789012345, 7, 8, -9, 1, 1}, t = {0, 0, 0, 0, 0, 0};
    struct exh_bytes c = exh_bytes_writer(buf, sizeof buf);
    exh_passivity_serialize(&c, &s);
    CHECK_EQ_I64((int64_t)c.at, 22);
    c = exh_bytes_reader(buf, c.at);
    exh_passivity_serialize(&c, &t);
    CHECK(s.energy_Ncnt_q20 == t.energy_Ncnt_q20 && t.held_N_q20 == 7 && t.late_N_q20 == 8 &&
              t.cnt == -9 && t.touching == 1 && t.started == 1,
        "%" PRId64, t.energy_Ncnt_q20);
}

/* For any bytes, later steps do not overflow (the sanitizers check). */
TEST(damaged_bytes_do_no_harm)
{
    static const uint8_t fill[] = {0x00, 0x7F, 0x80, 0xFF};
    start(2);
    CHECK_EQ_I64(setup(), 0);
    for (size_t i = 0; i < LEN(fill); i++) {
        for (size_t top = 0; top < LEN(fill); top++) {
            uint8_t buf[22];
            struct exh_bytes c = exh_bytes_reader(buf, sizeof buf);
            (void)memset(buf, fill[i], sizeof buf);
            buf[7] = buf[11] = buf[15] = fill[top];
            exh_passivity_serialize(&c, &rig.s);
            CHECK(rig.s.held_N_q20 >= 0 && rig.s.late_N_q20 >= 0 && rig.s.touching <= 1, "%zu", i);
            for (int32_t k = 0; k < 40; k++) {
                (void)tick(k & 1 ? INT32_MIN : 0, (k & 4) != 0, INT32_MAX, 0);
                (void)exh_passivity_J_q24(&rig.s, &rig.cfg);
            }
        }
    }
}

/* For a table beyond the highest f_max, f_max is the force that must be able to fall. */
TEST(what_has_to_fall_is_no_more_than_the_highest_limit)
{
    start(1);
    rig.to_cur[1] = (struct exh_knot){200 * NEWTON, 6 * AMPERE, {0, 0}};
    CHECK_EQ_I64(exh_table_setup(rig.to_cur, 2), 0);
    rig.drive_par.person_N_q20 = 100 * NEWTON;
    rig.drive_par.slew_down_Nps = 100001; /* of a tick of 1 ms, rounded: 100 N */
    CHECK_EQ_I64(exh_drive_setup(&rig.drive, &rig.drive_par, rig.T,
                     (struct exh_table){rig.to_cur, 2}, (struct exh_table){NULL, 0}),
        0);
    CHECK_EQ_I64(setup(), 0);
    rig.drive_par.slew_down_Nps = 99999;
    CHECK_EQ_I64(setup(), -EXH_E_RANGE);
}

/* The last LSB of a contact's energy goes with it; before the first tick nothing has moved. */
TEST(the_least_energy_is_forgotten_and_the_first_tick_moves_nothing)
{
    struct exh_force_ledger f = {.force_N_q20 = 0};
    start(2);
    CHECK_EQ_I64(setup(), 0);
    rig.s = (struct exh_passivity){.energy_Ncnt_q20 = 1, .late_N_q20 = 5, .started = 1};
    (void)exh_passivity_step(&rig.s, &rig.cfg, 0, 0, &f);
    CHECK_EQ_I64(rig.s.energy_Ncnt_q20, 0);
    rig.s = (struct exh_passivity){.energy_Ncnt_q20 = -1, .late_N_q20 = 5, .started = 1};
    (void)exh_passivity_step(&rig.s, &rig.cfg, 0, 0, &f);
    CHECK_EQ_I64(rig.s.energy_Ncnt_q20, -1);
    rig.s = (struct exh_passivity){.held_N_q20 = 7, .late_N_q20 = 5, .cnt = 1000};
    (void)exh_passivity_step(&rig.s, &rig.cfg, 3, 1, &f);
    CHECK_EQ_I64(rig.s.energy_Ncnt_q20, 0);
}

/* Energies end at 2^60; a way of so few counts that nothing has to be shifted. */
TEST(energies_and_ways_at_their_ends)
{
    static const int64_t row[][2] = {{INT64_C(1) << 60, INT64_C(1) << 60},
        {(INT64_C(1) << 60) + 1, INT64_C(1) << 60}, {INT64_MIN, -(INT64_C(1) << 60)},
        {INT64_MAX, INT64_C(1) << 60}};
    const struct exh_velocity_scale scale = {INT32_MAX, {1, 20000}};
    for (size_t i = 0; i < LEN(row); i++) {
        struct exh_passivity s = {.energy_Ncnt_q20 = row[i][0]};
        uint8_t buf[32];
        struct exh_bytes c = exh_bytes_writer(buf, sizeof buf);
        exh_bytes_i64(&c, &s.energy_Ncnt_q20);
        memset(buf + 8, 0, sizeof buf - 8);
        c = exh_bytes_reader(buf, sizeof buf);
        exh_passivity_serialize(&c, &s);
        CHECK(s.energy_Ncnt_q20 == row[i][1], "row %zu", i);
    }
    start(1);
    rig.T = scale.T;
    rig.drive_par.slew_down_Nps = 10000000;
    CHECK_EQ_I64(exh_drive_setup(&rig.drive, &rig.drive_par, rig.T,
                     (struct exh_table){rig.to_cur, 2}, (struct exh_table){NULL, 0}),
        0);
    CHECK_EQ_I64(exh_passivity_setup(&rig.cfg, &rig.par, &rig.drive, held(), scale, SPEED), 0);
    CHECK(rig.cfg.way_cnt == 1 && rig.cfg.shift == 0, "way %" PRId32 ", shift %d", rig.cfg.way_cnt,
        rig.cfg.shift);
}

/* A table of one knot is none, and nothing of an earlier set-up stays. */
TEST(set_up_anew)
{
    struct exh_velocity_scale scale;
    struct exh_passivity_cfg first;
    start(1);
    scale = (struct exh_velocity_scale){STEP, rig.T};
    for (uint8_t n = 0; n < 2; n++) {
        const struct exh_table few = {rig.held, n};
        CHECK_EQ_I64(
            exh_passivity_setup(&rig.cfg, &rig.par, &rig.drive, few, scale, SPEED), -EXH_E_RANGE);
    }
    CHECK_EQ_I64(setup(), 0);
    first = rig.cfg;
    memset(&rig.cfg, 0x0F, sizeof rig.cfg);
    CHECK_EQ_I64(setup(), 0);
    CHECK(rig.cfg.shift == first.shift && rig.cfg.way_cnt == first.way_cnt &&
              rig.cfg.share.mant == first.share.mant && rig.cfg.share.shift == first.share.shift,
        "shift %d", rig.cfg.shift);
}

TEST_MAIN("passivity", what_is_held_times_what_moves, what_is_owed_lowers_the_limit,
    the_bit_says_when_and_the_term_what, the_pull_back_is_not_the_contacts,
    contacts_are_reckoned_one_by_one, late_outputs_count_for_the_worse, counts_wrap,
    what_cannot_be_proved_is_refused, force_has_to_be_able_to_fall_in_one_tick, bytes_come_back,
    damaged_bytes_do_no_harm, what_has_to_fall_is_no_more_than_the_highest_limit,
    the_least_energy_is_forgotten_and_the_first_tick_moves_nothing, energies_and_ways_at_their_ends,
    set_up_anew);
