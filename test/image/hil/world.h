/* SPDX-License-Identifier: MIT */
/* The world behind the cards: the simulated device, held at each tick's instant. Beside it the
 * POSIX port does the same run, compared tick by tick. */
#ifndef HIL_WORLD_H
#define HIL_WORLD_H

#include "box.h"
#include "ref.h"

struct world_result {
    uint64_t ticks;     /* compared */
    uint64_t differ;    /* ticks */
    uint64_t first;     /* the first that differs */
    char what[160];     /* and in what */
    uint32_t digest[2]; /* CRC of all outputs and signals: the image's, the POSIX port's */
    uint64_t running;   /* ticks with a drive enabled */
    uint64_t packets;   /* over the link, both ways */
    uint64_t pulling;   /* with a code other than 0 A */
};

struct world {
    struct ref_cfg ref_cfg; /* board.T is the image's, once that is known */
    struct box *box;
    struct hil *h;
    int64_t spoil;  /* in this tick an encoder reads a count more: a test of the test; < 0: never */
    uint32_t scene; /* the image's descriptor */
    int begun;      /* the image's loop has */
    struct ref *ref;
    struct ref_frame now;    /* the reference's tick, while the image does it */
    unsigned received, sent; /* packets of this tick */
    uint64_t ticks;          /* instants so far */
    int open;                /* a tick is under way */
    int gloved;              /* its glove frame was converted */
    int differs;             /* this tick does */
    int broken;              /* the reference ended, or never began */
    struct world_result result;
};

void world_open(struct world *w, struct hil *h, struct box *b, uint32_t scene);
/* The image's loop has done all it has to do; the first time, the next instant is tick 0's. */
void world_waits(struct world *w);
/* The image is about to start its loop: parameters that its command line has no words for. */
void world_parameters(struct world *w);
/* It calls exh_board_link_recv() or exh_board_link_send(): the world's end of the link answers. */
void world_recv(struct world *w);
void world_send(struct world *w);
void world_instant(struct world *w);
/* The timer was set anew: that was not tick 0. */
void world_rewind(struct world *w);
void world_close(struct world *w);

#endif
