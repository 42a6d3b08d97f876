/* SPDX-License-Identifier: MIT */
/* What a block of code costs. The processor by its technical reference manual (DDI0439): one cycle
 * an instruction; one more a word loaded or stored, two more a change of the program counter, up to
 * ten more a division. The flash by RM0090: a line of 16 bytes that is in none of 64 buffers waits;
 * of one that follows in order the prefetch hides the time that the line before it runs. Words that
 * code loads from beside itself come through the data buffers: each counts as a hit but the first.
 */
#include "machine.h"

#include <stdlib.h>
#include <string.h>

void cost_open(struct cost *c)
{
    memset(c->line, 0xFF, sizeof c->line);
    memset(c->place, 0xFF, sizeof c->place);
    memset(c->used, 0, sizeof c->used);
}

static unsigned bits(unsigned v)
{
    unsigned n = 0;
    for (; v; v &= v - 1) { n++; }
    return n;
}

/* Beyond one cycle, of a Thumb instruction of 16 bits, */
static unsigned extra16(unsigned i)
{
    if (i >> 12 == 0xD && (i >> 8 & 15) < 14) { return 2; } /* B<cond>: taken, at worst */
    if (i >> 11 == 0x1C || (i & 0xFF00) == 0x4700) { return 2; }
    if ((i & 0xF500) == 0xB100) { return 2; } /* CBZ, CBNZ */
    if ((i & 0xFE00) == 0xB400) { return bits(i & 0x1FF); }
    if ((i & 0xFE00) == 0xBC00) { return bits(i & 0x1FF) + (i >> 8 & 1 ? 2 : 0); }
    if (i >> 12 == 0xC) { return bits(i & 0xFF); }
    if (i >> 11 == 9 || i >> 12 == 5 || i >> 13 == 3 || i >> 12 == 8 || i >> 12 == 9) { return 1; }
    return 0;
}

/* and of one of 32. */
static unsigned extra32(unsigned a, unsigned b)
{
    if ((a & 0xF800) == 0xF000 && b & 0x8000) { return 2; }             /* B, BL */
    if ((a & 0xFE40) == 0xE800) { return bits(b) + (b >> 15 ? 2 : 0); } /* LDM, STM */
    if ((a & 0xFE40) == 0xE840) { return 2; }                           /* LDRD, STRD, TBB */
    if ((a & 0xFE00) == 0xF800) { return (a & 0x10) && b >> 12 == 15 ? 3 : 1; }
    if ((a & 0xFFD0) == 0xFB90) { return 10; } /* SDIV, UDIV */
    return 0;
}

static void learn(struct block *k, const uint8_t *code, uint32_t off, uint32_t size, unsigned insns)
{
    unsigned cycles = insns;
    for (uint32_t at = 0; at + 1 < size;) {
        const unsigned a = code[at] | (unsigned)code[at + 1] << 8;
        const int wide = a >> 11 >= 0x1D && at + 3 < size;
        const unsigned b = wide ? code[at + 2] | (unsigned)code[at + 3] << 8 : 0;
        cycles += wide ? extra32(a, b) : extra16(a);
        at += wide ? 4 : 2;
    }
    k->insns = (uint16_t)insns;
    k->cycles = (uint16_t)cycles;
    k->lines = (uint8_t)((off + size - 1) / 16 - off / 16 + 1);
}

/* 1: it had to be fetched. The buffer used longest ago goes. */
static int fetch(struct cost *c, uint32_t line)
{
    unsigned oldest = 0;
    c->turn++;
    if (c->place[line] >= 0) {
        c->used[c->place[line]] = c->turn;
        return 0;
    }
    for (unsigned i = 1; i < LINES; i++) {
        if (c->used[i] < c->used[oldest]) { oldest = i; }
    }
    if (c->line[oldest] != UINT32_MAX) { c->place[c->line[oldest]] = -1; }
    c->line[oldest] = line;
    c->used[oldest] = c->turn;
    c->place[line] = (int16_t)oldest;
    return 1;
}

uint32_t cost_of(struct cost *c, const uint8_t *flash, uint32_t off, uint32_t size, unsigned insns,
    unsigned wait_states)
{
    struct block *k = &c->block[off / 2];
    uint32_t stall = 0, hidden = 0;
    if (k->insns == 0) { learn(k, &flash[off], off, size, insns); }
    for (unsigned i = 0; i < k->lines; i++) {
        if (fetch(c, off / 16 + i)) {
            stall += wait_states > hidden ? wait_states - hidden : 0;
            c->misses++;
        }
        hidden = k->cycles / k->lines;
    }
    c->stalls += stall;
    return k->cycles + stall;
}
