/* Random and extreme inputs, put in place of the image's own at the start of a scene's tick. */
#ifndef HIL_INPUTS_H
#define HIL_INPUTS_H

#include "scene.h"

struct inputs {
    uint64_t state; /* of the generator */
    struct exh_scene_in last;
};

void inputs_next(struct inputs *s, struct exh_scene_in *in);

#endif
