/* SPDX-License-Identifier: MIT */
/* Angle: binary angles, where 2^32 is one turn, and their sine and cosine.
 *
 * An int32_t x_turn_q32 covers -1/2 .. 1/2 turn with an LSB of 0.084 millionths of
 * a degree (1.46 nrad) and wraps by design: sums of angles need no reduction.
 */
#ifndef EXHAND_ANGLE_H
#define EXHAND_ANGLE_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* num/den degrees or millionths of a radian as a binary angle, for initialisers: integer
 * constant expressions, truncated towards zero, error <= 1 LSB. Within -180 <= x < 180 degrees and
 * |num| < 2^31 (EXH_DEG), |num| <= 3141592 (EXH_URAD). 683.565275576 LSB are 1 urad. */
#define EXH_DEG(num, den) ((int32_t)((num) * (INT64_C(1) << 32) / (INT64_C(360) * (den))))
#define EXH_URAD(num)     ((int32_t)((num)*INT64_C(683565275576) / INT64_C(1000000000)))

/* Sine and cosine of one angle. */
struct exh_sincos {
    int32_t sin_q30, cos_q30; /* -2^30 .. 2^30 */
};

/* Sine and cosine of any angle. Error <= 2.25 LSB of q30 (0.0021 ppm), found over all 2^32
 * angles; 0 and +-2^30 exactly at whole quarters of a turn, never beyond +-2^30. Symmetric to the
 * last bit: sin(-x) = -sin(x), cos(-x) = cos(x), but at the four odd eighths, where the two are 2
 * LSB apart and change places; a quarter turn on makes them cos(x), -sin(x) at every angle. The
 * work is the same for every angle: no table, no branch, nine products. */
void exh_sincos(int32_t x_turn_q32, struct exh_sincos *y);

#ifdef __cplusplus
}
#endif
#endif
