/* SPDX-License-Identifier: MIT */
/* What a block of code costs: at most and at least.
 *
 * The processor by its technical reference manual (DDI0439). At most: one cycle an instruction; one
 * more a word loaded or stored; two more a branch that is taken, ten more a division. At least:
 * loads behind one another and stores take one cycle each, a branch that is taken one more, a
 * division two.
 *
 * The flash by RM0090, 3.5.2, at most: 64 instruction buffers and 8 data buffers of 16 bytes. The
 * least recently used one goes. A line in none of them takes the wait states. A line that follows
 * in order was requested when the line before it began, so the time that one ran is hidden. At
 * least: no waits at all. */
#include "machine.h"

#include <stdlib.h>
#include <string.h>

#define REFILL 2u /* the pipeline: one to three */

static void open_lines(struct lines *l, unsigned n)
{
    memset(l, 0, sizeof *l);
    memset(l->line, 0xFF, sizeof l->line);
    memset(l->place, 0xFF, sizeof l->place);
    l->n = n;
}

void cost_open(struct cost *c)
{
    open_lines(&c->code, LINES);
    open_lines(&c->data, DATA_LINES);
}

static unsigned bits(unsigned v)
{
    unsigned n = 0;
    for (; v; v &= v - 1) { n++; }
    return n;
}

/* What an instruction adds to its cycle. */
struct extra {
    uint8_t most, least, load, cond; /* cond: only if it is taken */
};

static struct extra moves(unsigned words, int load, int jumps)
{
    const unsigned refill = jumps ? REFILL : 0;
    const struct extra e = {(uint8_t)(words + refill),
        (uint8_t)((load ? 1 : 0) + words - 1 + (jumps ? 1 : 0)), (uint8_t)load, 0};
    return e;
}
static const struct extra branch = {REFILL, 1, 0, 0}, on_condition = {0, 0, 0, 1}, none;

/* Of a Thumb instruction of 16 bits, */
static struct extra extra16(unsigned i)
{
    if (i >> 12 == 0xD && (i >> 8 & 15) < 14) { return on_condition; }
    if ((i & 0xF500) == 0xB100) { return on_condition; } /* CBZ, CBNZ */
    if (i >> 11 == 0x1C || (i & 0xFF00) == 0x4700) { return branch; }
    if ((i & 0xFE00) == 0xB400) { return moves(bits(i & 0x1FF), 0, 0); }
    if ((i & 0xFE00) == 0xBC00) { return moves(bits(i & 0x1FF), 1, i >> 8 & 1); }
    if (i >> 12 == 0xC) { return moves(bits(i & 0xFF), i >> 11 & 1, 0); }
    if (i >> 11 == 9) { return moves(1, 1, 0); }
    if (i >> 12 == 5) { return moves(1, (i >> 9 & 7) >= 3, 0); }
    if (i >> 13 == 3 || i >> 12 == 8 || i >> 12 == 9) { return moves(1, i >> 11 & 1, 0); }
    return none;
}

/* and of one of 32. */
static struct extra extra32(unsigned a, unsigned b)
{
    static const struct extra division = {10, 1, 0, 0};
    if ((a & 0xF800) == 0xF000 && (b & 0xD000) == 0x8000 && (a >> 6 & 15) < 14) {
        return on_condition;
    }
    if ((a & 0xF800) == 0xF000 && b & 0x8000) { return branch; } /* B, BL */
    if ((a & 0xFE40) == 0xE800) { return moves(bits(b), a >> 4 & 1, a >> 4 & b >> 15 & 1); }
    if ((a & 0xFFF0) == 0xE8D0 && (b & 0xF0) <= 0x10) { return moves(1, 1, 1); } /* TBB, TBH */
    if ((a & 0xFE40) == 0xE840) { return moves(2, a >> 4 & 1, 0); }              /* LDRD, STRD */
    if ((a & 0xFE00) == 0xF800) { return moves(1, a >> 4 & 1, a >> 4 & 1 && b >> 12 == 15); }
    if ((a & 0xFFD0) == 0xFB90) { return division; } /* SDIV, UDIV */
    return none;
}

/* Instructions are counted here: Unicorn counts those of other blocks. */
static void learn(struct block *k, const uint8_t *code, uint32_t off, uint32_t size)
{
    unsigned most = 0, least = 0;
    struct extra before = none, e = none;
    for (uint32_t at = 0; at + 1 < size;) {
        const unsigned a = code[at] | (unsigned)code[at + 1] << 8;
        const int wide = a >> 11 >= 0x1D && at + 3 < size;
        const unsigned b = wide ? code[at + 2] | (unsigned)code[at + 3] << 8 : 0;
        e = wide ? extra32(a, b) : extra16(a);
        k->insns++;
        most += 1u + e.most;
        least += 1u + e.least - (unsigned)(e.load & before.load);
        before = e;
        at += wide ? 4 : 2;
    }
    k->cycles = (uint16_t)most;
    k->least = (uint16_t)least;
    k->conditional = e.cond;
    k->lines = (uint8_t)((off + size - 1) / 16 - off / 16 + 1);
}

/* 1: it had to be fetched. The buffer used longest ago goes. */
static int fetch(struct lines *l, uint32_t line)
{
    unsigned oldest = 0;
    l->turn++;
    if (l->place[line] >= 0) {
        l->used[l->place[line]] = l->turn;
        return 0;
    }
    for (unsigned i = 1; i < l->n; i++) {
        if (l->used[i] < l->used[oldest]) { oldest = i; }
    }
    if (l->line[oldest] != UINT32_MAX) { l->place[l->line[oldest]] = -1; }
    l->line[oldest] = line;
    l->used[oldest] = l->turn;
    l->place[line] = (int16_t)oldest;
    return 1;
}

struct spent cost_of(
    struct cost *c, const uint8_t *flash, uint32_t off, uint32_t size, unsigned wait_states)
{
    struct block *k = &c->block[off / 2];
    struct spent t = {0, 0};
    if (k->insns == 0) { learn(k, &flash[off], off, size); }
    if (c->conditional && off != c->end) { t = (struct spent){REFILL, 1}; }
    for (unsigned i = 0; i < k->lines; i++) {
        const uint32_t line = off / 16 + i;
        if (line != c->at) { /* since: what the line before has run */
            const uint32_t hidden = line == c->at + 1 ? c->since : 0;
            if (fetch(&c->code, line) && wait_states > hidden) {
                t.most += wait_states - hidden;
                c->stalls += wait_states - hidden;
            }
            c->at = line;
            c->since = 0;
        }
        c->since += k->cycles / k->lines;
    }
    c->conditional = k->conditional;
    c->end = off + size;
    t.most += k->cycles;
    t.least += k->least;
    return t;
}

uint32_t cost_of_data(struct cost *c, uint32_t off, unsigned wait_states)
{
    const uint32_t waits = fetch(&c->data, off / 16) ? wait_states : 0;
    c->data_stalls += waits;
    return waits;
}

void cost_begin(struct cost *c)
{
    for (uint32_t i = 0; i < c->runs; i++) { c->run[i]->tick = 0; }
    c->runs = 0;
}

void cost_keep(struct cost *c)
{
    for (uint32_t i = 0; i < BLOCKS; i++) { c->block[i].most = c->block[i].tick; }
}
