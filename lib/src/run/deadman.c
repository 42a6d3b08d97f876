/* SPDX-License-Identifier: MIT */
/* Commands from the dead-man switch: run, clear, off. */
#include "exhand/run/deadman.h"

#include "exhand/fix.h"
#include "exhand/safety.h"

static const struct exh_safety *safety;
static uint32_t settle; /* ticks in 50 ms, against contact bounce and glitches */
static uint32_t open_for, closed_for;
static int armed; /* 1: it was open long enough */

void exh_deadman_start(const struct exh_scene *sc, struct exh_scene_board board)
{
    safety = sc->safety;
    settle = (uint32_t)exh_udiv64(board.T.den, UINT64_C(20) * board.T.num, NULL) + 1;
    open_for = closed_for = 0;
    armed = 0;
}

/* The command for closing the switch, by the state of the device. */
static uint8_t wanted(void)
{
    const uint8_t state = safety ? safety->state : (uint8_t)EXH_STATE_OFF;
    return (uint8_t)(state == EXH_STATE_FAULT ? EXH_CMD_CLEAR
                     : state == EXH_STATE_OFF ? EXH_CMD_RUN
                                              : EXH_CMD_NONE);
}

void exh_deadman_before(uint32_t tick, struct exh_scene_in *in)
{
    const int held = (in->drive.din & EXH_DIN_DEADMAN) != 0;
    (void)tick;
    open_for = held ? 0 : open_for + (open_for < settle);
    closed_for = held ? closed_for + (closed_for < settle) : 0;
    if (open_for == settle) { armed = 1; }
    if (armed && closed_for == settle) {
        in->command = wanted();
        armed = 0;
    }
}
