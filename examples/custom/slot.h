/* SPDX-License-Identifier: MIT */
/* Slot: a controller of your own instead of the law, with the functions init, step and terminate.
 *
 * It names its inputs: each is a signal of the slot or any parameter of the scene, and comes with
 * its row (exhand/signal.h). A controller in floats scales it by the row's format; one in integers
 * uses it as it is. The output is one force. The scene limits it, and the controller cannot
 * influence that. */
#ifndef EXAMPLES_SLOT_H
#define EXAMPLES_SLOT_H

#include "exhand/signal.h"
#include "exhand/units.h"

#include <stdint.h>

/* Largest number of inputs. */
#define SLOT_INPUTS 32
/* No answer: not a number, infinite, or the controller reported a failure. */
#define SLOT_NONE INT32_MIN

struct slot_wire {
    const struct exh_signal *row;
    const int32_t *value; /* raw, row->frac fraction bits; owned by the scene, of this tick */
};

/* One controller. An image has one, named slot. */
struct slot {
    const char *name;
    uint32_t rate_Hz;         /* its only sample rate; 0: any */
    uint8_t inputs;           /* number, at most SLOT_INPUTS */
    const char *const *input; /* their names */
    /* Initialises, also again after terminate. The wires, in the order of input, stay. 0 or
     * -EXH_E_.... */
    int (*init)(const struct slot_wire *wire, struct exh_period T);
    /* One tick: returns the requested string force, N q20, or SLOT_NONE. */
    int32_t (*step)(void);
    void (*terminate)(void);
};
extern const struct slot slot;

#endif
