/* SPDX-License-Identifier: MIT */
/* Registers of the Sensoray 526: offsets from its base, all of 16 bits. */
#ifndef CARDS_S526_REG_H
#define CARDS_S526_REG_H

#include "io.h"
#include "s526.h"

enum {
    S526_DAC = 0x04,
    S526_ADC = 0x06,
    S526_ADD = 0x08,
    S526_DIO = 0x0A,
    S526_ISR = 0x0E,
    S526_COUNTER = 0x12,
    S526_COUNTER_STEP = 8, /* of a counter: */
    S526_LOW = 0,
    S526_HIGH = 2,
    S526_MODE = 4,
    S526_CONTROL = 6,
    S526_EED = 0x32,
    S526_EEC = 0x34
};

/* DAC; channel k is selected by k << 1 */
enum { S526_DA_START = 0x0001 };
/* ADC; channel k is converted by 0x20 << k, selected by k << 1 */
enum {
    S526_AD_START = 0x0001,
    S526_AD_CONVERT0 = 0x0020,
    S526_AD_SETTLE = 0x8000,
    S526_AD_10V = 8,
    S526_AD_0V = 9 /* references are channels */
};
/* DIO */
enum {
    S526_DIO_OUT4 = 0x0800, /* pins 4..7 are outputs */
    S526_DIO_LINES = 0xF0
};
/* ISR; flags are cleared by writing them */
enum { S526_DA_DONE = 0x0002, S526_AD_DONE = 0x0004, S526_EE_DONE = 0x0080 };
/* a counter's mode */
enum {
    S526_PRELOAD0 = 0x0000,
    S526_PRELOAD1 = 0x4000,
    S526_QUAD_X4 = 0x0480 /* on, latch on read of the low word, nothing reloads it */
};
/* a counter's control and status */
enum { S526_CAPTURED = 0x000F, S526_ECAP = 0x0001, S526_LOAD = 0x4000, S526_RESET = 0x8000 };
#define S526_ALL_ONES 0xFFFFu /* an empty port */

static inline uint16_t s526_in(const struct exh_s526 *s, unsigned offset)
{
    return exh_io_in16((uint16_t)(s->base + offset));
}

static inline void s526_out(const struct exh_s526 *s, unsigned offset, unsigned value)
{
    exh_io_out16((uint16_t)(s->base + offset), (uint16_t)value);
}

/* A result of the A/D, two's complement. */
static inline int16_t s526_result(const struct exh_s526 *s)
{
    return (int16_t)((int32_t)(s526_in(s, S526_ADD) ^ 0x8000u) - 0x8000);
}

static inline unsigned s526_counter(unsigned axis, unsigned offset)
{
    return S526_COUNTER + axis * S526_COUNTER_STEP + offset;
}

/* Waits for flags of ISR. 0, or the fault: what, or no answer. */
int s526_wait(const struct exh_s526 *s, unsigned flags, uint32_t limit_us, unsigned what,
    unsigned at, uint16_t *isr, struct exh_card_fault *f);

#endif
