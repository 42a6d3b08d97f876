/* SPDX-License-Identifier: MIT */
/* A session of exhand identify, and its data. */
#ifndef TEST_SIM_IDENTIFY_RIG_H
#define TEST_SIM_IDENTIFY_RIG_H

#include "identify/session.h"

#include "check.h"

static struct identify_data data;

static struct identify_session session(uint64_t seed)
{
    struct identify_session c;
    memset(&c, 0, sizeof c);
    c.rate_Hz = 2000;
    c.mass_kg = 0.5;
    c.repeats = 2;
    c.board = posix_config_default();
    c.board.seed = seed;
    return c;
}

static void run(const struct identify_session *c)
{
    identify_data_free(&data);
    CHECK_EQ_I64(identify_session(c, &data), 0);
}

#endif
