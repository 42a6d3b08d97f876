/* SPDX-License-Identifier: MIT */
/* Faults, their place, and how the box ends: one run in closed loop that many others branch from,
 * each with a fault at its true source.
 *
 * A branch is a copy of the whole process at the end of a tick (fork): scene, loop, board, cards,
 * link, device and hand as they are then. Its scene goes once through its own bytes, so that what a
 * keyframe does not hold is missing in it. */
#ifndef CLI_FAULTS_H
#define CLI_FAULTS_H

#include "exhand/run/scene.h"

#include "exhand/frame.h"
#include "exhand/integrity.h"
#include "exhand/safety.h"

#include <stdint.h>
#include <stdio.h>

/* --- faults (source.c) --- */

enum faults_source {
    FAULTS_NOTHING,
    FAULTS_ESTOP,     /* its contact opens */
    FAULTS_DEADMAN,   /* its contact opens */
    FAULTS_DRIVE,     /* a drive's ready contact opens */
    FAULTS_LATE,      /* one tick is long: many are missed after it */
    FAULTS_SLOW,      /* every tick takes one and a half periods */
    FAULTS_JUMP,      /* the encoder jumps */
    FAULTS_STILL,     /* the encoder does not count */
    FAULTS_MONITOR,   /* the current monitor is off */
    FAULTS_DA,        /* the D/A says that it has updated and has not */
    FAULTS_SPEED,     /* the string runs faster than it may */
    FAULTS_GLOVE,     /* a wire of a glove's sensor breaks */
    FAULTS_GLOVE_OLD, /* no frame of the glove comes any more */
    FAULTS_CARD,      /* a card does not answer any more */
    FAULTS_LINK,      /* nothing comes over the link any more */
    FAULTS_SUPPLY_LOW,
    FAULTS_SUPPLY_HIGH,
    FAULTS_WATCHDOG,  /* its contact says that it has fired */
    FAULTS_DEAD_LOOP, /* no tick comes any more */
    FAULTS_PAR,       /* a bit of a parameter in memory turns over */
    FAULTS_CAL,       /* a bit of a calibration in memory turns over */
    FAULTS_STATE,     /* the state in memory becomes one that is none */
    FAULTS_OFF,       /* no fault: OFF is commanded; the last that random times draw */
    FAULTS_CHATTER,   /* the string swings to and fro, fast */
    FAULTS_SOURCES
};

#define FAULTS_DEAD_TICKS 26  /* of a loop that is dead, at most */
#define FAULTS_LINK_HZ    400 /* packets of the world */

/* Where the guard is in its round when memory is damaged. */
enum faults_place {
    FAULTS_ANYWHERE, /* where it happens to be */
    FAULTS_AHEAD,    /* it comes to it soon */
    FAULTS_PASSED    /* it has just passed by */
};

struct faults_what {
    uint8_t source;       /* enum faults_source */
    uint32_t after_ticks; /* it begins so long after the branch does, 0: before the next tick */
    uint32_t for_ticks;   /* and is gone after so many; 0: it stays */
    uint32_t how;         /* which bit, which way, how far */
    uint8_t place;        /* of the guard, by then: enum faults_place */
};

/* --- what must follow (spec.c) --- */

/* columns: the state it is seen in */
enum faults_in {
    FAULTS_IN_OFF,
    FAULTS_IN_ASKED, /* OFF, and RUN is commanded: arming is refused */
    FAULTS_IN_SMALL, /* ARM, the gate closed */
    FAULTS_IN_RAMP,  /* ARM, the limit rises */
    FAULTS_IN_RUN,
    FAULTS_IN_LIMIT,
    FAULTS_IN_RELEASE,
    FAULTS_IN_FAULT,
    FAULTS_INS
};

