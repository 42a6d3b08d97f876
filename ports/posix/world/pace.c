/* SPDX-License-Identifier: MIT */
#include "pace.h"

#include "rpy.h"

#include <string.h>

#define WINDOW_US 40000
#define GAP_US    250000
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

void pace_take(struct pace *p, const struct exh_wire_state *state, uint32_t stamp_us)
{
    const uint32_t since_us = p->n ? stamp_us - p->at[p->last].stamp_us : 0;
    const struct pace_at *from;
    struct pace_at *now;
    unsigned back = 1;
    double dt_s;
    if (p->n && since_us == 0) { return; } /* the same again */
    if (since_us > GAP_US) { p->n = 0; }
    p->last = (p->last + 1) % PACE_STATES;
    p->n += p->n < PACE_STATES;
    now = &p->at[p->last];
    now->stamp_us = stamp_us;
    memcpy(now->joint_turn_q32, state->joint_turn_q32, sizeof now->joint_turn_q32);
    memset(p->turn_q32ps, 0, sizeof p->turn_q32ps);
    if (p->n == 1) { return; }
    while (back + 1 < p->n && stamp_us - p->at[(p->last + PACE_STATES - back - 1) % PACE_STATES]
                                             .stamp_us <= WINDOW_US) {
        back++;
    }
    from = &p->at[(p->last + PACE_STATES - back) % PACE_STATES];
    dt_s = 1e-6 * (stamp_us - from->stamp_us);
    for (unsigned i = 0; i < FINGERS * 3; i++) {
        p->turn_q32ps[i / 3][i % 3] = ((double)now->joint_turn_q32[i / 3][i % 3] -
                                          from->joint_turn_q32[i / 3][i % 3]) /
                                      dt_s;
    }
}
