/* SPDX-License-Identifier: MIT */
/* Monitor of the drives' supply voltage. */
#include "exhand/supply.h"

#include "exhand/error.h"
#include "exhand/fix.h"

#define V_MAX_Q20   EXH_Q(100, 1, EXH_Q_SUPPLY)
#define TIME_MAX_MS 1000

/* Default scale: 24 V through a divider of 1:4, 305.2 uV per code. Only the builder knows whether a
 * monitor exists and its divider. So there is no check until supply_min is set. */
const struct exh_signal exh_supply_rows[EXH_SUPPLY_ROWS] = {
    {0x0D11, EXH_Q_SUPPLY, EXH_WHEN_SETUP, 0, V_MAX_Q20, 0, "supply_min", "v",
        "lowest voltage of the drives' supply; 0: it is not judged"},
    {0x0D12, EXH_Q_SUPPLY, EXH_WHEN_SETUP, 0, V_MAX_Q20, EXH_Q(30, 1, EXH_Q_SUPPLY), "supply_max",
        "v", "highest"},
    {0x0D13, EXH_Q_VPRAW, EXH_WHEN_SETUP, 1, INT32_MAX, EXH_Q(4 * 10, 32768, EXH_Q_VPRAW),
        "supply_scale", "v", "volt per code of its monitor"},
    {0x0D14, 0, EXH_WHEN_SETUP, 1, TIME_MAX_MS, 10, "supply_time", "ms",
        "outside them for no longer than this"},
};

int exh_supply_setup(
    struct exh_supply_cfg *cfg, const struct exh_supply_par *par, struct exh_period T)
{
    const unsigned up = EXH_Q_VPRAW - EXH_Q_SUPPLY;
    uint64_t least, most, rest;
    *cfg = (struct exh_supply_cfg){INT16_MIN, INT16_MAX, 1};
    if (par->min_V_q20 < 0 || par->min_V_q20 > V_MAX_Q20) { return -EXH_E_RANGE; }
    if (par->max_V_q20 < par->min_V_q20 || par->max_V_q20 > V_MAX_Q20) { return -EXH_E_RANGE; }
    if (par->scale_V_q30 < 1 || par->time_ms < 1 || par->time_ms > TIME_MAX_MS) {
        return -EXH_E_RANGE;
    }
    if (!exh_period_ok(T)) { return -EXH_E_RATE; }
    cfg->ticks = exh_ticks_in(par->time_ms, T) + 1;
    if (par->min_V_q20 == 0) { return 0; }
    least = exh_udiv64((uint64_t)(uint32_t)par->min_V_q20 << up, (uint32_t)par->scale_V_q30, &rest);
    least += rest != 0;
    most = exh_udiv64((uint64_t)(uint32_t)par->max_V_q20 << up, (uint32_t)par->scale_V_q30, NULL);
    /* Refuse a limit that the monitor cannot represent. */
    if (most >= INT16_MAX || least > most) { return -EXH_E_RANGE; }
    cfg->min_raw = (int16_t)least;
    cfg->max_raw = (int16_t)most;
    return 0;
}

int exh_supply_step(
    struct exh_supply *s, const struct exh_supply_cfg *cfg, int16_t raw, uint32_t missed)
{
    if (raw >= cfg->min_raw && raw <= cfg->max_raw) {
        s->off_ticks = 0;
    } else if (s->off_ticks < cfg->ticks) {
        const uint32_t left = cfg->ticks - s->off_ticks;
        s->off_ticks = missed < left ? s->off_ticks + missed + 1 : cfg->ticks;
    }
    return s->off_ticks >= cfg->ticks;
}

void exh_supply_serialize(struct exh_bytes *c, struct exh_supply *s)
{
    exh_bytes_u32(c, &s->off_ticks);
}
