/* SPDX-License-Identifier: MIT */
/* PROVES: low-pass
 * Each kind, with any coefficients and shift, damaged ones included, any state, any input and up
 * to three channels, which are independent. Reset, and the change from any coefficients to any
 * others.
 *
 * PLANT: lib/src/sense/filter_low.c: const int64_t p = exh_wrap_add64(s->vel, v); -> const int64_t p = s->vel + v;
 * PLANT: lib/src/sense/filter_low.c: (int64_t)high_word(p) * c -> p * c
 * PLANT: lib/src/sense/filter_high.c: return (uint64_t)((int64_t)word * c); -> return (uint64_t)(word * c);
 * PLANT: lib/src/sense/filter.c: exh_clamp64(s[i].pos, full) * (INT64_C(1) << more) -> s[i].pos * (INT64_C(1) << more)
 */
#include "num/bytes.c"
#include "sense/filter.c"
#include "sense/filter_low.c"
#include "sense/filter_high.c"

#include "any.h"

#define CHANNELS 3

static struct exh_filter s[CHANNELS];
static struct exh_filter_cfg cfg, other;
static int32_t x[CHANNELS], y[CHANNELS];

static void any_input(void)
{
    for (unsigned i = 0; i < CHANNELS; i++) { x[i] = any32(); }
}

/* n channels; cfg.a in the k-th eighth of all values, so that it is seen that 2a has the sign that it has. */
static void each(enum exh_filter_kind kind, unsigned n, int32_t k)
{
    const int32_t eighth = INT32_C(1) << 29;
    ANY(cfg);
    cfg.a = Frama_C_interval(k * eighth, k * eighth + (eighth - 1));
    cfg.kind = (uint8_t)kind;
    any_input();
    for (unsigned i = 0; i < CHANNELS; i++) { FROM_BYTES(s[i], exh_filter_serialize); }
    exh_filter_step(s, &cfg, x, y, n);
    any_input();
    exh_filter_step(s, &cfg, x, x, n); /* in place, from what the tick left */
    ANY(other);
    exh_filter_retune(s, &cfg, &other, n);
}

int main(void)
{
    for (int32_t k = -4; k < 4; k++) {
        each(EXH_FILTER_LOW1, CHANNELS, k);
        each(EXH_FILTER_LOW2, CHANNELS, k);
        each(EXH_FILTER_HIGH1, CHANNELS, k);
        each(EXH_FILTER_HIGH2, CHANNELS, k);
    }
    each(EXH_FILTER_LOW2, 0, 0);
    exh_filter_reset(s, x, CHANNELS);
    END();
    return 0;
}
