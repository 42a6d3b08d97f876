/* SPDX-License-Identifier: MIT */
/* The POSIX port's own controls: what a program may set before the loop starts and
 * ask while it runs. The port simulates the device in virtual time. */
#ifndef POSIX_H
#define POSIX_H

#include "cards.h"
#include "glove_tty.h"
#include "line.h"

#include "sim/bench.h"
#include "sim/device.h"
#include "sim/exo.h"
#include "sim/operator.h"

#include "exhand/units.h"

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

struct posix_config {
    struct sim_device device;
    uint64_t seed;
    int falls;           /* then the board says stop */
    struct exh_period T; /* num 0: 1 / rate */
    FILE *log;           /* records go here; NULL: taken and forgotten */
    int (*log_put)(
        const void *rec, size_t len_B); /* not NULL: takes them instead, 1, or loses one, 0 */
    int pace;                           /* 1: follow the wall clock; ticks that go by are missed */
    double slack_s;                     /* but a tick so late is made up for */
    uint32_t max_ticks;                 /* 0: no limit */
    int bench;                          /* 1: a bench for calibration instead of falls; it goes
                                         * on until posix_stop() */
    unsigned wrong;                     /* enum bench_wrong: what is wrong with the bench */
    int wait;                           /* 1: the first fall is held until posix_ready() */
    int from_here;                      /* 1: the first fall begins at from_x_m, from_q_m */
    double from_x_m, from_q_m;          /* mass and string, 0 = virtual contact */
    struct sim_exo_par exo;             /* fingers not 0: fingers in an exoskeleton instead of falls
                                         * and bench; when all their scripts have ended the
                                         * board says stop */
    unsigned drives;                    /* bit i: drive of finger i is present and ready; drives of
                                         * fingers in use always are */
    struct posix_cards cards;           /* how: all codes go through drivers and emulated cards */
    struct posix_line line;             /* on: the link leads somewhere */
    int gpio;              /* 1: contacts and outputs of gpio.h, which is open; with pace */
    double let_go_s;       /* the dead-man switch opens then; 0: never */
    double enc_jitter_cnt; /* peak to peak, uniform: 1 makes a resting encoder change
                            * between two counts */
    int glove;             /* 1: there is a glove, and a hand in it */
    struct sim_glove_par glove_par;
    int stock; /* 1: simulated as a stock glove's: samples of 8 bits, 1 .. 255 at -9 .. 9 V, a
                * frame late */
    struct sim_operator_par hand;
    const int16_t (*frame)[SIM_GLOVE_SENSORS]; /* recorded frames instead, the caller's, */
    long frames;                               /* one a read, the last for ever; NULL: none */
    struct glove_tty *glove_tty; /* or those of a stock glove on a serial line, the caller's, open;
                                  * codes 1 .. 255. Real time: with pace */
    /* Between box and device, for who rehearses faults; NULL: nothing. What the device gets, and
     * what it shows the box, cards included. */
    void (*wires_out)(struct exh_drive_out *out);
    void (*wires_in)(struct exh_drive_in *in);
    /* How many ticks go by before the loop waits for this one (from 0) again; NULL: none. */
    uint32_t (*late)(uint64_t tick);
};

/* Defaults: the committed device, seed 1, one fall. */
struct posix_config posix_config_default(void);

/* To be called before exh_board_init(). */
void posix_configure(const struct posix_config *c);

/* The fall under observation, 1…, or 0 while the mass is held or lifted. */
int posix_fall(void);

/* A finger in use, or NULL (tests, pictures). */
const struct sim_finger *posix_finger(unsigned i);

/* The device is in RUN: the time for which the mass is held counts from here. */
void posix_ready(void);
/* It does not any more: they catch it, and the next hold goes on until it does. */
void posix_hold(void);

/* 1 if the device and its pending inputs are at rest to the last bit (sim/still.h), until another
 * output or the fall's end. Then ticks may pass without the loop. Also the range of its monitor
 * meanwhile. */
int posix_still(void);
void posix_monitor(int16_t *low_raw, int16_t *high_raw);
/* The next tick has passed and the output is as it was; the monitor at it. 0: it has not, something
 * ends before it. */
int posix_pass(int16_t *mon_raw);

/* The person at the bench prepares a place; ready some time later. */
void posix_bench(enum bench_place place, double mass_kg);
int posix_bench_ready(void);

/* The hand in the glove goes to a pose (sim/operator.h); ready when it is there and still. */
void posix_hand(int pose);
int posix_hand_ready(void);

/* The glove itself, for faults. */
struct sim_glove *posix_glove(void);
void posix_glove_stop(void); /* no frame comes any more */

/* Ends the run: the next wait says stop. */
void posix_stop(void);

/* Ends this run and every later one of the process. Safe in a signal handler. */
void posix_interrupt(void);
int posix_interrupted(void);

/* The instant of the present tick, s, and the plant as it is (tests, pictures). */
double posix_time_s(void);
struct plant;
const struct plant *posix_plant(void);

#endif
