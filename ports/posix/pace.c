/* SPDX-License-Identifier: MIT */
#include "pace.h"

#include <errno.h>
#include <limits.h>
#include <time.h>

#define NS_PER_S 1000000000u

static struct {
    struct exh_period T;
    double slack_s;
    struct timespec from;
} clock_is;

void pace_start(struct exh_period T, double slack_s)
{
    clock_is.T = T;
    clock_is.slack_s = slack_s;
}

/* Time from tick 0 on; den < 2^32 and a second's nanoseconds < 2^30: no product overflows. */
static struct timespec due(uint64_t tick)
{
    const uint64_t num = tick * clock_is.T.num, den = clock_is.T.den;
    const uint64_t ns = num % den * NS_PER_S / den + (uint64_t)clock_is.from.tv_nsec;
    return (struct timespec){
        clock_is.from.tv_sec + (time_t)(num / den + ns / NS_PER_S), (long)(ns % NS_PER_S)};
}

/* The last tick that is due now. */
static uint64_t newest(void)
{
    struct timespec now;
    int64_t s, ns;
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    s = (int64_t)now.tv_sec - (int64_t)clock_is.from.tv_sec;
    ns = (int64_t)now.tv_nsec - (int64_t)clock_is.from.tv_nsec;
    if (ns < 0) {
        s--;
        ns += NS_PER_S;
    }
    return ((uint64_t)s * clock_is.T.den + (uint64_t)ns * clock_is.T.den / NS_PER_S) /
           clock_is.T.num;
}

uint32_t pace_wait(uint64_t tick, const volatile sig_atomic_t *end)
{
    struct timespec at;
    uint64_t last, late;
    if (tick == 0) {
        (void)clock_gettime(CLOCK_MONOTONIC, &clock_is.from);
    } /* set-up misses none */
    at = due(tick);
    while (!*end && clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &at, NULL) == EINTR) {}
    last = newest();
    late = last > tick ? last - tick : 0;
    if ((double)late * clock_is.T.num <= clock_is.slack_s * clock_is.T.den) { return 0; }
    return late < INT_MAX / 2 ? (uint32_t)late : INT_MAX / 2;
}
