/* SPDX-License-Identifier: MIT */
/* The D/A on the SPI: a DAC81408, eight channels of 16 bits, by its data sheet. */
#ifndef DA_H
#define DA_H

#include <stdint.h>

struct da {
    uint16_t reg[32];
    uint16_t active[8]; /* codes of the outputs */
    uint32_t frame, answer, next;
    uint8_t bits, answered, selected, silent, cleared;
    uint32_t frames, torn; /* taken; of another length than 24 */
};

void da_power_on(struct da *d);
/* Lines: SYNC and CLR, both active low; a byte on SDI, and what SDO shows meanwhile. */
void da_sync(struct da *d, int level);
void da_clear(struct da *d, int level);
void da_byte(struct da *d, uint8_t byte);
uint8_t da_answer(struct da *d);
/* At an output. */
int32_t da_uV(const struct da *d, unsigned channel);

#endif