struct faults_spec {
    const char *name, *what;
    uint32_t bits;      /* enum exh_fault */
    uint8_t cuts;       /* 1: no current in the tick that sees it; 0: the release law */
    uint8_t in;         /* bit i: can be seen in enum faults_in i; else there is nothing to see */
    uint32_t ticks, ms; /* seen within */
    uint8_t may;        /* 1: at random times it may be none: what is to be seen is not there */
    uint32_t also;      /* enum exh_fault that it may raise too, while it lasts */
};

/* The faults that cut, in bits. */
#define FAULTS_CUTS \
    ((uint32_t)(EXH_FAULT_ESTOP | EXH_FAULT_DRIVE | EXH_FAULT_TRACKING | EXH_FAULT_CARD | \
                EXH_FAULT_WATCHDOG | EXH_FAULT_CONFIG | EXH_FAULT_LOGIC))

const struct faults_spec *faults_spec_of(unsigned source);
int faults_has(unsigned scene, unsigned source);
int faults_is_memory(unsigned source); /* of what the guard looks at */
uint32_t faults_seen_within(unsigned scene, unsigned source, uint32_t rate_Hz);
/* The same of one of two, the other being `beside`. */
uint32_t faults_seen_beside(unsigned scene, unsigned source, unsigned beside, uint32_t rate_Hz);
uint32_t faults_release_ticks(uint32_t rate_Hz);
uint32_t faults_zero_ticks(uint32_t rate_Hz); /* at most */
int faults_next(unsigned source, int state, int open);
int faults_end(unsigned source, int state, int open);

/* --- the run that is branched from (scene.c) --- */

enum faults_scene { FAULTS_DROP, FAULTS_BILATERAL, FAULTS_SCENES };

struct faults_base {
    uint8_t scene;  /* enum faults_scene */
    uint8_t cards;  /* 1: through drivers and emulated cards */
    uint8_t gentle; /* 1: no limit holds anything back while it presses */
    uint32_t rate_Hz;
    uint32_t seed;
    uint32_t stuck_ms;  /* 0: the scene's own */
    uint32_t wait_ms;   /* so much longer before the finger moves */
    uint8_t chatter;    /* 1: a contact that buzzes is a fault, as it is outside experiments */
    uint8_t not_run;    /* 1: RUN is not commanded */
    uint8_t not_waived; /* 1: nor a calibration, of which there is none */
};

/* What the box says of a tick. */
struct faults_view {
    int state;   /* enum exh_state */
    int open;    /* the gate: a force is let through, or falls */
    int refused; /* bit of the step of arming, enum exh_arm */
    uint32_t faults, present, limits;
    int32_t force_N_q20[EXH_FINGERS], coded_A_q26[EXH_FINGERS];
};

#define FAULTS_FINGER 1u /* the one that is in use in bilateral: the index */

/* Runs the base from power-on to its end. `at` is called at the end of every tick with what the
 * box says: it branches there. 0 or -EXH_E…. */
typedef void faults_at(void *ctx, uint32_t tick, const struct faults_view *v);
int faults_run(const struct faults_base *b, faults_at *at, void *ctx);

uint32_t faults_run_tick(void);        /* in which the base commands RUN */
unsigned faults_finger(uint8_t scene); /* 0 or FAULTS_FINGER */

/* The memory of the scene's one instance. */
struct faults_memory {
    struct exh_safety *safety;
    int32_t *par;
    uint32_t pars;
    const struct exh_signal_table *table; /* theirs */
    void *cal;                            /* tables and what else set-up made of the calibration */
    uint32_t cal_B;
    struct exh_integrity *guard;
    const void *area; /* what the guard looks at: cal is part of it */
    uint32_t area_B;
};
struct faults_memory faults_memory(uint8_t scene);

/* Steps of arming, enum exh_arm, that do not hold from now on: as if set-up had found it so. */
void faults_lose(uint8_t scene, uint32_t steps);

/* The scene's state through its own bytes, and back. */
void faults_through_bytes(uint8_t scene);

/* --- a branch (branch.c) --- */

