/* SPDX-License-Identifier: MIT */
#include "box.h"

#define FULL ((int64_t)1 << 30)

/* Ticks of so many ms, rounded down. */
static uint64_t ticks_in(int32_t ms, struct exh_period T)
{
    return (uint64_t)ms * T.den / (1000 * (uint64_t)T.num);
}

static uint64_t at_least(uint64_t n, uint64_t least) { return n < least ? least : n; }

struct box_times box_times(
    const struct exh_safety_par *par, const struct exh_motion_par *watch, struct exh_period T)
{
    struct box_times t;
    t.arm = at_least(ticks_in(par->arm_ms, T) + 1, 2);
    t.ramp = ticks_in(par->ramp_ms, T) + 1;
    t.share = (FULL + (int64_t)t.ramp - 1) / (int64_t)t.ramp;
    t.release = at_least(ticks_in(par->release_ms, T), 3);
    if ((double)T.den / T.num < 500 && t.release > 4) { t.release = 4; }
    t.fast = ticks_in(watch->speed_ms, T) + 1;
    t.still = watch->stuck_ms ? ticks_in(watch->stuck_ms, T) + 1 : 0;
    t.late_most = 64 * par->missed_max;
    t.small_N_q20 = par->arm_force_N_q20;
    return t;
}

int64_t box_share(const struct box *b, const struct box_times *t)
{
    const int64_t share = (int64_t)b->ramped * t->share;
    return b->state == EXH_STATE_ARM && share < FULL ? share : FULL;
}

/* One missed tick in 64 is forgiven. */
static int too_late(struct box *b, const struct box_times *t, uint32_t missed)
{
    if (b->late > 0) { b->late--; }
    b->late += missed > 1 ? 128u : missed * 64u;
    if (b->late > 256) { b->late = 256; }
    return (int)b->late > t->late_most;
}

static uint32_t causes(struct box *b, const struct box_times *t, const struct exh_safety_in *in)
{
    static const struct {
        uint32_t healthy, cause;
    } contact[] = {{EXH_DIN_ESTOP, EXH_FAULT_ESTOP}, {EXH_DIN_DEADMAN, EXH_FAULT_DEADMAN},
        {EXH_DIN_WATCHDOG, EXH_FAULT_WATCHDOG}, {EXH_DIN_CARDS, EXH_FAULT_CARD},
        {EXH_DIN_DRIVE0, EXH_FAULT_DRIVE}};
    uint32_t c = in->raised;
    for (unsigned k = 0; k < sizeof contact / sizeof contact[0]; k++) {
        if ((in->din & contact[k].healthy) == 0) { c |= contact[k].cause; }
    }
    return too_late(b, t, in->missed) ? c | EXH_FAULT_OVERRUN : c;
}

static int is_open(const struct box *b)
{
    return b->state == EXH_STATE_RUN || b->state == EXH_STATE_LIMIT ||
           b->state == EXH_STATE_RELEASE || (b->state == EXH_STATE_ARM && b->ramped > 0);
}

/* What can wait lets go by the release law, what cannot cuts. */
static int cuts(uint32_t c)
{
    return (c & ~(uint32_t)(EXH_FAULT_OVERRUN | EXH_FAULT_ENCODER | EXH_FAULT_DEADMAN |
                            EXH_FAULT_STUCK | EXH_FAULT_SPEED | EXH_FAULT_GLOVE | EXH_FAULT_LINK |
                            EXH_FAULT_SUPPLY | EXH_FAULT_CHATTER)) != 0;
}

/* While force may act. */
static int leaves_open(
    const struct box *b, const struct box_times *t, const struct exh_safety_in *in, int lost)
{
    if (cuts(b->present)) { return EXH_STATE_FAULT; }
    if (b->state == EXH_STATE_RELEASE) {
        if (b->gone < t->release) { return EXH_STATE_RELEASE; }
        return b->faults ? EXH_STATE_FAULT : EXH_STATE_OFF;
    }
    if (b->present || in->command == EXH_CMD_OFF) { return EXH_STATE_RELEASE; }
    if (b->state == EXH_STATE_ARM) {
        if (lost) { return EXH_STATE_RELEASE; }
        return (int64_t)b->ramped * t->share >= FULL ? EXH_STATE_RUN : EXH_STATE_ARM;
    }
    return b->limited ? EXH_STATE_LIMIT : EXH_STATE_RUN;
}

/* While it may not. */
static int leaves_shut(struct box *b, const struct exh_safety_in *in, int may_arm)
{
    if (b->state == EXH_STATE_FAULT) {
        if (in->command != EXH_CMD_CLEAR || b->present || !b->opened) { return EXH_STATE_FAULT; }
        b->faults = 0;
        return EXH_STATE_OFF;
    }
    if (b->state == EXH_STATE_ARM) {
        return may_arm && in->command != EXH_CMD_OFF ? EXH_STATE_ARM : EXH_STATE_OFF;
    }
    return in->command == EXH_CMD_RUN && may_arm ? EXH_STATE_ARM : EXH_STATE_OFF;
}

enum box_gate box_step(struct box *b, const struct box_times *t, const struct exh_safety_in *in)
{
    const int lost = in->ready != 15, open = is_open(b), was = b->state;
    b->present = causes(b, t, in);
    if (open || was == EXH_STATE_FAULT) { b->faults |= b->present; }
    if (b->present) { b->opened = b->present == EXH_FAULT_DEADMAN; }
    b->state = open ? leaves_open(b, t, in, lost)
                    : leaves_shut(b, in, !lost && !b->present && b->calm > 0);
    if (b->state != was) { b->armed = b->ramped = b->gone = 0; }
    if (b->state == EXH_STATE_ARM && was == EXH_STATE_ARM && ++b->armed >= t->arm) { b->ramped++; }
    if (b->state == EXH_STATE_RELEASE) {
        if (was != EXH_STATE_RELEASE) { b->from = b->held; }
        b->gone += (uint64_t)in->missed + 1;
        return BOX_FALLS;
    }
    return is_open(b) ? BOX_OPEN : BOX_SHUT;
}
