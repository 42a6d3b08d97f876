/* SPDX-License-Identifier: MIT */
/* Space: which values of the simulated device and the box are searched, and how far. */
#ifndef FIT_SPACE_H
#define FIT_SPACE_H

#include "box/run.h"

enum space_kind {
    SPACE_DEVICE, /* a value of the device, by its name */
    SPACE_SCENE,  /* a parameter of the scene, by its name */
    SPACE_KF,     /* times the device's: what the box believes of it */
    SPACE_MONITOR
};

struct space_row {
    const char *name;
    enum space_kind kind;
    double lo, hi;
    enum { SPACE_LINEAR, SPACE_LOG, SPACE_WHOLE } scale;
    double start; /* of every search; the device that was committed before it */
    const char *why;
};

#define SPACE_ROWS 17
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

/* Writes device and settings (room for SPACE_ROWS of them) to c. */
void space_apply(const struct plant_point *p, struct run_cfg *c, struct run_setting *setting);

/* Row by name, or -1. */
int space_find(const char *name);

/* The natural logarithm of x > 0, from + - * /. */
double space_ln(double x);

#endif
