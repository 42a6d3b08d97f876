/* SPDX-License-Identifier: MIT */
/* Who gives up a place when all are taken. Who vanished without a word would hold his for ever, and
 * who opens connections and says nothing must not push out one that reads: so the idle go first, of
 * the same source before others, and a reader goes for nobody but its own source. Those on this
 * machine are one source: there a connection that never asked goes before one that did. */
#include "slave/libmodbus.h"

#define IDLE_S 60 /* a monitor asks more often */

/* The lower the sooner; NEVER: stays. */
enum { OWN_IDLE, IDLE, OWN, NEVER };

static int rank_of(const struct place *p, uint32_t address, double now_s)
{
    const int idle = !p->asked || now_s - p->heard_s > IDLE_S, own = p->address == address;
    if (idle) { return own ? OWN_IDLE : IDLE; }
    return own ? OWN : NEVER;
}

int place_to_clear(const struct place *p, int n, uint32_t address, double now_s)
{
    int which = -1, best = NEVER;
    for (int i = 0; i < n; i++) {
        const int rank = rank_of(p + i, address, now_s);
        if (rank < best || (which >= 0 && rank == best && p[i].heard_s < p[which].heard_s)) {
            which = i;
            best = rank;
        }
    }
    return which;
}
