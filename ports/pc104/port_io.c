/* SPDX-License-Identifier: MIT */
/* Port instructions for the drivers of the cards. (Their clock is in timer.c.) */
#include "io.h"

#include "cards/io.h"

uint8_t exh_io_in8(uint16_t port) { return pc104_in8(port); }

void exh_io_out8(uint16_t port, uint8_t value) { pc104_out8(port, value); }

uint16_t exh_io_in16(uint16_t port) { return pc104_in16(port); }

void exh_io_out16(uint16_t port, uint16_t value) { pc104_out16(port, value); }
