/* What a run costs: instructions and accesses of every tick, and of the scene's part of it. */
#ifndef HIL_COUNT_H
#define HIL_COUNT_H

#include "hil.h"

#include "scene.h"

#define COUNT_CLASSES 24

struct figure {
    uint32_t *at; /* one per tick, for the median */
    size_t n, cap;
};

struct count_class {
    unsigned key; /* what made the tick another: enum count_key */
    uint64_t n;
    uint32_t min, max;
};

/* A glove frame; so many packets; running. */
enum count_key { COUNT_GLOVE = 1, COUNT_RUNS = 2, COUNT_PACKET = 4, COUNT_KEYS = 64 };

struct count {
    /* from the timer's interrupt to the next wait */
    struct figure insns, ports, cards, busy_ns;
    /* of the scene's tick function, by class */
    struct figure scene;
    struct count_class class[COUNT_CLASSES];
    unsigned classes;

    uint64_t boot_insns, boot_ps; /* up to the first wait; to the first tick's end of it      */
    uint64_t boot_ports;
    int ticking;
    int no_memory;
    uint64_t at_insns, at_ports, at_cards, at_ps; /* when this tick began                      */
    uint64_t scene_at;
    unsigned key;
};

void count_wait(struct count *c, const struct hil *h); /* the image waits */
void count_tick(struct count *c, const struct hil *h); /* and is woken    */
void count_scene(struct count *c, const struct hil *h, unsigned key);
uint32_t count_scene_end(struct count *c, const struct hil *h);
void count_free(struct count *c);

struct count_range {
    uint32_t min, median, max;
};
struct count_range count_range(struct figure *f); /* sorts it */

/* The table. Returns the widest max - min of a class of ticks, in parts of 10^6 of its max. */
uint32_t count_print(struct count *c, const struct hil *h, double period_s);

#endif
