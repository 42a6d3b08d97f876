/* SPDX-License-Identifier: MIT */
/* Table: what the pins have beside what Linux says, a row a channel. */
#ifndef GUEST_TABLE_H
#define GUEST_TABLE_H

#include <stdint.h>

void table_head(const char *title, const char *pin_unit, const char *linux_unit);

/* One value: that of the pin, the expected one in Linux's unit, and the actual one. */
void table_row(const char *name, ...);
void table_value(int64_t pin, int64_t wanted, int64_t got);
void table_end_row(void);

/* A statement that holds or not. */
void say(int holds, const char *format, ...);

extern uint32_t values, wrong;

#endif
