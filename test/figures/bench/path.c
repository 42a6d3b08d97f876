/* SPDX-License-Identifier: MIT */
#include "path.h"

#include <string.h>

struct drop_par path_par;
struct drop_cfg path_cfg;

void path_setup(void)
{
    const struct exh_scene_board board = {{1, 2000}, 24};
    exh_scene_drop.defaults();
    memcpy(&path_par, exh_scene_drop.params->active, sizeof path_par);
    path_par.contact.k_Npm_q10 = EXH_Q(19973, 10, EXH_Q_K);
    path_par.contact.b_Nspm_q20 = EXH_Q(617, 100, EXH_Q_B);
    path_par.own.q_lim_m_q30 = EXH_Q(62413, 1000000, EXH_Q_POS);
    path_par.calib.uncalibrated = 1;
    EXH_ASSERT(drop_setup(&path_cfg, &path_par, board, NULL) == 0);
    bench_seed();
}

int32_t path_cnt(uint32_t i)
{
    const int64_t at = i % 1024;
    return (int32_t)(4 * 1056 * at * (1024 - at) / (1024 * 1024));
}

struct exh_contact_in path_in(uint32_t i)
{
    const int64_t at = i % 1024;
    /* 1056 counts of 66.32 um: q = 0.28 u (1-u) m, u = at/1024 over 0.512 s. */
    const int64_t top_q30 = EXH_Q(280, 1000, EXH_Q_POS);
    const int64_t slope_q27 = EXH_Q(280 * 1000, 512 * 1000, EXH_Q_VEL);
    return (struct exh_contact_in){(int32_t)(top_q30 * at * (1024 - at) >> 20),
        (int32_t)(slope_q27 * (1024 - 2 * at) / 1024), path_par.own.q_lim_m_q30};
}
