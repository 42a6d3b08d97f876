/* SPDX-License-Identifier: MIT */
/* contact.h against exact arithmetic: F = b*qd + k*q + F0, every corner of every
 * argument, parameters at the ends of their ranges. */
#include "exhand/contact.h"

#include "exhand/units.h"

#include "check.h"
#include "wide.h"

static int32_t in_row(unsigned r)
{
    return check_i32_in(exh_contact_rows[r].min, exh_contact_rows[r].max);
}

/* b*v in q47, k*pen in q40, F0 in q20: all brought to q47. */
static struct wide exact_N_q47(
    const struct exh_contact_par *par, struct exh_contact_in in, int touching, int inward)
{
    const int64_t past = (int64_t)in.pos_m_q30 - in.lim_m_q30;
    const int32_t pen = wide_sat32(wide_of(past)); /* documented: saturates at +-2 m */
    const struct wide f0 = wide_shl(wide_of(inward ? par->f0_N_q20 : 0), 27);
    const struct wide spring = wide_shl(wide_mul(par->k_Npm_q10, pen), 7);
    const struct wide damper = wide_mul(par->b_Nspm_q20, in.vel_mps_q27);
    return touching ? wide_add(f0, wide_add(spring, damper)) : f0;
}

static void law_case(
    const struct exh_contact_par *par, struct exh_contact s, struct exh_contact_in in)
{
    const struct exh_contact old = s;
    const int64_t past = (int64_t)in.pos_m_q30 - in.lim_m_q30;
    const uint32_t before = check_saturations;
    struct exh_force_ledger f = {1, 1, 1, 1, 1, 1, 1, 1};
    const int touching = exh_contact_step(&s, par, in, &f);
    const int64_t sum = f.spring_N_q20 + f.damper_N_q20 + f.pullback_N_q20;
    const struct wide err =
        wide_sub(wide_shl(wide_of(sum), 27), exact_N_q47(par, in, touching, s.inward));
    CHECK(wide_within(err, wide_of(INT64_C(1) << 27)),
        "k %" PRId32 " b %" PRId32 " q %" PRId32 " lim %" PRId32 " v %" PRId32 ": off by more "
        "than 1 LSB",
        par->k_Npm_q10, par->b_Nspm_q20, in.pos_m_q30, in.lim_m_q30, in.vel_mps_q27);
    CHECK(touching == (past >= 0 || (old.touching && past >= -(int64_t)par->hyst_m_q30)),
        "past %" PRId64 " hyst %" PRId32 ": touching %d", past, par->hyst_m_q30, touching);
    CHECK((past > INT32_MAX || past < INT32_MIN) == (check_saturations != before) || !touching,
        "past %" PRId64 ": audit", past);
    CHECK(
        f.pullback_N_q20 == (s.inward ? par->f0_N_q20 : 0), "pull-back %" PRId64, f.pullback_N_q20);
    CHECK(touching || (f.spring_N_q20 == 0 && f.damper_N_q20 == 0), "force without contact");
    CHECK_EQ_I64(f.passivity_N_q20, 0); /* the rest of the ledger is the drive's */
}

TEST(law_at_all_corners)
{
    for (uint32_t i = 0; i < 8 * 8 * 8 * 32; i++) {
        const uint32_t ends = i >> 9;
        const struct exh_contact_par par = {
            ends & 1 ? exh_contact_rows[0].max : exh_contact_rows[0].min,
            ends & 2 ? exh_contact_rows[1].max : exh_contact_rows[1].min,
            ends & 4 ? exh_contact_rows[2].max : exh_contact_rows[2].min,
            ends & 8 ? exh_contact_rows[3].max : exh_contact_rows[3].min,
            ends & 16 ? exh_contact_rows[4].max : exh_contact_rows[4].min};
        const struct exh_contact_in in = {
            check_corner[i & 7], check_corner[i >> 3 & 7], check_corner[i >> 6 & 7]};
        for (uint8_t state = 0; state < 8; state++) {
            const struct exh_contact s = {
                check_corner[(i + state) & 7], state & 1, state >> 1 & 1, state >> 2 & 1};
            law_case(&par, s, in);
        }
    }
}

TEST(law_at_random)
{
    while (check_case(1)) {
        const struct exh_contact_par par = {in_row(0), in_row(1), in_row(2), in_row(3), in_row(4)};
        const uint64_t bits = check_u64();
        const struct exh_contact s = {check_i32(), bits & 1, bits >> 1 & 1, bits >> 2 & 1};
        const int32_t pos = check_i32();
        const int32_t near = (int32_t)wide_sat32(wide_of((int64_t)pos + check_i32_in(-99, 99)));
        const struct exh_contact_in in = {pos, check_i32(), bits & 8 ? near : check_i32()};
        law_case(&par, s, in);
    }
}

/* Any bits in the parameters, too: the law must not lean on the range check. */
TEST(law_with_unchecked_parameters)
{
    while (check_case(2)) {
        const struct exh_contact_par par = {
            check_i32(), check_i32(), check_i32(), check_i32(), check_i32()};
        const struct exh_contact s = {check_i32(), check_u64() & 1, check_u64() & 1, 1};
        const struct exh_contact_in in = {check_i32(), check_i32(), check_i32()};
        law_case(&par, s, in);
    }
}

/* The pull-back reverses on more than the band from the farthest point, computed
 * here from the whole history, not from the law's state. */
