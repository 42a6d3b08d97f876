/* SPDX-License-Identifier: MIT */
/* What fingers before a wall are run with: options that several commands take. */
#ifndef BOX_HAND_OPTIONS_H
#define BOX_HAND_OPTIONS_H

#include "base/params_file.h"
#include "box/hand.h"

#include <stdio.h>

#define BILATERAL_SPEEDS_MAX   8
#define BILATERAL_SETTINGS_MAX 64
#define BILATERAL_NAME_B       32

struct bilateral_speed {
    char name[BILATERAL_NAME_B];
    double mps;
};

struct bilateral_options {
    struct bilateral_run_cfg run; /* all but the speed */
    struct bilateral_speed speed[BILATERAL_SPEEDS_MAX];
    int speeds;
    int64_t approaches, seed, seeds, jobs;
    int study, cards; /* study: the lab runs many */
    const char *scene, *out, *udp, *key, *link, *record, *columns;
    double record_Hz;
    struct run_setting setting[BILATERAL_SETTINGS_MAX];
    int settings;
    struct sim_trace trace;
    struct images images;
    struct params_file params;
};

extern const char *const bilateral_finger_name[BILATERAL_FINGERS];

/* What holds without options. */
void bilateral_defaults(struct bilateral_options *o);

/* Options by cli_call, ctx the struct above. 0, or 2 after a line on stderr. */
int bilateral_take_speeds(void *ctx, const char *text);
int bilateral_take_fingers(void *ctx, const char *text);
int bilateral_take_pose(void *ctx, const char *text);
int bilateral_take_setting(void *ctx, const char *text);
int bilateral_take_device(void *ctx, const char *text);
int bilateral_print_params(const struct bilateral_options *o);

/* What each finger did in all: its range of motion, its contacts, its largest force. */
void bilateral_print_session(FILE *f, const struct bilateral_run *r, unsigned fingers);

/* The run of one speed. */
struct bilateral_run_cfg bilateral_at_speed(const struct bilateral_options *o, double mps);

/* 2, after a line on stderr that names all poses. */
int hand_bad_pose(const char *text);

#endif
