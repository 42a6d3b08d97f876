/* SPDX-License-Identifier: MIT */
/* Frozen: a scene whose set-up was made with the image, for one period and one width of counters.
 *
 * `make image FROZEN=1000 SCENE=minimal PORT=...` runs the scene's own set-up on the machine that
 * builds and writes down, field by field, what it made (freeze.h): the scene is compiled with
 * EXH_FROZEN, which names that text, in the place of its set-up. So constants are constants: in
 * ROM, where nothing can change them, and in the code, where a branch or a product that they decide
 * is gone; and what divides is not linked.
 */
#ifndef EXAMPLES_FROZEN_H
#define EXAMPLES_FROZEN_H

#include "exhand/run/scene.h"

#include "exhand/error.h"

/* May a scene that was frozen for the one board run on the other: 0, or -EXH_E_RATE, another
 * period, which may be written as another ratio, or -EXH_E_RANGE, counters of another width. Never
 * without: at another period its forces, ramps and releases are others. */
static inline int exh_frozen_for(struct exh_scene_board frozen, struct exh_scene_board is)
{
    if (is.T.num == 0 || (uint64_t)is.T.num * frozen.T.den != (uint64_t)frozen.T.num * is.T.den) {
        return -EXH_E_RATE;
    }
    return is.enc_bits == frozen.enc_bits ? 0 : -EXH_E_RANGE;
}

#endif
