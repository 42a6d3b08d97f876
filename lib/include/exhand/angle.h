/* SPDX-License-Identifier: MIT */
/* Angle: binary angles, where 2^32 is one turn, and their sine and cosine.
 *
 * An int32_t x_turn_q32 covers -1/2 .. 1/2 turn. Its LSB is 0.084 millionths of a degree (1.46
 * nrad). It wraps by design, so sums of angles need no reduction.
 *
 *   struct exh_sincos y;
 *   exh_sincos(EXH_DEG(30, 1), &y);
 *   int32_t half = y.sin_q30; // 2^29 within 3 LSB */
#ifndef EXHAND_ANGLE_H
#define EXHAND_ANGLE_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Binary angles for initialisers: EXH_DEG takes num/den degrees, EXH_URAD takes millionths of a
 * radian. Both are integer constant expressions, truncated towards zero, with an error of at most
 * 1 LSB. EXH_DEG requires -180 <= num/den < 180 and |num| < 2^31. EXH_URAD requires
 * |num| <= 3141592. */
#define EXH_DEG(num, den) ((int32_t)((num) * (INT64_C(1) << 32) / (INT64_C(360) * (den))))
#define EXH_URAD(num)     ((int32_t)((num)*INT64_C(683565275576) / INT64_C(1000000000)))

/* Sine and cosine of one angle. */
struct exh_sincos {
    int32_t sin_q30, cos_q30; /* -2^30 .. 2^30 */
};

/* Sine and cosine of any angle, in constant time: nine products, no table, no branch. The error is
 * at most 2.25 LSB of q30 (0.0021 ppm), measured over all 2^32 angles. Multiples of a quarter turn
 * give exactly 0 or +-2^30. No result is beyond. A quarter turn more gives exactly cos(x), -sin(x).
 * sin(-x) = -sin(x) and cos(-x) = cos(x) are exact, except at the four odd eighths of a turn. There
 * the magnitudes differ by 2 LSB and swap. */
void exh_sincos(int32_t x_turn_q32, struct exh_sincos *y);

#ifdef __cplusplus
}
#endif
#endif
