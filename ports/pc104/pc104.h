/* Inside of the PC/104 port: what its files need from each other. */
#ifndef PC104_H
#define PC104_H

#include "exhand/units.h"

#include <stdint.h>

/* --- uart.c: COM1, 115200 8N1, polled; a line that does not take a character in
 * time is given up, so that a missing UART costs a moment and never the program --- */
void pc104_uart_open(void);
void pc104_uart_put(char c);

/* --- say.c: text for people, over the UART --- */
void pc104_say(const char *text);
void pc104_say_u32(uint32_t value);
void pc104_say_hex(uint32_t value);
int pc104_same_text(const char *a, const char *b);
void pc104_say_banner(uint32_t rate_Hz, struct exh_period T);

/* --- option.c: "name=number" on the multiboot command line --- */
uint32_t pc104_option_u32(const char *name, uint32_t otherwise);

/* --- timer.c: the 8254 that makes the ticks --- */
#define PC104_PIT_HZ 1193182u
/* Refuses as exh_board_init() does. Interrupts stay off. */
int pc104_timer_set(uint32_t rate_Hz, struct exh_period *achieved);
/* Deviation of a period from a rate, in counts of the PIT in one second. */
uint32_t pc104_timer_off_Hz(uint32_t rate_Hz, uint32_t divisor);
uint32_t pc104_timer_start(void);               /* ticks so far; the next is a whole period away */
uint32_t pc104_timer_wait(uint32_t seen_ticks); /* sleeps until there are others; modulo 2^32 */

/* --- trap.c: interrupts, and processor exceptions that say their name. Opened, as
 * the UART, before main() --- */
void pc104_trap_open(void);
void pc104_fault(uint32_t vector, uint32_t error, uint32_t eip);

/* --- crt0.S, vectors.S --- */
extern const uint32_t pc104_boot_magic;     /* what the loader left in EAX          */
extern const uint32_t pc104_boot_info;      /* and in EBX: physical address         */
extern const volatile uint32_t pc104_ticks; /* written by the timer interrupt alone */

#endif
