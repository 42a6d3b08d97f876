/* SPDX-License-Identifier: MIT */
/* Frozen: a scene whose set-up ran during the build, for one period and one counter width.
 *
 * `make image FROZEN=1000 SCENE=minimal PORT=...` runs the scene's set-up on the build machine and
 * writes the results field by field as C (freeze.h). The scene is compiled with EXH_FROZEN, which
 * names that text, instead of its set-up. So the values are constants: in ROM, where nothing can
 * change them, and in the code, where branches and products of constants disappear. Code that
 * divides is not linked. */
#ifndef EXAMPLES_FROZEN_H
#define EXAMPLES_FROZEN_H

#include "exhand/run/scene.h"

#include "exhand/error.h"

/* Checks whether a scene frozen for one board may run on another. 0; -EXH_E_RATE: another period,
 * where an equal ratio is accepted; -EXH_E_RANGE: another counter width. Always call it: at another
 * period all forces, ramps and releases differ. */
static inline int exh_frozen_for(struct exh_scene_board frozen, struct exh_scene_board is)
{
    if (is.T.num == 0 || (uint64_t)is.T.num * frozen.T.den != (uint64_t)frozen.T.num * is.T.den) {
        return -EXH_E_RATE;
    }
    return is.enc_bits == frozen.enc_bits ? 0 : -EXH_E_RANGE;
}

#endif
