/* SPDX-License-Identifier: MIT */
/* gpio_v2.c and all above it. */
#define GPIO_LIBRARY "libgpiod 2"
#include "lines.h"

extern int fake_objects; /* objects of the library that are not freed */

TEST(everything_is_freed)
{
    CHECK_EQ_I64(fake_objects, 0);
    chip_reset();
    CHECK_EQ_I64(opened(ALL), 0);
    CHECK_EQ_I64(fake_objects, 2);
    gpio_close();
    CHECK_EQ_I64(fake_objects, 0);
}

TEST_MAIN("gpio-v2", LINES_TESTS, everything_is_freed);
