/* SPDX-License-Identifier: MIT */
#include "box/guard.h"

static double newton(int32_t raw) { return (double)raw / (1 << EXH_Q_FORCE); }

void guard_start(struct guard *g, struct exh_scene_board board)
{
    const struct guarded_par *p =
        (const struct guarded_par *)(const void *)exh_scene_guarded.params->active;
    const double speed_mps = (double)p->drop.watch.speed_mps_q27 / (1 << EXH_Q_VEL);
    const double end_N =
        newton(p->drop.own.kf_NpA_q20) * p->drop.drive.i_peak_A_q26 / (1 << EXH_Q_CUR);
    const double f_max_N = newton(p->drop.drive.f_max_N_q20);
    const struct guard none = {.bound_J = 0};
    *g = none;
    g->T_s = (double)board.T.num / board.T.den;
    g->top_N = f_max_N < end_N ? f_max_N : end_N;
    g->bound_J = g->top_N * speed_mps * g->T_s * (p->passivity.on == 2 ? 2 : 1);
}

void guard_after(struct guard *g)
{
    const struct guarded_signals *s =
        (const struct guarded_signals *)(const void *)exh_scene_signals(&exh_scene_guarded);
    const double out_J = -(double)s->energy_J_q24 / (1 << 24);
    const double is_N = newton(s->drop.f_des_N_q20);
    double was_N = is_N - newton(s->passivity_N_q20);
    if (was_N > g->top_N) { was_N = g->top_N; }
    if (out_J > g->out_J) { g->out_J = out_J; }
    if (!s->drop.c || s->drop.state < EXH_STATE_RUN || s->drop.state > EXH_STATE_LIMIT) { return; }
    g->ticks++;
    g->force_Ns += was_N * g->T_s;
    if (was_N > is_N) {
        g->acted++;
        g->taken_Ns += (was_N - is_N) * g->T_s;
    }
}

static void print_stiffness(FILE *f, double Npm)
{
    if (Npm > 0) {
        fprintf(f, " %10.0f", Npm);
    } else {
        fprintf(f, " %10s", "-");
    }
}

void guard_print(FILE *f, const struct guard_row *row, int rows)
{
    fprintf(f, "\nPassivity, beside the same runs with it only observing. Given out: the most by "
               "which a contact was in\n"
               "debt (off: by outputs in time; on, passivity=2: by the worst that come up to a "
               "tick late). Bound: the work of\n"
               "one tick at the speed limit, of two for late outputs. Taken: share of the force in "
               "contact.\n\n"
               "  rate      k      b | stiffness        off | oscillate   off | given out   bound  "
               "  off |   taken  in ticks\n"
               "    Hz    N/m   Ns/m |       N/m        N/m |                 |        mJ      mJ  "
               "   mJ |       %%         %%\n");
    for (int i = 0; i < rows; i++) {
        const struct guard_row *r = &row[i];
        fprintf(f, "%6.6g %6.6g %6.6g |", r->rate_Hz, r->k_Npm, r->b_Nspm);
        print_stiffness(f, r->on_Npm);
        print_stiffness(f, r->off_Npm);
        fprintf(f, " | %5d/%d %3d/%d | %9.1f %7.1f %6.1f | %7.4f %9.3f\n", r->on_oscillating,
            r->falls, r->off_oscillating, r->falls, 1e3 * r->on.out_J, 1e3 * r->on.bound_J,
            1e3 * r->off.out_J, r->on.force_Ns > 0 ? 100 * r->on.taken_Ns / r->on.force_Ns : 0,
            r->on.ticks ? 100 * (double)r->on.acted / (double)r->on.ticks : 0);
    }
}
