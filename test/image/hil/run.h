/* SPDX-License-Identifier: MIT */
/* One run of an image: its options and its state. */
#ifndef HIL_RUN_H
#define HIL_RUN_H

#include "class.h"
#include "inputs.h"
#include "world.h"

struct run_options {
    const char *image, *options; /* the file, and its command line */
    const char *records;         /* file for the output of port 0xE9, or NULL */
    int wild, quiet, singly, loop, absent, board, turns, glove_last, whole;
    double cpi, port_us, hpet_MHz, baud;
    int64_t seed, where, ticks, rate_Hz, glove_age, monitor_age, spoil;
    struct ref_setting set[REF_SETTINGS];
    int sets;
};

struct run {
    const struct run_options *opt;
    struct hil h;
    struct box box;
    struct world world;
    struct count count;
    struct inputs inputs;
    uint32_t scene, tick, show; /* addresses: descriptor, its functions, */
    uint32_t back;              /* where tick returns to */
    int shown;                  /* show ran for the tick that returned */
    uint32_t out;               /* where its outputs go */
    struct class_of class_of;
    unsigned key;                   /* of the tick under way: enum count_key */
    int runs;                       /* the drives were enabled when the last tick ended */
    uint64_t passed;                /* instants of the timer since the first wait, */
    uint64_t instants, ticks;       /* those up to the last tick of the scene; these ticks */
    uint64_t late;                  /* instants that found it at work */
    uint32_t said_run, said_missed; /* ticks, as the image says at its end */
};
extern struct run run;

/* 0, or -1 after a line on stderr. */
int run_open(const struct run_options *opt);
void run_close(void);

#endif
