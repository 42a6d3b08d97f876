/* SPDX-License-Identifier: MIT */
/* The small pull of arming, which checks the signs of motor and encoder. */
#include "exhand/polarity.h"

#include "exhand/error.h"
#include "exhand/fix.h"

#define PULL_MAX_N_Q20 EXH_Q(1, 1, EXH_Q_FORCE)
#define TIME_MIN_MS    50
#define TIME_MAX_MS    5000
#define MOVE_MIN_M_Q30 EXH_Q(5, 100000, EXH_Q_POS)
#define MOVE_MAX_M_Q30 EXH_Q(20, 1000, EXH_Q_POS)
#define MOVE_MIN_CNT   2
#define REST_MIN_TICKS 4

const struct exh_signal exh_polarity_rows[EXH_POLARITY_ROWS] = {
    {0x0606, EXH_Q_FORCE, EXH_WHEN_SETUP, 0, PULL_MAX_N_Q20, 0, "arm_pull", "n",
        "arming pulls each string with this and sees it go in; 0: no pull"},
    {0x0607, 0, EXH_WHEN_SETUP, TIME_MIN_MS, TIME_MAX_MS, 400, "arm_pull_time", "ms",
        "for so long at most, a quarter of it at rest"},
    {0x0608, EXH_Q_POS, EXH_WHEN_SETUP, MOVE_MIN_M_Q30, MOVE_MAX_M_Q30, EXH_Q(3, 10000, EXH_Q_POS),
        "arm_pull_move", "m", "by so much, and 2 counts"},
};

int exh_polarity_setup(struct exh_polarity_cfg *cfg, const struct exh_polarity_par *par,
    int32_t step_m_q42, struct exh_period T)
{
    uint64_t move_cnt;
    if (step_m_q42 <= 0 || !exh_inside(par->pull_N_q20, 0, PULL_MAX_N_Q20) ||
        !exh_inside(par->time_ms, TIME_MIN_MS, TIME_MAX_MS) ||
        !exh_inside(par->move_m_q30, MOVE_MIN_M_Q30, MOVE_MAX_M_Q30)) {
        return -EXH_E_RANGE;
    }
    if (!exh_period_ok(T)) { return -EXH_E_RATE; }
    move_cnt = exh_udiv64((uint64_t)(uint32_t)par->move_m_q30 << (EXH_Q_STEP - EXH_Q_POS),
        (uint32_t)step_m_q42, NULL);
    cfg->pull_N_q20 = par->pull_N_q20;
    cfg->rest_ticks = exh_ticks_in(par->time_ms, T) / 4;
    if (cfg->rest_ticks < REST_MIN_TICKS) { cfg->rest_ticks = REST_MIN_TICKS; }
    cfg->ticks = 4 * cfg->rest_ticks;
    cfg->rise_N_q20 =
        (int32_t)exh_udiv64((uint32_t)par->pull_N_q20 + cfg->rest_ticks - 1, cfg->rest_ticks, NULL);
    cfg->move_cnt = exh_clamp((int64_t)move_cnt, MOVE_MIN_CNT, INT32_MAX);
    return 0;
}

uint8_t exh_polarity_step(
    struct exh_polarity *s, const struct exh_polarity_cfg *cfg, int pulls, int32_t cnt)
{
    const int64_t out = exh_wrap_diff(cnt, s->from_cnt);
    const int moves = out >= cfg->move_cnt || -out >= cfg->move_cnt;
    if (!pulls) {
        *s = (struct exh_polarity){.from_cnt = cnt};
    } else if (s->result != EXH_POLARITY_BUSY) {
        return s->result;
    } else if (++s->tick >= cfg->ticks) {
        s->result = EXH_POLARITY_STILL;
    } else if (s->rest < cfg->rest_ticks) {
        s->rest = moves ? 0 : s->rest + 1;
        if (moves || s->rest == cfg->rest_ticks) { s->from_cnt = cnt; }
    } else if (moves) {
        s->result = out < 0 ? EXH_POLARITY_SEEN : EXH_POLARITY_WRONG;
    } else {
        s->pulled++;
    }
    return s->result;
}

int32_t exh_polarity_force_N_q20(const struct exh_polarity *s, const struct exh_polarity_cfg *cfg)
{
    const int64_t force = (int64_t)s->pulled * cfg->rise_N_q20;
    return s->result == EXH_POLARITY_BUSY ? exh_clamp(force, 0, cfg->pull_N_q20) : 0;
}

void exh_polarity_serialize(struct exh_bytes *c, struct exh_polarity *s)
{
    exh_bytes_i32(c, &s->from_cnt);
    exh_bytes_u32(c, &s->tick);
    exh_bytes_u32(c, &s->rest);
    exh_bytes_u32(c, &s->pulled);
    exh_bytes_u8(c, &s->result);
}
