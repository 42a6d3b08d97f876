/* SPDX-License-Identifier: MIT */
/* Integer code that is not ours: idsp's recurrences, bare laws and velocities. */
#include "bare.h"
#include "idsp_twin.h"
#include "soft.h"

/* --- idsp: fc/fs = 0.01, as peers_idsp.c sets them up --- */

static void twins_start(void)
{
    static const int32_t ba[5] = {1014355, 2028711, 1014355, 2052132225, -982447822};
    static const int32_t k[2] = {4057421, -186645425};
    twin_df1_start(ba);
    twin_dither_start(ba);
    twin_lowpass_start(k);
}

static void df1_op(uint32_t i) { twin_df1_tick(&soft_x[i], soft_y); }
static void dither_op(uint32_t i) { twin_dither_tick(&soft_x[i], soft_y); }
static void lowpass_op(uint32_t i) { twin_lowpass_tick(&soft_x[i], soft_y); }

static const struct soft_op twins[] = {
    {"filter,idsp DF1", df1_op},
    {"filter,idsp DF1Dither", dither_op},
    {"filter,idsp Lowpass<2>", lowpass_op},
};
const struct soft_group soft_twins = {twins, sizeof twins / sizeof twins[0], twins_start};

/* --- bare --- */

static struct bare_law wall;
static struct bare_pole difference, pole;
static struct bare_track track;

static void bare_start(void)
{
    const struct bare_scale scale = {569684462, 5}; /* 66.3 um at 2 kHz */
    wall = (struct bare_law){2045184, 6471680, 0, 0, 100 << 20};
    difference = (struct bare_pole){scale, 0, 0, 0};
    pole = (struct bare_pole){scale, 2, 0, 0};
    track = (struct bare_track){scale, 408021893, 21474836, 0, 0};
}

static void law_op(uint32_t i)
{
    for (uint32_t f = 0; f < FINGERS; f++) {
        soft_sink = bare_law(&wall, soft_x[i + f] >> 6, soft_x[i + f + 1] >> 4);
    }
}

static int32_t cnt(uint32_t i) { return soft_x[i] >> 20; }
static void difference_op(uint32_t i) { soft_sink = bare_pole(&difference, cnt(i)); }
static void pole_op(uint32_t i) { soft_sink = bare_pole(&pole, cnt(i)); }
static void track_op(uint32_t i) { soft_sink = bare_track(&track, cnt(i)); }

static const struct soft_op bare[] = {
    {"law,bare integer law", law_op},
    {"velocity,bare difference", difference_op},
    {"velocity,bare pole", pole_op},
    {"velocity,bare track", track_op},
};
const struct soft_group soft_bare = {bare, sizeof bare / sizeof bare[0], bare_start};
