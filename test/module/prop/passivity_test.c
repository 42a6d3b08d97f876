/* SPDX-License-Identifier: MIT */
/* passivity.h: the energy that a contact has given out is within the bound at any moment, for any
 * commands of the law and any motion within the speed limit. The worst trajectory reaches the
 * bound, and exceeds it without the controller. */
#include "exhand/passivity.h"

#include "exhand/fix.h"
#include "exhand/units.h"

#include "check.h"

#define TICKS  300
#define NEWTON EXH_Q(1, 1, EXH_Q_FORCE)

static struct rig {
    struct exh_drive_par drive_par;
    struct exh_passivity_par par;
    struct exh_knot to_cur[4], held[4];
    struct exh_drive_cfg drive;
    struct exh_passivity_cfg cfg;
    struct exh_passivity s;
    int64_t bound; /* way * the greatest force held, N counts q20 */
} rig;

/* The code nearest to the current for a force, and the current of that code. */
static int32_t coded(int32_t force_N_q20)
{
    const int32_t asked = exh_table_at(rig.drive.force_to_cur, force_N_q20);
    const int64_t code = exh_mul_shr(asked, rig.drive_par.dac_rawpA_q16, EXH_Q_CUR + EXH_Q_DAC);
    return exh_sat32(exh_gain_mul(rig.drive.dac_A_q26, exh_clamp(code, -32767, 32767)));
}

static int32_t most(void)
{
    return rig.drive_par.f_max_N_q20 < rig.drive.f_top_N_q20 ? rig.drive_par.f_max_N_q20
                                                             : rig.drive.f_top_N_q20;
}

/* By how much more than commanded a code may hold: half a code on the steepest part of the table,
 * and 4 LSB of force. */
static int64_t half_a_code(void)
{
    int64_t steepest = 0;
    for (int i = 0; i < 3; i++) {
        const int64_t dN = rig.held[i + 1].y - rig.held[i].y;
        const int64_t dA = rig.held[i + 1].x - rig.held[i].x;
        const int64_t code_A = ((INT64_C(1) << 42) / rig.drive_par.dac_rawpA_q16 + 1) / 2 + 3;
        const int64_t by = (code_A * dN + dA - 1) / dA;
        if (by > steepest) { steepest = by; }
    }
    return steepest + 4;
}

static void defaults(int32_t on)
{
    static const struct rig none;
    rig = none;
    for (unsigned i = 0; i < EXH_DRIVE_ROWS; i++) {
        ((int32_t *)(void *)&rig.drive_par)[i] = exh_drive_rows[i].dflt;
    }
    rig.par.on = on;
}

/* A drive of four knots, any encoder, any rate, any speed limit. 0 if set-up refuses it. */
static int any_rig(int32_t on)
{
    struct exh_velocity_scale scale;
    defaults(on);
    rig.drive_par.f_max_N_q20 = check_i32_in(0, 100 * NEWTON);
    rig.drive_par.slew_down_Nps = 10000000;
    rig.drive_par.dac_rawpA_q16 = check_i32_in(EXH_Q(100, 1, 16), EXH_Q(2700, 1, 16));
    for (int i = 1; i < 4; i++) {
        rig.to_cur[i].x = rig.to_cur[i - 1].x + check_i32_in(NEWTON, 30 * NEWTON);
        rig.to_cur[i].y = rig.to_cur[i - 1].y + check_i32_in(1 << 26, 1 << 28);
    }
    scale.step_m_q42 = check_i32_in(EXH_Q(1, 1000000, EXH_Q_STEP), INT32_MAX);
    scale.T = (struct exh_period){1, 1u + (uint32_t)check_i32_in(0, 19999)};
    if (exh_table_setup(rig.to_cur, 4) < 0 || exh_table_invert(rig.held, rig.to_cur, 4) < 0 ||
        exh_drive_setup(&rig.drive, &rig.drive_par, scale.T, (struct exh_table){rig.to_cur, 4},
            (struct exh_table){NULL, 0}) < 0 ||
        exh_passivity_setup(&rig.cfg, &rig.par, &rig.drive, (struct exh_table){rig.held, 4}, scale,
            check_i32_in(EXH_Q(1, 10, EXH_Q_VEL), EXH_Q(10, 1, EXH_Q_VEL))) < 0) {
        return 0;
    }
    rig.bound = rig.cfg.way_cnt * (most() + half_a_code());
    return 1;
}

