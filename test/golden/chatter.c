/* SPDX-License-Identifier: MIT */
/* chatter: a contact that buzzes, and drives the string. */
#include "modules.h"

#include "exhand/chatter.h"
#include "exhand/fix.h"

void golden_chatter_par(struct exh_chatter_par *p, struct golden_rng *r)
{
    int64_t any = golden_draw(r, 0, 10475274);
    p->power_W_q20 = 10486 + (int32_t)(any >> golden_draw(r, 0, 12));
    any = golden_draw(r, 0, 16760438);
    p->energy_J_q24 = 16778 + (int32_t)(any >> golden_draw(r, 0, 12));
    if (golden_draw(r, 0, 7) == 0) { p->energy_J_q24 = 0; }
}

static void any_cfg(struct exh_chatter_cfg *cfg, struct golden_rng *r, struct exh_period T)
{
    struct exh_knot knot[2] = {{0, 0, {0, 0}}, {0, 0, {0, 0}}};
    struct exh_drive_cfg drive;
    struct exh_velocity_scale scale;
    struct exh_chatter_par par;
    knot[1].x = (int32_t)golden_draw(r, INT32_C(1) << 24, 104857600);
    knot[1].y = (int32_t)golden_draw(r, INT32_C(1) << 24, INT32_C(1) << 27);
    (void)memset(&drive, 0, sizeof drive);
    drive.force_to_cur = (struct exh_table){knot, 2};
    scale.step_m_q42 = golden_step(r);
    scale.T = T;
    golden_chatter_par(&par, r);
    CHECK_EQ_I64(exh_chatter_setup(cfg, &par, &drive, scale), 0);
}

void golden_chatter(struct golden *g, uint32_t rate_Hz)
{
    struct golden_rng r = golden_rng("chatter", rate_Hz, 0);
    struct exh_chatter_cfg cfg = {0, 0, 0};
    struct exh_chatter s = {0, 0, 0, 0, 0, 0, 0};
    int32_t cnt = 0, coded = 0, inward = 1;
    while (g->tick < GOLDEN_TICKS) {
        int64_t how, move;
        if (g->tick == 0 || g->tick == GOLDEN_AGAIN) {
            any_cfg(&cfg, &r, golden_period(rate_Hz, g->tick));
            (void)memset(&s, 0, sizeof s);
            cnt = (int32_t)golden_draw(&r, INT32_MIN, INT32_MAX);
            coded = 0;
            inward = 1;
        }
        how = golden_draw(&r, 0, 31);
        if (how == 0) { inward = 1 - inward; }
        if (golden_draw(&r, 0, 1)) {
            const int64_t any = golden_draw(&r, 0, 442918502);
            coded = (int32_t)(any >> golden_draw(&r, 0, 12));
        }
        move = golden_draw(&r, INT32_MIN, INT32_MAX);
        if (how != 1) { move >>= 20; }
        if (how != 1 && inward && move > 0) { move = -move; }
        cnt = exh_wrap_add(cnt, (int32_t)move);
        golden_put(g, cnt);
        golden_put(g, coded);
        golden_put(g, exh_chatter_step(&s, &cfg));
        exh_chatter_update(&s, &cfg, cnt, coded);
        golden_put(g, s.net_Acnt_q20 >> 32);
        golden_put(g, s.cycle_Acnt_q20 >> 32);
        golden_put(g, s.ticks);
        GOLDEN_STATE(g, exh_chatter_serialize, &s);
        golden_tick(g);
    }
}
