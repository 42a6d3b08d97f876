/* SPDX-License-Identifier: MIT */
/* Timers (RM0090 chapters 17 to 20): upwards by the clock, or by an encoder at channels 1 and 2. */
#include "stm.h"

#include <string.h>

enum {
    CR1 = 0,
    SMCR = 2,
    DIER = 3,
    SR = 4,
    EGR = 5,
    CCMR1 = 6,
    CCER = 8,
    CNT = 9,
    PSC = 10,
    ARR = 11
};
#define CEN 1u
#define UIF 1u
#define UIE 1u

static const uint8_t irq[STM_TIMS + 1] = {
    [1] = 25, [2] = 28, [3] = 29, [4] = 30, [5] = 50, [8] = 44};

static int is_wide(unsigned n) { return n == 2 || n == 5; }

static uint32_t top(const struct stm *s, unsigned n)
{
    return is_wide(n) ? s->tim[n].r[ARR] : s->tim[n].r[ARR] & 0xFFFF;
}

static int counts_time(const struct stm *s, unsigned n)
{
    return (s->tim[n].r[CR1] & CEN) && (s->tim[n].r[SMCR] & 7) == 0 && top(s, n);
}

/* Units of time a count. Timers 1 and 8 to 11 are of the faster bus. */
static uint64_t count_time(const struct stm *s, unsigned n)
{
    const uint32_t Hz = n == 1 || n >= 8 ? s->clk.tim2_Hz : s->clk.tim1_Hz;
    return (uint64_t)((STM_HZ + Hz / 2) / Hz) * (s->tim[n].r[PSC] + 1ull);
}

static uint64_t round_time(const struct stm *s, unsigned n)
{
    return (top(s, n) + 1ull) * count_time(s, n);
}

static uint32_t count(const struct stm *s, unsigned n)
{
    if (!counts_time(s, n)) { return s->tim[n].r[CNT]; }
    return (uint32_t)((s->now - s->tim[n].from) / count_time(s, n) % (top(s, n) + 1ull));
}

static void set_count(struct stm *s, unsigned n, uint32_t v)
{
    s->tim[n].r[CNT] = is_wide(n) ? v : v & 0xFFFF;
    s->tim[n].from = s->now - s->tim[n].r[CNT] * count_time(s, n);
}

static void update(struct stm *s, unsigned n)
{
    s->tim[n].r[SR] |= UIF;
    if (s->tim[n].r[DIER] & UIE && irq[n]) { stm_pend(s, STM_IRQ0 + irq[n]); }
}

void stm_tim_go_on(struct stm *s)
{
    for (unsigned n = 1; n <= STM_TIMS; n++) {
        while (counts_time(s, n) && s->tim[n].from + round_time(s, n) <= s->now) {
            s->tim[n].from += round_time(s, n);
            update(s, n);
        }
    }
}

uint64_t stm_tim_next(const struct stm *s)
{
    uint64_t next = STM_NEVER;
    for (unsigned n = 1; n <= STM_TIMS; n++) {
        if (!counts_time(s, n)) { continue; }
        const uint64_t at = s->tim[n].from + round_time(s, n);
        next = at < next ? at : next;
    }
    return next;
}

/* Encoder modes: 1 counts at edges of input 2, 2 of input 1, 3 of both; the inputs must be mapped
 * straight. Inverting one of them turns the direction. */
void stm_tim_turn(struct stm *s, unsigned n, int32_t quarters)
{
    const uint32_t *r = s->tim[n].r;
    const unsigned mode = r[SMCR] & 7;
    const int turned = (r[CCER] >> 1 ^ r[CCER] >> 5) & 1;
    const int64_t modulus = top(s, n) + 1ll;
    int64_t v = r[CNT];
    if (!(r[CR1] & CEN) || mode < 1 || mode > 3 || (r[CCMR1] & 0x303) != 0x101) { return; }
    v += turned ? -(int64_t)quarters : quarters;
    if (mode != 3) { v = (int64_t)r[CNT] + (turned ? -quarters : quarters) / 2; }
    v = (v % modulus + modulus) % modulus;
    s->tim[n].r[CNT] = (uint32_t)v;
}

uint32_t stm_tim_read(struct stm *s, unsigned n, uint32_t off)
{
    const unsigned at = off >> 2;
    return at == CNT ? count(s, n) : at < 24 && at != EGR ? s->tim[n].r[at] : 0;
}

void stm_tim_write(struct stm *s, unsigned n, uint32_t off, uint32_t v)
{
    struct stm_tim *t = &s->tim[n];
    const unsigned at = off >> 2;
    const uint32_t now = count(s, n);
    s->wake = 0;
    if (at >= 24) { return; }
    switch (at) {
    case CNT: set_count(s, n, v); return;
    case SR: t->r[SR] &= v; return;
    case EGR:
        if (v & 1) {
            set_count(s, n, 0);
            t->r[SR] |= UIF;
        }
        return;
    case ARR: t->r[ARR] = is_wide(n) ? v : v & 0xFFFF; break;
    case PSC: t->r[PSC] = v & 0xFFFF; break;
    default: t->r[at] = v; break;
    }
    set_count(s, n, now);
}

void stm_tim_reset(struct stm *s, unsigned n)
{
    memset(&s->tim[n], 0, sizeof s->tim[n]);
    s->tim[n].r[ARR] = is_wide(n) ? UINT32_MAX : 0xFFFF;
}
