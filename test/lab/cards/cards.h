/* SPDX-License-Identifier: MIT */
/* How does the box end when a card fails? One fault of one card begins in one phase of its driver,
 * at each access of that phase in turn. */
#ifndef CLI_CARDS_H
#define CLI_CARDS_H

#include "posix.h"

#include "exhand/units.h"

#include "../../../ports/cards/fault.h"

#define CARDS_OPENINGS 100 /* beginnings tried in a phase, if not all: of the opening, */
#define CARDS_RUNS     20  /* and where a run of the whole box is needed */

/* the same box with nothing wrong */
struct cards_healthy {
    uint32_t accesses[EMU_CARDS]
                     [EMU_PHASES];          /* of each card in each phase; of tick phases in one */
    uint32_t before[EMU_CARDS][EMU_PHASES]; /* and before that tick */
    uint32_t tick;                          /* in which all five fingers press */
    struct posix_cards_watch watch;
};

enum cards_end {
    CARDS_ERROR,  /* the driver's, which names this card and its base; outputs safe */
    CARDS_FAULT,  /* the library's; outputs safe */
    CARDS_SAME,   /* no difference in anything that comes out */
    CARDS_LET_GO, /* no error; the currents differ, stay within their limits, and end with the
                     contact */
    CARDS_UNSEEN, /* no error; the currents stay within their limits, beyond the contact, until the
                   * drives are disabled, which works */
    CARDS_OTHER,  /* none of these: undefined */
    CARDS_ENDS
};

struct cards_cell {
    uint8_t kind, card, phase;
    uint8_t all;       /* 1: try every access */
    uint16_t accesses; /* tried */
    uint16_t ends[CARDS_ENDS];
    uint16_t what[EXH_CARD_WHATS]; /* the driver's errors */
    uint32_t faults;               /* the library's, all of them */
    uint32_t ticks;                /* until safe, at most; of runs that ended in a tick */
    uint32_t late;                 /* let go so many ticks later than a healthy box, at most */
    struct emu_fault other;        /* the first of CARDS_OTHER */
};

/* 0, or -EXH_E…: the healthy box did not run. */
int cards_healthy(struct cards_healthy *h);

void cards_cell(struct cards_cell *c, const struct cards_healthy *h);

#endif
