/* SPDX-License-Identifier: MIT */
/* A rehearsal of one stage of examples/bringup on the simulated device: a person who does what is
 * asked, and what may be wrong. */
#ifndef CLI_BRINGUP_RUN_H
#define CLI_BRINGUP_RUN_H

#include "posix.h"

#include "bringup/bringup.h"

enum bringup_wrong {
    BRINGUP_RIGHT,
    BRINGUP_MOTOR_REVERSED,
    BRINGUP_ENCODER_REVERSED,
    BRINGUP_UNPLUGGED,    /* encoder: the count does not change */
    BRINGUP_COMES_OFF,    /* the same, but later */
    BRINGUP_STUCK,        /* the rotor does not turn */
    BRINGUP_MONITOR_DEAD, /* 0 V */
    BRINGUP_MONITOR_HALF, /* half of what it should be */
    BRINGUP_DA_STILL,     /* the D/A keeps its voltage */
    BRINGUP_NOT_READY,
    BRINGUP_ESTOP,
    BRINGUP_LET_GO,  /* the dead-man switch */
    BRINGUP_SLIPPED, /* the balance is off the string */
    BRINGUP_AWAY,    /* no person acts */
    BRINGUP_HELD,    /* the switch, before the question */
    BRINGUP_WRONGS
};
struct bringup_wrong_row {
    const char *name, *what;
};
extern const struct bringup_wrong_row bringup_wrong_row[BRINGUP_WRONGS];

struct bringup_run_cfg {
    uint32_t rate_Hz;
    const char *boot; /* "name=value ...", as on the image's command line */
    enum bringup_wrong wrong;
    int wrong_phase; /* it begins 0.2 s into this phase; < 0: at power-on */
    struct posix_config board;
};

struct bringup_run {
    unsigned phase, result; /* where it ended, enum bringup_result */
    uint32_t number;        /* that it printed, if it was done */
    double took_s;          /* from what is wrong, or the phase, until it ended */
    double most_A;          /* highest current coded with the drive enabled */
    double moved_m;         /* string at the motor, from the phase's begin to 0.2 s after the end */
    unsigned long unsafe;   /* ticks from then on with a code or an enable */
    double balance_N[BRINGUP_LEVELS];
};

/* Every stage and everything that may be wrong in it, as a table. 0, or 1 if anything that is
 * enabled went on where it should have ended. */
int bringup_faults(FILE *f, const struct bringup_run_cfg *cfg);

/* 0, or -EXH_E… after a line on stderr: it could not begin. Lines of the scene go to board.log. */
int bringup_run(const struct bringup_run_cfg *cfg, struct bringup_run *out);

#endif
