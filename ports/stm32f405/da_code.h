/* SPDX-License-Identifier: MIT */
/* The library's D/A codes in those of the DAC81408. */
#ifndef STM32F405_DA_CODE_H
#define STM32F405_DA_CODE_H

#include <stdint.h>

/* Offset binary, 3249 codes/V, to offset binary, 3276.8 codes/V: 32768/32490 from the middle,
 * rounded to the nearest code, which no product is halfway between. Beyond +-10 V: the last code.
 */
static inline uint16_t stm_da_code(uint16_t raw)
{
    const int32_t d = ((int32_t)raw - 32768) * 32768;
    const int32_t whole = 32768 + (d + (d < 0 ? -16245 : 16245)) / 32490;
    return (uint16_t)(whole < 0 ? 0 : whole > 65535 ? 65535 : whole);
}

#endif
