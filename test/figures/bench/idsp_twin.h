/* SPDX-License-Identifier: MIT */
/* The recurrences of the crate idsp 0.23.1 in C, for CPUs that cargo has no library for: 22
 * channels of each low-pass. `peers twins` holds them against the crate's, bit by bit. */
#ifndef BENCH_IDSP_TWIN_H
#define BENCH_IDSP_TWIN_H

#include <stdint.h>

/* start: five coefficients of 30 fraction bits, or two gains of 32; step: a sample of channel 0;
 * tick: one of each. */
#define IDSP_FILTER(name) \
    void name##_start(const int32_t *k); \
    int32_t name##_step(int32_t x); \
    void name##_tick(const int32_t *x, int32_t *y);
IDSP_FILTER(twin_df1)
IDSP_FILTER(twin_wide)
IDSP_FILTER(twin_dither)
IDSP_FILTER(twin_lowpass)

#endif
