/* SPDX-License-Identifier: MIT */
/* The result of a user's calibration of the glove. */
#ifndef GLOVE_RESULT_H
#define GLOVE_RESULT_H

#include "glove/poses.h"

#include <stdio.h>

#define DEG_OF_TURN_Q32 (360.0 / 4294967296.0)
#define DEG_OF_GAIN_Q38 (360.0 / 274877906944.0)

struct glove_result {
    struct exh_glove_cal cal;
    struct exh_glove_fit fit[EXH_GLOVE_SENSORS];
    uint8_t which[GLOVE_POSES]; /* of the poses that were fitted */
    struct exh_glove_pose pose[GLOVE_POSES];
    unsigned poses;
    struct glove_taken taken;
    uint32_t present;
    uint8_t image[EXH_GLOVE_CAL_IMAGE_B];
};

/* For people: a calibration alone; with what it was made of. */
void glove_cal_print(const struct exh_glove_cal *cal);
void glove_result_print(const struct glove_result *r);

/* The image, glove.csv and poses.csv. 0, or 1 after a line on stderr. */
int glove_result_write(const char *dir, struct glove_result *r);

#endif
