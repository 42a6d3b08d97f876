/* SPDX-License-Identifier: MIT */
/* Port input and output for the drivers of the cards: five functions that exist once per program
 * and are chosen by linking. On PC/104 they are the instructions; elsewhere an emulator of the
 * cards answers. */
#ifndef CARDS_IO_H
#define CARDS_IO_H

#include <stdint.h>

uint8_t exh_io_in8(uint16_t port);
void exh_io_out8(uint16_t port, uint8_t value);
uint16_t exh_io_in16(uint16_t port);
void exh_io_out16(uint16_t port, uint16_t value);

/* Microseconds, free-running, modulo 2^32. For time-outs only; no output may depend on it
 * otherwise. The clock may stop; then polls are counted (wait.h). */
uint32_t exh_io_time_us(void);

#endif
