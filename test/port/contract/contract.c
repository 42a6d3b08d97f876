/* SPDX-License-Identifier: MIT */
/* The scene that the ports name for the contract test. Its tick commands no current. */
#include "exhand/run/scene.h"

static void tick(const struct exh_scene_in *in, struct exh_drive_out *out)
{
    (void)in;
    *out = (struct exh_drive_out){.dac_raw = {32768, 32768, 32768, 32768, 32768}};
}

extern const struct exh_scene EXH_SCENE;
const struct exh_scene EXH_SCENE = {
    .name = "contract", .rate_Hz = CONTRACT_RATE_HZ, .fingers = EXH_FINGERS, .tick = tick};
