/* SPDX-License-Identifier: MIT */
#include "chips.h"

#define HPET_RUNS      1u
#define HPET_LEGACY    2u
#define TIMER_LEVEL    (1u << 1)
#define TIMER_ENABLE   (1u << 2)
#define TIMER_PERIODIC (1u << 3)
#define TIMER_CAN      (3u << 4) /* periodic, 64 bits */
#define TIMER_SET      (1u << 6)
#define TIMER_32       (1u << 8)
#define TIMER_WRITABLE 0x7F4Eu

static uint64_t hpet_counter(const struct hpet *t, uint64_t now_ps)
{
    if (!(t->config & HPET_RUNS)) { return t->held; }
    return t->held + (now_ps - t->from_ps) * 1000 / t->period_fs;
}

static uint64_t width_of(const struct hpet *t)
{
    return t->timer[0].config & TIMER_32 ? UINT32_MAX : UINT64_MAX;
}

/* When timer 0 meets its comparator next, seen from the counter `seen`. One that has been
 * passed is met when the counter has gone round, as in the chip. */
uint64_t hpet_next_ps(const struct hpet *t)
{
    uint64_t ahead;
    if (!t->period_fs || !(t->config & HPET_RUNS) || !(t->timer[0].config & TIMER_ENABLE)) {
        return CHIP_NEVER;
    }
    ahead = (t->timer[0].compare - t->held) & width_of(t);
    if (ahead == 0) { ahead = width_of(t); }
    if (ahead > (UINT64_MAX - t->period_fs) / t->period_fs) { return CHIP_NEVER; }
    return t->from_ps + (ahead * t->period_fs + 999) / 1000;
}

/* The counter's value is `held` at from_ps. Moves both up to the last access, without losing a part
 * of a count. */
static void hpet_move_up(struct hpet *t, uint64_t now_ps)
{
    const uint64_t counts = hpet_counter(t, now_ps) - t->held;
    /* a million counts are a whole number of nanoseconds' thousandths, whatever the period */
    const uint64_t whole = counts / 1000 * 1000;
    if (!(t->config & HPET_RUNS)) { return; }
    t->held += whole;
    t->from_ps += whole / 1000 * t->period_fs;
}

int hpet_advance(struct hpet *t, uint64_t now_ps)
{
    int fired = 0;
    while (hpet_next_ps(t) <= now_ps) {
        fired = 1;
        t->status |= t->timer[0].config & TIMER_LEVEL ? 1 : 0;
        if (!(t->timer[0].config & TIMER_PERIODIC) || t->timer[0].period == 0) {
            t->timer[0].config &= ~(uint64_t)TIMER_ENABLE; /* once; re-armed by a write */
            break;
        }
        const uint64_t met_ps = hpet_next_ps(t);
        t->timer[0].compare = (t->timer[0].compare + t->timer[0].period) & width_of(t);
        hpet_move_up(t, met_ps);
    }
    return fired && t->config & HPET_LEGACY;
}

static uint64_t hpet_word(const struct chips *c, uint64_t now_ps, uint32_t offset)
{
    const struct hpet *t = &c->hpet;
    const unsigned i = (offset - 0x100) / 0x20;
    if (offset == 0x000) { return (uint64_t)t->period_fs << 32 | 0x8086A201u; }
    if (offset == 0x010) { return t->config; }
    if (offset == 0x020) { return t->status; }
    if (offset == 0x0F0) { return hpet_counter(t, now_ps); }
    if (offset < 0x100 || i > 2) { return 0; }
    if ((offset & 0x1F) == 0) { return t->timer[i].config | TIMER_CAN; }
    if ((offset & 0x1F) == 8) { return t->timer[i].compare; }
    return 0;
}

uint32_t hpet_read(const struct chips *c, uint64_t now_ps, uint32_t offset)
{
    const uint64_t v = c->hpet.period_fs ? hpet_word(c, now_ps, offset & ~7u) : UINT64_MAX;
    return (uint32_t)(offset & 4 ? v >> 32 : v);
}

static void hpet_configure(struct hpet *t, uint64_t now_ps, uint64_t v)
{
    if (t->config & HPET_RUNS) { t->held = hpet_counter(t, now_ps); }
    t->from_ps = now_ps;
    t->config = v & (HPET_RUNS | HPET_LEGACY);
    t->loads++;
}

static void timer_compare(struct hpet *t, unsigned i, uint64_t v)
{
    const uint64_t config = t->timer[i].config;
    if (!(config & TIMER_PERIODIC) || config & TIMER_SET) { t->timer[i].compare = v; }
    if (config & TIMER_PERIODIC) { t->timer[i].period = v; }
    if (i == 0) { t->loads++; }
}

void hpet_write(struct chips *c, uint64_t now_ps, uint32_t offset, uint32_t value)
{
    struct hpet *t = &c->hpet;
    const uint32_t word = offset & ~7u;
    const unsigned i = (word - 0x100) / 0x20;
    uint64_t old;
    if (!t->period_fs) { return; }
    old = word == 0x0F0 ? hpet_counter(t, now_ps) : hpet_word(c, now_ps, word);
    const uint64_t v = offset & 4 ? (old & UINT32_MAX) | (uint64_t)value << 32
                                  : (old & ~(uint64_t)UINT32_MAX) | value;
    if (word == 0x010) { hpet_configure(t, now_ps, v); }
    if (word == 0x020) { t->status &= ~v; }
    if (word == 0x0F0 && !(t->config & HPET_RUNS)) { t->held = v; }
    if (word < 0x100 || i > 2) { return; }
    if ((word & 0x1F) == 0) { t->timer[i].config = v & TIMER_WRITABLE; }
    if ((word & 0x1F) == 8) {
        /* the value is set by its low half; writing the high one afterwards keeps that */
        timer_compare(t, i, v);
        if (!(offset & 4)) { t->timer[i].config &= ~(uint64_t)TIMER_SET; }
    }
}

int hpet_is_legacy(const struct hpet *t) { return (t->config & HPET_LEGACY) != 0; }
