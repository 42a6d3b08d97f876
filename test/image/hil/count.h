/* SPDX-License-Identifier: MIT */
/* What a run costs: instructions and accesses of every tick, and of the scene's part of it. */
#ifndef HIL_COUNT_H
#define HIL_COUNT_H

#include "hil.h"

#include "exhand/run/scene.h"

#define COUNT_CLASSES 96

struct figure {
    uint32_t *at; /* one per tick, for the median */
    size_t n, cap;
};

struct count_class {
    unsigned key; /* enum count_key */
    uint64_t n;
    uint32_t min, max;
};

/* What makes a class of ticks: bits, and counts of three. Packets are counted by kind, and those
 * among them that were refused. */
enum count_key {
    COUNT_RUNS = 1 << 0,   /* drives are enabled when the tick ends */
    COUNT_GLOVE = 1 << 1,  /* a new glove frame */
    COUNT_FIRST = 1 << 2,  /* the first since power-on */
    COUNT_TRACKS = 1 << 3, /* fingers whose q_lim moves along */
    COUNT_HELLO = 1 << 6,
    COUNT_PLANES = 1 << 9,
    COUNT_PARAM = 1 << 12,
    COUNT_REFUSED = 1 << 15,
    COUNT_KEYS = 1 << 18,
    COUNT_MASK = 7
};

struct count {
    /* from the timer's interrupt to the next wait */
    struct figure insns, ports, cards, busy_ns;
    /* of the scene's tick function, by class */
    struct figure scene;
    struct count_class class[COUNT_CLASSES];
    unsigned classes;

    uint64_t boot_insns, boot_ps; /* up to the first wait; to the first tick's end of it */
    uint64_t boot_ports;
    int ticking;
    int no_memory;
    uint64_t at_insns, at_ports, at_cards, at_ps; /* when this tick began */
    uint64_t scene_at;
};

void count_wait(struct count *c, const struct hil *h); /* the image waits */
void count_tick(struct count *c, const struct hil *h); /* and is woken */
void count_scene(struct count *c, const struct hil *h);
uint32_t count_scene_end(struct count *c, const struct hil *h, unsigned key); /* what it took */
void count_free(struct count *c);

struct count_range {
    uint32_t min, median, max;
};
struct count_range count_range(struct figure *f); /* sorts it */

/* The table. Returns the widest max - min of a class of ticks, in parts of 10^6 of its max. */
uint32_t count_print(struct count *c, const struct hil *h, double period_s);

#endif
