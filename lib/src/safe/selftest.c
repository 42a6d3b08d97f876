/* SPDX-License-Identifier: MIT */
/* Self-test at set-up: the arithmetic gives known answers. */
#include "exhand/angle.h"
#include "exhand/bytes.h"
#include "exhand/filter.h"
#include "exhand/fix.h"
#include "exhand/integrity.h"

/* Inputs are volatile, so that the compiler does not compute the results, and constant, so that
 * they are in ROM. A test that damages them redefines INPUT. */
#ifndef INPUT
#define INPUT static const volatile
#endif
INPUT int32_t a = 0x12345678, b = -0x0BCDEF01, tenth = -123456789;
INPUT int64_t odd = INT64_C(-0x123456789ABCDEF);
INPUT uint64_t num = UINT64_C(0xFEDCBA9876543210), den = UINT64_C(0x123456789);

static int shift_fails(void)
{
    const int64_t v = odd;
    return v >> 4 != INT64_C(-0x123456789ABCDF) ||
           exh_shr_round(v, 4) != INT64_C(-0x123456789ABCDF) ||
           exh_shr_round(v, 3) != INT64_C(-0x2468ACF13579BE) || exh_sat32(v) != INT32_MIN ||
           exh_sat32(exh_wrap_diff64(0, v)) != INT32_MAX || exh_clamp(v, -5, 7) != -5 ||
           exh_wrap_diff(INT32_MIN, INT32_MAX) != 1;
}

static int product_fails(void)
{
    return exh_mul_shr(a, b, 30) != -56332925 || exh_mul_hi(a, b) != -14083232 ||
           exh_mul64_q31(odd, 0x7654321F) != INT64_C(-0x10D43930C83FB72);
}

static int division_fails(void)
{
    uint64_t rem;
    struct exh_gain g;
    return exh_udiv64(num, den, &rem) != UINT64_C(0xE0000000) || rem != UINT64_C(0x96543210) ||
           exh_gain_set(&g, 7, 11) != 0 || g.mant != 1366580503 || g.shift != 31 ||
           exh_gain_mul(g, tenth) != -78563411 || exh_gain_floor(g, tenth) != -78563412;
}

static int crc_fails(void)
{
    static const volatile char text[9] = {'1', '2', '3', '4', '5', '6', '7', '8', '9'};
    char copy[9];
    for (unsigned i = 0; i < sizeof copy; i++) { copy[i] = text[i]; }
    return exh_crc32(0, copy, sizeof copy) != UINT32_C(0xCBF43926);
}

int exh_selftest(void)
{
    return shift_fails()      ? EXH_SELFTEST_SHIFT
           : product_fails()  ? EXH_SELFTEST_PRODUCT
           : division_fails() ? EXH_SELFTEST_DIVISION
           : crc_fails()      ? EXH_SELFTEST_CRC
                              : EXH_SELFTEST_OK;
}

/* --- additional code of scenes with a glove --- */

static int sine_fails(void)
{
    struct exh_sincos y;
    exh_sincos(a, &y);
    return y.sin_q30 != 463948540 || y.cos_q30 != 968335303;
}

/* A step of 2^20 into a filter of 30 Hz, order 2, at 2 kHz. All bits of the first outputs depend on
 * tan, both integrators and the feedback. */
static int filter_fails(void)
{
    static const int32_t want[] = {2182, 10618, 26639, 49166, 77200, 109819, 146181, 185515};
    const struct exh_filter_par par = {2, INT32_C(30) << 16};
    struct exh_filter_cfg cfg;
    struct exh_filter s;
    int32_t x = 0, y;
    if (exh_filter_setup(&cfg, &par, (struct exh_period){1, 2000}) < 0) { return 1; }
    exh_filter_reset(&s, &x, 1);
    for (unsigned k = 0; k < sizeof want / sizeof want[0]; k++) {
        x = a & INT32_C(1) << 20; /* 2^20 */
        exh_filter_step(&s, &cfg, &x, &y, 1);
        if (y != want[k]) { return 1; }
    }
    return 0;
}

int exh_selftest_glove(void)
{
    const int first = exh_selftest();
    return first            ? first
           : sine_fails()   ? EXH_SELFTEST_SINE
           : filter_fails() ? EXH_SELFTEST_FILTER
                            : EXH_SELFTEST_OK;
}
