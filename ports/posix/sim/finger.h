/* SPDX-License-Identifier: MIT */
/* Finger: one in the exoskeleton, with the motor that pulls it back.
 *
 * In string coordinates, x the string the finger draws out, q that at the motor:
 *
 *   m x'' = K (target - x) + B (target' - x') - T - dry(mu_mass T)
 *
 * and string, rotor and drive as plant.h says of the falling mass. The target is a path's
 * (path.h). Bending draws string out; the joints share it as lib's hand.h has it, least norm:
 *
 *   knuckle = arm1 x / A    each joint beyond = (arm2 + arm3) x / A    A = arm1^2 + (arm2 + arm3)^2
 *
 * so that straight is x = 0, beyond which neither finger nor string goes.
 */
#ifndef SIM_FINGER_H
#define SIM_FINGER_H

#include "path.h"
#include "plant.h"
#include "random.h"

#include <stdint.h>

/* Doubles only, in the order of the table in finger.c. */
struct sim_finger_par {
    double mass_kg, k_Npm, b_Nspm, learned;
    double arm_m[3];
};
extern const struct sim_device_row sim_finger_row[];
extern const int sim_finger_rows;

struct sim_finger_par sim_finger_default(void);

/* Sets one by name, as sim_device_set() does. */
int sim_finger_set(
    struct sim_finger_par *p, const char *name, double value, const struct sim_device_row **row);

struct sim_finger {
    struct sim_device device; /* with the finger as its mass */
    struct sim_finger_par par;
    struct sim_path path;
    struct plant plant;
    struct plant_pieces pieces;
    struct plant_hand hand; /* its target: of the path, now */
    struct sim_decay lead;  /* of the path's lead in a step, */
    double lead_left;       /* and since its phase began */
    struct sim_random rng;
    double now_s, grid_s; /* now; the same on the grid of lengths */
    double latched_A;     /* D/A output */
    double ref_A;         /* what the servo last sampled */
    double servo_s;       /* its first sample */
    double sample_s;      /* its next that changes ref_A; the others change nothing */
    double grid;          /* encoder phase, counts */
    double bend_radpm[2]; /* knuckle, joints beyond */
};

/* At rest where its path begins, the string just taut, at 0 s. */
void sim_finger_start(struct sim_finger *f, const struct sim_finger_par *par,
    const struct sim_path_par *path, const struct sim_path_record *record,
    const struct sim_device *d, uint64_t seed);

/* The D/A output changes at at_s, now or later, but before it changes again. */
void sim_finger_latch(struct sim_finger *f, double at_s, double ref_A);

/* Sets the D/A to zero and disables the drive, without a delay. */
void sim_finger_safe(struct sim_finger *f);

/* To until_s; changes of the reference, and what the path does, on their instants. */
void sim_finger_advance(struct sim_finger *f, double until_s);

/* Codes of encoder (jitter_cnt peak to peak on it) and monitor. */
void sim_finger_read(struct sim_finger *f, double jitter_cnt, uint32_t *enc_raw, int16_t *mon_raw);

/* The force between hand and finger as the hand feels it: K, B and what they are stretched by. */
double sim_finger_push_N(const struct sim_finger *f);

#endif
