/* SPDX-License-Identifier: MIT */
/* Which class of ticks a tick was of, for what the scene costs (count.h). */
#ifndef HIL_CLASS_H
#define HIL_CLASS_H

#include "count.h"

struct class_of {
    const struct exh_scene *twin; /* the same scene, of this program: names of signals; or NULL */
    uint32_t scene;               /* the image's, an address */
    uint32_t accepted;            /* packets, up to the tick before */
};

/* Sum of enum count_key: before the tick, of the inputs, and after it, of the outputs. */
unsigned class_in(struct class_of *c, const struct hil *h, const struct exh_scene_in *in);
unsigned class_out(
    struct class_of *c, const struct hil *h, const struct exh_drive_out *out, unsigned key);

#endif
