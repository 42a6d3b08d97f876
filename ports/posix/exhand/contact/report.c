/* SPDX-License-Identifier: MIT */
/* The experiment as tables. */
#include "contact/bilateral.h"

#include "box/hand_need.h"

#include "exhand/error.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* --- contacts --- */

static void number(FILE *f, int width, int digits, double v, int there)
{
    if (there) {
        fprintf(f, " %*.*f", width, digits, v);
    } else {
        fprintf(f, " %*s", width, "-");
    }
}

void bilateral_print_head(FILE *f)
{
    fprintf(f, "speed    finger   n   contact   speed  settled    rest  offset  F_des    F_mon  "
               "stiffness\n"
               "                            s     m/s    5 %%, ms      ms      mm  max, N  held, N "
               "       N/m\n");
}

/* What was odd about it, or why nothing was felt. */
static void remark(FILE *f, const struct bilateral_contact *c, long refused)
{
    if (c->t_s > 0) {
        if (c->late) { fprintf(f, "  late: %.1f mm inside", 1e3 * c->late_m); }
        fputs(c->nothing ? "  nothing is there" : c->early ? "  early" : "", f);
    } else if (!c->missed) {
        fputs("  nothing in its way", f);
    } else if (c->around) {
        fputs("  missed: it was inside when its plane came, and rested", f);
    } else if (refused > 0) {
        fprintf(f, "  missed: %ld planes refused", refused);
    } else {
        fputs("  missed: no plane in time", f);
    }
    fputc('\n', f);
}

void bilateral_print(FILE *f, const struct bilateral_result *r)
{
    for (int i = 0; i < r->contacts; i++) {
        const struct bilateral_contact *c = &r->contact[i];
        const int there = c->t_s > 0;
        fprintf(f, "%-8s %-7s %3d", r->speed->name, bilateral_finger_name[r->finger], c->approach);
        number(f, 9, 4, c->t_s, there);
        number(f, 7, 3, c->speed_mps, there);
        number(f, 8, 1, 1e3 * c->settle_s, c->settle_s >= 0);
        number(f, 8, 1, 1e3 * c->rest_s, c->rest_s >= 0);
        number(f, 7, 2, 1e3 * c->off_m, there && !isnan(c->off_m));
        number(f, 6, 2, c->f_max_N, 1);
        number(f, 8, 2, c->held_N, there);
        number(f, 10, 0, c->stiffness_Npm, c->stiffness_Npm > 0);
        remark(f, c, r->refused);
    }
}

/* A figure with its interval, and r2 where it has one. */
struct figure {
    double is, lo, hi, r2;
};

/* paper: 0 where it measured no such thing. */
static void beside(
    FILE *f, const char *what, struct figure ours, double paper, const char *unit, int digits)
{
    fprintf(f, "  %-34s", what);
    number(f, 9, digits, ours.is, ours.is > 0);
    fprintf(f, "%s%s", unit[0] ? " " : "", unit);
    if (ours.is > 0 && ours.hi > 0) {
        fprintf(f, ", 95 %% %.*f..%.*f", digits, ours.lo, digits, ours.hi);
    }
    if (ours.is > 0 && ours.r2 > 0) { fprintf(f, ", r2 %.2f", ours.r2); }
    if (paper > 0) { fprintf(f, "; paper %.*f", digits, paper); }
    fputc('\n', f);
}

/* The paper's wall is flat, hard, rendered at these gains and this rate. */
static int is_papers_wall(const struct bilateral_options *o)
{
    return o->scene == NULL && o->udp == NULL && o->run.rate_Hz == PAPER_RATE_HZ &&
           o->run.k_Npm == PAPER_K_NPM && o->run.b_Nspm == PAPER_B_NSPM;
}

/* Its figures are of one speed. */
static int is_papers_run(const struct bilateral_options *o, const struct bilateral_result *r)
{
    return is_papers_wall(o) && o->record == NULL && r->speed->mps == sim_path_speed("natural");
}

static int seeds_of(const struct bilateral_options *o)
{
    return o->udp || o->record ? 1 : (int)o->seeds;
}

static void print_local(FILE *f, const struct bilateral_options *o, const struct table2_runs *local)
{
    fputc('\n', f);
    if (local->b_Npm <= 0) { return; }
    fprintf(f,
        "Local: median of %d runs of ten falls of 0.5 kg, same rate and gains: %.0f N/m,\n"
        "95 %% %.0f..%.0f over the wall's positions",
        local->runs, local->b_Npm, local->low_Npm, local->high_Npm);
    if (is_papers_wall(o)) { fprintf(f, " (paper %.0f)", PAPER_LOCAL_NPM); }
    fprintf(f, ".\n");
}

