/* SPDX-License-Identifier: MIT */
/* Fails on purpose: current on, and then a function that calls itself until the stack is full. */
#include "exhand/board.h"
#include "exhand/error.h"

void exh_assert_failed(const char *file, int line)
{
    (void)line;
    exh_board_halt(file);
}

static unsigned deeper(volatile unsigned *above)
{
    volatile unsigned here[16];
    here[0] = *above + 1;
    return here[0] ? deeper(here) + here[0] : 0; /* it wraps long after the stack is full */
}

int main(void)
{
    const struct exh_drive_out out = {{32768 + 923, 32768, 32768, 32768, 32768}, 1, 0};
    volatile unsigned zero = 0;
    struct exh_period T;
    if (exh_board_init(1000, &T) < 0 || exh_board_wait() < 0) { exh_board_halt("not set up"); }
    (void)exh_board_write_drive(&out);
    (void)deeper(&zero);
    exh_board_halt("done"); /* which it must not come to */
    return 0;
}
