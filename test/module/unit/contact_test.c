/* SPDX-License-Identifier: MIT */
/* contact.h: truth table of the law, edge of the contact, hysteresis, and the
 * pull-back force that must not chatter. */
#include "exhand/contact.h"

#include "exhand/units.h"

#include "check.h"

static const struct exh_contact_par par_20k = {
    .k_Npm_q10 = EXH_Q(20000, 1, EXH_Q_K),
    .b_Nspm_q20 = EXH_Q(60, 1, EXH_Q_B),
    .f0_N_q20 = EXH_Q(1, 2, EXH_Q_FORCE),
    .f0_band_m_q30 = 1000,
    .hyst_m_q30 = 500,
};

/* eq. 1: contact or not, F0 or not. Stiffness and damping act in contact alone,
 * the pull-back in its own state, whatever the other does. */
TEST(truth_table)
{
    static const struct {
        int touching, inward;
        int64_t spring, damper, pullback;
    } row[] = {
        {0, 0, 0, 0, 0},
        {0, 1, 0, 0, 524288},
        {1, 0, 20971523, 6291456, 0},
        {1, 1, 20971523, 6291456, 524288},
    };
    for (size_t i = 0; i < LEN(row); i++) {
        const int32_t lim = 1 << 28;
        const int32_t depth = row[i].touching ? 1073742 /* 1 mm */ : -10000000;
        struct exh_contact s = {lim + depth, (uint8_t)row[i].inward, 0, 1};
        struct exh_force_ledger f;
        const struct exh_contact_in in = {lim + depth, EXH_Q(1, 10, EXH_Q_VEL), lim};
        CHECK_EQ_I64(exh_contact_step(&s, &par_20k, in, &f), row[i].touching);
        CHECK_EQ_I64(f.spring_N_q20, row[i].spring); /* 20 N and the rounding of 1 mm */
        CHECK_EQ_I64(f.damper_N_q20, row[i].damper); /* 6 N */
        CHECK_EQ_I64(f.pullback_N_q20, row[i].pullback);
    }
}

TEST(the_rest_of_the_ledger_is_of_others)
{
    struct exh_contact s = {0};
    struct exh_force_ledger f = {1, 2, 3, 4, 5, 6, 7, 8};
    (void)exh_contact_step(&s, &par_20k, (struct exh_contact_in){0, 0, 1}, &f);
    CHECK(f.spring_N_q20 == 0 && f.damper_N_q20 == 0, "terms without contact");
    CHECK(f.pullback_N_q20 == 0 && f.passivity_N_q20 == 0, "pull-back, passivity");
    CHECK(f.clamp_N_q20 == 5 && f.slew_N_q20 == 6 && f.release_N_q20 == 7, "what the drive makes");
    CHECK(f.force_N_q20 == 8, "force");
}

/* c = 1 at q >= q_lim, one LSB decides; 0 again below q_lim - hyst only. */
TEST(contact_boundary_and_hysteresis)
{
    static const struct {
        int32_t past;
        int touching;
    } row[] = {{-600, 0}, {-500, 0}, {-1, 0}, {0, 1}, {1, 1}, {-1, 1}, {-499, 1}, {-500, 1},
        {-501, 0}, {-500, 0}, {-1, 0}, {1000, 1}, {-501, 0}, {0, 1}, {INT32_MIN / 2, 0},
        {INT32_MAX / 2, 1}};
    static const int32_t lims[] = {0, 123456789, -123456789};
    for (size_t l = 0; l < LEN(lims); l++) {
        struct exh_contact s = {0};
        struct exh_force_ledger f;
        for (size_t i = 0; i < LEN(row); i++) {
            const struct exh_contact_in in = {lims[l] + row[i].past, 0, lims[l]};
            CHECK(exh_contact_step(&s, &par_20k, in, &f) == row[i].touching, "row %zu", i);
            CHECK(s.touching == row[i].touching, "row %zu: state", i);
        }
    }
}

TEST(no_hysteresis_by_default)
{
    const struct exh_contact_par par = {.k_Npm_q10 = 1024};
    struct exh_contact s = {0};
    struct exh_force_ledger f;
    for (int32_t k = 0; k < 20; k++) {
        const int32_t past = k & 1 ? 0 : -1;
        CHECK_EQ_I64(exh_contact_step(&s, &par, (struct exh_contact_in){past, 0, 0}, &f), k & 1);
    }
}

/* Opposite ends of int32: past q_lim by 4 m is contact, not a wrapped -4 m. */
TEST(far_ends_do_not_wrap)
{
    struct exh_contact s = {0};
    struct exh_force_ledger f;
    const uint32_t before = check_saturations;
    const struct exh_contact_in far_past = {INT32_MAX, 0, INT32_MIN};
    const struct exh_contact_in far_before = {INT32_MIN, 0, INT32_MAX};
    CHECK_EQ_I64(exh_contact_step(&s, &par_20k, far_past, &f), 1);
    CHECK(f.spring_N_q20 > 0, "spring %" PRId64, f.spring_N_q20);
    CHECK(check_saturations > before, "clipped in silence");
    CHECK_EQ_I64(exh_contact_step(&s, &par_20k, far_before, &f), 0);
    CHECK_EQ_I64(f.spring_N_q20, 0);
}

/* --- pull-back --- */

struct walk {
    struct exh_contact s;
    int switches;
    int inward;
};

