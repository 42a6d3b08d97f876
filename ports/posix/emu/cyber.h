/* SPDX-License-Identifier: MIT */
/* Cyber: a stock glove of 22 sensors at the far end of a serial line, and what can go wrong there.
 * Written from the facts about the line (docs/CYBERGLOVE.md), not from the parser.
 *
 * It takes bytes as a host sends them and gives bytes back when the line has brought them, 10 bits
 * at 115200 each. Integers only, no allocation, nothing from outside.
 */
#ifndef EMU_CYBER_H
#define EMU_CYBER_H

#include <stdint.h>

#define EMU_CYBER_SENSORS 22
#define EMU_CYBER_NOISE_B 9      /* of EMU_CYBER_GARBAGE */
#define EMU_CYBER_BYTE_NS 86806u /* 10 bits at 115200 */

enum emu_cyber_kind {
    EMU_CYBER_WELL,
    EMU_CYBER_CUT,      /* a frame ends after 10 samples, without its 0 */
    EMU_CYBER_ZERO,     /* a sample is 0 */
    EMU_CYBER_DROPPED,  /* the line loses a sample */
    EMU_CYBER_INSERTED, /* or makes one up */
    EMU_CYBER_ENDLESS,  /* or loses the 0 at the end */
    EMU_CYBER_HEADLESS, /* or the header */
    EMU_CYBER_GARBAGE,  /* noise before the frame, headers among it */
    EMU_CYBER_TWICE,    /* a frame comes twice, without a gap */
    EMU_CYBER_SILENT,   /* no frame */
    EMU_CYBER_OFF,      /* no glove on the unit: status bit 0 is 0, without status "eg" */
    EMU_CYBER_FAST,     /* "es" */
    EMU_CYBER_ERROR,    /* "e?", 0 before the frame */
    EMU_CYBER_EIGHTEEN, /* a glove of 18 sensors */
    EMU_CYBER_KINDS
};

struct emu_cyber {
    /* The emulator's user may set these at any time. */
    uint8_t sample[EMU_CYBER_SENSORS]; /* 1 .. 255 */
    uint8_t kind;   /* enum emu_cyber_kind, of each `every`th frame from the next on */
    uint8_t forced; /* 1: always sends a status byte, 2: never */
    uint8_t deaf;   /* takes no command */
    uint32_t every; /* 0 as 1 */
    /* What became of it. */
    uint32_t frames, wrong; /* sent; of these with something wrong */
    uint32_t commands, refused;
    uint8_t streams, status;
    uint32_t period_ns;
    /* Its own. */
    uint64_t now_ns, next_ns, free_ns; /* of a frame; when the line is free */
    uint8_t line[32];                  /* a command so far */
    uint8_t line_n;
    uint8_t out[128];
    uint8_t out_at, out_n;
    uint32_t noise;
};

/* Power on: it streams nothing, has no status, and is set to 100 Hz. */
void emu_cyber_open(struct emu_cyber *g);

/* A byte from the host. */
void emu_cyber_put(struct emu_cyber *g, uint8_t byte);

/* The next byte that the line has brought by then: 0 .. 255, or -1. Times rise from call to call.
 */
int emu_cyber_get(struct emu_cyber *g, uint64_t now_ns);

#endif
