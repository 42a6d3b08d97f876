/* SPDX-License-Identifier: MIT */
/* The box: emulated cards in the harness's time, wired to frames of raw codes. */
#ifndef HIL_BOX_H
#define HIL_BOX_H

#include "hil.h"

#include "emu/emu.h"

#include "exhand/frame.h"
#include "exhand/glove.h"

struct box {
    struct emu_box emu;
    uint64_t from_ns; /* emu.time_ns when the harness's time was 0 */
    int one_finger;   /* wired for one finger, on board A alone */
    /* The glove's samples are about to be read, or with glove_starts a scan begins. NULL: no
     * callback. */
    int glove_starts;
    void (*glove)(void *ctx);
    void *ctx;
};

void box_open(struct box *b, int one_finger, const struct emu_config *c);

/* 1: the port is a card's. Time passes as the access takes. */
int box_in(struct box *b, struct hil *h, uint16_t port, unsigned size, uint32_t *value);
int box_out(struct box *b, struct hil *h, uint16_t port, unsigned size, uint32_t value);

/* Signals from outside, and outputs of the cards. Encoders are at 0 until first set. */
void box_put(struct box *b, const struct exh_drive_in *in);
void box_put_glove(struct box *b, const int16_t raw[EXH_GLOVE_SENSORS]);
void box_get(const struct box *b, struct exh_drive_out *out);

#endif