void bilateral_print_paper(FILE *f, const struct bilateral_options *o,
    const struct bilateral_result *r, int n, const struct table2_runs *local)
{
    for (int i = 0; i < n; i++) {
        const int same = is_papers_run(o, &r[i]);
        const struct bilateral_count *c = &r[i].count;
        const struct bilateral_line *l = &c->line;
        fprintf(f,
            "\n%s, %s: %d approaches of %d seed%s, %d missed, %d early, %d late, %d settled\n",
            r[i].speed->name, bilateral_finger_name[r[i].finger], c->contacts, seeds_of(o),
            seeds_of(o) > 1 ? "s" : "", c->missed, c->early, c->late, c->settled);
        beside(f, "settled within 5 % of F_mon held",
            (struct figure){1e3 * c->settle_s, 1e3 * c->settle_lo_s, 1e3 * c->settle_hi_s, 0},
            same * 1e3 * PAPER_SETTLING_S, "ms", 1);
        beside(f, "stiffness, all approaches",
            (struct figure){l->k_Npm, l->lo_Npm, l->hi_Npm, l->r2}, same * PAPER_STIFFNESS_NPM,
            "N/m", 0);
        if (local->b_Npm <= 0) { continue; }
        beside(f, "bilateral / local stiffness", (struct figure){l->k_Npm / local->b_Npm, 0, 0, 0},
            same * PAPER_STIFFNESS_NPM / PAPER_LOCAL_NPM, "", 3);
    }
    print_local(f, o, local);
    fprintf(f,
        "settled: F_mon stays within 5 %% of its mean over the last 0.2 s of the hold; rest: "
        "position\n"
        "within 0.2 mm and F_mon within 1.5 N of it. offset: q_lim minus the string at which "
        "pad and\n"
        "object touch. No data of a hand in this device exist: finger and hand are guesses, "
        "and the\n"
        "spread over them is wider than the distance to the paper.\n");
}

void bilateral_csv_head(FILE *f)
{
    fprintf(f,
        "speed,finger,approach,t_s,speed_m_per_s,settle_s,rest_s,place_m,f_des_max_n,f_mon_held_n,"
        "stiffness_n_per_m,frozen,missed,early,late_m\n");
}

static void cell(FILE *f, double v, int there)
{
    fputc(',', f);
    if (there) { fprintf(f, "%.9g", v); }
}

void bilateral_csv(FILE *f, const struct bilateral_result *r)
{
    for (int i = 0; i < r->contacts; i++) {
        const struct bilateral_contact *c = &r->contact[i];
        const int there = c->t_s > 0;
        fprintf(f, "%s,%s,%d", r->speed->name, bilateral_finger_name[r->finger], c->approach);
        cell(f, c->t_s, there);
        cell(f, c->speed_mps, there);
        cell(f, c->settle_s, c->settle_s >= 0);
        cell(f, c->rest_s, c->rest_s >= 0);
        cell(f, c->off_m, there && !isnan(c->off_m));
        cell(f, c->f_max_N, 1);
        cell(f, c->held_N, there);
        cell(f, c->stiffness_Npm, c->stiffness_Npm > 0);
        fprintf(f, ",%d,%d,%d", c->frozen, c->missed, c->early);
        cell(f, c->late_m, c->late);
        fputc('\n', f);
    }
}

/* --- d_lim --- */

/* Parameters as the scene has them after the run. */
static const struct bilateral_par *par(void)
{
    return (const struct bilateral_par *)(const void *)exh_scene_bilateral.params->active;
}

void bilateral_print_advice(
    FILE *f, const struct bilateral_options *o, const struct bilateral_result *r, int n)
{
    for (int i = 0; i < n; i++) {
        const struct exh_period T = {1, o->run.rate_Hz};
        const int32_t d_lim = par()->precontact[r[i].finger].d_lim_m_q30;
        const double fastest = r[i].speed->mps * (1 + o->run.board.exo.path[r[i].finger].vary);
        const struct exh_precontact_need need = hand_need(&o->run, r[i].scale, fastest);
        struct exh_precontact_advice a;
        if (exh_precontact_advise(&a, &need, T, d_lim) < 0) { continue; }
        fprintf(f,
            "%sd_lim %.2f mm, %s at %.2f m/s: %s %.2f mm (fingertip %.2f m/s, lag %.2f ms, "
            "noise %.2f mm)\n",
            i ? "" : "\n", ldexp(1e3 * d_lim, -30), bilateral_finger_name[r[i].finger], fastest,
            d_lim <= a.d_lim_m_q30 ? "enough; wanted" : "TOO SMALL: make it",
            floor(ldexp(1e5 * a.d_lim_m_q30, -30)) / 100, ldexp(need.speed_mps_q27, -27),
            need.lag_us / 1e3, ldexp(1e3 * need.noise_m_q30, -30));
    }
}
