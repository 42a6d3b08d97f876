/* SPDX-License-Identifier: MIT */
/* A hand in the full box at a wall, and what it felt: for the tests of the bilateral experiment. */
#ifndef TEST_SIM_FELT_H
#define TEST_SIM_FELT_H

#include "check.h"

#include "box/hand.h"

#include <string.h>

static inline struct bilateral_run_cfg plain(unsigned fingers, double mps, int approaches)
{
    static const struct run_setting f_max = {"mat_f_max", 40};
    struct bilateral_run_cfg c;
    memset(&c, 0, sizeof c);
    c.rate_Hz = 2000;
    c.board = posix_config_default();
    c.board.exo = sim_exo_default();
    c.board.exo.fingers = fingers;
    c.setting = &f_max;
    c.settings = 1;
    c.k_Npm = 20000;
    c.b_Nspm = 60;
    c.at_m = 0.03;
    c.fps = 400;
    c.until_s = 1e30;
    c.keep = 1;
    for (unsigned f = 0; f < BILATERAL_FINGERS; f++) {
        c.board.exo.path[f].speed_mps = mps;
        c.board.exo.path[f].approaches = approaches;
    }
    return c;
}

static inline struct bilateral_run run(const struct bilateral_run_cfg *c)
{
    struct bilateral_run r;
    CHECK_EQ_I64(bilateral_run(c, &r), 0);
    CHECK_EQ_I64(r.faults, 0);
    for (unsigned f = 0; f < BILATERAL_FINGERS; f++) {
        CHECK(r.finger[f].unfrozen == 0, "finger %u: %ld ticks of contact before its freeze", f,
            r.finger[f].unfrozen);
    }
    return r;
}

/* The first freeze of a finger, as a sample. */
static inline size_t freeze_of(const struct bilateral_track *t)
{
    for (size_t i = 0; i < t->n; i++) {
        if (t->at[i].bits & EXH_PRECONTACT_FREEZE) { return i; }
    }
    CHECK(0, "no freeze");
    return 0;
}

static inline size_t contact_of(const struct bilateral_track *t)
{
    for (size_t i = 0; i < t->n; i++) {
        if (t->at[i].raw.c) { return i; }
    }
    CHECK(0, "no contact");
    return 0;
}

static inline int same_felt(const struct bilateral_paper *a, const struct bilateral_paper *b)
{
    return a->q_m_q30 == b->q_m_q30 && a->qd_mps_q27 == b->qd_mps_q27 &&
           a->f_des_N_q20 == b->f_des_N_q20 && a->i_des_A_q26 == b->i_des_A_q26 && a->c == b->c &&
           a->f_mon_N_q20 == b->f_mon_N_q20;
}

#endif
