/* SPDX-License-Identifier: MIT */
/* One run of the drop scene on the simulated device: the paper's ten falls. */
#ifndef CLI_RUN_H
#define CLI_RUN_H

#include "falls/analysis.h"
#include "box/guard.h"
#include "box/images.h"
#include "posix.h"

#include "exhand/run/loop.h"

#include "exhand/params.h"

/* a parameter of the scene, by name, in SI */
struct run_setting {
    const char *name;
    double value;
};

/* A run without a time limit: keeps no results, takes its commands from `more`, and does not stop
 * at a fault. */
struct run_live {
    int on;
    const void *image; /* of parameters, staged before the settings; NULL: none */
    size_t image_B;
    const char *name; /* of it, in messages */
    int gains;        /* 1: k and b of the run are behind it */
};

/* Where the virtual wall lies between two encoder counts. At 2 kHz it decides whether a fall comes
 * to rest, and no experimenter knows it, so a command draws it in each run. */
enum run_wall {
    RUN_WALL_AT_HEIGHT, /* wherever the device's height puts it */
    RUN_WALL_DRAWN,     /* uniform over a count, by the board's seed */
    RUN_WALL_AT_PHASE   /* `phase` counts above a count: the nearest such place to the height */
};

struct run_cfg {
    const struct exh_scene
        *scene; /* drop, or one that begins with its parameters and signals; NULL: drop */
    uint32_t rate_Hz;
    double k_Npm, b_Nspm;
    enum run_wall wall;
    double phase;                      /* 0..1 of a count */
    const struct run_setting *setting; /* further parameters; one of q_lim is above `wall` */
    int settings;
    const struct exh_loop_hooks *more; /* behind the run's own; NULL: none */
    double mon_gain;                   /* on the monitor's force, behind the box; 0: 1 */
    struct posix_config board;         /* device, seed, falls, log, pace */
    const struct images *images;       /* calibrations; NULL, or none: uncalibrated */
    const char *blackbox;              /* dumps go there (dumpfile.h); NULL: no black box */
    size_t blackbox_B;                 /* its memory; 0: as it is there */
    int all; /* 1: every tick is run, also those that are known (idle.h): longer, and no digit else
              */
    struct run_live live;
};

struct run {
    struct fall_log log; /* samples of the falls only, not of hold and lift */
    struct exh_period T;
    double q_lim_m, phase; /* the wall, and its place in counts above a count */
    uint64_t ticks, known; /* the latter of them not run: idle.h */
    uint32_t lost;         /* log records lost */
    uint32_t faults;       /* enum exh_fault */
    uint32_t refused;      /* enum exh_arm: the step at which arming was; no fall then */
    struct guard guard;    /* of scene guarded */
    int dumps;             /* of the black box; -1: one could not be written */
};

/* Stages an image of parameters. 0, or -EXH_E… after a line on stderr; without an image nothing. */
int run_image(const struct run_live *l, struct exh_params *p);
/* Call it after all settings: prints the values that the image did not change. */
void run_image_left(const struct run_live *l, const struct exh_params *p);

/* Whether the scene takes these parameters at this period: 0, or -EXH_E… after a
 * line on stderr. */
int run_check(const struct run_cfg *c);

/* 0 or -EXH_E… after a line on stderr. The scene's encoder step and kf are taken
 * from the device: the box is calibrated. The log in *r is the caller's to free,
 * also after an error. */
int run_drop(const struct run_cfg *c, struct run *r);
void run_free(struct run *r);

#endif