TEST(pullback_against_the_whole_history)
{
    while (check_case(50)) {
        const struct exh_contact_par par = {0, 0, 1, check_i32_in(0, exh_contact_rows[3].max), 0};
        struct exh_contact s = {0, 0, 0, 0};
        int32_t pos = check_i32_in(-1000000000, 1000000000);
        int64_t far = pos;
        int inward = 0;
        for (int k = 0; k < 50; k++) {
            struct exh_force_ledger f;
            (void)exh_contact_step(&s, &par, (struct exh_contact_in){pos, 0, INT32_MAX}, &f);
            if (inward ? pos > far + par.f0_band_m_q30 : pos < far - par.f0_band_m_q30) {
                inward = !inward;
                far = pos;
            }
            far = inward ? (pos < far ? pos : far) : (pos > far ? pos : far);
            CHECK(f.pullback_N_q20 == inward, "step %d", k);
            pos = wide_sat32(wide_of((int64_t)pos + check_i32_in(-20000000, 20000000)));
        }
    }
}

/* The law without memory: F0 by the velocity's sign, the whole penetration of up to 4 m. */
static void plain_case(const struct exh_contact_par *par, struct exh_contact_in in)
{
    const int64_t past = (int64_t)in.pos_m_q30 - in.lim_m_q30, most = EXH_FORCE_MAX_N_Q20;
    const struct wide half = wide_of(INT64_C(1) << 26), tenth = wide_of(INT64_C(1) << 19);
    const struct wide f0 = wide_shl(wide_of(in.vel_mps_q27 < 0 ? par->f0_N_q20 : 0), 27);
    const struct wide spring = wide_shl(wide_mul(par->k_Npm_q10, past), 7);
    const struct wide in_touch = wide_add(spring, wide_mul(par->b_Nspm_q20, in.vel_mps_q27));
    const struct wide exact = past >= 0 ? wide_add(f0, in_touch) : f0;
    struct exh_force_ledger f = {1, 1, 1, 1, 5, 6, 7, 8};
    const int touching = exh_contact_law(par, in, &f);
    const int64_t sum = f.spring_N_q20 + f.damper_N_q20 + f.pullback_N_q20;
    const int64_t force = exh_contact_force(par, in);
    const struct wide off = wide_sub(wide_shl(wide_of(force), 27), exact);
    CHECK_EQ_I64(touching, past >= 0);
    CHECK(touching || (f.spring_N_q20 == 0 && f.damper_N_q20 == 0), "force without contact");
    CHECK(f.passivity_N_q20 == 0 && f.clamp_N_q20 == 5 && f.force_N_q20 == 8, "the drive's");
    CHECK(wide_within(wide_sub(wide_shl(wide_of(sum), 27), exact), wide_of(INT64_C(1) << 27)),
        "past %" PRId64 ": the sum of the terms is off by more than 1 LSB", past);
    CHECK(force >= 0 && force <= most, "force %" PRId64, force);
    CHECK(wide_within(off, wide_add(half, tenth)) || (force == 0 && !wide_negative(off)) ||
              (force == most && wide_negative(off)),
        "past %" PRId64 ": force %" PRId64 " is off by more than 0.51 LSB", past, force);
}

TEST(law_without_memory)
{
    for (uint32_t i = 0; i < 8 * 8 * 8 * 8; i++) {
        const struct exh_contact_par par = {
            i >> 9 & 1 ? exh_contact_rows[0].max : exh_contact_rows[0].min,
            i >> 10 & 1 ? exh_contact_rows[1].max : exh_contact_rows[1].min,
            i >> 11 & 1 ? exh_contact_rows[2].max : exh_contact_rows[2].min, 0, 0};
        plain_case(&par, (struct exh_contact_in){check_corner[i & 7], check_corner[i >> 3 & 7],
                             check_corner[i >> 6 & 7]});
    }
    while (check_case(1)) {
        const struct exh_contact_par par = {in_row(0), in_row(1), in_row(2), 0, 0};
        const int32_t pos = check_i32(), most_vel = check_i32_in(1, INT32_MAX);
        const int64_t lim = (int64_t)pos + check_i32_in(-99999, 99);
        const int32_t near = (int32_t)wide_sat32(wide_of(lim));
        plain_case(&par, (struct exh_contact_in){pos, check_i32_in(-most_vel, most_vel), near});
        plain_case(&par, (struct exh_contact_in){pos, check_i32(), check_i32()});
    }
}

/* Without hysteresis and F0 both laws are the same to the bit. */
TEST(both_laws_agree)
{
    while (check_case(1)) {
        const struct exh_contact_par par = {in_row(0), in_row(1), 0, 0, 0};
        const struct exh_contact_in in = {
            check_i32_in(-(1 << 30), 1 << 30), check_i32(), check_i32_in(-(1 << 30) + 1, 1 << 30)};
        struct exh_contact s = {check_i32(), check_u64() & 1, check_u64() & 1, 1};
        struct exh_force_ledger a, b;
        CHECK_EQ_I64(exh_contact_law(&par, in, &a), exh_contact_step(&s, &par, in, &b));
        CHECK(a.spring_N_q20 == b.spring_N_q20 && a.damper_N_q20 == b.damper_N_q20, "terms");
    }
}

TEST_MAIN("prop/contact", law_at_all_corners, law_at_random, law_with_unchecked_parameters,
    pullback_against_the_whole_history, law_without_memory, both_laws_agree);
