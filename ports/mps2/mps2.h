/* SPDX-License-Identifier: MIT */
/* Inside of this port: what its files need from each other. */
#ifndef MPS2_H
#define MPS2_H

#include <stdint.h>

/* A register: its address is in the manual of the board or of the processor. */
#define MPS2_REG(address) (*(volatile uint32_t *)(address))

/* --- start.c --- */
uint32_t mps2_stack_B(void); /* most that was used of it so far */

/* --- board.c --- */
void mps2_systick(void);             /* the interrupt */
void mps2_fault(uint32_t exception); /* on a fresh stack; does not return */

/* --- say.c: text over UART 0; a line that takes no character is given up --- */
void mps2_say_open(void);
void mps2_say(const char *text);
void mps2_say_u32(uint32_t value);
void mps2_exit(uint32_t status); /* ends an emulator or debugger; returns where there is none */

#endif
