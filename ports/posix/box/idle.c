/* SPDX-License-Identifier: MIT */
#include "box/idle.h"

#include "posix.h"

#include "exhand/fix.h"

#include <string.h>

/* Removes counters of ticks, which affect nothing else. */
static void leave_out_counts(struct drop *s)
{
    s->safety.tick = 0;
    s->safety.alive = 0;
    memset(s->safety.held, 0, sizeof s->safety.held);
    s->velocity.at = 0;
}

/* Which of the window's counts is the oldest is all one if they are the same. */
static int one_count(const struct drop *s, const struct drop_cfg *cfg)
{
    for (unsigned i = 0; i < cfg->velocity.n; i++) {
        if (s->velocity.cnt[i] != s->quad.cnt) { return 0; }
    }
    return 1;
}

static int followed(const struct drop *s, const struct drop_cfg *cfg, int16_t mon_raw)
{
    struct exh_tracking track = s->track;
    exh_tracking_step(&track, &cfg->track, exh_drive_monitor_A_q26(&cfg->drive, mon_raw));
    return track.off_ticks == 0;
}

int idle_step(struct idle *i)
{
    struct drop_cfg *cfg;
    const struct drop *s = drop_memory(&cfg);
    struct drop now;
    int16_t low_raw, high_raw;
    int same;
    if (!posix_still()) {
        i->there = 0;
        return 0;
    }
    memcpy(&now, s, sizeof now);
    leave_out_counts(&now);
    same = i->there && memcmp(&now, &i->was, sizeof now) == 0;
    memcpy(&i->was, &now, sizeof now);
    i->there = 1;
    if (!same || !one_count(s, cfg)) { return 0; }
    posix_monitor(&low_raw, &high_raw);
    return followed(s, cfg, low_raw) && followed(s, cfg, high_raw);
}

void idle_passed(uint32_t ticks)
{
    struct drop_cfg *cfg;
    struct drop *s = drop_memory(&cfg);
    s->safety.tick += ticks;
    s->safety.alive = (uint8_t)(s->safety.alive + ticks);
    s->velocity.at = (uint8_t)((s->velocity.at + ticks) & (cfg->velocity.n - 1u));
    for (unsigned k = 0; k < EXH_LIMITS; k++) {
        const uint64_t sum = s->safety.held[k] + (uint64_t)ticks * (s->safety.limits >> k & 1u);
        s->safety.held[k] = sum < UINT32_MAX ? (uint32_t)sum : UINT32_MAX;
    }
}

int32_t idle_monitor_N_q20(int16_t mon_raw)
{
    struct drop_cfg *cfg;
    drop_memory(&cfg);
    return exh_drive_monitor_N_q20(&cfg->drive, exh_drive_monitor_A_q26(&cfg->drive, mon_raw));
}
