/* SPDX-License-Identifier: MIT */
/* watch: too fast, or standing while pulled. */
#include "modules.h"

#include "exhand/fix.h"
#include "exhand/motion.h"

void golden_watch_par(struct exh_motion_par *p, struct golden_rng *r, uint32_t rate_Hz)
{
    p->speed_mps_q27 = (int32_t)golden_draw(r, 13421773, 1342177280);
    p->speed_ms = exh_clamp(golden_draw(r, 1, 5) * 1000 / rate_Hz, 1, 1000);
    p->stuck_ms = exh_clamp(golden_draw(r, 1, 24) * 1000 / rate_Hz, 100, 60000);
    if (golden_draw(r, 0, 3) == 0) { p->stuck_ms = 0; }
    p->stuck_cur_A_q26 = (int32_t)golden_draw(r, 3355443, 442918502);
}

void golden_watch(struct golden *g, uint32_t rate_Hz)
{
    static struct golden_wave moves;
    struct golden_rng r = golden_rng("watch", rate_Hz, 0);
    struct exh_motion_par par = {0, 0, 0, 0};
    struct exh_motion_cfg cfg = {NULL, 0, 0};
    struct exh_motion s = {0, 0, 0};
    int32_t cnt = 0;
    unsigned stands = 0;
    unsigned fast = 0;
    golden_wave(
        &moves, "watch", rate_Hz, 1, INT32_MIN, INT32_MAX, INT32_C(1) << golden_draw(&r, 20, 27));
    while (g->tick < GOLDEN_TICKS) {
        const uint32_t k = g->tick;
        int32_t vel = moves.at[k];
        uint32_t limits = 0;
        uint32_t faults;
        int32_t coded;
        if (k == 0 || k == GOLDEN_AGAIN) {
            golden_watch_par(&par, &r, rate_Hz);
            CHECK_EQ_I64(exh_motion_setup(&cfg, &par, golden_period(rate_Hz, k)), 0);
            s = (struct exh_motion){0, 0, 0};
        }
        if (golden_draw(&r, 0, 15) == 0) { stands ^= 1; }
        if (golden_draw(&r, 0, 15) == 0) { fast ^= 1; }
        vel = fast ? (vel < 0 ? INT32_MIN : INT32_MAX) : vel >> 8;
        if (!stands) { cnt = exh_wrap_add(cnt, (int32_t)golden_draw(&r, -2, 2)); }
        coded = par.stuck_cur_A_q26 + (int32_t)golden_draw(&r, -1, stands ? 31 : 1);
        golden_put(g, vel);
        golden_put(g, cnt);
        golden_put(g, coded);
        faults = exh_motion_step(&s, &cfg, &vel, &limits);
        exh_motion_update(&s, &cfg, cnt, coded);
        golden_put(g, faults);
        golden_put(g, vel);
        golden_put(g, limits);
        GOLDEN_STATE(g, exh_motion_serialize, &s);
        golden_tick(g);
    }
}