/* One tick of the chain. Returns the contact's force that is held from here on. */
static int32_t tick(int32_t cnt, int touching, int64_t spring, int64_t damper, int32_t pull)
{
    struct exh_force_ledger f = {
        .spring_N_q20 = spring, .damper_N_q20 = damper, .pullback_N_q20 = pull};
    const uint32_t bit = exh_passivity_step(&rig.s, &rig.cfg, cnt, touching, &f);
    CHECK((bit == EXH_LIMIT_PASSIVITY) == (f.passivity_N_q20 < 0) && f.passivity_N_q20 <= 0,
        "%" PRId64, f.passivity_N_q20);
    f.force_N_q20 = exh_clamp(spring + damper + pull + f.passivity_N_q20, 0, most());
    exh_passivity_update(&rig.s, &rig.cfg, &f, coded(f.force_N_q20));
    return rig.s.held_N_q20;
}

/* What a law may ask for: nothing, everything, more than everything, something. */
static int64_t any_force(void)
{
    const uint64_t how = check_u64() % 8;
    if (how < 2) { return 0; }
    if (how < 4) { return most(); }
    if (how < 5) { return check_i64() >> 20; }
    return check_i32_in(-NEWTON, 100 * NEWTON);
}

static int32_t any_move(void)
{
    const uint64_t how = check_u64() % 8;
    if (how < 2) { return -rig.cfg.way_cnt; }
    if (how < 3) { return rig.cfg.way_cnt; }
    if (how < 4) { return 0; }
    return check_i32_in(-rig.cfg.way_cnt, rig.cfg.way_cnt);
}

/* Energy that flowed, computed again from the forces held. In time, or late by `late` 16ths of a
 * tick, where any share of the string's way falls to either force. Both times 16. */
struct flow {
    int64_t in_time, late;
    int32_t held, before;
};

static void flow(struct flow *e, int32_t moved, int32_t late_16)
{
    e->in_time += (int64_t)e->held * moved * 16;
    e->late += ((int64_t)e->before * late_16 + (int64_t)e->held * (16 - late_16)) * moved;
}

static void contact_begins(struct flow *e, int quiet)
{
    if (quiet && e->held == 0) {
        e->in_time = 0;
        if (e->before == 0) { e->late = 0; }
    }
}

/* Any law, any movement. */
TEST(no_contact_gives_out_more_than_the_bound)
{
    while (check_case(2000)) {
        const int32_t on = 1 + (int32_t)(check_u64() & 1);
        struct flow e = {0, 0, 0, 0};
        int32_t cnt = check_i32();
        int touching = 0;
        if (!any_rig(on)) { continue; }
        (void)tick(cnt, 0, 0, 0, 0);
        for (int k = 0; k < TICKS; k++) {
            const int32_t moved = any_move();
            const int touched = touching;
            const int32_t pull = check_u64() & 1 ? NEWTON : 0;
            touching = check_u64() % 32 ? touching : !touching;
            cnt = exh_wrap_add(cnt, moved);
            flow(&e, moved, (int32_t)(check_u64() % 17));
            CHECK(-e.in_time <= 16 * rig.bound, "tick %d: %" PRId64 " of %" PRId64, k,
                e.in_time / 16, rig.bound);
            CHECK(on == 1 || -e.late <= 32 * rig.bound, "tick %d, late: %" PRId64 " of %" PRId64, k,
                e.late / 16, rig.bound);
            contact_begins(&e, !(touching && touched));
            e.before = e.held;
            e.held = tick(
                cnt, touching, touching ? any_force() : 0, touching ? any_force() / 4 : 0, pull);
            CHECK(on == 2 || rig.s.energy_Ncnt_q20 * 16 == e.in_time, "tick %d: %" PRId64, k,
                rig.s.energy_Ncnt_q20);
            CHECK(rig.s.energy_Ncnt_q20 * 16 <= e.in_time, "tick %d", k);
        }
    }
}

/* The worst case: in a tick a stiff spring reaches its whole force. It is met at the speed limit,
 * then the string moves back and forth. The energy reaches the bound within 1 % and never passes
 * it. Without the controller each turn gives as much again. */
static int64_t worst_given_out(int32_t on, int turns)
{
    const int32_t way = rig.cfg.way_cnt;
    int64_t given = 0;
    int32_t held, cnt = 0;
    rig.par.on = on;
    rig.s = (struct exh_passivity){0, 0, 0, 0, 0, 0};
    (void)tick(-way, 0, 0, 0, 0);
    held = tick(0, 1, 0, 0, 0);
    for (int k = 0; k < turns; k++) {
        given -= (int64_t)held * way; /* in: nothing yet, on the way back the whole force */
        cnt += way;
        held = tick(cnt, 1, most(), 0, 0);
        given += (int64_t)held * way;
        cnt -= way;
        held = tick(cnt, 1, 0, 0, 0);
    }
    return given;
}

