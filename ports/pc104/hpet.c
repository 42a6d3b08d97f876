/* SPDX-License-Identifier: MIT */
/* HPET in legacy replacement mode: timer 0 takes the 8254's place on IRQ 0. Registers are read
 * and written 32 bits at a time, so the counter is used modulo 2^32. */
#include "pc104.h"

#include "exhand/error.h"
#include "exhand/fix.h"

#define BASE 0xFED00000u /* of every chip set with one; firmware may have left it off */
enum { CAP = 0x00, PERIOD_FS = 0x04, CONF = 0x10, COUNTER = 0xF0, T0_CONF = 0x100, T0_CMP = 0x108 };
#define CAP_LEGACY   (1u << 15)
#define CONF_ENABLE  1u
#define CONF_LEGACY  2u
#define T_INTERRUPT  (1u << 2)
#define T_PERIODIC   (1u << 3)
#define T_CAN_REPEAT (1u << 4)
#define T_SET_VALUE  (1u << 6) /* the next write of the comparator also sets its accumulator */
#define T_32BIT      (1u << 8)

#define PERIOD_FS_MIN  1000000u   /* 1 GHz: a period of 1 s stays below 2^31 counts */
#define PERIOD_FS_MAX  100000000u /* the specification's */
#define FS_PER_S       UINT64_C(1000000000000000)
#define PROBE_READS    100000u
#define COMPARE_COUNTS 11932u /* of the 8254: 10 ms */
#define COMPARE_TRIES  8u     /* an emulator's host may take a moment away in between */

static uint32_t get(unsigned reg) { return *(volatile uint32_t *)(BASE + reg); }

static void put(unsigned reg, uint32_t value) { *(volatile uint32_t *)(BASE + reg) = value; }

uint32_t pc104_hpet_now(void) { return get(COUNTER); }

/* Detects a stopped counter or an empty bus, before currents flow. */
static int counts(void)
{
    const uint32_t first = get(COUNTER);
    for (uint32_t i = 0; i < PROBE_READS; i++) {
        if (get(COUNTER) != first) { return 1; }
    }
    return 0;
}

/* The frequency is only what a register says: 10 ms by the 8254 must be 10 ms. 1 if they agree
 * within 1 %, or if there is no 8254 that counts. */
static int agrees(uint32_t Hz)
{
    const uint32_t want = (uint32_t)exh_udiv64((uint64_t)Hz * COMPARE_COUNTS, PC104_PIT_HZ, NULL);
    pc104_pit_load(65536);
    for (unsigned n = 0; n < COMPARE_TRIES; n++) {
        const uint32_t from = pc104_pit_count(), began = get(COUNTER);
        uint32_t reads = 0, took;
        while (((from - pc104_pit_count()) & 0xFFFFu) < COMPARE_COUNTS) {
            if (++reads == PROBE_READS) { return 1; }
        }
        took = get(COUNTER) - began;
        if (took >= want - want / 100 && took <= want + want / 100) { return 1; }
    }
    return 0;
}

int pc104_hpet_open(struct pc104_timer *t, const char **why)
{
    const uint32_t cap = get(CAP), period_fs = get(PERIOD_FS), vendor = cap >> 16;

    *why = "not there";
    if (vendor == 0 || vendor == 0xFFFFu) { return -EXH_E_ABSENT; }
    *why = "cannot replace the 8254";
    if (!(cap & CAP_LEGACY) || !(get(T0_CONF) & T_CAN_REPEAT)) { return -EXH_E_ABSENT; }
    *why = "says a period outside 1..100 ns";
    if (period_fs < PERIOD_FS_MIN || period_fs > PERIOD_FS_MAX) { return -EXH_E_IO; }
    t->name = "HPET";
    t->Hz = (uint32_t)exh_udiv64(FS_PER_S + period_fs / 2, period_fs, NULL);
    t->counts_max = INT32_MAX;
    put(T0_CONF, 0);
    put(CONF, CONF_ENABLE);
    *why = "stands still";
    if (!counts()) { return -EXH_E_IO; }
    *why = "and 8254 differ by more than 1 %";
    return agrees(t->Hz) ? 0 : -EXH_E_IO;
}

/* The first write sets the accumulator, the second the period, on every chip set and at any count.
 * The counter stops for these writes, which precede the first tick. */
void pc104_hpet_start(uint32_t first, uint32_t period)
{
    put(CONF, 0);
    put(T0_CONF, T_INTERRUPT | T_PERIODIC | T_SET_VALUE | T_32BIT);
    put(T0_CMP, first);
    put(T0_CMP, period);
    put(CONF, CONF_ENABLE | CONF_LEGACY);
}

void pc104_hpet_stop(void)
{
    put(T0_CONF, 0);
    put(CONF, 0);
}
