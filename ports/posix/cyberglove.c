/* SPDX-License-Identifier: MIT */
#include "cyberglove.h"

#include <string.h>

#define SAMPLES     CYBERGLOVE_SENSORS
#define STATUS_TOP  7 /* three bits: plugged, switch, light */
#define STATUS_PLUG 1u

enum form { UNKNOWN, PLAIN, STATUS };

static int lose(struct cyberglove *g, enum cyberglove_cause why)
{
    g->lost[why]++;
    g->sure = 0;
    g->rest = why == CYBERGLOVE_ZERO || why == CYBERGLOVE_EIGHTEEN;
    return 0;
}

/* Frames of the other form, until there were enough in a row. */
static int refuse(struct cyberglove *g, unsigned form)
{
    if (form == (g->told ? STATUS : g->form)) { return 0; }
    if (!g->told && ++g->sure >= CYBERGLOVE_SURE) { return 0; }
    g->lost[CYBERGLOVE_FORM]++;
    return 1;
}

/* 1: it may be believed. */
static int whole(struct cyberglove *g, unsigned form)
{
    const uint8_t status = form == STATUS ? g->held[SAMPLES + 1] : 0;
    if (form == STATUS && !(status & STATUS_PLUG)) { return lose(g, CYBERGLOVE_UNPLUGGED); }
    g->rest = 0;
    g->bare = form == PLAIN;
    if (refuse(g, form)) { return 0; }
    g->form = (uint8_t)form;
    g->sure = 0;
    g->status = status;
    memcpy(g->sample, g->held + 1, SAMPLES);
    g->frames++;
    return 1;
}

/* Behind the samples: nothing, a status, 'e' and a letter, or both. */
static int ended(struct cyberglove *g)
{
    const uint8_t *tail = g->held + 1 + SAMPLES;
    uint32_t n = g->n - 1 - SAMPLES;
    const int status = n > 0 && tail[0] <= STATUS_TOP;
    if (n == (uint32_t)status) { return whole(g, status ? STATUS : PLAIN); }
    tail += status;
    n -= (uint32_t)status;
    if (n == 2 && tail[0] == 'e' && (tail[1] == 's' || tail[1] == 'g')) {
        return lose(g, tail[1] == 's' ? CYBERGLOVE_FAST : CYBERGLOVE_UNPLUGGED);
    }
    return lose(g, CYBERGLOVE_LENGTH);
}

static int frame(struct cyberglove *g)
{
    const uint32_t samples = g->n - 1;
    if (samples >= SAMPLES) { return ended(g); }
    if (samples == 18 || (samples == 19 && g->held[19] <= STATUS_TOP)) {
        return lose(g, CYBERGLOVE_EIGHTEEN);
    }
    return lose(g, CYBERGLOVE_ZERO);
}

/* What begins with no header: an answer, or anything. A 0 behind a frame without status is the
 * frame's end, and the one before was a status that says: unplugged. */
static void other(struct cyberglove *g)
{
    const int refused = g->n == 2 && g->held[0] == 'e' && strchr("?nygs", g->held[1]) != NULL;
    const int taken = g->n == 1 && strchr("cfltuFLTU", g->held[0]) != NULL;
    g->sure = 0;
    if (g->rest) {
        g->rest = 0;
    } else if (g->n == 0 && g->bare && (g->told || g->form == STATUS)) {
        g->lost[CYBERGLOVE_FORM]--;
        g->lost[CYBERGLOVE_UNPLUGGED]++;
    } else if (refused || taken) {
        g->errors += (uint32_t)refused;
        g->replies += (uint32_t)taken;
        g->answer = g->held[0];
    } else {
        g->strays += g->n + 1;
    }
    g->bare = 0;
}

int cyberglove_take(struct cyberglove *g, uint8_t byte)
{
    int came = 0;
    if (byte != 0) {
        if (g->n < sizeof g->held) { g->held[g->n] = byte; }
        g->n += g->n < UINT32_MAX;
        return 0;
    }
    if (g->n > 0 && (g->held[0] == 'S' || g->held[0] == 'G')) {
        g->bare = 0;
        came = frame(g);
    } else {
        other(g);
    }
    g->n = 0;
    return came;
}

int16_t cyberglove_raw(uint8_t sample)
{
    const int32_t tenths = (sample - 128) * 294912 / 127; /* 18 V of 20 V are 58982.4 codes */
    return (int16_t)((tenths + (tenths < 0 ? -5 : 5)) / 10);
}

const char *cyberglove_cause_text(unsigned cause)
{
    static const char *const text[CYBERGLOVE_CAUSES] = {
        "zero sample", "18 samples", "wrong length", "other form", "unplugged", "too fast"};
    return cause < CYBERGLOVE_CAUSES ? text[cause] : "unknown";
}
