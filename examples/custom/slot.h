/* SPDX-License-Identifier: MIT */
/* Slot: a controller of your own in the place of the law, behind init, step and terminate.
 *
 * What goes in is named: each input is a signal of the slot, or any parameter of the scene, and
 * comes with its row (exhand/signal.h), so a controller in floats scales it by the row's format and
 * one in integers takes it as it is. What comes out is one force; what becomes of it is the scene's
 * business, and a controller can do nothing about it.
 */
#ifndef EXAMPLES_SLOT_H
#define EXAMPLES_SLOT_H

#include "exhand/signal.h"
#include "exhand/units.h"

#include <stdint.h>

/* Inputs at the most. */
#define SLOT_INPUTS 32
/* The answer that is none: not a number, infinite, or the controller said that it failed. */
#define SLOT_NONE INT32_MIN

struct slot_wire {
    const struct exh_signal *row;
    const int32_t *value; /* raw, row->frac fraction bits; the scene's, of this tick */
};

/* One controller; an image has one, `slot`. */
struct slot {
    const char *name;
    uint32_t rate_Hz;         /* the only one it may run at; 0: any */
    uint8_t inputs;           /* at most SLOT_INPUTS */
    const char *const *input; /* their names */
    /* Power-on, again after terminate. The wires, in the order of `input`, stay. 0 or -EXH_E…. */
    int (*init)(const struct slot_wire *wire, struct exh_period T);
    /* A tick: string force asked for, N q20, or SLOT_NONE. */
    int32_t (*step)(void);
    void (*terminate)(void);
};
extern const struct slot slot;

#endif
