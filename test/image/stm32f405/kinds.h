/* SPDX-License-Identifier: MIT */
/* Faults of chip, wiring and program, and the required results. */
#ifndef KINDS_H
#define KINDS_H

#include "loop.h"

enum kind_end {
    ENDS_OFF,   /* drives off within 20 ms, and they stay off */
    ENDS_WORDS, /* the same, and words say why: behind a log of 82 ms */
    ENDS_BOUND, /* no detector need see it; the current stays within its limits */
    ENDS_LETGO, /* the same, and a finger that the glove sees far before its wall is let go */
    ENDS_ARM,   /* the box does not arm, and pulls no more than arm_pull */
    ENDS_WELL   /* nothing happens */
};

/* Kinds are drawn from one set at a time. */
enum kind_set {
    SET_MANY,   /* all, for 50 ms */
    SET_GLOVE,  /* encoders of fingers that press against a wall, until they withdraw */
    SET_ARM,    /* encoders, before a box arms that has an arm_pull */
    SET_LONG,   /* encoders, for as long as I2t allows the peak current, and on */
    SET_PERSON, /* the same, where person_i is low */
    SETS
};

struct kind {
    const char *name;
    const char *told; /* a fault's name, words, or "reset"; "": nothing is said */
    enum kind_end ends;
    void (*begin)(unsigned chance); /* chance: which finger, or where to */
    void (*cease)(void);            /* 3 us later, or NULL */
    uint32_t (*sign)(void); /* another value at the end than before: it took effect. NULL: named */
    enum kind_set set;
};
extern const struct kind kinds[];
extern const unsigned kind_count;
void kind_overruns(unsigned chance); /* the stack */

/* The parameters of a set, in addition to the scene's. */
void kinds_set(enum kind_set set);
#define KIND_ARM_N    0.3
#define KIND_ARM_MS   400
#define KIND_PERSON_A 1.0

#define KIND_DOUBT_MS 100  /* doubt_max: what bilateral has */
#define KIND_FAR_M    0.02 /* string of a finger far before its wall, which is at 30 mm */

/* Puts into flash what programs that go astray find there. */
void kinds_prepare(struct machine *m);

#endif
