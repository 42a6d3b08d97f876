/* SPDX-License-Identifier: MIT */
/* The analog chain of the glove, from 22 joint angles to 22 A/D codes: angle, low-pass, sensor (its
 * own two end points), amplifier, multiplexer, noise, A/D. The low-pass comes first: sensor and
 * amplifier are linear up to the rails, so the order has no effect. After angles in closed form its
 * output has a closed form (lag.h).
 *
 * The card converts one channel after the other, the last one `interval` before the tick that reads
 * the frame. Channel i is held at tick - (22 - i) interval. */
#ifndef SIM_GLOVE_H
#define SIM_GLOVE_H

#include "device.h"
#include "lag.h"
#include "random.h"

#include <stdint.h>

#define SIM_GLOVE_SENSORS 22

/* Doubles only, in the order of the table in glove.c. */
struct sim_glove_par {
    double excite_V, dead, gain, offset_V, rail_V, couple;
    double cutoff_Hz, noise_V;
    double interval_s, settle_s, span_V;
};

extern const struct sim_device_row sim_glove_row[];
extern const int sim_glove_rows;

/* The committed values. */
struct sim_glove_par sim_glove_default(void);

/* Sets one by name, as sim_device_set() does. */
int sim_glove_set(
    struct sim_glove_par *p, const char *name, double value, const struct sim_device_row **row);

/* One sensor: its output, as a share of the live part of the excitation, is a straight line
 * through these. */
struct sim_glove_sensor {
    const char *name;
    double lo_deg, lo, hi_deg, hi;
    int bend[2]; /* sensors whose mean this one sees `couple` of, -1: none */
};
extern const struct sim_glove_sensor sim_glove_sensor[SIM_GLOVE_SENSORS];

enum sim_glove_fault {
    SIM_GLOVE_WELL,
    SIM_GLOVE_OPEN,      /* a broken wire: all of the excitation at the amplifier */
    SIM_GLOVE_SHORT,     /* none of it */
    SIM_GLOVE_STUCK,     /* the code stays what it last was */
    SIM_GLOVE_RAIL_HIGH, /* the amplifier at a rail */
    SIM_GLOVE_RAIL_LOW
};

struct sim_glove {
    struct sim_glove_par par;
    struct sim_random rng;
    struct sim_lag angle_rad[SIM_GLOVE_SENSORS];
    unsigned char fault[SIM_GLOVE_SENSORS]; /* enum sim_glove_fault */
    int16_t code[SIM_GLOVE_SENSORS];        /* the last */
    double held_V, held_s;                  /* on the multiplexer, and since when */
    /* What most channels need not work out again. */
    uint32_t reads, holds;                   /* channels that are read, and that those depend on */
    uint32_t moves, seen[SIM_GLOVE_SENSORS]; /* channels that may change; those that see angle i */
    double volt_V[SIM_GLOVE_SENSORS];        /* of those that do not; of others of no use */
    double line_s;                           /* when an angle last began another movement */
    uint32_t lines, stays;   /* angles that then began a straight line; that never moved */
    double tau_s, line_left; /* of the low-pass, and what it leaves from channel to channel */
    struct sim_decay low_pass[SIM_GLOVE_SENSORS];
    double at_0_V[SIM_GLOVE_SENSORS], V_perrad[SIM_GLOVE_SENSORS]; /* behind the amplifier */
    double slot_left, code_perV, noise_V_perLSB, noise_V_most;     /* multiplexer, A/D, noise */
    /* Angle i is share[i] times angle of[i]. For an independent one, of[i] is i, share[i] is 1. */
    unsigned char of[SIM_GLOVE_SENSORS];
    double share[SIM_GLOVE_SENSORS];
    struct sim_glove_sees {
        unsigned char n, of[3];
        double share[3];
    } sees[SIM_GLOVE_SENSORS]; /* the angles that bend a sensor, and how much */
};

/* Settled at these angles; the multiplexer at rest on channel 0. */
void sim_glove_start(struct sim_glove *g, const struct sim_glove_par *p, uint64_t seed,
    const double angle_rad[SIM_GLOVE_SENSORS]);

/* From x->start_s on, the joint of sensor i moves so. */
void sim_glove_move(struct sim_glove *g, unsigned i, const struct sim_curve *x);

/* Behind the amplifier, without noise, at t_s. */
double sim_glove_volt(const struct sim_glove *g, unsigned i, double t_s);

/* From now on the joint of sensor i moves by `share` of what that of sensor `of` does. */
void sim_glove_follow(struct sim_glove *g, unsigned i, unsigned of, double share);

/* At the start: only these channels are read. The others keep their first code; these have the
 * codes that they would have anyway. */
void sim_glove_reads(struct sim_glove *g, uint32_t channels);

/* When channel i of the frame of this tick is held. */
static inline double sim_glove_held_s(const struct sim_glove_par *p, unsigned i, double tick_s)
{
    return tick_s - (SIM_GLOVE_SENSORS - i) * p->interval_s;
}

/* Converts channel i, held at t_s; in the order of time. */
int16_t sim_glove_convert(struct sim_glove *g, unsigned i, double t_s);

/* Channels first to end - 1 of the frame of this tick, whose first is 0. */
void sim_glove_scan(struct sim_glove *g, unsigned first, unsigned end, double tick_s);

/* The code of a voltage: nearest, limited to 16 bits. */
int16_t sim_glove_code(const struct sim_glove_par *p, double v_V);

#endif
