/* SPDX-License-Identifier: MIT */
/* Ticks by the wall clock, over a clock of the test's own. */
#include "check.h"

#include <errno.h>
#include <signal.h>
#include <time.h>

static int own_gettime(clockid_t which, struct timespec *t);
static int own_nanosleep(
    clockid_t which, int flags, const struct timespec *t, struct timespec *left);
#define clock_gettime   own_gettime
#define clock_nanosleep own_nanosleep
#define pace_start      own_pace_start
#define pace_wait       own_pace_wait
#include "pace.c"
#undef clock_gettime
#undef clock_nanosleep

static struct {
    int64_t now_ns, due_ns; /* due: what was slept for last */
    int64_t late_ns;        /* it wakes so much later */
    int interrupts;         /* before it does */
    volatile sig_atomic_t end;
} own;

static int own_gettime(clockid_t which, struct timespec *t)
{
    CHECK_EQ_I64(which, CLOCK_MONOTONIC);
    *t = (struct timespec){(time_t)(own.now_ns / 1000000000), (long)(own.now_ns % 1000000000)};
    return 0;
}

static int own_nanosleep(
    clockid_t which, int flags, const struct timespec *t, struct timespec *left)
{
    CHECK(which == CLOCK_MONOTONIC && flags == TIMER_ABSTIME && left == NULL, "another clock");
    CHECK(t->tv_nsec >= 0 && t->tv_nsec < 1000000000, "%ld ns", (long)t->tv_nsec);
    own.due_ns = (int64_t)t->tv_sec * 1000000000 + t->tv_nsec;
    if (own.interrupts > 0) {
        if (--own.interrupts == 0) { own.end = 1; }
        return EINTR;
    }
    if (own.now_ns < own.due_ns) { own.now_ns = own.due_ns; }
    own.now_ns += own.late_ns;
    return 0;
}

/* From a clock that is about to begin another second. */
static void begin(uint32_t num, uint32_t den, double slack_s)
{
    memset(&own, 0, sizeof own);
    own.now_ns = INT64_C(77999999999);
    pace_start((struct exh_period){num, den}, slack_s);
    CHECK_EQ_I64(pace_wait(0, &own.end), 0);
}

TEST(ticks_are_due_at_their_time)
{
    static const struct exh_period T[] = {
        {1, 1}, {1, 90}, {1, 2000}, {597, 1193182}, {1, 20000}, {1, 4294967295u}};
    for (size_t i = 0; i < sizeof T / sizeof T[0]; i++) {
        begin(T[i].num, T[i].den, 0);
        for (uint64_t n = 1; n < 3000000000u; n = n * 7 + 1) {
            CHECK_EQ_I64(pace_wait(n, &own.end), 0);
            CHECK_EQ_I64(own.due_ns - INT64_C(77999999999),
                (int64_t)(n * T[i].num / T[i].den * 1000000000 +
                          n * T[i].num % T[i].den * 1000000000 / T[i].den));
        }
    }
}

/* A whole period late is one missed, a nanosecond less is none: as a timer's count of a board. */
TEST(what_went_by_is_missed)
{
    static const struct {
        int64_t late_ns;
        uint32_t missed;
    } row[] = {{0, 0}, {999999, 0}, {1000000, 1}, {1999999, 1}, {2000000, 2},
        {INT64_C(3600000000000), 3600000}};
    for (size_t i = 0; i < sizeof row / sizeof row[0]; i++) {
        begin(1, 1000, 0);
        CHECK_EQ_I64(pace_wait(1, &own.end), 0);
        own.late_ns = row[i].late_ns;
        CHECK_EQ_I64(pace_wait(2, &own.end), row[i].missed);
        own.late_ns = 0;
        CHECK_EQ_I64(pace_wait(3 + row[i].missed, &own.end), 0);
        own.now_ns += row[i].late_ns; /* the tick itself took so long */
        CHECK_EQ_I64(pace_wait(4 + row[i].missed, &own.end),
            row[i].late_ns ? (uint32_t)((row[i].late_ns - 1000000) / 1000000) : 0);
    }
}

/* An age of nights stays a number that a board may return. */
TEST(a_very_long_stop)
{
    begin(1, 20000, 0);
    own.late_ns = INT64_C(86400000000000) * 365;
    CHECK_EQ_I64(pace_wait(1, &own.end), INT_MAX / 2);
}

/* Within the slack it is made up for, tick by tick; beyond, all of it is missed. */
TEST(slack)
{
    begin(1, 1000, 0.1);
    own.now_ns += 100 * 1000000;
    for (uint64_t n = 1; n <= 200; n++) { CHECK_EQ_I64(pace_wait(n, &own.end), 0); }
    CHECK_EQ_I64(own.now_ns, INT64_C(77999999999) + 200 * 1000000);
    own.now_ns += 102 * 1000000;
    CHECK_EQ_I64(pace_wait(201, &own.end), 101);
}

TEST(signals)
{
    begin(1, 1, 0);
    own.interrupts = 3;
    CHECK_EQ_I64(pace_wait(1, &own.end), 0);
    CHECK(own.end == 1 && own.now_ns == INT64_C(77999999999), "it did not come back");
}

TEST_MAIN(
    "pace", ticks_are_due_at_their_time, what_went_by_is_missed, a_very_long_stop, slack, signals);
