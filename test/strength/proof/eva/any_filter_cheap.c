/* SPDX-License-Identifier: MIT */
/* PROVES: low-pass, cheap
 * Both kinds, with any coefficients, damaged ones included, any state, any input and up to three
 * channels, which are independent. Reset.
 *
 * PLANT: lib/src/sense/filter_cheap.c: return (uint64_t)((int64_t)a * b); -> return (uint64_t)(int64_t)(a * b);
 * PLANT: lib/src/sense/filter_cheap.c: exh_from_u64((uint64_t)s->pos + times(v, c)) -> s->pos + (int64_t)v * c
 */
#include "num/bytes.c"
#include "sense/filter_cheap.c"

#include "any.h"

#define CHANNELS 3

static struct exh_filter_cheap s[CHANNELS];
static struct exh_filter_cheap_cfg cfg;
static int32_t x[CHANNELS], y[CHANNELS];

static void any_input(void)
{
    for (unsigned i = 0; i < CHANNELS; i++) { x[i] = any32(); }
}

static void each(uint8_t high, unsigned n)
{
    ANY(cfg);
    cfg.high = high;
    any_input();
    for (unsigned i = 0; i < CHANNELS; i++) { FROM_BYTES(s[i], exh_filter_cheap_serialize); }
    exh_filter_cheap_step(s, &cfg, x, y, n);
    any_input();
    exh_filter_cheap_step(s, &cfg, x, x, n); /* in place, from what the tick left */
    exh_filter_cheap_reset(s, &cfg, x, n);
}

int main(void)
{
    each(0, CHANNELS);
    each(1, CHANNELS);
    each(0, 0);
    END();
    return 0;
}
