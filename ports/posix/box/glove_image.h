/* SPDX-License-Identifier: MIT */
/* The file that `exhand calibrate --glove` writes and others read. */
#ifndef CLI_GLOVE_IMAGE_H
#define CLI_GLOVE_IMAGE_H

#include "exhand/glove.h"

#define IMAGE_NAME   "glove.bin"
#define IMAGE_WANTED IMAGE_NAME " that `exhand calibrate --glove --out` wrote"

/* Whole and in range: 0; or an exit status after a line on stderr that names the option. */
int glove_image_read(struct exh_glove_cal *cal, const char *option, const char *path);

#endif
