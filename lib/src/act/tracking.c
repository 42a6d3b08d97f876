/* SPDX-License-Identifier: MIT */
/* Compares the measured current with the coded one. */
#include "exhand/tracking.h"

#include "exhand/error.h"
#include "exhand/fix.h"

#include <stddef.h>

#define TOL_MIN_A_Q26 EXH_Q(1, 10, EXH_Q_CUR)
#define TOL_MAX_A_Q26 EXH_Q(1, 1, EXH_Q_CUR)
#define TIME_MAX_MS   100
/* An output may take three ticks, and the monitor may be converted one tick before. */
#define LATE_TICKS 4

/* Default tolerance: the monitor noise of the paper is 47.2 mA peak to peak. D/A and monitor steps
 * are 0.5 mA each. A scale difference of 3 % gives 0.2 A at the peak. Default time: an output is up
 * to 10 ms late, and the drive samples at 4 kHz (0.25 ms). Current loop and monitor (0.11 and 0.57
 * ms) need 2.5 ms from 13.2 A to 0.2 A. Rounded up to 20 ms for slower drives. */
const struct exh_signal exh_tracking_rows[EXH_TRACKING_ROWS] = {
    {0x0D01, EXH_Q_CUR, EXH_WHEN_SETUP, TOL_MIN_A_Q26, TOL_MAX_A_Q26, EXH_Q(1, 4, EXH_Q_CUR),
        "track_tol", "a", "current monitored differs from what is coded by no more"},
    {0x0D02, 0, EXH_WHEN_SETUP, 1, TIME_MAX_MS, 20, "track_time", "ms",
        "for no longer than this and 4 ticks"},
};

int exh_tracking_setup(
    struct exh_tracking_cfg *cfg, const struct exh_tracking_par *par, struct exh_period T)
{
    if (par->tol_A_q26 < TOL_MIN_A_Q26 || par->tol_A_q26 > TOL_MAX_A_Q26 || par->time_ms < 1 ||
        par->time_ms > TIME_MAX_MS) {
        return -EXH_E_RANGE;
    }
    if (!exh_period_ok(T)) { return -EXH_E_RATE; }
    cfg->tol_A_q26 = par->tol_A_q26;
    cfg->ticks = exh_ticks_in(par->time_ms, T) + 1 + LATE_TICKS;
    return 0;
}

int exh_tracking_step(struct exh_tracking *s, const struct exh_tracking_cfg *cfg, int32_t mon_A_q26)
{
    const int64_t lowest = (int64_t)s->lo_A_q26 - cfg->tol_A_q26;
    const int64_t highest = (int64_t)s->hi_A_q26 + cfg->tol_A_q26;
    if (mon_A_q26 >= lowest && mon_A_q26 <= highest) {
        s->off_ticks = 0;
    } else if (s->off_ticks < cfg->ticks) {
        s->off_ticks++;
    }
    return s->off_ticks >= cfg->ticks;
}

void exh_tracking_update(struct exh_tracking *s, int32_t coded_A_q26)
{
    const int anew = s->off_ticks == 0;
    if (anew || coded_A_q26 < s->lo_A_q26) { s->lo_A_q26 = coded_A_q26; }
    if (anew || coded_A_q26 > s->hi_A_q26) { s->hi_A_q26 = coded_A_q26; }
}

void exh_tracking_serialize(struct exh_bytes *c, struct exh_tracking *s)
{
    exh_bytes_i32(c, &s->lo_A_q26);
    exh_bytes_i32(c, &s->hi_A_q26);
    exh_bytes_u32(c, &s->off_ticks);
}
