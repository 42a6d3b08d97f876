/* SPDX-License-Identifier: MIT */
/* Cheap filter: the second-order low-pass of filter.h at half its cost, for small CPUs.
 *
 * It is the same Butterworth filter by the same bilinear transform. Up to 0.0685 of the sample rate
 * the recursion uses position and speed, above that a direct form 1. Each product is 32 by 32 bits,
 * and the remainder of each rounding enters the next tick. So the gain at 0 Hz is 1, and the output
 * reaches its input. Compared with filter.h, fc is less accurate and overshoot is clipped at full
 * scale. Call it as filter.h. */
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
    int32_t a;    /* factor of the speed, q32; high: of the output, q29 */
    int32_t b;    /* factor of input minus output, q32; high: of the inputs, q29 */
    int32_t c;    /* factor of the speed in the output, q32; high: of the previous output, q29 */
    uint8_t high; /* 1: fc is above 0.0685 of the sample rate */
};

/* State of one channel. */
struct exh_filter_cheap {
    int64_t pos; /* output, LSB of x in q32; high: output and rounding remainder, q29 */
    int64_t vel; /* speed, in c LSB per tick; high: previous output, q32 */
    int32_t in1; /* previous input */
    int32_t in2; /* the input before in1 */
};

/* Set-up (divides). Errors as exh_filter_setup(); an order other than 2 is -EXH_E_RANGE. The
 * relative error of fc is below 2^-36 / (fc/rate): 1.5 ppm at 10^-5, 0.15 ppm at 10^-4. Above
 * 0.0685 of the sample rate it is below 2^-26. */
int exh_filter_cheap_setup(
    struct exh_filter_cheap_cfg *cfg, const struct exh_filter_par *par, struct exh_period T);

/* Settles n channels at x: the next outputs are x while the inputs stay x. Reset after set-up. */
void exh_filter_cheap_reset(struct exh_filter_cheap *s, const struct exh_filter_cheap_cfg *cfg,
    const int32_t *x, unsigned n);

/* Filters one sample of each of n channels: any int32_t in x[n], result in y[n]; y may be x. The
 * output reaches a constant input exactly and keeps it.
 *
 * Error against the ideal filter while the signal moves: at most 8 LSB + rate/(16 fc) LSB (0.3 ppm
 * of full scale at 10^-4). Between 0.0685 and 0.45 of the sample rate it is at most 80 LSB. Both
 * bounds require that the ideal output stays within full scale. Inputs within 0.9 of full scale
 * ensure that, or 0.48 where fc is high.
 *
 * y saturates with the right sign, and the recursion continues from there: no input wraps or
 * latches it. Below 0.0685 of the rate, it then stays within 0.11 of full scale of the ideal
 * filter. From a corrupted state the filter recovers. */
void exh_filter_cheap_step(struct exh_filter_cheap *s, const struct exh_filter_cheap_cfg *cfg,
    const int32_t *x, int32_t *y, unsigned n);

/* State through a cursor (bytes.h). */
void exh_filter_cheap_serialize(struct exh_bytes *c, struct exh_filter_cheap *s);

#ifdef __cplusplus
}
#endif
#endif
