/* SPDX-License-Identifier: MIT */
/* Space: which values of the simulated device and the box are searched, and how far; what they make
 * of the model that judges them. */
#ifndef FIT_SPACE_H
#define FIT_SPACE_H

#include "sim/settle.h"

enum space_kind {
    SPACE_DEVICE, /* a value of the device, by its name */
    SPACE_F0,     /* pull-back force of the scene */
    SPACE_WINDOW, /* of the velocity, 2^p ticks: window and FOAW */
    SPACE_TAU     /* of the velocity: pole and observer */
};

struct space_row {
    const char *name;
    enum space_kind kind;
    double lo, hi;
    enum { SPACE_LINEAR, SPACE_LOG, SPACE_WHOLE } scale;
    double start; /* of every search; the device that was committed before it */
    const char *why;
};

#define SPACE_ROWS 16
extern const struct space_row space_row[SPACE_ROWS];

/* A plant: one number 0..1 a row. */
struct plant_point {
    double u[SPACE_ROWS];
};

/* The value of a row at u, and back. */
double space_value(int row, double u);
double space_unit(int row, double value);
/* 1 if the row can take this very value: whole ones take whole numbers below hi. */
int space_exact(int row, double value);

/* Where every search starts. */
struct plant_point space_start(void);

/* Device and wall of the model, with a velocity estimator of this kind; gains and rate are the
 * caller's. < 0: no integration step will do. */
int space_apply(const struct plant_point *p, enum estimate_kind kind, struct sim_device *d,
    struct settle_wall *w);

/* Row by name, or -1. */
int space_find(const char *name);

#endif
