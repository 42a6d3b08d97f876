/* SPDX-License-Identifier: MIT */
/* libfixmath as the benches call it: 16 fraction bits, its caches off, since inputs that repeat
 * would hide what a sine costs. */
#ifndef BENCH_PEERS_FIXMATH_H
#define BENCH_PEERS_FIXMATH_H

#include <math.h>
#include <stdint.h>

#include "fix16.h"

fix16_t fixmath_lut_sin(fix16_t rad);
fix16_t fixmath_lut_cos(fix16_t rad);
#define FIXMATH_LUT_B (102688u * 2)

static inline fix16_t fixmath_of(long double x) { return (fix16_t)lrintl(x * 65536); }

/* A binary angle, 2^32 a turn, in radians to the nearest. */
static inline fix16_t fixmath_rad(int32_t turn_q32)
{
    return (fix16_t)(((int64_t)turn_q32 * fix16_pi + (1 << 30)) >> 31);
}

#endif
