/* SPDX-License-Identifier: MIT */
/* What must happen, said once more: written from docs/SAFETY.md and the drives' needs, not from the
 * library's table. */
#include "lab/faults/faults.h"

#include <stddef.h>

#define ALL 0xFFu

/* ticks and ms: it is seen no later than that many ticks and milliseconds after the first tick that
 * could. */
static const struct faults_spec spec[FAULTS_SOURCES] = {
    [FAULTS_NOTHING] = {"nothing", "", 0, 0, 0, 0, 0, 0, 0},
    [FAULTS_ESTOP] = {"e-stop", "contact opens", EXH_FAULT_ESTOP, 1, ALL, 0, 0, 0, 0},
    [FAULTS_DEADMAN] = {"dead-man", "contact opens", EXH_FAULT_DEADMAN, 0, ALL, 0, 0, 0, 0},
    [FAULTS_DRIVE] = {"drive", "ready contact opens", EXH_FAULT_DRIVE, 1, ALL, 0, 0, 0, 0},
    [FAULTS_LATE] = {"overrun", "one tick misses three", EXH_FAULT_OVERRUN, 0, ALL, 0, 0, 0, 0},
    [FAULTS_SLOW] = {"overrun", "every tick takes 1.5 periods", EXH_FAULT_OVERRUN, 0, ALL, 3, 0, 0,
        0},
    [FAULTS_JUMP] = {"encoder", "jumps", EXH_FAULT_ENCODER, 0, ALL, 0, 0, 0, 0},
    [FAULTS_STILL] = {"encoder", "is stuck", EXH_FAULT_STUCK, 0,
        1u << FAULTS_IN_RUN | 1u << FAULTS_IN_LIMIT | 1u << FAULTS_IN_RELEASE, 2, 1000, 1, 0},
    [FAULTS_MONITOR] = {"current", "monitor is off by 1 A", EXH_FAULT_TRACKING, 1, ALL, 5, 20, 1,
        0},
    [FAULTS_DA] = {"current", "D/A is stuck: seen once the code moves on", EXH_FAULT_TRACKING, 1,
        1u << FAULTS_IN_RUN, 8, 800, 1, 0},
    [FAULTS_SPEED] = {"speed", "string runs at 6 m/s", EXH_FAULT_SPEED, 0, ALL, 18, 20, 1, 0},
    [FAULTS_GLOVE] = {"glove", "a wire breaks", EXH_FAULT_GLOVE, 0, ALL, 8, 170, 0, 0},
    [FAULTS_GLOVE_OLD] = {"glove", "no frame comes", EXH_FAULT_GLOVE, 0, ALL, 8, 170, 0, 0},
    [FAULTS_CARD] = {"card", "does not answer", EXH_FAULT_CARD, 1, ALL, 1, 0, 0, 0},
    [FAULTS_LINK] = {"link", "nothing comes", EXH_FAULT_LINK, 0, ALL, 8, 200, 0, 0},
    [FAULTS_SUPPLY_LOW] = {"supply", "falls to half", EXH_FAULT_SUPPLY, 0, ALL, 8, 20, 0, 0},
    [FAULTS_SUPPLY_HIGH] = {"supply", "rises by half", EXH_FAULT_SUPPLY, 0, ALL, 8, 20, 0, 0},
    [FAULTS_WATCHDOG] = {"watchdog", "contact reports that it fired", EXH_FAULT_WATCHDOG, 1, ALL, 0,
        0, 0, 0},
    [FAULTS_DEAD_LOOP] = {"watchdog", "no tick comes for 16 periods", EXH_FAULT_WATCHDOG, 1, ALL, 0,
        0, 0, EXH_FAULT_OVERRUN},
    [FAULTS_PAR] = {"memory", "a bit of a parameter flips", EXH_FAULT_CONFIG, 1, ALL, 0, 0, 0, 0},
    [FAULTS_CAL] = {"memory", "a bit of a calibration flips", EXH_FAULT_CONFIG, 1, ALL, 0, 0, 0, 0},
    [FAULTS_STATE] = {"memory", "the state is invalid", EXH_FAULT_LOGIC, 1, ALL, 0, 0, 0, 0},
    [FAULTS_OFF] = {"OFF", "is commanded", 0, 0, 0, 0, 0, 0, 0},
    /* 30 mJ at a swing of 0.5 A and 1 m/s take a few cycles of 4 ticks. A force that is held at
     * its limit, or let go, does not swing. */
    [FAULTS_CHATTER] = {"chatter", "the string of a contact swings at 1 m/s", EXH_FAULT_CHATTER, 0,
        1u << FAULTS_IN_RUN, 12, 40, 1, 0},
};

