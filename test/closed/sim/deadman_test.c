/* SPDX-License-Identifier: MIT */
/* lib/src/run/deadman.c: which grip gives which command, and what is none. */
#include "check.h"

#include "exhand/run/deadman.h"

#define HELD EXH_DIN_DEADMAN

static struct exh_safety safety;
static const struct exh_scene scene = {.name = "none", .safety = &safety};
static const struct exh_scene blind = {.name = "none"};

static void start(const struct exh_scene *sc, uint32_t rate_Hz, uint8_t state)
{
    safety = (struct exh_safety){.state = state};
    exh_deadman_start(sc, (struct exh_scene_board){{1, rate_Hz}, 24});
}

static uint8_t tick(uint32_t din)
{
    struct exh_scene_in in = {.command = EXH_CMD_NONE};
    in.drive.din = din;
    exh_deadman_before(0, &in);
    return in.command;
}

/* So many ticks; the only command that came in them, in *at, or NONE. */
static uint8_t ticks(uint32_t din, unsigned n, unsigned *at)
{
    uint8_t command = EXH_CMD_NONE;
    for (unsigned i = 1; i <= n; i++) {
        const uint8_t now = tick(din);
        if (now == EXH_CMD_NONE) { continue; }
        CHECK(command == EXH_CMD_NONE, "tick %u: another command", i);
        command = now;
        *at = i;
    }
    return command;
}

/* 50 ms and a tick after it closed: once, however long it is held. */
TEST(a_grip_gives_one_command)
{
    static const struct {
        uint32_t rate_Hz;
        unsigned settle;
    } row[] = {{1, 1}, {20, 2}, {90, 5}, {1000, 51}, {2000, 101}, {20000, 1001}};
    for (size_t i = 0; i < LEN(row); i++) {
        unsigned at = 0;
        start(&scene, row[i].rate_Hz, EXH_STATE_OFF);
        CHECK_EQ_I64(ticks(0, 2 * row[i].settle, &at), EXH_CMD_NONE);
        CHECK_EQ_I64(ticks(HELD, 5 * row[i].settle, &at), EXH_CMD_RUN);
        CHECK_EQ_I64(at, row[i].settle);
    }
}

TEST(the_state_says_which)
{
    static const struct {
        uint8_t state, want;
    } row[] = {{EXH_STATE_OFF, EXH_CMD_RUN}, {EXH_STATE_FAULT, EXH_CMD_CLEAR},
        {EXH_STATE_RUN, EXH_CMD_NONE}};
    for (size_t i = 0; i < LEN(row); i++) {
        unsigned at = 0;
        start(&scene, 1000, row[i].state);
        (void)ticks(0, 60, &at);
        CHECK(ticks(HELD, 200, &at) == row[i].want, "state %u", row[i].state);
    }
    start(&blind, 1000, EXH_STATE_FAULT); /* the state is unknown */
    CHECK_EQ_I64(ticks(0, 60, &(unsigned){0}), EXH_CMD_NONE);
    CHECK_EQ_I64(ticks(HELD, 200, &(unsigned){0}), EXH_CMD_RUN);
}

/* The second grip is another one: let go for as long as it takes to be one. */
TEST(after_a_fault_it_takes_two_grips)
{
    unsigned at = 0;
    start(&scene, 1000, EXH_STATE_FAULT);
    (void)ticks(0, 60, &at);
    CHECK_EQ_I64(ticks(HELD, 60, &at), EXH_CMD_CLEAR);
    safety.state = EXH_STATE_OFF;
    CHECK_EQ_I64(ticks(HELD, 5000, &at), EXH_CMD_NONE);
    CHECK_EQ_I64(ticks(0, 50, &at), EXH_CMD_NONE); /* a tick too short */
    CHECK_EQ_I64(ticks(HELD, 500, &at), EXH_CMD_NONE);
    CHECK_EQ_I64(ticks(0, 51, &at), EXH_CMD_NONE);
    CHECK_EQ_I64(ticks(HELD, 500, &at), EXH_CMD_RUN);
}

TEST(held_at_power_on_is_no_grip)
{
    unsigned at = 0;
    start(&scene, 1000, EXH_STATE_OFF);
    CHECK_EQ_I64(ticks(HELD, 5000, &at), EXH_CMD_NONE);
    CHECK_EQ_I64(ticks(0, 51, &at), EXH_CMD_NONE);
    CHECK_EQ_I64(ticks(HELD, 500, &at), EXH_CMD_RUN);
}

/* Contacts that bounce: the grip begins when they have stopped. */
TEST(a_contact_that_bounces_is_no_hand_yet)
{
    unsigned at = 0;
    start(&scene, 1000, EXH_STATE_OFF);
    (void)ticks(0, 60, &at);
    for (int i = 0; i < 100; i++) {
        CHECK_EQ_I64(ticks(HELD, 50, &at), EXH_CMD_NONE);
        CHECK_EQ_I64(ticks(0, 1, &at), EXH_CMD_NONE);
    }
    CHECK_EQ_I64(ticks(HELD, 60, &at), EXH_CMD_RUN);
    CHECK_EQ_I64(at, 51);
}

TEST_MAIN("deadman", a_grip_gives_one_command, the_state_says_which,
    after_a_fault_it_takes_two_grips, held_at_power_on_is_no_grip,
    a_contact_that_bounces_is_no_hand_yet);
