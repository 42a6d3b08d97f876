/* SPDX-License-Identifier: MIT */
/* Quantizer: a code of N bits with hysteresis, which suppresses noise of the input.
 *
 *   struct exh_quantizer_par par = {10, 2000}; // 10 bits of 32; noise of 2000 LSB
 *   int err = exh_quantizer_setup(&cfg, &par);
 *   int32_t stable = exh_quantizer_step(&channel, &cfg, x); */
#ifndef EXHAND_QUANTIZER_H
#define EXHAND_QUANTIZER_H

#include "exhand/bytes.h"
#include "exhand/signal.h"

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Parameters; rows in exh_quantizer_rows[]. */
struct exh_quantizer_par {
    int32_t bits;         /* stable bits of the full int32_t range, 1 .. 24 */
    int32_t hyst_raw_q16; /* hysteresis, LSB of x, 0 .. 2^(32-bits): peak-to-peak noise */
};
#define EXH_QUANTIZER_ROWS 2
extern const struct exh_signal exh_quantizer_rows[EXH_QUANTIZER_ROWS];

/* Set-up, shared by any number of channels. */
struct exh_quantizer_cfg {
    uint32_t keep; /* a code is kept while the input is within this distance of its value */
    uint32_t half; /* half a code, LSB of the input */
};
/* One channel. All zeros: no input yet. */
struct exh_quantizer {
    int32_t value;   /* value of the present code, in units of the input */
    uint8_t started; /* 1 after the first call, which takes the nearest code */
};

/* Set-up. -EXH_E_RANGE: bits not 1 .. 24, or the hysteresis is negative or above one code. If the
 * noise exceeds one code, choose fewer bits. */
int exh_quantizer_setup(struct exh_quantizer_cfg *cfg, const struct exh_quantizer_par *par);

/* The stable value, in units of the input: a multiple of Q = 2^(32-bits). The value stays while |x
 * - value| <= (Q + hysteresis)/2. Otherwise it becomes the multiple nearest to x, half up; the
 *   highest is 2^31 - Q. At a constant input with peak-to-peak noise up to the hysteresis, it
 *   changes at most once. The error is at most (Q + hysteresis)/2, at the top, where no higher code
 *   exists, below Q. */
int32_t exh_quantizer_step(struct exh_quantizer *s, const struct exh_quantizer_cfg *cfg, int32_t x);

/* State through a cursor (bytes.h). A value that is no multiple of Q, from damaged bytes or other
 * parameters, is kept with the same error bound until the input leaves it. */
void exh_quantizer_serialize(struct exh_bytes *c, struct exh_quantizer *s);

#ifdef __cplusplus
}
#endif
#endif
