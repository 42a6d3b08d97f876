/* SPDX-License-Identifier: MIT */
/* A scene that is too slow on purpose. Every SLOW_EVERY-th tick computes past two instants of the
 * timer. So one tick is missed, and the next begins late. The port must count exactly these. */
#include "exhand/run/scene.h"

#define SLOW_EVERY 100u
#define SLOW_US    1250u                 /* of 1.25 ns an instruction */
#define SLOW_TURNS (SLOW_US * 800u / 6u) /* six instructions each */

static uint32_t ticks, sum;

static int setup(struct exh_scene_board board)
{
    (void)board;
    ticks = 0;
    return 0;
}

static void tick(const struct exh_scene_in *in, struct exh_drive_out *out)
{
    static const struct exh_drive_out none = {.dac_raw = {32768, 32768, 32768, 32768, 32768}};
    volatile uint32_t n = ticks++ % SLOW_EVERY == SLOW_EVERY - 1 ? SLOW_TURNS : 1;
    *out = none;
    while (n > 0) { n--; }
    sum += in->drive.din;
}

const struct exh_scene exh_scene_slow = {
    .name = "slow", .rate_Hz = 2000, .fingers = 1, .setup = setup, .tick = tick};
