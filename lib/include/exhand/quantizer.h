/* SPDX-License-Identifier: MIT */
/* Quantizer: a code of N bits that stands still while its input only trembles. */
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
    int32_t bits;         /* stable bits of the full int32 range, 1 .. 24 */
    int32_t hyst_raw_q16; /* hysteresis, LSB of the input, 0 .. 2^(32-bits): noise,
                             peak to peak, that shall not show */
};
#define EXH_QUANTIZER_ROWS 2
extern const struct exh_signal exh_quantizer_rows[EXH_QUANTIZER_ROWS];

/* Set up; one for any number of channels. */
struct exh_quantizer_cfg {
    uint32_t keep; /* a code is kept while the input is within this of its value */
    uint32_t half; /* half a code, LSB of the input */
};
/* One channel. A state of zeros has seen nothing. */
struct exh_quantizer {
    int32_t value;   /* of the code kept, in units of the input */
    uint8_t started; /* the first call takes the nearest code */
};

/* Set-up. -EXH_E_RANGE: bits not 1 .. 24, or a hysteresis that is negative or more than one
 * code: who has that much noise has fewer stable bits. */
int exh_quantizer_setup(struct exh_quantizer_cfg *cfg, const struct exh_quantizer_par *par);

/* The stable value, in units of the input: a multiple of Q = 2^(32-bits). It is kept
 * while |x - value| <= (Q + hysteresis)/2, else it is the multiple nearest to x, half
 * up, the highest of which is 2^31 - Q. So at a constant input with noise of at most the
 * hysteresis, peak to peak, it changes at most once, and never again. Error
 * <= (Q + hysteresis)/2; at the top, where there is no higher code, below Q. */
int32_t exh_quantizer_step(struct exh_quantizer *s, const struct exh_quantizer_cfg *cfg, int32_t x);

/* State through a cursor (bytes.h). A value read that is no multiple of Q (damaged, or of other
 * parameters) is kept as any other, within the same error, until the input leaves it. */
void exh_quantizer_serialize(struct exh_bytes *c, struct exh_quantizer *s);

#ifdef __cplusplus
}
#endif
#endif
