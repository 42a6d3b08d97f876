/* SPDX-License-Identifier: MIT */
/* Detector of a limit cycle: energy output of fast cycles of the current. */
#include "exhand/chatter.h"

#include "exhand/error.h"
#include "exhand/fix.h"
#include "exhand/safety.h"

#define Q_ACNT      20
#define POWER_MIN   EXH_Q(1, 100, 20)
#define POWER_MAX   EXH_Q(10, 1, 20)
#define ENERGY_MIN  EXH_Q(1, 1000, 24)
#define ENERGY_MAX  EXH_Q(1, 1, 24)
#define SWING_A_Q26 EXH_Q(1, 4, EXH_Q_CUR)
/* A hand oscillates at 8 Hz at most. A loop at its stability limit reverses every 4 ticks. */
#define CYCLE_MS    50
#define CYCLE_TICKS 8u
/* Above the fastest movement. Sums of that many ticks stay below 2^63, even when damaged. */
#define WAY_MAX_CNT  (INT32_C(1) << 24)
#define SUM_MAX_ACNT (INT64_C(1) << 58)

/* Default power: with the paper's gains at 2 kHz, a limit cycle of one count gives out up to 27 mW,
 * a wall of 1000 kN/m 330 mW. */
const struct exh_signal exh_chatter_rows[EXH_CHATTER_ROWS] = {
    {0x1401, 20, EXH_WHEN_SETUP, POWER_MIN, POWER_MAX, EXH_Q(15, 100, 20), "chatter_power", "w",
        "what fast cycles of current may give out without end"},
    {0x1402, 24, EXH_WHEN_SETUP, 0, ENERGY_MAX, 0, "chatter_energy", "j",
        "a fault if they give out so much beyond it, 0: never"},
};

int exh_chatter_setup(struct exh_chatter_cfg *cfg, const struct exh_chatter_par *par,
    const struct exh_drive_cfg *drive, struct exh_velocity_scale scale)
{
    const struct exh_table t = drive->force_to_cur;
    struct exh_gain joule, tick; /* A counts q20 per J q24; seconds */
    uint64_t ApN_q38;
    int64_t second;    /* energy of power in one second */
    unsigned down = 0; /* scaling shift */

    if (!exh_period_ok(scale.T)) { return -EXH_E_RATE; }
    if (!exh_inside(par->power_W_q20, POWER_MIN, POWER_MAX) ||
        (par->energy_J_q24 != 0 && !exh_inside(par->energy_J_q24, ENERGY_MIN, ENERGY_MAX)) ||
        scale.step_m_q42 <= 0 || t.n < 2 || t.knot[t.n - 1].x <= 0 || t.knot[t.n - 1].y <= 0) {
        return -EXH_E_RANGE;
    }
    ApN_q38 = exh_udiv64(
        (uint64_t)(uint32_t)t.knot[t.n - 1].y << 32, (uint64_t)(uint32_t)t.knot[t.n - 1].x, NULL);
    /* Formats 38 and 42 minus 20 and 24: no shift remains. */
    if (exh_gain_set(&joule, ApN_q38, (uint64_t)(uint32_t)scale.step_m_q42) < 0 ||
        exh_gain_set(&tick, scale.T.num, scale.T.den) < 0) {
        return -EXH_E_RANGE;
    }
    cfg->energy_Acnt_q20 = exh_gain_mul(joule, par->energy_J_q24);
    second = exh_gain_mul(joule, par->power_W_q20 * (1 << (24 - 20)));
    if (second > SUM_MAX_ACNT) { return -EXH_E_RANGE; } /* energy is at most 1/10 of it */
    for (; second > INT32_MAX; second >>= 1) { down++; }
    /* A tick lasts at most 1 s (exh_period_ok()). */
    cfg->leak_Acnt_q20 =
        exh_clamp(exh_gain_mul(tick, (int32_t)second), 0, (int32_t)second) * (INT64_C(1) << down);
    cfg->ticks = exh_ticks_in(CYCLE_MS, scale.T) + 1;
    if (cfg->ticks < CYCLE_TICKS + 1) { cfg->ticks = CYCLE_TICKS + 1; }
    return 0;
}

uint32_t exh_chatter_step(const struct exh_chatter *s, const struct exh_chatter_cfg *cfg)
{
    const int due = cfg->energy_Acnt_q20 != 0 && s->net_Acnt_q20 >= cfg->energy_Acnt_q20;
    return due ? EXH_FAULT_CHATTER : 0u;
}

/* 1 at a minimum: the current fell and has risen by a swing. */
static int valley(struct exh_chatter *s, int32_t now_A_q26)
{
    const int32_t end_A_q26 = s->end_A_q26; /* within 2^30 of the other, or damaged */
    const int32_t back =
        s->rises ? exh_wrap_diff(end_A_q26, now_A_q26) : exh_wrap_diff(now_A_q26, end_A_q26);
    const int turns = back > SWING_A_Q26;
    if (turns || back < 0) { s->end_A_q26 = now_A_q26; }
    s->rises = (uint8_t)(s->rises ^ turns);
    return turns && s->rises;
}

/* v, moved towards 0 by at most by. */
static int64_t leaked(int64_t v, int64_t by)
{
    const int64_t sign = v >> 63, left = (v ^ sign) - sign - by, size = left & ~(left >> 63);
    return (size ^ sign) - sign;
}

void exh_chatter_update(
    struct exh_chatter *s, const struct exh_chatter_cfg *cfg, int32_t cnt, int32_t coded_A_q26)
{
    const int32_t moved = exh_clamp32(exh_wrap_diff(cnt, s->cnt), -WAY_MAX_CNT, WAY_MAX_CNT);
    const int64_t given = -(int64_t)(s->held_A_q26 >> (EXH_Q_CUR - Q_ACNT)) * moved;
    const int counts = s->ticks < cfg->ticks;

    if (s->net_Acnt_q20 != 0) { s->net_Acnt_q20 = leaked(s->net_Acnt_q20, cfg->leak_Acnt_q20); }
    s->cycle_Acnt_q20 = counts ? s->cycle_Acnt_q20 + given : 0;
    s->ticks += (uint32_t)counts;
    if (valley(s, coded_A_q26)) {
        s->net_Acnt_q20 = exh_clamp64(s->net_Acnt_q20 + s->cycle_Acnt_q20, cfg->energy_Acnt_q20);
        s->cycle_Acnt_q20 = 0;
        s->ticks = 0;
    }
    s->held_A_q26 = coded_A_q26;
    s->cnt = cnt;
}

void exh_chatter_serialize(struct exh_bytes *c, struct exh_chatter *s)
{
    exh_bytes_i64(c, &s->net_Acnt_q20);
    exh_bytes_i64(c, &s->cycle_Acnt_q20);
    exh_bytes_i32(c, &s->held_A_q26);
    exh_bytes_i32(c, &s->end_A_q26);
    exh_bytes_i32(c, &s->cnt);
    exh_bytes_u32(c, &s->ticks);
    exh_bytes_u8(c, &s->rises);
    s->net_Acnt_q20 = exh_clamp64(s->net_Acnt_q20, SUM_MAX_ACNT);
    s->cycle_Acnt_q20 = exh_clamp64(s->cycle_Acnt_q20, SUM_MAX_ACNT);
    s->rises = s->rises != 0;
}
