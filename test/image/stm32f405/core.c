/* SPDX-License-Identifier: MIT */
/* System registers of the Cortex-M4: SysTick, NVIC, SCB, MPU as registers, DWT's counter. */
#include "stm.h"

#define NONE 256

/* --- exceptions --- */

/* Lower goes first. Exceptions without a register are below 0. */
static int priority_of(const struct stm_core *c, unsigned e)
{
    switch (e) {
    case 1: return -3;
    case STM_NMI: return -2;
    case STM_HARDFAULT: return -1;
    default: return c->priority[e] >> 4;
    }
}

static int group_of(const struct stm_core *c, int priority)
{
    const unsigned prigroup = c->scb[3] >> 8 & 7; /* AIRCR; 4 bits of priority are there */
    return priority < 0 || prigroup <= 3 ? priority : priority >> (prigroup - 3);
}

static int running(const struct stm_core *c)
{
    int lowest = NONE;
    for (unsigned e = 2; e < STM_EXCEPTIONS; e++) {
        const int p = group_of(c, priority_of(c, e));
        if (c->active[e] && p < lowest) { lowest = p; }
    }
    return lowest;
}

static unsigned first_pending(const struct stm_core *c)
{
    unsigned found = 0;
    for (unsigned e = 2; e < STM_EXCEPTIONS; e++) {
        const int on = e < STM_IRQ0 || c->enabled[e];
        if (on && c->pending[e] && (!found || priority_of(c, e) < priority_of(c, found))) {
            found = e;
        }
    }
    return found;
}

void stm_pend(struct stm *s, unsigned e)
{
    s->core.pending[e] = 1;
    s->wake = 0;
}

unsigned stm_wanted(const struct stm *s, int masked)
{
    const struct stm_core *c = &s->core;
    const unsigned e = first_pending(c);
    if (e == 0 || (masked && priority_of(c, e) >= 0)) { return 0; }
    return group_of(c, priority_of(c, e)) < running(c) ? e : 0;
}

int stm_wakes(const struct stm *s)
{
    const struct stm_core *c = &s->core;
    const unsigned e = first_pending(c);
    return e && group_of(c, priority_of(c, e)) < running(c);
}

/* --- SysTick: counts down from its reload value, which it meets again after one more --- */

enum { CSR, RVR, CVR };
#define RUNS  1u
#define TICKS 2u
#define FLAG  0x10000u

static uint64_t systick_cycle(const struct stm *s)
{
    return (uint64_t)s->clk.cycle * (s->core.systick[CSR] & 4 ? 1 : 8);
}

static uint32_t systick_value(const struct stm *s)
{
    const struct stm_core *c = &s->core;
    const uint64_t n = (s->now - c->systick_from) / systick_cycle(s);
    if (!(c->systick[CSR] & RUNS)) { return c->systick[CVR]; }
    return n == 0 ? 0 : c->systick[RVR] - (uint32_t)((n - 1) % (c->systick[RVR] + 1ull));
}

static uint64_t systick_next(const struct stm *s)
{
    const struct stm_core *c = &s->core;
    if (!(c->systick[CSR] & RUNS) || c->systick[RVR] == 0) { return STM_NEVER; }
    return c->systick_from + (c->systick[RVR] + 1ull) * systick_cycle(s);
}

static void systick_write(struct stm *s, uint32_t at, uint32_t v)
{
    struct stm_core *c = &s->core;
    if (at == CSR) {
        if (v & RUNS && !(c->systick[CSR] & RUNS)) { c->systick_from = s->now; }
        c->systick[CSR] = (c->systick[CSR] & FLAG) | (v & 7);
    } else if (at == RVR) {
        c->systick[RVR] = v & 0xFFFFFF;
    } else if (at == CVR) {
        c->systick[CVR] = 0;
        c->systick[CSR] &= ~FLAG;
        c->systick_from = s->now;
    }
    s->wake = 0;
}

void stm_core_go_on(struct stm *s)
{
    struct stm_core *c = &s->core;
    while (systick_next(s) <= s->now) {
        c->systick_from = systick_next(s);
        c->systick[CSR] |= FLAG;
        if (stm_outside.tick) { stm_outside.tick(stm_outside.ctx); }
        if (c->systick[CSR] & TICKS) { stm_pend(s, STM_SYSTICK); }
    }
}

