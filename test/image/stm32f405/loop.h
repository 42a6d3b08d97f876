/* SPDX-License-Identifier: MIT */
/* Closed loop: the image over the simulated device, and beside it the same scene of this program,
 * fed with what the image read. */
#ifndef LOOP_H
#define LOOP_H

#include "board.h"
#include "machine.h"

#include "../hil/ref.h"

#define LOOP_KEEPS 100000u
struct loop_result {
    uint32_t kept[LOOP_KEEPS];     /* cycles, by tick: at most, */
    uint32_t fewest[LOOP_KEEPS];   /* and at least */
    uint64_t ticks, differ, first; /* compared; those that do; the first of them */
    char what[160];
    uint64_t running, pulling, packets, missed, first_missed, dearest;
    uint32_t most_insns, most_cycles, most_accesses; /* of the dearest tick, by cycles */
    uint64_t insns, cycles, least, accesses;         /* of all, from the instant to the next wait */
};

#define LOOP_PAST 8u
struct loop {
    int16_t past[LOOP_PAST][EXH_FINGERS]; /* monitors */
    uint64_t instants, missed, calm;
    struct machine *m;
    struct board board;
    struct ref_cfg cfg;
    uint32_t rate_Hz, ticks_wanted;
    uint32_t cut;  /* contacts that are open: enum exh_din */
    uint8_t quiet; /* nothing is compared */
    int64_t spoil;
    void (*show_words)(const char *image); /* called at the first instant, or NULL */
    uint32_t scene, tick, show, back, out;
    struct exh_period T;
    struct exh_drive_in in, before; /* as the device has it; a tick ago */
    struct exh_scene_in seen;       /* as the image read it */
    struct exh_drive_out twin, last;
    uint8_t begun, open, ready, shown, ticking, differs, waits;
    uint64_t at_insns, at_cycles, at_least, at_accesses;
    uint8_t frame[300];
    unsigned frame_B;
    struct loop_result r;
    char text[4096];
    unsigned text_n;
};
extern struct loop loop;

/* 0, or -1 after a line on stderr. */
int loop_open(struct machine *m, const char *image, uint64_t seed);
void loop_run(void);

#endif
