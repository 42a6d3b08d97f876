/* SPDX-License-Identifier: MIT */
/* Which client loses its place when all are taken. A client that vanished must not hold a place
 * forever, and idle connections must not displace an active reader. So idle clients go first, those
 * of the same source before others. A reader is displaced only by its own source. All clients on
 * this machine are one source; there a connection without any request goes first. */
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
