/* SPDX-License-Identifier: MIT */
/* gpio_v1.c and all above it. */
#define GPIO_LIBRARY "libgpiod 1"
#include "lines.h"

/* A kernel that knows no bias gives the lines without. */
TEST(kernel_without_bias)
{
    chip_reset();
    chip.no_bias = 1;
    CHECK_EQ_I64(opened(ALL), 0);
    CHECK(chip.line[ESTOP].held && !chip.line[ESTOP].pulled_down, "with bias");
    gpio_close();
    chip.line[ESTOP].holder = "thief";
    CHECK_EQ_I64(opened(ALL), -1);
    CHECK(strstr(said, "held by \"thief\"") != NULL, "%s", said);
}

TEST_MAIN("gpio-v1", LINES_TESTS, kernel_without_bias);
