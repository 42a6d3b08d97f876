/* SPDX-License-Identifier: MIT */
/* What an op takes on this machine; needs _POSIX_C_SOURCE 200809L. */
#ifndef BENCH_CLOCK_H
#define BENCH_CLOCK_H

#include "bench.h"

#include <time.h>

/* ns of one op, the least of 15 runs of BENCH_OPS: other work on the machine only adds to it. */
static inline double bench_least_ns(void (*op)(uint32_t i))
{
    double least = 0;
    for (int k = 0; k < 15; k++) {
        struct timespec a, b;
        double ns;
        clock_gettime(CLOCK_MONOTONIC, &a);
        bench_measure(op, BENCH_OPS);
        clock_gettime(CLOCK_MONOTONIC, &b);
        ns = (1e9 * (double)(b.tv_sec - a.tv_sec) + (double)(b.tv_nsec - a.tv_nsec)) / BENCH_OPS;
        least = k == 0 || ns < least ? ns : least;
    }
    return least;
}

#endif