static void walk_to(struct walk *w, const struct exh_contact_par *par, int32_t pos)
{
    struct exh_force_ledger f;
    (void)exh_contact_step(&w->s, par, (struct exh_contact_in){pos, 0, INT32_MAX}, &f);
    w->switches += (f.pullback_N_q20 != 0) != w->inward;
    w->inward = f.pullback_N_q20 != 0;
    CHECK(f.pullback_N_q20 == (w->inward ? par->f0_N_q20 : 0), "neither 0 nor F0");
}

TEST(pullback_follows_the_direction)
{
    struct walk w = {{0}, 0, 0};
    for (int32_t p = 0; p <= 50000; p += 100) { walk_to(&w, &par_20k, p); }
    CHECK(!w.inward, "pulls while the string runs out");
    for (int32_t p = 50000; p >= 49000; p -= 100) { walk_to(&w, &par_20k, p); }
    CHECK(!w.inward, "switched within the dead band");
    walk_to(&w, &par_20k, 48999);
    CHECK(w.inward, "did not switch beyond the dead band");
    for (int32_t p = 48900; p >= 0; p -= 100) { walk_to(&w, &par_20k, p); }
    CHECK(w.inward && w.switches == 1, "%d switches", w.switches);
    walk_to(&w, &par_20k, 1000);
    CHECK(w.inward, "switched back within the dead band");
    walk_to(&w, &par_20k, 1001);
    CHECK(!w.inward && w.switches == 2, "%d switches", w.switches);
}

/* Noise of +-1 count on every sample, count steps of 15.7 um, a band of 2 counts:
 * at most one switch per reversal, none at rest. */
TEST(at_most_one_switch_per_reversal_under_noise)
{
    const int32_t count = 16857;
    struct exh_contact_par par = par_20k;
    par.f0_band_m_q30 = 2 * count;
    while (check_case(500)) {
        const int32_t speed = 1 + (int32_t)(check_u64() % 9); /* ticks per count: as slow as 1/9 */
        struct walk w = {{0}, 0, 0};
        int reversals = 0;
        int32_t pos = 0;
        for (int leg = 0; leg < 8; leg++) {
            const int32_t dir = leg & 1 ? -1 : 1;
            const int before = w.switches;
            for (int k = 0; k < 60 * speed; k++) {
                const int32_t noise = (int32_t)(check_u64() % 3) - 1;
                pos += k % speed == 0 ? dir : 0;
                walk_to(&w, &par, (pos + noise) * count);
            }
            reversals += leg > 0;
            CHECK(w.switches - before <= 1, "leg %d: %d switches", leg, w.switches - before);
            CHECK(w.inward == (dir < 0), "leg %d ends with the wrong pull-back", leg);
        }
        CHECK(w.switches <= reversals, "%d switches, %d reversals", w.switches, reversals);
        for (int k = 0; k < 200; k++) {
            walk_to(&w, &par, (pos + (int32_t)(check_u64() % 3) - 1) * count);
        }
        CHECK(w.switches <= reversals, "switched at rest");
    }
}

TEST(state_round_trip)
{
    struct exh_contact s = {-123456789, 1, 0, 1};
    struct exh_contact back = {0};
    uint8_t buf[16];
    struct exh_bytes c = exh_bytes_writer(buf, sizeof buf);
    exh_contact_serialize(&c, &s);
    CHECK_EQ_I64(c.at, 7);
    c = exh_bytes_reader(buf, c.at);
    exh_contact_serialize(&c, &back);
    CHECK(exh_bytes_ok(&c) && back.turn_m_q30 == s.turn_m_q30, "turn");
    CHECK(back.inward == 1 && back.touching == 0 && back.started == 1, "flags");
    memset(buf, 0xFE, sizeof buf); /* damaged: flags are factors of a force */
    c = exh_bytes_reader(buf, sizeof buf);
    exh_contact_serialize(&c, &back);
    CHECK(back.inward == 1 && back.touching == 1, "damaged flags");
}

/* A position at the format's end is a place like any other: without a contact nothing acts there.
 * A contact that was there has ended. */
TEST(nothing_to_touch)
{
    static const int32_t at[] = {INT32_MIN, -1, 0, 1, INT32_MAX};
    const struct exh_contact_par par = {
        EXH_Q(1000, 1, EXH_Q_K), EXH_Q(60, 1, EXH_Q_B), EXH_Q(1, 10, EXH_Q_FORCE), 1000, 1000};
    for (size_t i = 0; i < sizeof at / sizeof at[0]; i++) {
        for (int was = 0; was < 4; was++) {
            struct exh_contact s = {at[i], (uint8_t)(was & 1), (uint8_t)(was >> 1), 1};
            struct exh_contact same = s;
            struct exh_force_ledger f, want;
            exh_contact_step_free(&s, &par, at[i], &f);
            (void)exh_contact_step(
                &same, &par, (struct exh_contact_in){at[i], 7, INT32_MAX}, &want);
            CHECK(s.touching == 0 && f.spring_N_q20 == 0 && f.damper_N_q20 == 0, "at %" PRId32,
                at[i]);
            CHECK(f.pullback_N_q20 == want.pullback_N_q20 && s.inward == same.inward &&
                      s.turn_m_q30 == same.turn_m_q30,
                "F0 as ever at %" PRId32, at[i]);
        }
    }
}

TEST_MAIN("unit/contact", truth_table, the_rest_of_the_ledger_is_of_others,
    contact_boundary_and_hysteresis, no_hysteresis_by_default, far_ends_do_not_wrap,
    pullback_follows_the_direction, at_most_one_switch_per_reversal_under_noise, state_round_trip,
    nothing_to_touch);
