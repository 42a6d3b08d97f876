/* SPDX-License-Identifier: MIT */
/* The bare-metal image finds the longest gap between two reads of its counter. */
#include "check.h"

#include "../../../ports/pc104/gap.c"

/* Seven counts a read, and whatever firmware takes at the reads named. */
static uint32_t counter, reads, often;

static uint32_t now(void)
{
    counter += ++reads == 1000 ? 5000 : reads == 2000 ? 431 : reads == 3000 ? 430 : 7;
    often += counter < 7; /* it went round */
    return counter;
}

static struct pc104_gap look(uint32_t from, uint64_t counts)
{
    counter = from;
    reads = often = 0;
    return pc104_gap_look(now, counts, 430);
}

TEST(the_longest_gap_and_those_that_are_too_long)
{
    struct pc104_gap g = look(0, 100000);
    CHECK_EQ_I64(g.longest, 5000);
    CHECK_EQ_I64(g.beyond, 2);
    g = look(0, 6000);
    CHECK_EQ_I64(g.longest, 7);
    CHECK_EQ_I64(g.beyond, 0);
}

TEST(a_counter_goes_round)
{
    struct pc104_gap g = look(UINT32_MAX - 20000, 100000);
    CHECK_EQ_I64(g.longest, 5000);
    CHECK(reads > 13000 && often >= 1, "%u reads", reads);
}

TEST_MAIN("pc104_gap", the_longest_gap_and_those_that_are_too_long, a_counter_goes_round);
