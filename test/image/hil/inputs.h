/* SPDX-License-Identifier: MIT */
/* Random and extreme inputs, put in place of the image's own at the start of a scene's tick. */
#ifndef HIL_INPUTS_H
#define HIL_INPUTS_H

#include "exhand/run/scene.h"

struct inputs {
    uint64_t state;             /* of the generator */
    uint32_t walk[EXH_FINGERS]; /* further movement of the strings */
    int torn; /* encoders jump, too: the scene takes none that did for good again */
    struct exh_scene_in last;
};

/* runs: the scene ran in its last tick. */
void inputs_next(struct inputs *s, int runs, struct exh_scene_in *in);

#endif
