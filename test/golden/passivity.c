/* SPDX-License-Identifier: MIT */
/* passivity: no contact gives back more energy than it was given. */
#include "modules.h"

#include "exhand/fix.h"
#include "exhand/passivity.h"

struct finger {
    struct exh_drive_par drive_par;
    struct exh_passivity_par par;
    struct exh_knot to_cur[3], held[3];
    struct exh_drive_cfg drive;
    struct exh_passivity_cfg cfg;
    struct exh_passivity s;
    int32_t cnt;
    int touching;
};

static void any_tables(struct finger *d, struct golden_rng *r)
{
    for (int i = 1; i < 3; i++) {
        d->to_cur[i].x =
            d->to_cur[i - 1].x + (int32_t)golden_draw(r, INT32_C(1) << 20, INT32_C(1) << 25);
        d->to_cur[i].y =
            d->to_cur[i - 1].y + (int32_t)golden_draw(r, INT32_C(1) << 24, INT32_C(1) << 27);
    }
    CHECK_EQ_I64(exh_table_setup(d->to_cur, 3), 0);
    CHECK_EQ_I64(exh_table_invert(d->held, d->to_cur, 3), 0);
}

static void any_finger(struct finger *d, struct golden_rng *r, uint32_t rate_Hz, uint32_t k)
{
    struct exh_velocity_scale scale;
    int32_t speed;
    (void)memset(d, 0, sizeof *d);
    golden_drive_par(&d->drive_par, r, rate_Hz);
    d->drive_par.slew_down_Nps = 10000000;
    any_tables(d, r);
    scale.step_m_q42 = golden_step(r);
    scale.T = golden_period(rate_Hz, k);
    speed = (int32_t)golden_draw(r, 13421773, 1342177280);
    CHECK_EQ_I64(exh_drive_setup(&d->drive, &d->drive_par, scale.T,
                     (struct exh_table){d->to_cur, 3}, (struct exh_table){NULL, 0}),
        0);
    CHECK_EQ_I64(exh_passivity_setup(
                     &d->cfg, &d->par, &d->drive, (struct exh_table){d->held, 3}, scale, speed),
        0);
    d->cnt = (int32_t)golden_draw(r, INT32_MIN, INT32_MAX);
    d->par.on = 2;
}

static int32_t any_move(struct golden_rng *r, int32_t way)
{
    const int64_t how = golden_draw(r, 0, 15);
    const int64_t near = golden_draw(r, -way, way);
    const int64_t far = golden_draw(r, INT32_MIN, INT32_MAX);
    return (int32_t)(how < 4 ? -way : how < 6 ? way : how < 7 ? 0 : how < 8 ? far : near);
}

static void any_asked(struct exh_force_ledger *f, struct golden_rng *r, int32_t most)
{
    const int64_t how = golden_draw(r, 0, 7);
    const int64_t some = golden_draw(r, -(INT32_C(1) << 20), INT32_C(1) << 27);
    const int64_t any = golden_draw(r, INT32_MIN, INT32_MAX);
    f->spring_N_q20 = how < 1 ? 0 : how < 3 ? most : how < 4 ? any * 2048 : some;
    f->damper_N_q20 = golden_draw(r, -(INT32_C(1) << 22), INT32_C(1) << 22);
}

/* The current of the code: with an error of up to 20000 LSB, now and then 0. */
static int32_t any_coded(const struct finger *d, struct golden_rng *r, int32_t force)
{
    const int64_t off = golden_draw(r, -20000, 20000);
    return golden_draw(r, 0, 31) == 0 ? 0
                                      : exh_sat32(exh_table_at(d->drive.force_to_cur, force) + off);
}

void golden_passivity(struct golden *g, uint32_t rate_Hz)
{
    static struct finger d;
    struct golden_rng r = golden_rng("passivity", rate_Hz, 0);
    while (g->tick < GOLDEN_TICKS) {
        const uint32_t k = g->tick;
        struct exh_force_ledger f = {.force_N_q20 = 0};
        int32_t coded, most;
        uint32_t bit;
        if (k == 0 || k == GOLDEN_AGAIN) { any_finger(&d, &r, rate_Hz, k); }
        if (golden_draw(&r, 0, 9) == 0) { d.par.on = (int32_t)golden_draw(&r, 0, 2); }
        if (golden_draw(&r, 0, 5) == 0) { d.touching = !d.touching; }
        d.cnt = exh_wrap_add(d.cnt, any_move(&r, d.cfg.way_cnt));
        most = d.drive_par.f_max_N_q20 < d.drive.f_top_N_q20 ? d.drive_par.f_max_N_q20
                                                             : d.drive.f_top_N_q20;
        any_asked(&f, &r, most);
        if (!d.touching) { f.spring_N_q20 = f.damper_N_q20 = 0; }
        f.pullback_N_q20 = golden_draw(&r, 0, 3) == 0 ? golden_draw(&r, 0, 20971520) : 0;
        bit = exh_passivity_step(&d.s, &d.cfg, d.cnt, d.touching, &f);
        f.force_N_q20 = exh_clamp(
            f.spring_N_q20 + f.damper_N_q20 + f.pullback_N_q20 + f.passivity_N_q20, 0, most);
        coded = any_coded(&d, &r, f.force_N_q20);
        exh_passivity_update(&d.s, &d.cfg, &f, coded);
        golden_put(g, d.par.on);
        golden_put(g, d.cnt);
        golden_put(g, d.touching);
        golden_put(g, f.spring_N_q20);
        golden_put(g, f.damper_N_q20);
        golden_put(g, f.pullback_N_q20);
        golden_put(g, coded);
        golden_put(g, bit);
        golden_put(g, f.passivity_N_q20);
        golden_put(g, exh_passivity_J_q24(&d.s, &d.cfg));
        golden_put(g, d.s.held_N_q20);
        golden_put(g, d.s.late_N_q20);
        GOLDEN_STATE(g, exh_passivity_serialize, &d.s);
        golden_tick(g);
    }
}
