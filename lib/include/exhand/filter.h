/* SPDX-License-Identifier: MIT */
/* Filter: low-pass of first or second order for many channels over one set of
 * coefficients.
 *
 * Butterworth by the bilinear transform, as a state-variable filter: the output is
 * an integral that stands still only where it equals the input, so gain at 0 Hz is 1
 * whatever the coefficients round to, and a constant input comes out exactly.
 */
#ifndef EXHAND_FILTER_H
#define EXHAND_FILTER_H

#include "exhand/bytes.h"
#include "exhand/signal.h"
#include "exhand/units.h"

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Parameters of all channels; rows in exh_filter_rows[]. */
struct exh_filter_par {
    int32_t order;     /* 1 or 2 */
    int32_t fc_Hz_q16; /* -3.01 dB, Hz, 0.01 .. 10^4, below half the rate */
};
#define EXH_FILTER_ROWS 2
extern const struct exh_signal exh_filter_rows[EXH_FILTER_ROWS];

/* docs/NUMERICS.md, "low-pass" */
enum exh_filter_kind {
    EXH_FILTER_LOW2,  /* low fc, order 2 */
    EXH_FILTER_LOW1,  /* low fc, order 1 */
    EXH_FILTER_HIGH2, /* high fc, order 2 */
    EXH_FILTER_HIGH1  /* high fc, order 1 */
};

/* Coefficients; what each means depends on the kind. */
struct exh_filter_cfg {
    /* docs/NUMERICS.md, "low-pass", has what is rounded to them. */
    int32_t a, b, c; /* 0 where unused */
    uint8_t shift;   /* 0 .. 31 */
    uint8_t kind;    /* enum exh_filter_kind: low is fc up to 0.105 of the rate */
};

/* One channel. */
struct exh_filter {
    int64_t pos;  /* low-pass state, LSB of x in q31, and half an LSB more */
    int64_t vel;  /* band-pass state, 23/16 LSB of x in q32; of HIGH2 LSB of x a tick */
    uint8_t wide; /* 1: of a high kind, both in q22 */
};

/* Set-up (divides). Coefficients for the period T. -EXH_E_CUTOFF: fc at or above half
 * the rate; -EXH_E_RATE: no period; -EXH_E_RANGE: order not 1 or 2, fc not positive or below 2^-21
 * (4.8e-7) of the rate. Relative error of fc and Q: NUMERICS.md, "low-pass: fc". Gain at 0 Hz is 1.
 */
int exh_filter_setup(
    struct exh_filter_cfg *cfg, const struct exh_filter_par *par, struct exh_period T);

/* n channels settled at x: the next outputs are x while the inputs are. */
void exh_filter_reset(struct exh_filter *s, const int32_t *x, unsigned n);

/* One sample of n channels, any int32; y may be x. A constant input is reached exactly and
 * kept; while anything moves, be it from rail to rail, the output of a low kind is within 6 LSB of
 * the ideal filter's (rms 0.3 to 1 LSB). Of a high kind up to 0.45 of the rate it is within 16 LSB;
 * the rms is up to 2.3 LSB at 0.37 of full scale. Towards half the rate errors grow, and above
 * 0.489 a large input that swings at half the rate wraps the states: the output is anywhere until
 * it ends. y saturates with the right sign (a step overshoots by 4.3 %) and comes back: no other
 * input wraps a state. A state from damaged bytes that none can cause finds its way back. */
void exh_filter_step(struct exh_filter *s, const struct exh_filter_cfg *cfg, const int32_t *x,
    int32_t *y, unsigned n);

/* From one set of coefficients to another, between two ticks, of n channels. A settled
 * channel stays exactly where it is; one that moves goes on from its place, and with its
 * speed if both are LOW2, or HIGH2 and fc no lower than before. So the next output is at most
 * from->c + to->c LSB away from the last, LOW2 both: 23/16 tan(pi fc T) of full scale each; any
 * tick may add two thirds of that. */
void exh_filter_retune(struct exh_filter *s, const struct exh_filter_cfg *from,
    const struct exh_filter_cfg *to, unsigned n);

/* State through a cursor (bytes.h). */
void exh_filter_serialize(struct exh_bytes *c, struct exh_filter *s);

#ifdef __cplusplus
}
#endif
#endif