TEST(the_worst_turn_comes_up_to_it)
{
    while (check_case(1000)) {
        int64_t with, without;
        if (!any_rig(1) || most() < 50 * half_a_code()) { continue; }
        with = worst_given_out(1, 8);
        without = worst_given_out(0, 8);
        CHECK(with <= rig.bound, "%" PRId64 " of %" PRId64, with, rig.bound);
        /* But for the two half codes by which a force held may differ. */
        CHECK(100 * with >= 99 * (rig.bound - 2 * half_a_code() * rig.cfg.way_cnt),
            "%" PRId64 " of %" PRId64, with, rig.bound);
        CHECK(without >= 7 * with, "%" PRId64 ", with it %" PRId64, without, with);
    }
}

/* Late outputs: two ticks' work, when the force held stays on through the next tick. */
TEST(late_outputs_come_up_to_twice_that)
{
    while (check_case(1000)) {
        int64_t given = 0;
        int32_t held[2];
        if (!any_rig(2) || most() < 50 * half_a_code()) { continue; }
        (void)tick(0, 0, 0, 0, 0);
        (void)tick(0, 1, most(), 0, 0);
        held[0] = tick(0, 1, most(), 0, 0);
        given += (int64_t)held[0] * rig.cfg.way_cnt;
        held[1] = tick(-rig.cfg.way_cnt, 1, most(), 0, 0);
        /* What the code held less than was commanded may still come. */
        CHECK(held[1] <= 2 * half_a_code(), "%" PRId32, held[1]);
        given += (int64_t)held[0] * rig.cfg.way_cnt; /* late by the whole tick */
        (void)tick(-2 * rig.cfg.way_cnt, 1, most(), 0, 0);
        CHECK_EQ_I64(-rig.s.energy_Ncnt_q20, given);
        CHECK(given <= 2 * rig.bound, "%" PRId64 " of %" PRId64, given, rig.bound);
        CHECK(100 * given >= 198 * (rig.bound - 2 * half_a_code() * rig.cfg.way_cnt),
            "%" PRId64 " of %" PRId64, given, rig.bound);
    }
}

/* The limit, against its definition: 0..3 LSB below f_max - owed / way, and 0 where that is less.
 */
TEST(the_limit_is_never_above_and_hardly_below)
{
    while (check_case(100)) {
        struct exh_force_ledger f = {.spring_N_q20 = INT32_MAX};
        int64_t owed, limit, exact; /* times way */
        if (!any_rig(1)) { continue; }
        owed = check_u64() & 1 ? (int64_t)(check_u64() % (uint64_t)(rig.bound + 2)) + 1
                               : (int64_t)(check_u64() >> 4) + 1;
        rig.s = (struct exh_passivity){-owed, 0, 0, 0, 1, 1};
        (void)exh_passivity_step(&rig.s, &rig.cfg, 0, 1, &f);
        limit = INT32_MAX + f.passivity_N_q20;
        exact = (int64_t)most() * rig.cfg.way_cnt - owed;
        CHECK(limit >= 0 && (limit == 0 || limit * rig.cfg.way_cnt <= exact), "%" PRId64, limit);
        CHECK((limit + 3) * rig.cfg.way_cnt >= exact, "%" PRId64 ", exact %" PRId64, limit, exact);
    }
}

/* m consecutive missed ticks make the bound m + 1 times as large, once. */
TEST(missed_ticks_count_for_ticks)
{
    while (check_case(4000)) {
        struct flow e = {0, 0, 0, 0};
        int32_t cnt = 0;
        const int32_t m = (int32_t)(check_u64() % 3);
        if (!any_rig(1)) { continue; }
        (void)tick(cnt, 0, 0, 0, 0);
        for (int k = 0; k < TICKS; k++) {
            const int32_t n = check_u64() % 8 ? 1 : 1 + m;
            const int32_t moved = check_u64() & 1 ? -n * rig.cfg.way_cnt : n * any_move();
            cnt = exh_wrap_add(cnt, moved);
            flow(&e, moved, 0);
            CHECK(-e.in_time <= 16 * (m + 1) * rig.bound, "tick %d: %" PRId64, k, e.in_time);
            e.held = tick(cnt, 1, any_force(), 0, 0);
        }
    }
}

/* Every state of a small drive, with f_max of 24 LSB and a travel of 3 counts. From each state that
 * keeps the invariant of docs/NUMERICS.md, each step leads to another one that does, for any
 * motion, contact and command. on = 2; on = 1 is the same with late = held and half the bound. */
