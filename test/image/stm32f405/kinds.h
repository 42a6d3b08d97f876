/* SPDX-License-Identifier: MIT */
/* What goes wrong in chip, wiring and program, and what must follow. */
#ifndef KINDS_H
#define KINDS_H

#include "loop.h"

enum kind_end {
    ENDS_OFF,   /* drives off within 20 ms, and they stay off */
    ENDS_WORDS, /* the same, and words say why: behind a log of 82 ms */
    ENDS_BOUND, /* no detector need see it; the current stays within its limit */
    ENDS_STUCK, /* seen within 100 ms, or the current stays within its limit */
    ENDS_WELL   /* nothing happens */
};

struct kind {
    const char *name;
    const char *told; /* a fault's name, words, or "reset"; "": nothing is said */
    enum kind_end ends;
    void (*begin)(unsigned chance); /* chance: which finger, or where to */
    void (*cease)(void);            /* 3 us later, or NULL */
};
extern const struct kind kinds[];
/* The last one stands behind them: for a scene whose stuck_time is KIND_STUCK_MS. */
extern const unsigned kind_count;
#define KIND_STUCK_MS 100

/* Puts into flash what programs that go astray find there. */
void kinds_prepare(struct machine *m);

#endif
