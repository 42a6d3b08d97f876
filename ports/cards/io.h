/* SPDX-License-Identifier: MIT */
/* Port input and output, as the drivers of the cards need it: five functions that exist once in
 * a program, chosen by what is linked. On PC/104 they are the instructions; elsewhere whatever
 * stands for the cards answers. */
#ifndef CARDS_IO_H
#define CARDS_IO_H

#include <stdint.h>

uint8_t exh_io_in8(uint16_t port);
void exh_io_out8(uint16_t port, uint8_t value);
uint16_t exh_io_in16(uint16_t port);
void exh_io_out16(uint16_t port, uint16_t value);

/* Microseconds, free-running, modulo 2^32. For time-outs alone: nothing that is put out may
 * depend on it otherwise. It may stand still; then polls are counted (wait.h). */
uint32_t exh_io_time_us(void);

#endif
