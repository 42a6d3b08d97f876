/* SPDX-License-Identifier: MIT */
/* Inputs that take scene minimal through all its states. In each round the box arms with the string
 * at rest, runs, and goes through the wall and back. Then one event happens, a different one in
 * each round. The round ends when the switch was let go or a fault is latched. */
#ifndef TEST_FROZEN_RIDE_H
#define TEST_FROZEN_RIDE_H

#include "exhand/run/scene.h"

#include "exhand/safety.h"

#define RIDE_TICKS 3000u /* of a round while it runs */
#define RIDE_AFTER 500u  /* and after what happens */
#define RIDE_CNT   480u  /* 32 mm of string; the wall is at 20 */

enum ride_event {
    RIDE_ESTOP,
    RIDE_DEADMAN,
    RIDE_DRIVE,
    RIDE_CARDS,
    RIDE_MISSED,
    RIDE_JUMP,
    RIDE_MONITOR,
    RIDE_OFF,
    RIDE_EVENTS
};

struct ride {
    uint32_t round, at, ran, after, random; /* at power-on: 0, and random not 0 */
};

static inline uint32_t ride_random(struct ride *r)
{
    r->random ^= r->random << 13;
    r->random ^= r->random >> 17;
    r->random ^= r->random << 5;
    return r->random;
}

static inline void ride_event(const struct ride *r, struct exh_scene_in *in)
{
    switch (r->round % RIDE_EVENTS) {
    case RIDE_ESTOP: in->drive.din &= ~(uint32_t)EXH_DIN_ESTOP; break;
    case RIDE_DEADMAN: in->drive.din &= ~(uint32_t)EXH_DIN_DEADMAN; break;
    case RIDE_DRIVE: in->drive.din &= ~(uint32_t)EXH_DIN_DRIVE0; break;
    case RIDE_CARDS: in->drive.din &= ~(uint32_t)EXH_DIN_CARDS; break;
    case RIDE_MISSED: in->missed = 3; break;
    case RIDE_JUMP: in->drive.enc_raw[0] += 1u << 22; break;
    case RIDE_MONITOR: in->drive.mon_raw[0] = 9000; break;
    default: in->command = EXH_CMD_OFF; break;
    }
}

/* The inputs of the next tick, from the outputs of the last. 1: a new round begins with it, set the
 * scene up. */
static inline int ride(struct ride *r, const struct exh_scene *sc, const struct exh_drive_out *out,
    struct exh_scene_in *in)
{
    const uint32_t at = r->ran % (2 * RIDE_CNT), along = at < RIDE_CNT ? at : 2 * RIDE_CNT - at;
    const int codes = out->dac_raw[0] - 32768;
    const int anew = r->after > RIDE_AFTER;
    if (anew) { r->at = r->ran = r->after = 0, r->round++; }
    in->drive.din = EXH_DIN_ESTOP | EXH_DIN_WATCHDOG | EXH_DIN_CARDS | EXH_DIN_DRIVE0;
    if (r->at >= 5) { in->drive.din |= EXH_DIN_DEADMAN; }
    in->drive.enc_raw[0] = (anew ? 0 : along) + (r->ran ? ride_random(r) & 1u : 0u);
    in->drive.mon_raw[0] = (int16_t)(codes + codes / 16 + (int)(ride_random(r) % 31u) -
                                     15); /* 1.06 for the drive's 1.05 */
    in->missed = r->ran % 1000 == 999;
    in->command = EXH_CMD_NONE;
    if (r->ran == 0 && r->at >= 5 && sc->safety->state == EXH_STATE_OFF) {
        in->command = EXH_CMD_RUN;
    }
    r->at++;
    if (r->ran > 0 || exh_safety_is_running(sc->safety)) { r->ran++; }
    if (r->ran > RIDE_TICKS) {
        if (r->after < RIDE_AFTER - 20) { ride_event(r, in); }
        if (r->after == RIDE_AFTER - 10) { in->drive.din &= ~(uint32_t)EXH_DIN_DEADMAN; }
        if (r->after == RIDE_AFTER - 5) { in->command = EXH_CMD_CLEAR; }
        r->after++;
    }
    return anew;
}

#endif
