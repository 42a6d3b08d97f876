/* SPDX-License-Identifier: MIT */
/* examples/frozen.h: constants that are those of set-up, no other board, and the same ticks. */
#include "ride.h"
#include "side.h"

#include "exhand/error.h"

#include "check.h"

#include <stdio.h>
#include <stdlib.h>
#include <sys/wait.h>

#define TICKS 120000

static const struct frozen {
    const struct side *side;
    struct exh_scene_board board;
} frozen[] = {{&side_90, {{1, 90}, 24}}, {&side_1000, {{1, 1000}, 24}},
    {&side_20000, {{1, 20000}, 24}}, {&side_1193_1193182, {{1193, 1193182}, 24}}};

TEST(constants_are_those_of_set_up)
{
    for (size_t k = 0; k < LEN(frozen); k++) {
        struct side_cfg want, got;
        CHECK_EQ_I64(side_live.scene->setup(frozen[k].board), 0);
        side_live.cfg(&want);
        frozen[k].side->cfg(&got);
        CHECK(memcmp(&want, &got, sizeof want) == 0, "frozen %d", (int)k);
        CHECK(side_live.points() && frozen[k].side->points(), "frozen %d", (int)k);
    }
}

TEST(another_board_is_refused)
{
    static const struct {
        struct exh_scene_board board;
        int err;
    } row[] = {{{{1, 1000}, 24}, 0}, {{{25000, 25000000}, 24}, 0}, /* the same, as a timer has it */
        {{{1, 999}, 24}, -EXH_E_RATE}, {{{1, 1001}, 24}, -EXH_E_RATE},
        {{{1193, 1193182}, 24}, -EXH_E_RATE}, {{{1, 1000000}, 24}, -EXH_E_RATE},
        {{{1u << 31, 1000u << 21}, 24}, -EXH_E_RATE}, {{{0, 1000}, 24}, -EXH_E_RATE},
        {{{1, 0}, 24}, -EXH_E_RATE}, {{{0, 0}, 24}, -EXH_E_RATE}, {{{1, 1000}, 23}, -EXH_E_RANGE},
        {{{1, 1000}, 32}, -EXH_E_RANGE}, {{{1, 1000}, 0}, -EXH_E_RANGE}};
    for (size_t k = 0; k < LEN(row); k++) {
        const int err = side_1000.scene->setup(row[k].board);
        CHECK(err == row[k].err, "row %d: %d", (int)k, err);
    }
}

static size_t state_of(const struct side *side, uint8_t *buf, size_t cap_B)
{
    struct exh_bytes c = exh_bytes_writer(buf, cap_B);
    side->state(&c);
    CHECK(exh_bytes_ok(&c), "%u bytes", (unsigned)c.at);
    return c.at;
}

/* Both sides, tick by tick; and what was there: states of the box as bits, faults, ticks with a
 * current. */
static void same_ticks(const struct frozen *f, uint32_t *states, uint32_t *faults, uint32_t *pulled)
{
    struct ride r = {.random = 1};
    struct exh_scene_in in = {.command = EXH_CMD_NONE};
    struct exh_drive_out want = {.dac_raw = {32768}}, got = want;
    uint8_t a[512], b[512];
    size_t len;
    CHECK_EQ_I64(side_live.scene->setup(f->board), 0);
    CHECK_EQ_I64(f->side->scene->setup(f->board), 0);
    for (uint32_t k = 0; k < TICKS; k++) {
        if (ride(&r, side_live.scene, &want, &in)) {
            CHECK_EQ_I64(side_live.scene->setup(f->board), 0);
            CHECK_EQ_I64(f->side->scene->setup(f->board), 0);
        }
        side_live.scene->tick(&in, &want);
        f->side->scene->tick(&in, &got);
        CHECK(memcmp(want.dac_raw, got.dac_raw, sizeof want.dac_raw) == 0 &&
                  want.enable == got.enable && want.alive == got.alive,
            "tick %" PRIu32 ": dac %d, want %d", k, got.dac_raw[0], want.dac_raw[0]);
        len = state_of(&side_live, a, sizeof a);
        CHECK(state_of(f->side, b, sizeof b) == len && memcmp(a, b, len) == 0,
            "tick %" PRIu32 ": state", k);
        *states |= 1u << side_live.scene->safety->state;
        *faults |= side_live.scene->safety->faults;
        *pulled += want.dac_raw[0] != 32768;
    }
}

TEST(ticks_are_the_same)
{
    for (size_t k = 0; k < LEN(frozen); k++) {
        uint32_t states = 0, faults = 0, pulled = 0;
        same_ticks(&frozen[k], &states, &faults, &pulled);
        CHECK_EQ_I64(states, (1 << EXH_STATES) - 1);
        CHECK_EQ_I64(faults, EXH_FAULT_ESTOP | EXH_FAULT_DEADMAN | EXH_FAULT_DRIVE |
                                 EXH_FAULT_CARD | EXH_FAULT_OVERRUN | EXH_FAULT_ENCODER |
                                 EXH_FAULT_TRACKING);
        CHECK(pulled > TICKS / 20, "%" PRIu32 " ticks with a current", pulled);
    }
}

static int status(const char *program, const char *words)
{
    char line[256];
    int s;
    (void)snprintf(line, sizeof line, "%s %s >/dev/null 2>&1", program, words);
    s = system(line);
    return WIFEXITED(s) ? WEXITSTATUS(s) : 128;
}

TEST(the_program_takes_what_it_says)
{
    static const struct {
        const char *words;
        int status;
    } row[] = {{"--help", 0}, {"1000 24", 0}, {"25000/25000000 32", 0}, {"", 2}, {"1000", 2},
        {"0 24", 2}, {"20030 24", 2}, {"2/1 24", 2}, {"1/ 24", 2}, {"1000x 24", 2},
        {"4294967297 24", 2}, {"1000 15", 2}, {"1000 33", 2}, {"1000 -1", 2}, {"1000 24 1", 2},
        {"1 16", 1}}; /* at 1 Hz 10 m/s exceed 16 bits */
    for (size_t k = 0; k < LEN(row); k++) {
        const int is = status(FREEZE, row[k].words);
        CHECK(is == row[k].status, "freeze %s: %d, want %d", row[k].words, is, row[k].status);
    }
}

TEST(a_field_that_is_not_written_down_is_refused)
{
    CHECK_EQ_I64(status(FREEZE_PLANTED, "1000 24"), 1);
}

TEST_MAIN("frozen", constants_are_those_of_set_up, another_board_is_refused, ticks_are_the_same,
    the_program_takes_what_it_says, a_field_that_is_not_written_down_is_refused);
