/* SPDX-License-Identifier: MIT */
/* libfixmath's sine out of its table of 205 KB, beside the one by series: the same source once more
 * under other names. */
#define FIXMATH_SIN_LUT
#define fix16_sin          fixmath_lut_sin
#define fix16_cos          fixmath_lut_cos
#define fix16_sin_parabola fixmath_lut_sin_parabola
#define fix16_tan          fixmath_lut_tan
#define fix16_asin         fixmath_lut_asin
#define fix16_acos         fixmath_lut_acos
#define fix16_atan         fixmath_lut_atan
#define fix16_atan2        fixmath_lut_atan2
#include "fix16_trig.c"
