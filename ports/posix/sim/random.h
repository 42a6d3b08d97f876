/* SPDX-License-Identifier: MIT */
/* Random numbers of the simulation: seeded, the same on every machine. */
#ifndef SIM_RANDOM_H
#define SIM_RANDOM_H

#include <stdint.h>
#if defined(__SSE2__) && defined(__x86_64__) && !defined(__TINYC__)
#include <emmintrin.h>
#endif

struct sim_random {
    uint64_t state;
};

#define SIM_RANDOM_STEP UINT64_C(0x9E3779B97F4A7C15)

/* splitmix64 (Steele, Lea, Flood 2014). */
static inline uint64_t sim_random_u64(struct sim_random *r)
{
    uint64_t z = r->state += SIM_RANDOM_STEP;
    z = (z ^ z >> 30) * UINT64_C(0xBF58476D1CE4E5B9);
    z = (z ^ z >> 27) * UINT64_C(0x94D049BB133111EB);
    return z ^ z >> 31;
}

/* As if it had been asked n times. */
static inline void sim_random_skip(struct sim_random *r, unsigned n)
{
    r->state += SIM_RANDOM_STEP * n;
}

/* Uniform in 0 <= u < 1, 53 bits. */
static inline double sim_random_unit(struct sim_random *r)
{
    return (double)(sim_random_u64(r) >> 11) * (1.0 / 9007199254740992.0);
}

/* Four uniforms of 16 bits as two sums, one in each half; and the sum of all, of 2^14 draws at
 * most. */
static inline uint64_t sim_random_four(struct sim_random *r)
{
    const uint64_t half = UINT64_C(0x0000FFFF0000FFFF), u = sim_random_u64(r);
    return (u & half) + (u >> 16 & half);
}

static inline int32_t sim_random_sum(uint64_t fours)
{
    return (int32_t)((fours >> 32) + (fours & UINT32_MAX));
}

/* Twelve uniforms: a normal of deviation 1 within +-6. */
static inline double sim_random_normal(struct sim_random *r)
{
    const uint64_t a = sim_random_four(r), b = sim_random_four(r), c = sim_random_four(r);
    return (sim_random_sum(a + b + c) - 6 * 65535) * (1.0 / 65536);
}

/* The sum of the eight bytes of a number. */
static inline double sim_random_eight(uint64_t u)
{
#if defined(__SSE2__) && defined(__x86_64__) && !defined(__TINYC__)
    const __m128i sum = _mm_sad_epu8(_mm_cvtsi64_si128((int64_t)u), _mm_setzero_si128());
    return _mm_cvtsd_f64(_mm_cvtepi32_pd(sum));
#else
    const uint64_t bytes = UINT64_C(0x00FF00FF00FF00FF), two = (u & bytes) + (u >> 8 & bytes);
    return (double)(int32_t)(two * UINT64_C(0x0001000100010001) >> 48);
#endif
}

/* Eight uniforms of 8 bits, of one number: a normal of deviation 1 within +-4.9, in steps of 1/209
 * of it. */
static inline double sim_random_bytes(struct sim_random *r)
{
    return (sim_random_eight(sim_random_u64(r)) - 4 * 255) * 0.0047841924;
}

/* A bell over -1/2..1/2: the mean of four 16-bit uniforms, peak to peak 1, standard
 * deviation 1/6.9. Noise that is known by its peak-to-peak value has bounds. */
static inline double sim_random_bell(struct sim_random *r)
{
    return (double)(sim_random_sum(sim_random_four(r)) - 2 * 65535) * (1.0 / (4 * 65535.0));
}

#endif
