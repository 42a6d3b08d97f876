/* SPDX-License-Identifier: MIT */
/* A program that leaves memory: each way ends in a state that has a name, and soon. */
#include "faults.h"

#include <string.h>

#define CODE    (STM_FLASH + 0x400)
#define HANDLER (STM_FLASH + 0x500)
#define STACK   (STM_RAM + 0x2000)
#define WATCHED (STM_HZ / 100)
#define BX_R0   0x4700

enum handlers { GOOD, ASTRAY }; /* each vector's: an endless loop; where the jump went, too */

static const struct {
    const char *name;
    uint32_t to, sp;
    uint16_t insn;
    uint8_t handlers;
    enum machine_end end;
    uint8_t in; /* exception that runs at the end */
    const char *why;
} row[] = {
    {"into a hole", 0x30000001, STACK, BX_R0, GOOD, M_DONE, STM_HARDFAULT, ""},
    {"to address 1", 1, STACK, BX_R0, GOOD, M_DONE, STM_HARDFAULT, ""},
    {"behind the flash", 0x08100001, STACK, BX_R0, GOOD, M_DONE, STM_HARDFAULT, ""},
    {"to flash's last half-word", 0x080FFFFF, STACK, BX_R0, GOOD, M_DONE, STM_HARDFAULT, ""},
    {"into erased flash", 0x08000601, STACK, BX_R0, GOOD, M_DONE, STM_HARDFAULT, ""},
    {"to an even address", HANDLER, STACK, BX_R0, GOOD, M_DONE, STM_HARDFAULT, ""},
    {"into peripherals", 0x40000001, STACK, BX_R0, GOOD, M_DONE, STM_HARDFAULT, ""},
    {"into system registers", 0xE000E001, STACK, BX_R0, GOOD, M_DONE, STM_HARDFAULT, ""},
    {"to a return out of no handler", 0xFFFFFFF9, STACK, BX_R0, GOOD, M_DONE, STM_HARDFAULT, ""},
    {"into RAM", STM_RAM + 1, STACK, BX_R0, GOOD, M_BROKEN, 0, "control went to 0x20000000"},
    {"an undefined instruction", 1, STACK, 0xDEFF, GOOD, M_DONE, STM_HARDFAULT, ""},
    {"a breakpoint", 1, STACK, 0xBE00, GOOD, M_BROKEN, 0, "a breakpoint at 0x8000402"},
    {"a supervisor call", 1, STACK, 0xDF00, GOOD, M_DONE, STM_SVCALL, ""},
    {"the stack is nowhere", 0x30000001, 0x10, BX_R0, GOOD, M_DONE, STM_HARDFAULT, ""},
    {"handlers in a hole, too", 0x30000001, STACK, BX_R0, ASTRAY, M_DONE, STM_HARDFAULT,
        "locked up: exception 5 in a handler, at 0x30000000"},
    {"handlers in peripherals, too", 0x40000001, STACK, BX_R0, ASTRAY, M_DONE, STM_HARDFAULT,
        "locked up: exception 4 in a handler, at 0x40000000"},
};
enum { ROWS = sizeof row / sizeof row[0] };

static void put(struct machine *m, uint32_t at, uint32_t v, size_t size)
{
    memcpy(&m->flash[at - STM_FLASH], &v, size);
}

static void program(struct machine *m, unsigned i)
{
    put(m, STM_FLASH, row[i].sp, 4);
    put(m, STM_FLASH + 4, CODE | 1, 4);
    for (uint32_t e = 2; e < 16; e++) {
        put(m, STM_FLASH + 4 * e, row[i].handlers == GOOD ? HANDLER | 1 : row[i].to, 4);
    }
    put(m, CODE, 0x4801, 2); /* ldr r0, [pc, #4] */
    put(m, CODE + 2, row[i].insn, 2);
    put(m, CODE + 8, row[i].to, 4);
    put(m, HANDLER, 0xE7FE, 2);
}

int stm_jumps(void)
{
    unsigned bad = 0;
    for (unsigned i = 0; i < ROWS; i++) {
        struct machine m;
        memset(&m, 0, sizeof m);
        if (machine_open(&m, NULL) < 0) { return 1; }
        program(&m, i);
        stm_reset(&m.s, STM_POWER_ON);
        machine_boot(&m);
        m.stop_at = m.s.now + WATCHED;
        const enum machine_end end = machine_run(&m);
        const unsigned in = machine_reg(&m, UC_ARM_REG_XPSR) & 0x1FF;
        if (end != row[i].end || in != row[i].in || strcmp(m.why, row[i].why) != 0) {
            printf("%s: ended as %d in exception %u: %s\n", row[i].name, (int)end, in, m.why);
            bad++;
        }
        machine_close(&m);
    }
    printf("%u jumps out of the program: each ends in its state: %s\n", (unsigned)ROWS,
        bad ? "NOT ALL" : "all");
    return bad != 0;
}
