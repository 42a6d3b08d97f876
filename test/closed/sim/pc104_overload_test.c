/* SPDX-License-Identifier: MIT */
/* The bare-metal image halts for a burst of late ticks, and not for one a minute all day. */
#include "check.h"

#include "../../../ports/pc104/overload.c"

#define RATE_HZ 500u
#define DAY_S   86400u

static struct pc104_overload fresh(void)
{
    return (struct pc104_overload){.most = 100, .leak_ticks = 10 * RATE_HZ};
}

/* Ticks until it halts when every `apart`th is late; 0: not within a day. */
static uint32_t halts_after(uint32_t apart)
{
    struct pc104_overload o = fresh();
    for (uint32_t tick = 1; tick <= DAY_S * RATE_HZ; tick++) {
        if (pc104_overload_step(&o, 1, tick % apart == 0)) { return tick; }
    }
    return 0;
}

TEST(one_a_minute_for_a_day_is_no_overload)
{
    CHECK_EQ_I64(halts_after(60 * RATE_HZ), 0);
    CHECK_EQ_I64(halts_after(10 * RATE_HZ), 0);
}

/* 101 together. One a second: nine of ten stay. */
TEST(a_burst_and_too_many_for_long_are)
{
    struct pc104_overload o = fresh();
    CHECK_EQ_I64(halts_after(1), 101);
    CHECK_EQ_I64(halts_after(RATE_HZ), 112 * RATE_HZ);
    CHECK_EQ_I64(pc104_overload_step(&o, 1, 100), 0);
    CHECK_EQ_I64(pc104_overload_step(&o, 1, 1), 1);
    CHECK_EQ_I64(pc104_overload_step(&o, 1, UINT32_MAX), 1);
    o = (struct pc104_overload){.most = 0, .leak_ticks = 20};
    CHECK_EQ_I64(pc104_overload_step(&o, 1, 1), 1);
}

/* Ticks that were missed are time that passed, however many: but one is forgotten in a call. */
TEST(missed_ticks_are_time)
{
    struct pc104_overload o = fresh();
    CHECK_EQ_I64(pc104_overload_step(&o, 1, 100), 0);
    CHECK_EQ_I64(pc104_overload_step(&o, 10 * RATE_HZ, 1), 0);
    CHECK_EQ_I64(pc104_overload_step(&o, UINT32_MAX, 1), 0);
    CHECK_EQ_I64(pc104_overload_step(&o, 1, 1), 1);
}

TEST_MAIN("pc104_overload", one_a_minute_for_a_day_is_no_overload,
    a_burst_and_too_many_for_long_are, missed_ticks_are_time);