const struct faults_spec *faults_spec_of(unsigned source)
{
    return &spec[source < FAULTS_SOURCES ? source : FAULTS_NOTHING];
}

#define BIT(source) (UINT32_C(1) << FAULTS_##source)
/* What a scene has no source for. */
static const uint32_t without[FAULTS_SCENES] = {
    [FAULTS_DROP] =
        BIT(GLOVE) | BIT(GLOVE_OLD) | BIT(LINK) | BIT(SUPPLY_LOW) | BIT(SUPPLY_HIGH) | BIT(CHATTER),
};

int faults_has(unsigned scene, unsigned source) { return !(without[scene] >> source & 1); }

int faults_is_memory(unsigned source) { return source == FAULTS_PAR || source == FAULTS_CAL; }

/* A round, and for the area another, as its sum is known at the end and it may just have passed. */
static uint32_t rounds_of(unsigned scene, unsigned source)
{
    const struct faults_memory m = faults_memory((uint8_t)scene);
    if (source == FAULTS_PAR) { return (m.pars + 1) / 2; }
    return source == FAULTS_CAL ? 2 * ((m.area_B + 7) / 8) : 0;
}

uint32_t faults_seen_within(unsigned scene, unsigned source, uint32_t rate_Hz)
{
    const struct faults_spec *s = faults_spec_of(source);
    return s->ticks + (s->ms * rate_Hz + 999) / 1000 + rounds_of(scene, source);
}

/* Packets that came while the loop was dead are taken so many a tick, and until then it hears them.
 */
uint32_t faults_seen_beside(unsigned scene, unsigned source, unsigned beside, uint32_t rate_Hz)
{
    const uint32_t waiting = FAULTS_DEAD_TICKS * FAULTS_LINK_HZ / rate_Hz + 1;
    const int queued = source == FAULTS_LINK && beside == FAULTS_DEAD_LOOP;
    return faults_seen_within(scene, source, rate_Hz) +
           (queued ? (waiting + EXH_SCENE_PACKETS - 1) / EXH_SCENE_PACKETS : 0);
}

/* 15 ms in whole ticks, three at least, and four at most where four are no longer than 20 ms. */
uint32_t faults_release_ticks(uint32_t rate_Hz)
{
    const uint32_t n = rate_Hz * 15 / 1000;
    return n < 3 ? 3 : rate_Hz < 500 && n > 4 ? 4 : n;
}

uint32_t faults_zero_ticks(uint32_t rate_Hz) { return rate_Hz < 500 ? 4 : rate_Hz * 20 / 1000; }

/* The state in the tick that sees it, by the state before. */
int faults_next(unsigned source, int state, int open)
{
    const struct faults_spec *s = faults_spec_of(source);
    if (s->bits & EXH_FAULT_LOGIC) { return EXH_STATE_FAULT; } /* whatever it was */
    if (state == EXH_STATE_FAULT) { return EXH_STATE_FAULT; }
    if (!open) { return EXH_STATE_OFF; }
    return s->cuts ? EXH_STATE_FAULT : EXH_STATE_RELEASE;
}

/* And in the end. */
int faults_end(unsigned source, int state, int open)
{
    const int next = faults_next(source, state, open);
    return next == EXH_STATE_RELEASE ? EXH_STATE_FAULT : next;
}
