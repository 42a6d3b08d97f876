/* SPDX-License-Identifier: MIT */
/* Writes the parameters of a keyframe, an instance of a group at a time: a log may spread them over
 * ticks. Not part of the library's interface. */
#ifndef NUM_PARAMS_WRITE_H
#define NUM_PARAMS_WRITE_H

#include "exhand/params.h"

#include "word.h"

/* The next value to write. Zeros: the first. */
struct params_place {
    uint16_t group, instance;
    uint32_t value;
};

/* Writes two words of a slewed value, one of any other; returns what is behind them. */
static inline uint8_t *params_write(
    uint8_t *to, const struct exh_params *p, struct params_place *at)
{
    const struct exh_signal_group *g = &p->table->group[at->group];
    const int32_t *is = p->active + at->value, *wanted = p->staged + at->value;
    const struct exh_signal *row = g->row, *const end = row + g->rows;
    at->value += g->rows;
    at->instance++;
    if (at->instance >= g->instances) {
        at->instance = 0;
        at->group++;
    }
    for (; row < end; row++, is++, wanted++, to += 4) {
        put_word(to, (uint32_t)*is);
        if (!exh_signal_is_slewed(row)) { continue; }
        to += 4;
        put_word(to, (uint32_t)*wanted);
    }
    return to;
}

#endif
