/* SPDX-License-Identifier: MIT */
/* A run of examples/identify on the simulated device's bench, with the person at it. */
#ifndef IDENTIFY_SESSION_H
#define IDENTIFY_SESSION_H

#include "identify/data.h"

#include "posix.h"

#include <stdio.h>

#define IDENTIFY_SETTINGS_MAX 32

struct identify_setting {
    const char *name;
    double value;
};

struct identify_session {
    uint32_t rate_Hz;
    double mass_kg, hung_kg; /* stated mass, real mass; 0: the same */
    int repeats;             /* 0: the scene's */
    double step_m;           /* stated; 0: the device's, rounded to two digits */
    const struct identify_setting *setting;
    int settings;
    const struct identify_par *par; /* not NULL: the scene's parameters, all of them */
    struct posix_config board;
};

/* Writes to board.log, if there is one, what a box would. 0, or -EXH_E… after a line on stderr: it
 * could not begin. How the run ended is data->result. */
int identify_session(const struct identify_session *s, struct identify_data *data);

#endif
