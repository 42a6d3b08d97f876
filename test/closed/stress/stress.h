/* SPDX-License-Identifier: MIT */
/* Stress: one rig for all cases. It is a drop scene of our own, its shadow made from the
 * modules, and what was seen of both; tick() holds every rule of stress.c against them. */
#ifndef STRESS_H
#define STRESS_H

#include "box.h"
#include "drop/drop.h"

#include "exhand/exhand.h"

#include <inttypes.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#define LEN(a) (sizeof(a) / sizeof((a)[0]))

/* parameters that cases set, by id */
enum {
    ID_K = 0x0401,
    ID_B = 0x0402,
    ID_F0 = 0x0403,
    ID_SLEW_UP = 0x0502,
    ID_SLEW_DOWN = 0x0503,
    ID_PEAK_TIME = 0x0506,
    ID_ARM_TIME = 0x0603,
    ID_RAMP_TIME = 0x0604,
    ID_SUPPLY_MIN = 0x0D11,
    ID_TUNE_TIME = 0x1301,
    ID_Q_LIM = 0x8001
};

struct watch {
    uint64_t ticks, broken;
    char first[160]; /* the first rule that broke, with its values */
    int32_t force_max, q_min, q_max;
    int code_max; /* from dac_zero */
    double slew_share, cur_max_A, heat_share;
    uint32_t crc;            /* of all outputs and signals */
    uint64_t in[EXH_STATES]; /* ticks in each state of the box */
};

struct rig {
    struct drop_par active, staged;
    struct exh_params params;
    struct drop_cfg cfg;
    struct drop state, shadow;
    struct drop_signals sig;
    struct exh_period T;
    uint8_t enc_bits; /* of the board's counter, 24 unless a case says so */
    int blind;        /* 1: no movement is a fault, so that wild inputs act */
    double heat;      /* A^2 s above continuous, in doubles */
    struct box box;
    struct box_times times;
    struct watch w;
};

extern struct rig rig;

/* --- a case: fresh(), settings, start(), ticks, report() --- */

/* Parameters to their defaults, nothing seen. */
void fresh(void);
void set(uint16_t id, int32_t raw);
void set_gains(double k_Npm, double b_Nspm);
/* 0, or the scene's refusal. */
int ready(struct exh_period T);
/* ready(), which must not refuse. */
void start(struct exh_period T);
/* Ticks at rest, at 0, until the box is in RUN; it must come there, and when it must. */
void arm(void);
/* Parameters one tick on: what is staged acts, each as it may. */
void apply(void);
/* Ticks of each of the long cases. */
extern uint64_t cases;

#ifdef __GNUC__
__attribute__((format(printf, 3, 4)))
#endif
void must(int holds, const char *rule, const char *fmt, ...);

/* One tick of the rig, watched. */
void tick(const struct exh_scene_in *in, struct exh_drive_out *out);

/* A line of the table, with the further condition beside the rules. */
void report(const char *name, const char *besides);
int failures(void);

/* --- inputs --- */

uint64_t any_u64(void);
/* 0..n-1 */
uint32_t any(uint32_t n);
/* A healthy box; tick 0 has the command to run. */
struct exh_scene_in idle_in(uint64_t n, uint32_t enc_raw);
/* While the gate is open, encoder and monitor alternate between their ends and any values. Else
 * mostly a string far in and a person who clears, lets go and arms. */
struct exh_scene_in handled_in(uint64_t n);

/* --- the cases, a file each --- */

void closed_loops(void);
void open_loops(void);
void random_parameters(void);
void heats(void);
void wraps(void);
void all_at_their_ends(void);
/* 1 if any angle is wrong; of the stretches of 1024, one in so many. */
int every_angle(uint32_t thin);

#endif