#define SMALL 24
#define WAY   3
#define BOUND (SMALL * WAY)

static int may_be(const struct exh_passivity *s, int on)
{
    const int64_t e = s->energy_Ncnt_q20, debt = e < 0 ? e : 0;
    const int32_t worst = s->held_N_q20 > s->late_N_q20 ? s->held_N_q20 : s->late_N_q20;
    const int64_t next = BOUND + debt > 0 ? BOUND + debt : 0;
    return s->held_N_q20 * WAY <= next && s->late_N_q20 <= SMALL &&
           (on == 2 || s->late_N_q20 == s->held_N_q20) && e >= -on * BOUND &&
           e - (int64_t)worst * WAY >= -on * BOUND;
}

static void small_rig(int on)
{
    const struct exh_velocity_scale scale = {EXH_Q(5, 100000, EXH_Q_STEP), {1, 1000}};
    defaults(on);
    rig.drive_par.f_max_N_q20 = SMALL;
    for (int i = 0; i < 4; i++) { rig.to_cur[i].x = rig.to_cur[i].y = i << 24; } /* 1 to 1 */
    CHECK_EQ_I64(exh_table_setup(rig.to_cur, 4), 0);
    CHECK_EQ_I64(exh_table_invert(rig.held, rig.to_cur, 4), 0);
    CHECK_EQ_I64(exh_drive_setup(&rig.drive, &rig.drive_par, scale.T,
                     (struct exh_table){rig.to_cur, 4}, (struct exh_table){NULL, 0}),
        0);
    CHECK_EQ_I64(exh_passivity_setup(&rig.cfg, &rig.par, &rig.drive,
                     (struct exh_table){rig.held, 4}, scale, EXH_Q(1, 10, EXH_Q_VEL)),
        0);
    CHECK_EQ_I64(rig.cfg.way_cnt, WAY);
}

/* One step from s; the state behind it may be again. 1 if the bound was come up to. */
static int small_step(const struct exh_passivity *s, int moved, int touching, int32_t asked)
{
    struct exh_force_ledger f = {.spring_N_q20 = asked};
    rig.s = *s;
    (void)exh_passivity_step(&rig.s, &rig.cfg, moved, touching, &f);
    f.force_N_q20 = exh_clamp(asked + f.passivity_N_q20, 0, SMALL);
    exh_passivity_update(&rig.s, &rig.cfg, &f, f.force_N_q20);
    if (!may_be(&rig.s, rig.par.on)) {
        CHECK(0,
            "on %d: e %" PRId64 ", held %" PRId32 ", late %" PRId32 ", moved %d, asked %" PRId32,
            (int)rig.par.on, s->energy_Ncnt_q20, s->held_N_q20, s->late_N_q20, moved, asked);
    }
    return rig.s.energy_Ncnt_q20 == -rig.par.on * BOUND;
}

static uint32_t small_states(int on, int touched, uint32_t *attained)
{
    uint32_t n = 0;
    struct exh_passivity s = {0, 0, 0, 0, (uint8_t)touched, 1};
    for (s.energy_Ncnt_q20 = -on * BOUND; s.energy_Ncnt_q20 <= 40; s.energy_Ncnt_q20++) {
        for (s.held_N_q20 = 0; s.held_N_q20 <= SMALL; s.held_N_q20++) {
            for (s.late_N_q20 = 0; s.late_N_q20 <= SMALL; s.late_N_q20++) {
                if (!may_be(&s, on)) { continue; }
                for (int moved = -WAY; moved <= WAY; moved++) {
                    for (int asked = 0; asked < 12; asked++, n++) {
                        *attained +=
                            (uint32_t)small_step(&s, moved, asked & 1, asked < 2 ? 0 : asked * 3);
                    }
                }
            }
        }
    }
    return n;
}

TEST(every_small_state_keeps_the_bound)
{
    uint32_t n = 0, attained = 0;
    for (int on = 1; on <= 2; on++) {
        uint32_t here = 0;
        small_rig(on);
        n += small_states(on, 0, &here) + small_states(on, 1, &here);
        CHECK(here > 0, "on %d: nothing comes up to the bound", on);
        attained += here;
    }
    check_note("%" PRIu32 " steps from every state of a small drive; %" PRIu32
               " end at the bound, none beyond",
        n, attained);
}

TEST_MAIN("passivity", no_contact_gives_out_more_than_the_bound, the_worst_turn_comes_up_to_it,
    late_outputs_come_up_to_twice_that, the_limit_is_never_above_and_hardly_below,
    missed_ticks_count_for_ticks, every_small_state_keeps_the_bound);
