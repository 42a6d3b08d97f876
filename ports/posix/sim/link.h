/* SPDX-License-Identifier: MIT */
/* Link: effects of a network on packets, in virtual time, with a seed. Each of two directions
 * delays packets (constant, with jitter of three kinds, or from a recorded trace), loses and
 * duplicates them. It holds some back so that later ones overtake, and has outages, in which
 * nothing arrives. A packet arrives at sent + delay; simultaneous ones keep their order.
 *
 * The number in transit is bounded; further packets are dropped and counted. Random numbers are
 * drawn separately per effect and once per packet, even if an effect is off. So more loss does not
 * change the delay of other packets. */
#ifndef SIM_LINK_H
#define SIM_LINK_H

#include "device.h"
#include "random.h"
#include "trace.h"

#include <stddef.h>
#include <stdint.h>

#define SIM_LINK_PACKET_B 1472 /* what an Ethernet frame carries over UDP */
#define SIM_LINK_QUEUE    1024

enum sim_link_jitter {
    SIM_LINK_CONSTANT,
    SIM_LINK_UNIFORM,   /* +- jitter */
    SIM_LINK_NORMAL,    /* deviation jitter / 3, clipped at +- jitter */
    SIM_LINK_CORRELATED /* the same, each with `memory` of the one before */
};

/* Doubles only, in the order of the table in link.c; of one way. */
struct sim_link_par {
    double delay_s, jitter, jitter_s, memory; /* jitter: enum sim_link_jitter */
    double loss, duplicate, duplicate_s, reorder, reorder_s;
    double hole_at_s, hole_s, hole_every_s;
    double in_order, queue, trace_scale;
};
extern const struct sim_device_row sim_link_row[];
extern const int sim_link_rows;

/* A perfect link: nothing of all this. */
struct sim_link_par sim_link_default(void);

/* Sets one by name, as sim_device_set() does. */
int sim_link_set(
    struct sim_link_par *p, const char *name, double value, const struct sim_device_row **row);

/* sent + doubled = arrived + lost + in_hole + overflow + on their way. */
struct sim_link_counts {
    uint64_t sent; /* handed in */
    uint64_t doubled;
    uint64_t arrived; /* handed out */
    uint64_t lost, in_hole, overflow;
    uint64_t overtaken; /* of those that arrived: after one that was sent later */
    uint64_t too_long;  /* not taken, or longer than the receiver's buffer */
};

struct sim_link_packet {
    double due_s, sent_s;
    uint64_t number; /* of the packet, from 0; a double has its original's */
    uint64_t serial; /* of the copy: who came first among equals */
    uint16_t len_B;
    uint8_t byte[SIM_LINK_PACKET_B];
};

struct sim_link_way {
    struct sim_link_par par;
    const struct sim_trace *trace; /* instead of delay's model, added to `delay`; NULL: none */
    struct sim_random delay_rng, loss_rng, duplicate_rng, reorder_rng;
    double wander;     /* correlated jitter's state, -1 .. 1 or a little more */
    double fresh;      /* what memory leaves for chance: sqrt(1 - memory^2) */
    double last_due_s; /* of the latest so far */
    uint64_t next_number, next_serial, newest; /* newest: number + 1 that arrived */
    uint16_t order[SIM_LINK_QUEUE];            /* slots by due time; then the free ones */
    unsigned queued;
    struct sim_link_counts counts;
    struct sim_link_packet slot[SIM_LINK_QUEUE];
};

enum { SIM_LINK_OUT, SIM_LINK_IN, SIM_LINK_WAYS }; /* from and to the controller */

struct sim_link {
    struct sim_link_way way[SIM_LINK_WAYS];
};

/* Empty, at 0 s. trace: the caller's, or NULL. */
void sim_link_start(struct sim_link_way *w, const struct sim_link_par *p,
    const struct sim_trace *trace, uint64_t seed);

/* Takes a packet at t_s, not before the last: its length, whatever becomes of it, or -1:
 * longer than any may be. */
int sim_link_send(struct sim_link_way *w, double t_s, const void *buf, size_t len_B);

/* The next that has arrived by t_s, or NULL: none. One longer than cap_B is dropped. It stays valid
 * until the next is sent. */
const struct sim_link_packet *sim_link_take(struct sim_link_way *w, double t_s, size_t cap_B);

/* The same, copied: its length, or 0: none. */
int sim_link_recv(struct sim_link_way *w, double t_s, void *buf, size_t cap_B);

/* When the next arrives, 1e30: nothing is on its way. */
double sim_link_next_s(const struct sim_link_way *w);

#endif
