/* SPDX-License-Identifier: MIT */
/* track: does the current monitored follow what is coded? */
#include "modules.h"

#include "exhand/drive.h"
#include "exhand/fix.h"
#include "exhand/tracking.h"

void golden_track_par(struct exh_tracking_par *p, struct golden_rng *r, uint32_t rate_Hz)
{
    p->tol_A_q26 = (int32_t)golden_draw(r, 6710886, 67108864);
    p->time_ms = exh_clamp(golden_draw(r, 1, 12) * 1000 / rate_Hz, 1, 100);
}

int16_t golden_monitor(
    unsigned *astray, const struct exh_drive_par *p, struct golden_rng *r, int32_t coded_A_q26)
{
    const int64_t any_raw = golden_draw(r, -32768, 32767);
    const int64_t up = ((int64_t)coded_A_q26 << 14) / p->mon_A_q40; /* coded >= 0 in a scene */
    if (golden_draw(r, 0, *astray ? 7 : 31) == 0) { *astray ^= 1; }
    return (int16_t)(*astray ? any_raw : exh_clamp(p->mon_zero_raw + up, -32768, 32767));
}

static int32_t any_monitor(struct golden_rng *r, unsigned *astray, int32_t coded, int32_t tol)
{
    const int64_t any = golden_draw(r, INT32_MIN, INT32_MAX);
    const int64_t how = golden_draw(r, 0, 7);
    const int64_t by = tol + golden_draw(r, 0, 1);
    if (golden_draw(r, 0, *astray ? 31 : 15) == 0) { *astray ^= 1; }
    if (*astray || how > 5) { return (int32_t)any; }
    return exh_sat32(coded + (how < 2 ? by : how < 4 ? -by : 0));
}

void golden_track(struct golden *g, uint32_t rate_Hz)
{
    static struct golden_wave coded;
    struct golden_rng r = golden_rng("track", rate_Hz, 0);
    struct exh_tracking_par par = {0, 0};
    struct exh_tracking_cfg cfg = {0, 0};
    struct exh_tracking s = {0, 0, 0};
    int32_t last = 0;
    unsigned astray = 0;
    golden_wave(&coded, "track", rate_Hz, 1, INT32_MIN, INT32_MAX,
        (int32_t)(UINT32_C(1) << golden_draw(&r, 20, 27)));
    while (g->tick < GOLDEN_TICKS) {
        const uint32_t k = g->tick;
        int32_t mon;
        if (k == 0 || k == GOLDEN_AGAIN) {
            golden_track_par(&par, &r, rate_Hz);
            CHECK_EQ_I64(exh_tracking_setup(&cfg, &par, golden_period(rate_Hz, k)), 0);
            s = (struct exh_tracking){0, 0, 0};
            last = 0;
        }
        mon = any_monitor(&r, &astray, last, cfg.tol_A_q26);
        last = coded.at[k];
        golden_put(g, mon);
        golden_put(g, last);
        golden_put(g, exh_tracking_step(&s, &cfg, mon));
        exh_tracking_update(&s, last);
        golden_put(g, s.lo_A_q26);
        golden_put(g, s.hi_A_q26);
        golden_put(g, s.off_ticks);
        GOLDEN_STATE(g, exh_tracking_serialize, &s);
        golden_tick(g);
    }
}
