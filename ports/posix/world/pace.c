/* SPDX-License-Identifier: MIT */
#include "pace.h"

#include "rpy.h"

#include <string.h>

#define WINDOW_US 250000
#define APART_US  10000
#define TURN_Q32  INT64_C(136000000) /* 0.2 rad */
#define PULL_MPS  0.05

void pace_pull(struct pace *p, const struct exh_wire_hello *hello)
{
    for (unsigned i = 0; i < FINGERS; i++) {
        for (unsigned j = 0; j < 2; j++) {
            p->pull_turn_q32ps[i][j + 1] =
                hello->pull_radpm_q7[i][j] / 128.0 * PULL_MPS / RAD_PER_TURN_Q32;
        }
    }
}

/* Did a joint of any finger turn by more than TURN_Q32 between the two? One test for all joints,
 * because mostly none did. */
static int turned(const struct pace *p, const struct pace_at *a, const struct pace_at *b)
{
    const int32_t *was = a->joint_turn_q32[0], *is = b->joint_turn_q32[0];
    int far = 0;
    for (unsigned i = p->from; i < p->to; i++) {
        far |= (uint64_t)((int64_t)is[i] - was[i] + TURN_Q32) > 2 * (uint64_t)TURN_Q32;
    }
    return far;
}

/* None of the states is a turn away: by the least and the most of each joint. */
static int all_near(const struct pace *p, const struct pace_at *now)
{
    const int32_t *at = now->joint_turn_q32[0];
    int far = 0;
    for (unsigned i = p->from; i < p->to; i++) {
        far |= at[i] > p->least_turn_q32[i] + TURN_Q32 || at[i] < p->most_turn_q32[i] - TURN_Q32;
    }
    return !far;
}

static void find_ends(struct pace *p)
{
    for (unsigned i = 0; i < FINGERS * 3; i++) {
        p->least_turn_q32[i] = INT32_MAX;
        p->most_turn_q32[i] = INT32_MIN;
    }
    for (unsigned back = 0; back < p->n; back++) {
        const int32_t *at = p->at[(p->last + PACE_STATES - back) % PACE_STATES].joint_turn_q32[0];
        for (unsigned i = p->from; i < p->to; i++) {
            if (at[i] < p->least_turn_q32[i]) { p->least_turn_q32[i] = at[i]; }
            if (at[i] > p->most_turn_q32[i]) { p->most_turn_q32[i] = at[i]; }
        }
    }
}

/* The state to compare with: as old as possible, as codes are coarse, but not before a turn. */
static const struct pace_at *before(const struct pace *p, const struct pace_at *now)
{
    const struct pace_at *from = &p->at[p->last];
    const int near = all_near(p, now);
    for (unsigned back = 1; back < p->n; back++) {
        const struct pace_at *older = &p->at[(p->last + PACE_STATES - back) % PACE_STATES];
        if (now->stamp_us - older->stamp_us > WINDOW_US || (!near && turned(p, now, older))) {
            break;
        }
        from = older;
    }
    return from;
}

/* Adds fingers to those that any state reported, and finds the range of their joints. */
static void widen(struct pace *p, unsigned fingers)
{
    if (p->n > 0 && (p->fingers | fingers) == p->fingers) { return; }
    p->fingers = p->n > 0 ? p->fingers | fingers : fingers;
    p->from = p->to = 0;
    for (unsigned f = FINGERS; f-- > 0;) {
        if (!(p->fingers >> f & 1)) { continue; }
        p->from = 3 * f;
        if (p->to == 0) { p->to = 3 * (f + 1); }
    }
    find_ends(p);
}

void pace_take(struct pace *p, const struct exh_wire_state *state, uint32_t stamp_us)
{
    struct pace_at now = {.stamp_us = stamp_us};
    const uint32_t since_us = p->n ? stamp_us - p->at[p->last].stamp_us : 0;
    if (p->n && since_us == 0) { return; } /* the same again */
    if (since_us > WINDOW_US) { p->n = 0; }
    widen(p, state->fingers);
    for (unsigned f = 0; f < FINGERS; f++) {
        if (!(state->fingers >> f & 1)) { continue; }
        memcpy(now.joint_turn_q32[f], state->joint_turn_q32[f], sizeof now.joint_turn_q32[f]);
    }
    memset(p->turn_q32ps, 0, sizeof p->turn_q32ps);
    if (p->n > 0) {
        const struct pace_at *from = before(p, &now);
        const double dt_s = 1e-6 * (stamp_us - from->stamp_us);
        for (unsigned i = p->from; i < p->to; i++) {
            p->turn_q32ps[i / 3][i % 3] =
                ((double)now.joint_turn_q32[i / 3][i % 3] - from->joint_turn_q32[i / 3][i % 3]) /
                dt_s;
        }
    }
    if (p->n > 0 && since_us < APART_US) { return; }
    p->last = (p->last + 1) % PACE_STATES;
    p->n += p->n < PACE_STATES;
    p->at[p->last] = now;
    find_ends(p);
}
