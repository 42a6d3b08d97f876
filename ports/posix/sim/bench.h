/* SPDX-License-Identifier: MIT */
/* Bench: the actions of the experimenter during a calibration, and possible errors. The string has
 * an end (a knot at the sheath) at q = 0. The person draws it out and releases it, or places a mass
 * on a support and makes its string taut. Meanwhile the hand guides the string. */
#ifndef SIM_BENCH_H
#define SIM_BENCH_H

#include "plant.h"
#include "random.h"

enum bench_place {
    BENCH_SLACK, /* the string drawn out, nothing on it */
    BENCH_MASS   /* a mass on a support, its string just taut */
};

/* bits */
enum bench_wrong {
    BENCH_MOTOR_REVERSED = 1 << 0,
    BENCH_ENCODER_REVERSED = 1 << 1,
    BENCH_STUCK = 1 << 2,      /* the rotor does not turn */
    BENCH_CAUGHT = 1 << 3,     /* the string is caught 70 mm from its end */
    BENCH_ENDLESS = 1 << 4,    /* nothing stops it at its end */
    BENCH_NO_MASS = 1 << 5,    /* the mass was not hung on */
    BENCH_FIXED_MASS = 1 << 6, /* the mass cannot be lifted */
    BENCH_PULLED = 1 << 7      /* a person pulls the string out */
};

struct bench {
    enum bench_place place;
    unsigned wrong;           /* enum bench_wrong */
    int moving;               /* the hand is at it */
    struct sim_device device; /* with the mass on it */
    double now_s, from_s, until_s, from_m, to_m;
};

/* The string drawn out, at rest, nothing on it. */
void bench_start(struct bench *b, struct plant *p, const struct sim_device *d, unsigned wrong);

/* The person prepares another place; ready when it is done, after about a second. */
void bench_prepare(struct bench *b, const struct plant *p, struct sim_random *r,
    enum bench_place place, double mass_kg);
int bench_ready(const struct bench *b);

/* As plant_advance(), with hand, end and support acting on the string. */
void bench_advance(struct bench *b, struct plant *p, double dt_s, double ref_A);

/* Position as the encoder is wired to see it. */
double bench_encoder_m(const struct bench *b, const struct plant *p);

#endif