uint64_t stm_core_next(const struct stm *s) { return systick_next(s); }

/* --- registers --- */

static uint32_t nvic_bits(const uint8_t *of, unsigned word)
{
    uint32_t v = 0;
    for (unsigned i = 0; i < 32 && word * 32 + i < STM_IRQS; i++) {
        v |= (uint32_t)of[STM_IRQ0 + word * 32 + i] << i;
    }
    return v;
}

static void nvic_set(uint8_t *of, unsigned word, uint32_t bits, uint8_t to)
{
    for (unsigned i = 0; i < 32 && word * 32 + i < STM_IRQS; i++) {
        if (bits >> i & 1) { of[STM_IRQ0 + word * 32 + i] = to; }
    }
}

static uint32_t nvic_read(struct stm *s, uint32_t off)
{
    const struct stm_core *c = &s->core;
    const unsigned word = off >> 2 & 7;
    switch (off >> 7) {
    case 0:
    case 1: return nvic_bits(c->enabled, word);
    case 2:
    case 3: return nvic_bits(c->pending, word);
    case 4: return nvic_bits(c->active, word);
    default: return off - 0x300 < STM_IRQS ? c->priority[STM_IRQ0 + off - 0x300] : 0;
    }
}

static void nvic_write(struct stm *s, uint32_t off, unsigned size, uint32_t v)
{
    struct stm_core *c = &s->core;
    const unsigned word = off >> 2 & 7;
    s->wake = 0;
    switch (off >> 7) {
    case 0: nvic_set(c->enabled, word, v, 1); return;
    case 1: nvic_set(c->enabled, word, v, 0); return;
    case 2: nvic_set(c->pending, word, v, 1); return;
    case 3: nvic_set(c->pending, word, v, 0); return;
    default: break;
    }
    for (unsigned i = 0; i < size && off >= 0x300 && off - 0x300 + i < STM_IRQS; i++) {
        c->priority[STM_IRQ0 + off - 0x300 + i] = (uint8_t)(v >> 8 * i & 0xF0);
    }
}

enum { ICSR = 1, VTOR = 2, AIRCR = 3, SHPR = 6, SHCSR = 9, CFSR = 10, HFSR = 11 };

static void scb_write(struct stm *s, uint32_t off, unsigned size, uint32_t v)
{
    struct stm_core *c = &s->core;
    const unsigned at = off >> 2;
    s->wake = 0;
    if (at >= SHPR && at < SHPR + 3) {
        for (unsigned i = 0; i < size; i++) {
            c->priority[4 + off - 4 * SHPR + i] = (uint8_t)(v >> 8 * i & 0xF0);
        }
    } else if (at == ICSR) {
        if (v & 1u << 31) { stm_pend(s, STM_NMI); }
        if (v & 1u << 28) { stm_pend(s, STM_PENDSV); }
        if (v & 1u << 27) { c->pending[STM_PENDSV] = 0; }
        if (v & 1u << 26) { stm_pend(s, STM_SYSTICK); }
        if (v & 1u << 25) { c->pending[STM_SYSTICK] = 0; }
    } else if (at == AIRCR) {
        if (v >> 16 != 0x5FA) { return; }
        c->scb[AIRCR] = v & 0x700;
        c->wants_reset = (uint8_t)(v >> 2 & 1);
        if (c->wants_reset) {
            s->resets = 1;
            s->reset_flags = STM_SOFT;
        }
    } else if (at == CFSR || at == HFSR) {
        c->scb[at] &= ~v;
    } else if (at < 40) {
        c->scb[at] = at == VTOR ? v & 0x3FFFFF80u : v;
    }
}

static uint32_t scb_read(struct stm *s, uint32_t off)
{
    const struct stm_core *c = &s->core;
    const unsigned at = off >> 2;
    if (at == 0) { return 0x410FC241u; }
    if (at == AIRCR) { return 0xFA050000u | c->scb[AIRCR]; }
    if (at == ICSR) {
        return (uint32_t)c->pending[STM_NMI] << 31 | (uint32_t)c->pending[STM_PENDSV] << 28 |
               (uint32_t)c->pending[STM_SYSTICK] << 26 | first_pending(c) << 12;
    }
    if (at >= SHPR && at < SHPR + 3) {
        const uint8_t *p = &c->priority[4 + off - 4 * SHPR];
        return p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
    }
    return at < 40 ? c->scb[at] : 0;
}

