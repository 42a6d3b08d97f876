/* SPDX-License-Identifier: MIT */
/* A stock glove on a serial line, for commands. */
#ifndef BOX_GLOVE_LINE_H
#define BOX_GLOVE_LINE_H

#include "exhand/run/scene.h"

#include "exhand/glove.h"

#define GLOVE_SERIAL_HZ 90 /* a stock glove's frames */

struct glove_tty;

/* 0, or 3 after a line on stderr that names the option, the device and what to do. */
int glove_serial_open(struct glove_tty *t, const char *option, const char *path, double glove_Hz);

/* Stages a user's calibration, or for NULL the default (exh_glove_cal_default) without code limits,
 * in scene glove or bilateral, with the other settings for a stock glove. 0 or -EXH_E_... after a
 * line on stderr. */
int glove_serial_stage(
    const struct exh_scene *sc, const struct exh_glove_cal *cal, double rate_Hz, double glove_Hz);

#endif
