/* SPDX-License-Identifier: MIT */
/* Pins: voltages at the connectors of the cards, and their codes. Voltages are whole microvolts. An
 * A/D code is 10 V / 32768 = 305.17578125 uV, two's complement. A D/A code is 1 / 3249 V, offset
 * binary around 32768. Every code converts to microvolts and back without change. */
#ifndef EMU_PINS_H
#define EMU_PINS_H

#include <stdint.h>

#define EMU_S526S    2
#define EMU_AXES     4 /* counters, and D/A channels, of one S526 */
#define EMU_S526_AD  8
#define EMU_GLOVE_AD 32

struct emu_pins {
    int32_t enc_cnt[EMU_S526S][EMU_AXES];  /* encoder, counts x4 */
    int32_t ad_uV[EMU_S526S][EMU_S526_AD]; /* A/D inputs of the S526 */
    int32_t glove_uV[EMU_GLOVE_AD];        /* A/D inputs of the DMM-32X-AT */
    uint8_t din[EMU_S526S];                /* DIO pins, as others drive them */
    int32_t da_uV[EMU_S526S][EMU_AXES];    /* out: D/A outputs */
    uint8_t dout[EMU_S526S];               /* out: DIO pins the card drives; others 0 */
};

/* A/D: nearest code (there are no ties), limited to -32768 .. 32767. */
int16_t emu_ad_code(int32_t v_uV);
/* The voltage in the middle of a code, nearest microvolt. */
int32_t emu_ad_uV(int16_t code);

/* The same for a range 10 V / 2^gain, and for its unipolar half, 0 .. 10 V / 2^gain as
 * -32768 .. 32767. gain 0 .. 4. */
int16_t emu_ad_code_gain(int32_t v_uV, unsigned gain, int unipolar);

/* D/A at 3249 codes a volt: nearest microvolt, and back, limited to 0 .. 65535. */
int32_t emu_da_uV(uint16_t code);
uint16_t emu_da_code(int32_t v_uV);

#endif
