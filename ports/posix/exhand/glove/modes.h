/* SPDX-License-Identifier: MIT */
/* What the parts of `exhand glove` share. */
#ifndef CLI_GLOVE_H
#define CLI_GLOVE_H

#include "base/option.h"
#include "box/recording.h"

#include "box/glove_line.h"
#include "posix.h"
#include "box/run.h"

#include "glove/glove.h"

#include <stdint.h>

#define GLOVE_SETTINGS 64

struct glove_options {
    int tips, deg, cards, study; /* study: the lab asks for no mode of these */
    const char *serial, *csv, *record, *play, *calibration, *unit, *columns, *scale, *does, *pose;
    double rate_Hz;  /* 0: not said */
    double glove_Hz; /* of --serial */
    double seconds;  /* 0: not said */
    int64_t seed;
    struct sim_device device;
    struct sim_glove_par chain;
    int fc_given;
    struct run_setting setting[GLOVE_SETTINGS]; /* as they were given */
    int settings;
};

/* Frames of codes as they came. */
struct glove_frames {
    int16_t (*raw)[EXH_GLOVE_SENSORS];
    long n;
    struct exh_period T;
};

/* 1 / rate as a ratio, to 1/1000 Hz. */
struct exh_period glove_period(double rate_Hz);

/* The scene's parameters as they are staged, and set up from them. A filter that nobody asked
 * for goes down to a quarter of the rate where it must. 0, or 2 after a line on stderr. */
int glove_ready(const struct glove_options *o, struct glove_par *par, struct glove_cfg *cfg,
    struct exh_period T);

/* How its recording is to be read. */
struct recording_ask glove_asked(const struct glove_options *o);

/* The codes of a recording; angles through the calibration, backwards. If angles come without
 * --calibration, a glove is staged whose 65536 codes are one turn, so that each has its code.
 * 0, or an exit status after a line on stderr. Free raw. */
int glove_frames_of(struct glove_frames *f, const struct glove_options *o, const char *path);

/* Rows as --csv writes them. */
void glove_header(const struct glove_options *o);
void glove_line(const struct glove_options *o, double t_s, const struct glove_signals *s);
/* Options that do not go together: 2 after a line on stderr. */
int glove_bad(const char *what);

/* What the lab does with the options besides. */
struct glove_study {
    struct cli_more more;
    int (*check)(struct glove_options *o); /* 0 or 2; NULL: nothing */
    int (*run)(const struct glove_options *o);
};

/* The command; study->run NULL: the modes alone. Exit status. */
int glove_command(int argc, char **argv, const struct glove_study *study);

/* The modes: exit status. */
int glove_csv(const struct glove_options *o);
int glove_record(const struct glove_options *o);
int glove_serial(const struct glove_options *o);

#endif