struct faults_case {
    struct faults_what what[2];
    uint32_t follow_ticks; /* so long */
    uint32_t run_tick;     /* RUN is commanded in this one; 0: in none */
    uint8_t whole;         /* 1: its state does not go through bytes */
    uint8_t loses;         /* steps of arming, enum exh_arm, that do not hold any more */
    uint8_t eager;         /* RUN and CLEAR are commanded all the time */
    FILE *trace;           /* force, tick by tick; NULL: none */
};

enum faults_bad {
    FAULTS_BAD_RISE = 1 << 0,   /* force rose after the cause was seen */
    FAULTS_BAD_SLOPE = 1 << 1,  /* it fell faster than the release law */
    FAULTS_BAD_ZERO = 1 << 2,   /* not zero in time */
    FAULTS_BAD_CUT = 1 << 3,    /* a fault that cuts did not, in the tick that saw it */
    FAULTS_BAD_ENABLE = 1 << 4, /* a drive enabled though the force is zero */
    FAULTS_BAD_OPEN = 1 << 5,   /* it opened again without a command */
    FAULTS_BAD_CODE = 1 << 6,   /* a code beyond its span */
    FAULTS_BAD_DEVICE = 1 << 7, /* current in the motor after that */
    FAULTS_BAD_LOST = 1 << 8,   /* the branch did not come to its end */
    FAULTS_BAD_BYTES = 1 << 9   /* with no fault, it is another run than without bytes */
};
#define FAULTS_BADS 10

struct faults_seen {
    struct faults_view from; /* at the end of the tick of the branch */
    uint32_t bad;            /* enum faults_bad */
    uint8_t ended;           /* the run has, by a card's error */
    uint8_t opened;          /* the gate was, in some tick of the branch */
    uint8_t released;        /* the state was, in some tick */
    uint32_t present;        /* causes, in the ticks that saw them */
    uint32_t digest;         /* CRC-32 of all that came out */
    int32_t seen_ticks[2];   /* from when it began to the tick that says so; -1: none */
    int32_t zero_ticks; /* of the first tick without force; that which saw a cause is 1; 0: none was
                           held */
    int32_t after_ticks;          /* the same from when what[0] was seen */
    struct faults_view before[2]; /* the tick that saw it */
    int32_t state[2];             /* in that tick */
    struct faults_view end;
    double zero_s;              /* from that tick to no current in the motor */
    double force_N;             /* held before */
    double slope;               /* worst fall of a tick over the law's, 0: no release */
    double back_mps, jerk_mps3; /* of the finger or mass, until 50 ms later */
};

/* To be called in faults_at, where it returns twice, as fork does: in the branch with 1, and
 * faults_at is not called any more. */
int faults_branch(const struct faults_base *b, const struct faults_case *c, uint32_t tick,
    const struct faults_view *v, struct faults_seen *seen);
void faults_ended(void); /* behind the run: does not return in a branch */

/* Of the loop: the commands, and 1 in a branch. */
void faults_before(uint32_t tick, struct exh_scene_in *in);
int faults_after(uint32_t tick, const struct faults_view *v, const struct exh_drive_out *out);

/* What is wrong on the way in and out, and with time (source.c). */
void faults_wires_in(struct exh_drive_in *in);
void faults_wires_out(struct exh_drive_out *out);
uint32_t faults_late(uint64_t tick);

/* In a branch, at the end of each tick, before what that does can be seen in the next one. */
void faults_source_start(
    const struct faults_base *b, const struct faults_what what[2], uint32_t tick);
void faults_source_step(uint32_t tick);
/* From damage with the guard FAULTS_AHEAD to the tick that sees it. */
uint32_t faults_source_ahead(unsigned scene, unsigned source, uint32_t how);
const struct exh_signal *faults_source_row(void); /* that is damaged by now; NULL: none */
int faults_source_off(void);                      /* OFF is commanded in this tick */
uint32_t faults_source_gone(void);                /* ticks of a dead loop, once */
void faults_dead_tick(double fed_s);              /* one of them, in the branch */

#endif
