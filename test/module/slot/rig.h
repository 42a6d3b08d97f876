/* SPDX-License-Identifier: MIT */
/* Scene custom with the model that this binary was linked with, in closed loop with the simulated
 * device. */
#ifndef TEST_SLOT_RIG_H
#define TEST_SLOT_RIG_H

#include "closed/sim/logs.h"

#include "box/table2.h"
#include "posix.h"

#include "custom/custom.h"

/* Two falls at the paper's gains of that rate but for k and b, if these are not below 0. */
static inline struct run_cfg rig(double rate_Hz, double k, double b)
{
    const struct table2_row *g = table2_gains(rate_Hz);
    struct run_cfg c;
    memset(&c, 0, sizeof c);
    c.scene = &exh_scene_custom;
    c.rate_Hz = (uint32_t)rate_Hz;
    c.k_Npm = k < 0 ? g->k_Npm : k;
    c.b_Nspm = b < 0 ? g->b_Nspm : b;
    c.board = posix_config_default();
    c.board.falls = 2;
    return c;
}

static inline const struct custom_signals *rig_signals(void)
{
    return (const struct custom_signals *)(const void *)exh_scene_signals(&exh_scene_custom);
}

/* A run whose log replays: from the beginning, and from a keyframe, where the controller's memory
 * is another. */
static inline void rig_replays(struct run_cfg c)
{
    struct table2_result r;
    const char *path = log_path();
    c.board.log = fopen(path, "wb");
    CHECK(c.board.log != NULL, "%s", path);
    r = table2_measure(&c, NULL, TABLE2_SAME);
    CHECK(r.done && !r.error && r.faults == 0, "faults %x", r.faults);
    CHECK_EQ_I64(fclose(c.board.log), 0);
    CHECK_EQ_I64(replay(path, NULL), 0);
    CHECK_EQ_I64(replay(path, "1500"), 0);
    CHECK_EQ_I64(remove(path), 0);
}

#endif
