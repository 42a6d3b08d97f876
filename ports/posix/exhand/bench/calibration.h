/* SPDX-License-Identifier: MIT */
/* One calibration on the simulated device's bench, and the files of its results. */
#ifndef CLI_CALIBRATION_H
#define CLI_CALIBRATION_H

#include "posix.h"

#include "exhand/calibrate.h"

#include <stdio.h>

/* a parameter of the scene, by name, in SI */
struct calibration_setting {
    const char *name;
    double value;
};

struct calibration_cfg {
    uint32_t rate_Hz;
    const double *mass_kg; /* masses on the string, as the person stated */
    const double *hung_kg; /* and what does; NULL: the same */
    int masses;
    const struct calibration_setting *setting;
    int settings;
    struct posix_config board; /* device, seed, bench, what is wrong */
    FILE *progress;            /* a line per step; NULL: none */
};

struct calibration {
    struct exh_calib c; /* points below; whose and when is the caller's */
    struct exh_calib_point point[EXH_CALIB_POINTS_MAX];
    unsigned step, result;   /* the step in which it ended, and why (examples/calibrate): DONE
                              * if all of it is done; BUSY: it was ended before */
    uint32_t faults, limits; /* all faults; the limits that ended it */
    double home_m;           /* the end, from where the string was at first */
    double polarity_A;       /* current that moved the string */
    double most_A;           /* the highest current coded in all */
    double last_s;           /* how long the last step took */
    double last_most_A;      /* and the highest current in it */
    double last_travel_m;    /* and the farthest from its start */
};

/* 0, or -EXH_E… after a line on stderr: it could not begin, or (-EXH_E_STATE) it was
 * interrupted. A step that failed is in *out, and said on progress. */
int calibration_run(const struct calibration_cfg *cfg, struct calibration *out);

/* Why it ended, with the names of the faults or limits. */
#define CALIBRATION_WHY_B 200
void calibration_why(char to[CALIBRATION_WHY_B], const struct calibration *r);

/* Lines of both fits: N/A, and the largest residual, N. 0 or -EXH_E…. */
struct calibration_lines {
    struct exh_calib_fit cur, mon;
    double cur_worst_N, mon_worst_N, f0_N;
};
int calibration_lines(const struct exh_calib *c, struct calibration_lines *l);

/* For people; CSV of the points; CSV of both tables' knots. */
void calibration_print(FILE *f, const struct exh_calib *c, const struct calibration_lines *l);
void calibration_csv(FILE *f, const struct exh_calib *c, const struct calibration_lines *l);
int calibration_table_csv(FILE *f, const struct exh_calib *c);

#endif
