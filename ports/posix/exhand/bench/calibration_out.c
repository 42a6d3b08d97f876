/* SPDX-License-Identifier: MIT */
/* The results of a calibration: lines through its points, tables for people and as CSV. */
#include "bench/calibration.h"

#include "exhand/error.h"

#include <string.h>

static double si(int32_t raw, int frac) { return (double)raw / (double)(INT64_C(1) << frac); }

int calibration_lines(const struct exh_calib *c, struct calibration_lines *l)
{
    struct exh_knot knot[EXH_CALIB_POINTS_MAX + 2];
    struct exh_table cur_to_force = {knot, 0};
    int n;
    memset(l, 0, sizeof *l);
    n = exh_calib_fit(&l->cur, c->point, c->points, EXH_CALIB_CURRENT);
    if (n == 0) { n = exh_calib_fit(&l->mon, c->point, c->points, EXH_CALIB_MONITOR); }
    if (n == 0) { n = exh_calib_force_table(c, knot, EXH_CALIB_POINTS_MAX + 2, NULL); }
    if (n < 0) { return n; }
    for (int i = 0; i < c->points; i++) {
        const double r =
            si(exh_calib_residual_N_q20(&l->cur, &c->point[i], EXH_CALIB_CURRENT), EXH_Q_FORCE);
        const double m =
            si(exh_calib_residual_N_q20(&l->mon, &c->point[i], EXH_CALIB_MONITOR), EXH_Q_FORCE);
        if ((r < 0 ? -r : r) > l->cur_worst_N) { l->cur_worst_N = r < 0 ? -r : r; }
        if ((m < 0 ? -m : m) > l->mon_worst_N) { l->mon_worst_N = m < 0 ? -m : m; }
    }
    cur_to_force.n = (uint8_t)n;
    n = exh_table_invert(knot, knot, (unsigned)n);
    if (n == 0) { l->f0_N = si(exh_table_at(cur_to_force, c->f0_A_q26), EXH_Q_FORCE); }
    return n;
}

struct point_si {
    double force_N, cur_A, mon_A, friction_N, cur_off_N, mon_off_N;
};

static struct point_si point_si(const struct exh_calib *c, const struct calibration_lines *l, int i)
{
    const struct exh_calib_point *p = &c->point[i];
    return (struct point_si){si(p->force_N_q20, EXH_Q_FORCE), si(p->cur_A_q26, EXH_Q_CUR),
        si(p->mon_A_q26, EXH_Q_CUR),
        si(p->friction_A_q26, EXH_Q_CUR) * si(l->cur.kf_NpA_q20, EXH_Q_FORCE),
        si(exh_calib_residual_N_q20(&l->cur, p, EXH_CALIB_CURRENT), EXH_Q_FORCE),
        si(exh_calib_residual_N_q20(&l->mon, p, EXH_CALIB_MONITOR), EXH_Q_FORCE)};
}

void calibration_print(FILE *f, const struct exh_calib *c, const struct calibration_lines *l)
{
    fprintf(f, "\n   force   current   residual   monitored   residual   friction\n"
               "       N         A         mN           A         mN          N\n");
    for (int i = 0; i < c->points; i++) {
        const struct point_si p = point_si(c, l, i);
        fprintf(f, "%8.4f %9.4f %10.1f %11.4f %10.1f %10.3f\n", p.force_N, p.cur_A,
            p.cur_off_N * 1e3, p.mon_A, p.mon_off_N * 1e3, p.friction_N);
    }
    fprintf(f,
        "\nforce over current %.4f N/A (worst residual %.1f mN), over monitored current %.4f N/A "
        "(%.1f mN)\n",
        si(l->cur.kf_NpA_q20, EXH_Q_FORCE), l->cur_worst_N * 1e3,
        si(l->mon.kf_NpA_q20, EXH_Q_FORCE), l->mon_worst_N * 1e3);
    fprintf(f, "F0 %.1f mA = %.3f N\n", si(c->f0_A_q26, EXH_Q_CUR) * 1e3, l->f0_N);
    if (c->points > 0 && c->end_A_q26 > c->point[c->points - 1].cur_A_q26) {
        fprintf(f, "the tables go straight on from %.3f A to %.3f A: not measured there\n",
            si(c->point[c->points - 1].cur_A_q26, EXH_Q_CUR), si(c->end_A_q26, EXH_Q_CUR));
    }
}

void calibration_csv(FILE *f, const struct exh_calib *c, const struct calibration_lines *l)
{
    fprintf(f, "force_n,current_a,monitored_a,friction_n,residual_current_n,residual_monitor_n\n");
    for (int i = 0; i < c->points; i++) {
        const struct point_si p = point_si(c, l, i);
        fprintf(f, "%.7f,%.8f,%.8f,%.7f,%.7f,%.7f\n", p.force_N, p.cur_A, p.mon_A, p.friction_N,
            p.cur_off_N, p.mon_off_N);
    }
}

int calibration_table_csv(FILE *f, const struct exh_calib *c)
{
    struct exh_knot cur[EXH_CALIB_POINTS_MAX + 2], mon[2 * EXH_CALIB_POINTS_MAX + 3];
    const int n = exh_calib_force_table(c, cur, EXH_CALIB_POINTS_MAX + 2, NULL);
    const int m = exh_calib_monitor_table(c, mon, 2 * EXH_CALIB_POINTS_MAX + 3, NULL);
    if (n < 0 || m < 0) { return n < 0 ? n : m; }
    fprintf(f, "current_a,force_n,monitored_a,force_monitored_n\n");
    for (int i = 0; i < n; i++) { /* the monitor's from its middle on: it is odd */
        const struct exh_knot *k = &mon[m / 2 + i];
        fprintf(f, "%.8f,%.7f,%.8f,%.7f\n", si(cur[i].y, EXH_Q_CUR), si(cur[i].x, EXH_Q_FORCE),
            si(k->x, EXH_Q_CUR), si(k->y, EXH_Q_FORCE));
    }
    return 0;
}
