/* SPDX-License-Identifier: MIT */
/* What the parts of `exhand glove` share. */
#ifndef CLI_GLOVE_H
#define CLI_GLOVE_H

#include "base/recording.h"

#include "glove/serial.h"
#include "posix.h"
#include "base/run.h"

#include "glove/glove.h"

#include <stdint.h>

#define GLOVE_SETTINGS 64

struct glove_options {
    int selftest, skew, tips, deg, cards;
    const char *serial, *csv, *log, *record, *play, *calibration, *unit, *does, *pose;
    double rate_Hz;  /* 0: not said */
    double glove_Hz; /* of --serial */
    double seconds;  /* 0: not said */
    double from_s, to_s;
    double travel_m, span_A, span_V;
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

/* What was taken at rest. */
struct glove_rest {
    struct glove_frames frames;
    uint32_t *enc; /* and mon: ticks of them; NULL: no motor in the recording */
    int16_t *mon;
    long ticks, cap;
};

/* From the board, from a log, from a recording; what of a recording lies between --from and --to.
 * 0, or an exit status after a line on stderr. Free the three arrays. */
int glove_rest_board(struct glove_rest *r, const struct glove_options *o);
int glove_rest_log(struct glove_rest *r, const char *path);
int glove_rest_csv(struct glove_rest *r, const struct glove_options *o);
int glove_rest_cut(struct glove_frames *f, const struct glove_options *o);

/* From here on Ctrl-C ends the board's run, not the program: what there is of a log gets whole. */
void glove_catch(void);

/* 1 / rate as a ratio, to 1/1000 Hz. */
struct exh_period glove_period(double rate_Hz);

/* The scene's parameters as they are staged, and set up from them. A filter that nobody asked
 * for goes down to a quarter of the rate where it must. 0, or 2 after a line on stderr. */
int glove_ready(const struct glove_options *o, struct glove_par *par, struct glove_cfg *cfg,
                struct exh_period T);

/* The codes of a recording; angles through the calibration, backwards. If angles come without
 * --calibration, a glove is staged whose 65536 codes are one turn, so that each has its code.
 * 0, or an exit status after a line on stderr. Free raw. */
int glove_frames_of(struct glove_frames *f, const struct glove_options *o, const char *path);

/* Rows as --csv writes them. */
void glove_header(const struct glove_options *o);
void glove_line(const struct glove_options *o, double t_s, const struct glove_signals *s);

/* The calibration of a file, staged. 0, or 2 after a line on stderr. */
int glove_load_calibration(const char *path);

/* The modes: exit status. */
int glove_table1(const struct glove_options *o);
int glove_csv(const struct glove_options *o);
int glove_skew(const struct glove_options *o);
int glove_record(const struct glove_options *o);
int glove_serial(const struct glove_options *o);

#endif
