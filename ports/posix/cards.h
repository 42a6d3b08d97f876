/* SPDX-License-Identifier: MIT */
/* Cards: between the board's functions and the simulated device, the drivers of ports/cards and
 * the emulated cards. The device shows its codes on the cards' connectors as voltages and counts,
 * the drivers read them from registers; what they put out comes back the same way. */
#ifndef POSIX_CARDS_H
#define POSIX_CARDS_H

#include "emu/emu.h"

#include "exhand/frame.h"
#include "exhand/glove.h"

#include <stdint.h>

enum posix_cards_how {
    POSIX_CARDS_NONE,
    POSIX_CARDS_INSTANT, /* once opened, accesses and conversions take no time: same bits */
    POSIX_CARDS_TIMED    /* they take what they take on the bus */
};

struct posix_cards {
    uint8_t how;            /* enum posix_cards_how */
    uint8_t quiet;          /* 1: what is wrong with a card is not said on stderr */
    struct emu_fault fault; /* what is wrong with one */
};

/* Power on at time 0, find and calibrate the cards of so many fingers and perhaps a glove. 0, or
 * the driver's error, said on stderr. */
int cards_start(const struct posix_cards *c, unsigned fingers, int glove);

/* It is t_s now. */
void cards_at(double t_s);

/* in: what the device shows, and then what the box read of it. 0 or -EXH_E_IO. */
int cards_read_drive(struct exh_drive_in *in);

/* 0 or -EXH_E_IO; seen: what the device sees of it. */
int cards_write_drive(const struct exh_drive_out *out, struct exh_drive_out *seen);

/* code: voltages at the glove's connector on entry, the codes read on return. */
int cards_read_glove(int16_t code[EXH_GLOVE_SENSORS]);

/* seen: what the device sees then. */
void cards_safe(struct exh_drive_out *seen);

/* The box itself, and what the device saw of it since the start (tests, tables). */
struct emu_box *posix_cards_box(void);

#define POSIX_CARDS_REST_RAW 200 /* codes from 0 A; what keeps a string wound is less */

struct posix_cards_watch {
    uint32_t ticks;    /* written */
    uint32_t digest;   /* CRC-32 of all that came out of the cards, tick by tick */
    uint32_t pressed;  /* the last of them with more than that in a drive, from 1; 0: none */
    uint16_t most_raw; /* the farthest any D/A of an enabled drive was from 0 A, */
    uint16_t now_raw;  /* and is */
};
const struct posix_cards_watch *posix_cards_watch(void);

#endif
