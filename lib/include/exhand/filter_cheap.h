/* SPDX-License-Identifier: MIT */
/* Cheap filter: the second-order low-pass of filter.h at half its price, for small CPUs.
 *
 * The same Butterworth by the same bilinear transform. Up to 0.0685 of the rate the recursion runs
 * over position and speed, above as a direct form 1. Each product is of 32 by 32 bits, and what a
 * rounding leaves over goes into the next tick. So gain at 0 Hz is 1, and nothing stays short of
 * its input. Next to filter.h it has fewer bits of fc, and no room for what overshoots full scale.
 *
 * A scene chooses by what it calls. It links this kind, that one, or both.
 */
#ifndef EXHAND_FILTER_CHEAP_H
#define EXHAND_FILTER_CHEAP_H

#include "exhand/bytes.h"
#include "exhand/filter.h"
#include "exhand/units.h"

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Coefficients of all channels (docs/NUMERICS.md, "low-pass, cheap"). */
struct exh_filter_cheap_cfg {
    int32_t a;    /* of the speed, q32; high: of the output, q29 */
    int32_t b;    /* of the inputs less the output, q32; high: of the inputs, q29 */
    int32_t c;    /* of the speed to the output, q32; high: of the output before, q29 */
    uint8_t high; /* 1: fc above 0.0685 of the rate */
};

/* One channel. */
struct exh_filter_cheap {
    int64_t pos; /* output, LSB of x in q32; high: output, and below it what rounding left, q29 */
    int64_t vel; /* speed, in c LSB a tick; high: the output before, q32 */
    int32_t in1; /* the input before */
    int32_t in2; /* and the one before that */
};

/* Set-up (divides). Refuses as exh_filter_setup() does, and all but order 2: -EXH_E_RANGE.
 * Relative error of fc below 2^-36 over fc/rate (1.5 ppm at 10^-5, 0.15 ppm at 10^-4), above
 * 0.0685 of the rate below 2^-26. Gain at 0 Hz is 1. */
int exh_filter_cheap_setup(
    struct exh_filter_cheap_cfg *cfg, const struct exh_filter_par *par, struct exh_period T);

/* n channels settled at x: the next outputs are x while the inputs are. There is no retuning:
 * other coefficients start here. */
void exh_filter_cheap_reset(struct exh_filter_cheap *s, const struct exh_filter_cheap_cfg *cfg,
    const int32_t *x, unsigned n);

/* One sample of n channels, any int32; y may be x. A constant input is reached exactly and kept.
 * While the input moves the output is within 8 LSB + rate/(16 fc) LSB of the ideal filter's (0.3
 * ppm of full scale at 10^-4), above 0.0685 of the rate within 80 LSB up to 0.45. That holds where
 * the ideal one stays within full scale: of inputs within 0.9 of it, or 0.48 where fc is high. y
 * saturates with the right sign, and the recursion goes on from there: no input wraps or latches
 * it. Below 0.0685 of the rate it then is within 0.11 of full scale of the ideal one. A state from
 * damaged bytes that no input can cause finds its way back. */
void exh_filter_cheap_step(struct exh_filter_cheap *s, const struct exh_filter_cheap_cfg *cfg,
    const int32_t *x, int32_t *y, unsigned n);

/* State through a cursor (bytes.h). */
void exh_filter_cheap_serialize(struct exh_bytes *c, struct exh_filter_cheap *s);

#ifdef __cplusplus
}
#endif
#endif
