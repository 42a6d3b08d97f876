/* SPDX-License-Identifier: MIT */
/* Filter: low-pass of first or second order for many channels with one set of coefficients.
 *
 * It is a Butterworth filter by the bilinear transform, realised as a state-variable filter. The
 * output is an integral that comes to rest only when it equals the input. So the gain at 0 Hz is
 * exactly 1, and a constant input comes out exactly, however the coefficients are rounded.
 *
 *   struct exh_filter_par par = {2, EXH_Q(50, 1, 16)}; // order 2, 50 Hz
 *   int err = exh_filter_setup(&cfg, &par, (struct exh_period){1, 2000});
 *   exh_filter_reset(state, x, 22);
 *   exh_filter_step(state, &cfg, x, y, 22); // once per tick */
#ifndef EXHAND_FILTER_H
#define EXHAND_FILTER_H

#include "exhand/bytes.h"
#include "exhand/signal.h"
#include "exhand/units.h"

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Parameters, common to all channels; rows in exh_filter_rows[]. */
struct exh_filter_par {
    int32_t order;     /* 1 or 2 */
    int32_t fc_Hz_q16; /* frequency at -3.01 dB, Hz, 0.01 .. 10^4, below half the sample rate */
};
#define EXH_FILTER_ROWS 2
extern const struct exh_signal exh_filter_rows[EXH_FILTER_ROWS];

/* The form of the recursion (docs/NUMERICS.md, "low-pass"). */
enum exh_filter_kind {
    EXH_FILTER_LOW2,  /* low fc, order 2 */
    EXH_FILTER_LOW1,  /* low fc, order 1 */
    EXH_FILTER_HIGH2, /* high fc, order 2 */
    EXH_FILTER_HIGH1  /* high fc, order 1 */
};

/* Coefficients. Their meaning depends on the kind (docs/NUMERICS.md, "low-pass"). */
struct exh_filter_cfg {
    int32_t a, b, c; /* 0 where unused */
    uint8_t shift;   /* 0 .. 31 */
    uint8_t kind;    /* enum exh_filter_kind; low: fc up to 0.105 of the sample rate */
};

/* State of one channel. */
struct exh_filter {
    int64_t pos;  /* low-pass state, LSB of x in q31, plus half an LSB */
    int64_t vel;  /* band-pass state, 23/16 LSB of x in q32; of HIGH2: LSB of x per tick */
    uint8_t wide; /* 1: a high kind; both states are in q22 */
};

/* Set-up (divides): coefficients for the period T. -EXH_E_CUTOFF: fc at or above half the sample
 * rate. -EXH_E_RATE: no period. -EXH_E_RANGE: order not 1 or 2, fc not positive, or fc below 2^-21
 * (4.8e-7) of the rate. docs/NUMERICS.md, "low-pass: fc", gives the relative errors of fc and Q. */
int exh_filter_setup(
    struct exh_filter_cfg *cfg, const struct exh_filter_par *par, struct exh_period T);

/* Settles n channels at x: the next outputs are x while the inputs stay x. */
void exh_filter_reset(struct exh_filter *s, const int32_t *x, unsigned n);

/* Filters one sample of each of n channels: any int32_t in x[n], result in y[n]; y may be x. The
 * output reaches a constant input exactly and keeps it.
 *
 * Error against the ideal filter while the signal moves:
 * - Low kinds: at most 6 LSB, rms 0.3 to 1 LSB.
 * - High kinds up to 0.45 of the sample rate: at most 16 LSB, rms up to 2.3 LSB at 0.37 of full
 *   scale.
 * - Towards half the rate it grows. Above 0.489 a large input that alternates at half the rate
 *   wraps the states; the output is undefined until that input ends. No other input wraps a state.
 *
 * y saturates with the right sign; a step overshoots by 4.3 %. It recovers from corrupted
 * states. */
void exh_filter_step(struct exh_filter *s, const struct exh_filter_cfg *cfg, const int32_t *x,
    int32_t *y, unsigned n);

/* Changes n channels from one set of coefficients to another, between two ticks. A settled channel
 * keeps its value exactly. A moving one continues from its position. It keeps its speed if both
 * sets are LOW2, or if both are HIGH2 and fc does not fall. With both LOW2, the next output differs
 * from the last by at most from->c + to->c LSB; each is 23/16 tan(pi fc T) of full scale. Any
 * ordinary tick may change the output by two thirds of that. */
void exh_filter_retune(struct exh_filter *s, const struct exh_filter_cfg *from,
    const struct exh_filter_cfg *to, unsigned n);

/* State through a cursor (bytes.h). */
void exh_filter_serialize(struct exh_bytes *c, struct exh_filter *s);

#ifdef __cplusplus
}
#endif
#endif
