/* SPDX-License-Identifier: MIT */
/* --calibration: images of fingers, as `exhand calibrate --out` writes them, for a scene's set-up.
 */
#ifndef CLI_IMAGES_H
#define CLI_IMAGES_H

#include "exhand/run/scene.h"

#include "exhand/calibrate.h"

struct images {
    struct {
        char path[512];
        uint8_t byte[EXH_CALIB_IMAGE_B + 1]; /* one more shows a file that is longer */
        uint32_t len_B;
    } at[EXH_FINGERS];
    int n;
};

/* FILE[,FILE...], or a directory: all of its *.bin, by name. An option's call, ctx a struct images.
 * 0, or the status to end with, after a line on stderr. */
int images_take(void *ctx, const char *text);

/* Into the scene, behind its defaults: with images, those, device_id 1 and today as `exhand
 * calibrate` does; without, `uncalibrated`. Settings that come later may still say otherwise. NULL:
 * without. 0 or -EXH_E_…. */
int images_give(const struct images *im, const struct exh_scene *sc);

/* A line on stderr, of which image set-up refused and why. 1 if it was one. */
int images_complain(const struct images *im, const struct exh_scene *sc);

#endif