/* A region is written by its number, in RBAR or RNR. */
static void mpu_write(struct stm *s, uint32_t off, uint32_t v)
{
    struct stm_core *c = &s->core;
    uint32_t *region = c->mpu_region[c->mpu[2] & 7];
    switch (off >> 2) {
    case 1: c->mpu[1] = v & 7; break;
    case 2: c->mpu[2] = v & 7; break;
    case 3:
        if (v & 0x10) { c->mpu[2] = v & 7; }
        c->mpu_region[c->mpu[2] & 7][0] = v & ~31u;
        break;
    case 4: region[1] = v; break;
    default: break;
    }
}

static uint32_t mpu_read(const struct stm *s, uint32_t off)
{
    const struct stm_core *c = &s->core;
    switch (off >> 2) {
    case 0: return 0x800; /* eight regions */
    case 3: return c->mpu_region[c->mpu[2] & 7][0] | c->mpu[2];
    case 4: return c->mpu_region[c->mpu[2] & 7][1];
    default: return off < 12 ? c->mpu[off >> 2] : 0;
    }
}

uint32_t stm_core_read(struct stm *s, uint32_t a, unsigned size)
{
    struct stm_core *c = &s->core;
    (void)size;
    if (a == 0xE0001004u) {
        return c->dwt[0] & 1 ? c->dwt[1] + (uint32_t)((s->now - c->cycles_from) / s->clk.cycle)
                             : c->dwt[1];
    }
    if (a == 0xE0001000u) { return c->dwt[0] | 0x40000000u; }
    if (a >= 0xE000E010u && a < 0xE000E020u) {
        const unsigned at = (a - 0xE000E010u) >> 2;
        const uint32_t v = at == CVR ? systick_value(s) : c->systick[at];
        if (at == CSR) { c->systick[CSR] &= ~FLAG; }
        return v;
    }
    if (a >= 0xE000E100u && a < 0xE000E500u) { return nvic_read(s, a - 0xE000E100u); }
    if (a >= 0xE000ED90u && a < 0xE000EDC0u) { return mpu_read(s, a - 0xE000ED90u); }
    if (a >= 0xE000ED00u && a < 0xE000ED90u) { return scb_read(s, a - 0xE000ED00u); }
    if (a >= 0xE000EDF0u && a < 0xE000EE00u) { return c->dcb[(a - 0xE000EDF0u) >> 2]; }
    if (a >= 0xE000EF30u && a < 0xE000EF48u) { return 0; } /* FPU */
    s->unknown++;
    s->unknown_at = s->unknown_at ? s->unknown_at : a;
    return 0;
}

void stm_core_write(struct stm *s, uint32_t a, unsigned size, uint32_t v)
{
    struct stm_core *c = &s->core;
    if (a == 0xE0001004u) {
        c->dwt[1] = v;
        c->cycles_from = s->now;
    } else if (a == 0xE0001000u) {
        if (v & 1 && !(c->dwt[0] & 1)) { c->cycles_from = s->now; }
        c->dwt[0] = c->dcb[3] & 1u << 24 ? v & 1 : 0; /* DEMCR.TRCENA first */
    } else if (a >= 0xE000E010u && a < 0xE000E020u) {
        systick_write(s, (a - 0xE000E010u) >> 2, v);
    } else if (a >= 0xE000E100u && a < 0xE000E500u) {
        nvic_write(s, a - 0xE000E100u, size, v);
    } else if (a >= 0xE000ED90u && a < 0xE000EDC0u) {
        mpu_write(s, a - 0xE000ED90u, v);
    } else if (a >= 0xE000ED00u && a < 0xE000ED90u) {
        scb_write(s, a - 0xE000ED00u, size, v);
    } else if (a >= 0xE000EDF0u && a < 0xE000EE00u) {
        c->dcb[(a - 0xE000EDF0u) >> 2] = v;
    } else if (a < 0xE000EF30u || a >= 0xE000EF48u) {
        s->unknown++;
        s->unknown_at = s->unknown_at ? s->unknown_at : a;
    }
}

void stm_core_reset(struct stm *s)
{
    const struct stm_core zero = {.cycles_from = s->now};
    s->core = zero;
    s->core.scb[5] = 0x200; /* CCR: the stack is aligned to 8 */
}
