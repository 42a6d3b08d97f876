/* A stock glove on a serial line, for commands. */
#ifndef CLI_GLOVE_SERIAL_H
#define CLI_GLOVE_SERIAL_H

#include "scene.h"

#include "exhand/glove.h"

#define GLOVE_SERIAL_HZ 90 /* a stock glove's frames                              */

struct glove_tty;

/* 0, or 3 after a line on stderr that names the option, the device and what to do. */
int glove_serial_open(struct glove_tty *t, const char *option, const char *path, double glove_Hz);

/* Nobody's hand, as exh_glove_cal_default, in codes 1 .. 255 of a stock glove; and in parameters of scene
 * glove or bilateral, with all else that suits one. 0 or -EXH_E... after a line on stderr. */
void glove_serial_cal(struct exh_glove_cal *cal);
int glove_serial_stage(const struct exh_scene *sc, double rate_Hz, double glove_Hz);

#endif
