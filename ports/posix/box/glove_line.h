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

/* A user's calibration, or NULL: nobody's hand (exh_glove_cal_default), every code believed; in
 * parameters of scene glove or bilateral, with all else that suits a stock glove. 0 or -EXH_E...
 * after a line on stderr. */
int glove_serial_stage(
    const struct exh_scene *sc, const struct exh_glove_cal *cal, double rate_Hz, double glove_Hz);

#endif
