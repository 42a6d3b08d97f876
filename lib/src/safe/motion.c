/* SPDX-License-Identifier: MIT */
/* Speed limit of a finger, and detector of a stuck encoder. */
#include "exhand/motion.h"

#include "exhand/error.h"
#include "exhand/fix.h"
#include "exhand/safety.h"

#include <stddef.h>

#define SPEED_MIN_MPS_Q27 EXH_Q(1, 10, EXH_Q_VEL)
#define SPEED_MAX_MPS_Q27 EXH_Q(10, 1, EXH_Q_VEL)
#define SPEED_MAX_MS      1000
#define STUCK_MIN_MS      100
#define STUCK_MAX_MS      60000
#define CUR_MIN_A_Q26     EXH_Q(1, 20, EXH_Q_CUR)
#define CUR_MAX_A_Q26     EXH_Q(66, 10, EXH_Q_CUR)

const struct exh_signal exh_motion_rows[EXH_MOTION_ROWS] = {
    {0x0E01, EXH_Q_VEL, EXH_WHEN_SETUP, SPEED_MIN_MPS_Q27, SPEED_MAX_MPS_Q27,
        EXH_Q(3, 1, EXH_Q_VEL), "speed_limit", "m_per_s", "velocity into the law is no more"},
    {0x0E02, 0, EXH_WHEN_SETUP, 1, SPEED_MAX_MS, 20, "speed_time", "ms",
        "a fault if it would be for longer"},
    {0x0E03, 0, EXH_WHEN_SETUP, 0, STUCK_MAX_MS, 0, "stuck_time", "ms",
        "a fault if not one count moves for longer, 0: never"},
    {0x0E04, EXH_Q_CUR, EXH_WHEN_SETUP, CUR_MIN_A_Q26, CUR_MAX_A_Q26, EXH_Q(1, 4, EXH_Q_CUR),
        "stuck_cur", "a", "while more than this is coded"},
};

static uint32_t ticks_of(int32_t ms, struct exh_period T) { return exh_ticks_in(ms, T) + 1; }

int exh_motion_setup(
    struct exh_motion_cfg *cfg, const struct exh_motion_par *par, struct exh_period T)
{
    if (!exh_inside(par->speed_mps_q27, SPEED_MIN_MPS_Q27, SPEED_MAX_MPS_Q27) ||
        !exh_inside(par->speed_ms, 1, SPEED_MAX_MS) ||
        (par->stuck_ms != 0 && !exh_inside(par->stuck_ms, STUCK_MIN_MS, STUCK_MAX_MS)) ||
        !exh_inside(par->stuck_cur_A_q26, CUR_MIN_A_Q26, CUR_MAX_A_Q26)) {
        return -EXH_E_RANGE;
    }
    if (!exh_period_ok(T)) { return -EXH_E_RATE; }
    cfg->par = par;
    cfg->speed_ticks = ticks_of(par->speed_ms, T);
    cfg->stuck_ticks = par->stuck_ms ? ticks_of(par->stuck_ms, T) : 0;
    return 0;
}

/* The length of a run: one more, up to most, while on is 1; else 0. */
static uint32_t run_of(uint32_t ticks, int on, uint32_t most)
{
    return !on ? 0 : ticks < most ? ticks + 1 : most;
}

uint32_t exh_motion_step(
    struct exh_motion *s, const struct exh_motion_cfg *cfg, int32_t *vel_mps_q27, uint32_t *limits)
{
    const int32_t most = cfg->par->speed_mps_q27;
    const int32_t held = exh_clamp32(*vel_mps_q27, -most, most);
    const int fast = held != *vel_mps_q27;
    uint32_t due = 0;
    if (fast) {
        *vel_mps_q27 = held;
        *limits |= EXH_LIMIT_SPEED;
    }
    s->fast_ticks = run_of(s->fast_ticks, fast, cfg->speed_ticks);
    if (s->fast_ticks >= cfg->speed_ticks) { due = EXH_FAULT_SPEED; }
    if (cfg->stuck_ticks && s->stuck_ticks >= cfg->stuck_ticks) { due |= EXH_FAULT_STUCK; }
    return due;
}

void exh_motion_update(
    struct exh_motion *s, const struct exh_motion_cfg *cfg, int32_t cnt, int32_t coded_A_q26)
{
    const int pulled = coded_A_q26 > cfg->par->stuck_cur_A_q26;
    s->stuck_ticks = run_of(s->stuck_ticks, pulled && cnt == s->cnt, cfg->stuck_ticks);
    s->cnt = cnt;
}

void exh_motion_serialize(struct exh_bytes *c, struct exh_motion *s)
{
    exh_bytes_u32(c, &s->fast_ticks);
    exh_bytes_u32(c, &s->stuck_ticks);
    exh_bytes_i32(c, &s->cnt);
}
