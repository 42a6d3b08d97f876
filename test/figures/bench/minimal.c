/* SPDX-License-Identifier: MIT */
/* The minimal scene, with its constants in sight: they are private to its file, and a
 * copy of them here would go stale. */
#include "minimal/minimal.c"

#include "path.h"

struct exact minimal_exact(void)
{
    const long double full_N = bench_q(knot[1].x, EXH_Q_FORCE);
    return (struct exact){.step_m = bench_q(quad_par.step_m_q42, EXH_Q_STEP),
        .T_s = 1 / (long double)MINIMAL_RATE_HZ,
        .k_Npm = bench_q(contact_par.k_Npm_q10, EXH_Q_K),
        .b_Nspm = bench_q(contact_par.b_Nspm_q20, EXH_Q_B),
        .lim_m = bench_q(wall_m_q30, EXH_Q_POS),
        .f_max_N = bench_q(drive_par.f_max_N_q20, EXH_Q_FORCE),
        .slew_Nps = drive_par.slew_up_Nps,
        .A_per_N = bench_q(knot[1].y, EXH_Q_CUR) / full_N,
        .peak_A = bench_q(drive_par.i_peak_A_q26, EXH_Q_CUR),
        .code_per_A = bench_q(drive_par.dac_rawpA_q16, EXH_Q_DAC),
        .code_zero = drive_par.dac_zero_raw};
}
