/* SPDX-License-Identifier: MIT */
/* Passivity: one finger's tick, and its limit against the exact one. */
#include "path.h"

#include "exhand/passivity.h"

#define CASES 300000

static struct exh_passivity_par par = {2};
static struct exh_passivity_cfg cfg;
static struct exh_passivity state;
static struct exh_force_ledger ledger;
static struct exh_knot held[2];

static void start(void)
{
    struct exh_velocity_scale scale = {0, {1, 2000}};
    path_setup();
    scale.step_m_q42 = path_par.quad.step_m_q42;
    state = (struct exh_passivity){0, 0, 0, 0, 0, 0};
    ledger = (struct exh_force_ledger){.spring_N_q20 = 20 << EXH_Q_FORCE};
    EXH_ASSERT(exh_table_invert(held, path_cfg.calib.force_to_cur, 2) == 0);
    EXH_ASSERT(exh_passivity_setup(&cfg, &par, &path_cfg.drive, (struct exh_table){held, 2}, scale,
                   EXH_Q(3, 1, EXH_Q_VEL)) == 0);
}

/* In and out of a wall half-way, at 1.5 A. */
static void op(uint32_t i)
{
    const int32_t cnt = path_cnt(i);
    ledger.passivity_N_q20 = 0;
    bench_sink = exh_passivity_step(&state, &cfg, cnt, cnt > 528, &ledger);
    ledger.force_N_q20 = 5 << EXH_Q_FORCE;
    exh_passivity_update(&state, &cfg, &ledger, 3 << (EXH_Q_CUR - 1));
}

/* The limit; of what is not limited, nothing. */
static void error(struct error *e)
{
    int32_t most;
    start();
    most =
        path_par.drive.f_max_N_q20 < cfg.f_top_N_q20 ? path_par.drive.f_max_N_q20 : cfg.f_top_N_q20;
    for (int i = 0; i < CASES; i++) {
        const int64_t owed = (int64_t)(bench_u64() % (uint64_t)(2 * (int64_t)most * cfg.way_cnt));
        long double want = (long double)most - (long double)owed / cfg.way_cnt;
        ledger = (struct exh_force_ledger){.spring_N_q20 = INT64_C(1) << 40};
        state = (struct exh_passivity){-owed - 1, 0, 0, 0, 1, 1};
        (void)exh_passivity_step(&state, &cfg, 0, 1, &ledger);
        want -= (long double)1 / cfg.way_cnt;
        error_add(e, (long double)(ledger.spring_N_q20 + ledger.passivity_N_q20) -
                         bench_clamp(want, 0, most));
    }
}

static const struct kernel kernels[] = {
    {"passivity", "N", 1.0 / (1 << EXH_Q_FORCE), 3, 1, start, op, error,
        "passivity.h; energy owed, 0 to twice what may be", 0, NULL},
};
const struct kernel_group passivity_group = {kernels, sizeof kernels / sizeof kernels[0]};
