/* SPDX-License-Identifier: MIT */
/* The minimal scene with its constants and state in sight. */
#include "scenes.h"

#include "minimal/minimal.c"

int32_t minimal_force_N_q20(void) { return s.drive.force_N_q20; }

void minimal_par(struct pipe_wall_par *p, long double *lim_m)
{
    p->step_m = bench_q(quad_par.step_m_q42, EXH_Q_STEP);
    p->window = 1 << vel_par.p;
    p->speed_mps = 1000;
    p->k_Npm = bench_q(contact_par.k_Npm_q10, EXH_Q_K);
    p->b_Nspm = bench_q(contact_par.b_Nspm_q20, EXH_Q_B);
    p->f_max_N = bench_q(drive_par.f_max_N_q20, EXH_Q_FORCE);
    p->up_Nps = drive_par.slew_up_Nps;
    p->down_Nps = drive_par.slew_down_Nps;
    *lim_m = bench_q(wall_m_q30, EXH_Q_POS);
}

void minimal_now(struct pipe_wall_now *now)
{
    now->turn_m = 0; /* its law remembers nothing */
    now->inward = now->touching = 0;
    now->force_N = bench_q(s.drive.force_N_q20, EXH_Q_FORCE);
}
