/* SPDX-License-Identifier: MIT */
/* PROVES: arithmetic
 * fix.h over its whole documented range. The wp/ proofs rely on this arithmetic.
 *
 * WP: Contracts of exh_sat32(), exh_clamp() and exh_clamp32().
 *
 * PLANT: lib/include/exhand/fix.h: ((int64_t)a * b + (INT64_C(1) << (n - 1))) >> n -> ((int64_t)a * b + (INT64_C(1) << n)) >> n
 * PLANT: lib/include/exhand/fix.h: const int64_t hi = (a >> 32) * b; -> const int64_t hi = a * b;
 */
#include "exhand/fix.h"

#include "any.h"

static void products(void)
{
    for (unsigned n = 1; n <= 62; n++) {
        int64_t r = exh_mul_shr(any32(), any32(), n);
        /*@ assert mul_shr_bound: -4611686018427387904 <= r <= 4611686018427387904; */
        if (n == 42) { /*@ assert mul_shr_42: -1048576 <= r <= 1048576; */
        }
        r = exh_mul_shr(0, any32(), n);
        /*@ assert mul_shr_zero: r == 0; */
        r = exh_shr_round(any64(), n);
    }
}

static void gains(void)
{
    for (uint8_t shift = 0; shift <= 62; shift++) {
        const struct exh_gain g = {Frama_C_interval(0, INT32_MAX), shift};
        int64_t r = exh_gain_mul(g, any32());
        /*@ assert gain_mul_bound: -4611686018427387904 <= r <= 4611686018427387904; */
        r = exh_gain_mul(g, 0);
        /*@ assert gain_mul_zero: r == 0; */
        r = exh_gain_mul(g, Frama_C_interval(0, INT32_MAX));
        /*@ assert gain_mul_sign: r >= 0; */
        r = exh_gain_floor(g, any32());
    }
}

static void rest(void)
{
    int64_t r = exh_sat32(any64());
    (void)exh_mul_hi(any32(), any32());
    (void)exh_umul_hi(any_u32(), any_u32());
    r = exh_mul64_q31(any64(), Frama_C_interval(0, INT32_MAX));
    r = exh_from_u32(any_u32());
    r = exh_from_u64((uint64_t)any64());
    r = exh_wrap_add64(any64(), any64());
    r = exh_wrap_diff64(any64(), any64());
    r = exh_wrap_diff(any32(), any32());
    r = exh_wrap_add(any32(), any32());
    (void)r;
}

int main(void)
{
    products();
    gains();
    rest();
    END();
    return 0;
}
