/* SPDX-License-Identifier: MIT */
/* Inline quantizer, for quantizer.c and for glove.c, which needs 22 in a tick. Not part of the
 * library's interface. */
#ifndef EXH_QUANTIZER_TICK_H
#define EXH_QUANTIZER_TICK_H

#include "exhand/fix.h"
#include "exhand/quantizer.h"

static inline int32_t quantizer_in_place(
    struct exh_quantizer *s, const struct exh_quantizer_cfg *cfg, int32_t x)
{
    const int32_t value = s->value;
    const uint32_t off = x > value ? (uint32_t)x - (uint32_t)value : (uint32_t)value - (uint32_t)x;
    if (!s->started || off > cfg->keep) {
        /* Above most there is no code to round to. */
        const int32_t most = exh_from_u32((uint32_t)INT32_MAX - cfg->half);
        const uint32_t up = (uint32_t)(x < most ? x : most) + cfg->half;
        s->value = exh_from_u32(up & (0u - 2 * cfg->half));
        s->started = 1;
    }
    return s->value;
}

#endif
