/* SPDX-License-Identifier: MIT */
/* PROVES: hand: fingertip and slope
 * Set-up with any bones and parameters, then tip and slope at any angles. int_fast32_t has 64 bits
 * here. z3 proves that 32 bits are enough (smt_hand.py), and eva/hand_tip.acsl assumes that bound.
 *
 * EVA: -eva-slevel 60
 * PLANT: lib/src/sense/hand.c: b->base_m_q32[i] > BASE_MAX_M_Q32 -> b->base_m_q32[i] > 2 * BASE_MAX_M_Q32
 * PLANT: lib/src/sense/hand.c: const int64_t along_q54 = 2 * w2_radpm_q20 -> const int64_t along_q54 = 16 * w2_radpm_q20
 * PLANT: lib/src/sense/hand.c: const int64_t sum_q54 = (int64_t)row_q30[0] -> const int64_t sum_q54 = 4 * (int64_t)row_q30[0]
 * PLANT: lib/src/sense/hand.c: if (square_q60 < (uint64_t)ARM_MIN_M_Q30 * ARM_MIN_M_Q30) { return -EXH_E_RANGE; } -> (void)0;
 */
#include <stdint.h>
#define int_fast32_t int64_t
#include "num/bytes.c"
#define exh_udiv64 udiv64_by_steps /* as in any_probe.c */
#include "num/fix.c"
#undef exh_udiv64
#define exh_udiv64 udiv64
static uint64_t udiv64(uint64_t num, uint64_t den, uint64_t *rem)
{
    uint64_t quot;
    /*@ assert divisor: den != 0; */
    quot = num / den;
    if (rem) { *rem = num % den; }
    /*@ admit pull: quot <= 262144032; */ /* smt_hand.py: pull_is_within_its_bound */
    return quot;
}
#include "any.h"

#include "num/sincos.h" /* its proof is any_angle.c */
static struct exh_sincos any_sincos(int32_t x_turn_q32)
{
    const struct exh_sincos y = {
        Frama_C_interval(-(1 << 30), 1 << 30), Frama_C_interval(-(1 << 30), 1 << 30)};
    (void)x_turn_q32;
    return y;
}
#define sincos_in_place any_sincos
#include "sense/hand.c"

#define PULL_MOST_RADPM_Q20 (PULL_MAX_RADPM_Q20 + 32)

static struct exh_hand_bones bones;
static struct exh_hand_par par;
static struct exh_hand_finger f;

static void set_up(void)
{
    ANY(bones);
    ANY(par);
    if (exh_hand_setup(&f, &bones, &par) == 0) {
        /*@ assert pulls: 0 <= f.pull_radpm_q20[0] <= 262144032 && 0 <= f.pull_radpm_q20[1] <= 262144032; */
        /*@ assert base: -(1 << 29) <= bones.base_m_q32[0] <= 1 << 29 && -(1 << 29) <= bones.base_m_q32[2] <= 1 << 29; */
        /*@ assert bone: 0 < bones.len_m_q34[0] && 0 < bones.len_m_q34[2]; */
        /*@ assert row: -(1 << 30) <= bones.rot_q30[0][0] <= 1 << 30 && -(1 << 30) <= bones.rot_q30[2][2] <= 1 << 30; */
    }
}

/* As set-up and follow let them. */
static void any_finger(void)
{
    for (unsigned i = 0; i < 3; i++) {
        bones.len_m_q34[i] = Frama_C_interval(1, LEN_MAX_M_Q34);
        bones.base_m_q32[i] = Frama_C_interval(-BASE_MAX_M_Q32, BASE_MAX_M_Q32);
        for (unsigned k = 0; k < 3; k++) {
            bones.rot_q30[i][k] = Frama_C_interval(-(1 << 30), 1 << 30);
        }
    }
    f.bones = &bones;
    f.pull_radpm_q20[0] = Frama_C_interval(-PULL_MOST_RADPM_Q20, PULL_MOST_RADPM_Q20);
    f.pull_radpm_q20[1] = Frama_C_interval(-PULL_MOST_RADPM_Q20, PULL_MOST_RADPM_Q20);
}

int main(void)
{
    int32_t joint_turn_q32[EXH_HAND_JOINTS];
    struct exh_vec3 tip_m_q30, slope_q24;
    ANY(joint_turn_q32);
    set_up();
    any_finger();
    exh_hand_tip(&f, joint_turn_q32, &tip_m_q30);
    /*@ assert within_half_a_metre: -(1 << 29) <= tip_m_q30.x < 1 << 29; */
    exh_hand_tip_slope(&f, joint_turn_q32, &tip_m_q30, &slope_q24);
    END();
    return 0;
}
