/* SPDX-License-Identifier: MIT */
#include "cyber.h"

#define BAUD        115200u
#define OUT         ((unsigned)sizeof((struct emu_cyber *)0)->out)
#define SWITCH_BITS 2u /* of the status: the switch is sometimes not pressed */

/* --- the line to the host --- */

static void say(struct emu_cyber *g, unsigned byte)
{
    if (g->out_n == OUT) { return; } /* more than the line can carry: lost */
    if (g->out_n == 0 && g->free_ns < g->now_ns) { g->free_ns = g->now_ns; }
    g->out[(g->out_at + g->out_n) % OUT] = (uint8_t)byte;
    g->out_n++;
}

static void say_error(struct emu_cyber *g, unsigned letter)
{
    say(g, 'e');
    say(g, letter);
    say(g, 0);
}

/* --- frames --- */

static uint8_t noise(struct emu_cyber *g)
{
    g->noise = g->noise * 1664525u + 1013904223u;
    return (uint8_t)(g->noise >> 24);
}

static int has_status(const struct emu_cyber *g) { return g->forced ? g->forced == 1 : g->status; }

static void say_garbage(struct emu_cyber *g)
{
    for (unsigned i = 0; i < EMU_CYBER_NOISE_B; i++) {
        say(g, i % 4 == 3 ? 'S' : (unsigned)noise(g) | 0x80u);
    }
}

static void say_samples(struct emu_cyber *g, unsigned kind)
{
    const unsigned n = kind == EMU_CYBER_CUT        ? 10
                       : kind == EMU_CYBER_EIGHTEEN ? 18
                                                    : EMU_CYBER_SENSORS;
    const unsigned at = noise(g) % EMU_CYBER_SENSORS;
    for (unsigned i = 0; i < n; i++) {
        if (kind == EMU_CYBER_DROPPED && i == at) { continue; }
        if (kind == EMU_CYBER_INSERTED && i == at) { say(g, noise(g) | 1u); }
        say(g, kind == EMU_CYBER_ZERO && i == at ? 0u : g->sample[i]);
    }
}

static void say_frame(struct emu_cyber *g, unsigned header, unsigned kind)
{
    if (kind == EMU_CYBER_SILENT) { return; }
    if (kind == EMU_CYBER_GARBAGE) { say_garbage(g); }
    if (kind == EMU_CYBER_ERROR) { say_error(g, '?'); }
    if (kind != EMU_CYBER_HEADLESS) { say(g, header); }
    say_samples(g, kind);
    if (kind == EMU_CYBER_CUT) { return; }
    if (has_status(g)) { say(g, (unsigned)(kind != EMU_CYBER_OFF) | (noise(g) & SWITCH_BITS)); }
    if (kind == EMU_CYBER_FAST || (kind == EMU_CYBER_OFF && !has_status(g))) {
        say(g, 'e');
        say(g, kind == EMU_CYBER_FAST ? 's' : 'g');
    }
    if (kind != EMU_CYBER_ENDLESS) { say(g, 0); }
}

static void sample(struct emu_cyber *g, unsigned header)
{
    const unsigned kind = g->frames % (g->every ? g->every : 1) == 0 ? g->kind : EMU_CYBER_WELL;
    g->frames++;
    g->wrong += kind != EMU_CYBER_WELL;
    say_frame(g, header, kind);
    if (kind == EMU_CYBER_TWICE) { say_frame(g, header, EMU_CYBER_WELL); }
}

/* --- commands --- */

/* Reads the number at index *at of the command and moves *at beyond it. */
static uint32_t number(const struct emu_cyber *g, unsigned *at)
{
    uint32_t v = 0;
    while (*at < g->line_n && g->line[*at] == ' ') { ++*at; }
    while (*at < g->line_n && g->line[*at] >= '0' && g->line[*at] <= '9' && v < 100000) {
        v = v * 10 + (g->line[(*at)++] - (uint32_t)'0');
    }
    return v;
}

/* 1: it was one. */
static int obey(struct emu_cyber *g)
{
    unsigned at = 1;
    const uint32_t v = number(g, &at);
    switch (g->line[0]) {
    case 'f':
    case 'l': return 1;
    case 'u': g->status = v != 0; return 1;
    case 't': {
        const uint64_t ticks = (uint64_t)v * number(g, &at);
        if (ticks == 0 || ticks > UINT64_C(4000000000) * BAUD / 1000000000u) { return 0; }
        g->period_ns = (uint32_t)(ticks * 1000000000u / BAUD);
        return 1;
    }
    default: return 0;
    }
}

static void end_of_line(struct emu_cyber *g)
{
    if (obey(g)) {
        g->commands++;
        say(g, g->line[0]);
        say(g, 0);
    } else {
        g->refused++;
        say_error(g, '?');
    }
    g->line_n = 0;
}

void emu_cyber_put(struct emu_cyber *g, uint8_t byte)
{
    if (g->deaf) { return; }
    if (byte == 3 || (byte == 'c' && g->line_n == 1 && g->line[0] == '^')) {
        g->streams = 0;
        g->line_n = 0;
    } else if (g->line_n == 0 && byte == 'S') {
        if (!g->streams) { g->next_ns = g->now_ns + g->period_ns; }
        g->streams = 1;
    } else if (g->line_n == 0 && byte == 'G') {
        sample(g, 'G');
    } else if (byte == '\r') {
        end_of_line(g);
    } else if (g->line_n < sizeof g->line) {
        g->line[g->line_n++] = byte;
    }
}

/* --- time --- */

void emu_cyber_open(struct emu_cyber *g)
{
    static const struct emu_cyber off;
    *g = off;
    g->period_ns = 10000000;
    g->noise = 1;
    for (unsigned i = 0; i < EMU_CYBER_SENSORS; i++) { g->sample[i] = (uint8_t)(100 + i); }
}

int emu_cyber_get(struct emu_cyber *g, uint64_t now_ns)
{
    while (g->streams && g->next_ns <= now_ns && g->out_n < OUT / 2) {
        g->now_ns = g->next_ns;
        g->next_ns += g->period_ns;
        sample(g, 'S');
    }
    g->now_ns = g->now_ns < now_ns ? now_ns : g->now_ns;
    if (g->out_n == 0 || g->free_ns + EMU_CYBER_BYTE_NS > now_ns) { return -1; }
    g->free_ns += EMU_CYBER_BYTE_NS;
    g->out_n--;
    g->out_at = (uint8_t)((g->out_at + 1) % OUT);
    return g->out[(g->out_at + OUT - 1) % OUT];
}
