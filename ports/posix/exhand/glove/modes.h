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
#define GLOVE_RATE_TOP 20000

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
    double *t_s;                      /* as recorded; NULL: a row each T */
    char (*label)[RECORDING_LABEL_B]; /* NULL: none */
};

/* 1 / rate as a ratio, to 1/1000 Hz. */
struct exh_period glove_period(double rate_Hz);

/* Stages the scene's parameters and sets up from them. A default filter is lowered to a quarter of
 * the rate if necessary. 0, or 2 after a line on stderr. */
int glove_ready(const struct glove_options *o, struct glove_par *par, struct glove_cfg *cfg,
    struct exh_period T);

/* What the options say of a recording's text. */
struct recording_ask glove_asked(const struct glove_options *o);

/* The codes of a recording; angles through the calibration, backwards. If angles come without
 * --calibration, a glove is staged whose 65536 codes are one turn, so that each has its code.
 * T is that of --rate, else by the recorded time; _from leaves it as it is, and takes time and
 * labels out of r. 0, or an exit status after a line on stderr. */
int glove_frames_of(struct glove_frames *f, const struct glove_options *o, const char *path);
int glove_frames_from(
    struct glove_frames *f, const struct glove_options *o, struct recording *r, const char *path);
void glove_frames_free(struct glove_frames *f);

/* Rows as --csv writes them; label NULL: without. */
void glove_header(const struct glove_options *o, int labelled);
void glove_line(
    const struct glove_options *o, double t_s, const struct glove_signals *s, const char *label);
/* Options that do not go together: 2 after a line on stderr. */
int glove_bad(const char *what);

/* Additional work of exhand-lab with the options. */
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
