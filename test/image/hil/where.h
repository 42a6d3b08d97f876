/* SPDX-License-Identifier: MIT */
/* Where the instructions of the cheapest and of the dearest tick of a scene were. */
#ifndef HIL_WHERE_H
#define HIL_WHERE_H

#include "hil.h"

void where_begin(void);
/* The tick took n. */
void where_end(uint32_t n);
/* A hook of the machine: n instructions at an address. */
void where_block(uint32_t address, unsigned n);
/* Blocks that differ, or all: address, instructions in the cheapest tick, and in the dearest. */
void where_print(int all);

#endif
