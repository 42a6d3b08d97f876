/* SPDX-License-Identifier: MIT */
#include "bench.h"

#include "exhand/error.h"

#include <stdio.h>
#include <stdlib.h>

volatile int64_t bench_sink;
static uint64_t state;

void exh_assert_failed(const char *file, int line)
{
    fprintf(stderr, "%s:%d: assertion\n", file, line);
    exit(1);
}

/* callgrind knows the function by its name, so no copy of it may be made. */
#if defined __GNUC__ && !defined __clang__
__attribute__((noipa))
#endif
void bench_measure(void (*op)(uint32_t i), uint32_t n)
{
    for (uint32_t i = 0; i < n; i++) { op(i); }
}

void error_add(struct error *e, long double lsb)
{
    const long double abs = lsb < 0 ? -lsb : lsb;
    e->n++;
    e->sum_squares += lsb * lsb;
    if (!(abs <= e->max)) { e->max = abs; }
}

void bench_seed(void) { state = UINT64_C(20130506); }

uint64_t bench_u64(void)
{
    uint64_t z = state += UINT64_C(0x9E3779B97F4A7C15);
    z = (z ^ z >> 30) * UINT64_C(0xBF58476D1CE4E5B9);
    z = (z ^ z >> 27) * UINT64_C(0x94D049BB133111EB);
    return z ^ z >> 31;
}

int32_t bench_in(int32_t lo, int32_t hi)
{
    const uint64_t span = (uint64_t)((int64_t)hi - lo) + 1;
    return (int32_t)(lo + (int64_t)(bench_u64() % span));
}

int32_t bench_i32(void)
{
    static const int32_t corner[] = {0, 1, -1, INT32_MAX, INT32_MIN, INT32_MAX - 1, 1 << 30};
    const int32_t v = bench_in(INT32_MIN, INT32_MAX);
    switch (bench_u64() % 3) {
    case 0: return v;
    case 1: return v / (int32_t)(UINT32_C(1) << bench_in(0, 30));
    default: return corner[bench_u64() % (sizeof corner / sizeof corner[0])];
    }
}
