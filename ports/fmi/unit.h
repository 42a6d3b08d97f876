/* SPDX-License-Identifier: MIT */
/* A unit: the implementation of the FMI 3.0 functions, either the controller or the simulated
 * device, one per FMU. Its list of variables comes from the signal tables. describe.c prints the
 * model description from it, and a value reference is an index into it. */
#ifndef FMI_UNIT_H
#define FMI_UNIT_H

#include "exhand/bytes.h"
#include "exhand/units.h"

#include <stddef.h>
#include <stdint.h>

enum unit_type { UNIT_INT32, UNIT_FLOAT64 };
enum unit_role {
    UNIT_FIXED,   /* parameter, before the first step */
    UNIT_TUNABLE, /* parameter, between any two */
    UNIT_INPUT,
    UNIT_OUTPUT
};

struct unit_var {
    uint8_t type, role;
    char name[32];
    const char *unit, *help; /* unit "": none */
    double min, max, start;  /* min > max: no bounds worth telling */
};

extern const char unit_name[]; /* the model's identifier */
extern const char unit_help[];
/* What it must be called with between two steps; a loop of both is the native one bit for bit. */
extern const char unit_order[];

/* Values to power-on defaults; to be called first. */
void unit_reset(void);
/* How many variables there are, and the i-th. */
uint32_t unit_vars(void);
void unit_var(uint32_t i, struct unit_var *v);
double unit_get(uint32_t i);
/* 0, or -EXH_E_…: out of its range, or not now. Parameters act with the next step. */
int unit_set(uint32_t i, double value);
/* Parameters are given: outputs of time 0. 0 or -EXH_E_…, and then *which is those that do not go
 * together. */
int unit_start(const char **which);
/* The period that it was started with. */
struct exh_period unit_period(void);
/* One period, from the inputs as they are now. 0, or -EXH_E_…. */
int unit_step(void);
/* All of it between two steps, through a cursor; of the same unit, built for the same machine. */
void unit_bytes(struct exh_bytes *c);

#endif
