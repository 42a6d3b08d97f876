/* SPDX-License-Identifier: MIT */
/* What --out leaves behind. */
#include "contact/bilateral.h"

#include "base/outfile.h"

#include <math.h>
#include <string.h>

#define PATH_B 1024
#define GAIN_B 24

static const char *const tables[] = {"contact.png", "force.png", "sweep.png", "contacts.csv",
    "crisp.png", "hands.png", "crisp.csv", "hands.csv", "crisp.gp", "hands.gp", "sweep.csv",
    "bilateral.gp", "sweep.gp"};
#define TABLES (sizeof tables / sizeof tables[0])

static int made[TABLES]; /* by this experiment */

int bilateral_out_open(const char *dir)
{
    char path[PATH_B];
    const struct outfile_option first = {"out", path};
    const int err = outfile_dir(dir, "bilateral_natural_index_raw.csv");
    if (err) { return err; }
    memset(made, 0, sizeof made);
    snprintf(path, sizeof path, "%s/contacts.csv", dir);
    return outfile_try(&first, 1);
}

FILE *bilateral_out_file(const char *dir, const char *name)
{
    for (size_t i = 0; i < TABLES; i++) { made[i] |= strcmp(name, tables[i]) == 0; }
    return outfile_in(dir, name);
}

void bilateral_out_clear(const char *dir)
{
    char path[PATH_B];
    int any = 0;
    for (size_t i = 0; i < TABLES; i++) { any |= made[i]; }
    for (size_t i = 0; any && i < TABLES; i++) {
        if (made[i]) { continue; }
        snprintf(path, sizeof path, "%s/%s", dir, tables[i]);
        (void)remove(path);
    }
}

void bilateral_out_name(
    char *to, size_t cap_B, const char *dir, const char *speed, int finger, const char *suffix)
{
    snprintf(to, cap_B, "%s%sbilateral_%s%s%s%s", dir ? dir : "", dir ? "/" : "", speed,
        finger < 0 ? "" : "_", finger < 0 ? "" : bilateral_finger_name[finger], suffix);
}

/* The paper's nine. */
int bilateral_out_csv(const char *dir, const struct bilateral_run *r, unsigned f, const char *speed)
{
    const struct bilateral_track *t = &r->finger[f];
    char name[PATH_B];
    FILE *to;
    bilateral_out_name(name, sizeof name, NULL, speed, (int)f, ".csv");
    to = bilateral_out_file(dir, name);
    if (to == NULL) { return 1; }
    fprintf(to, "t_s,q_m,qd_m_per_s,f_des_n,i_des_a,c,f_mon_n,d_m,q_lim_m\n");
    for (size_t i = 0; i < t->n; i++) {
        const struct fall_sample s = bilateral_si(&t->at[i], i, r->T);
        const struct bilateral_paper *p = &t->at[i].raw;
        fprintf(to, "%.9f,%.9g,%.9g,%.9g,%.9g,%d,%.9g,", s.t_s, s.q_m, s.qd_mps, s.f_des_N,
            s.i_des_A, s.c, s.f_mon_N);
        if (p->d_m_q30 != INT32_MIN) { fprintf(to, "%.9g", ldexp(p->d_m_q30, -EXH_Q_POS)); }
        fputc(',', to);
        if (p->q_lim_m_q30 != EXH_PRECONTACT_NO_LIM) {
            fprintf(to, "%.9g", ldexp(p->q_lim_m_q30, -EXH_Q_POS));
        }
        fputc('\n', to);
    }
    return outfile_close(to);
}

/* The contact that is shown: the first that was one. */
static const struct bilateral_contact *shown(const struct bilateral_result *r)
{
    for (int i = 0; i < r->contacts; i++) {
        if (r->contact[i].t_s > 0) { return &r->contact[i]; }
    }
    return NULL;
}

/* Empty: below 0 every material has its own. */
static const char *gain(char to[GAIN_B], double value)
{
    to[0] = '\0';
    if (value >= 0) { (void)snprintf(to, GAIN_B, "%.6g", value); }
    return to;
}

static void list(FILE *f, const char *name) { fprintf(f, "'\n%s='", name); }

int bilateral_out_pictures(const char *dir, const struct bilateral_result *r, int n, double k_Npm,
    double b_Nspm, const char *link)
{
    FILE *f = bilateral_out_file(dir, "bilateral.gp");
    char name[PATH_B], text[2][GAIN_B];
    if (f == NULL) { return 1; }
    fprintf(f,
        "# Made by exhand bilateral. Inside this directory, PLOTS the way to "
        "ports/posix/plot:\n"
        "#   gnuplot -c bilateral.gp PLOTS\nplots=ARG1\nk='%s'; b='%s'; link=\"%s\"; names='",
        gain(text[0], k_Npm), gain(text[1], b_Nspm), link);
    for (int i = 0; i < n; i++) { fprintf(f, " %s", r[i].speed->name); }
    list(f, "fingers");
    for (int i = 0; i < n; i++) { fprintf(f, " %s", bilateral_finger_name[r[i].finger]); }
    list(f, "files");
    for (int i = 0; i < n; i++) {
        bilateral_out_name(name, sizeof name, NULL, r[i].speed->name, (int)r[i].finger, "");
        fprintf(f, " %s", name);
    }
    list(f, "contacts");
    for (int i = 0; i < n; i++) { fprintf(f, " %.9g", shown(&r[i]) ? shown(&r[i])->t_s : -1); }
    list(f, "speeds");
    for (int i = 0; i < n; i++) { fprintf(f, " %.3f", shown(&r[i]) ? shown(&r[i])->speed_mps : 0); }
    list(f, "settles");
    for (int i = 0; i < n; i++) {
        fprintf(f, " %.1f",
            shown(&r[i]) && shown(&r[i])->settle_s >= 0 ? 1e3 * shown(&r[i])->settle_s : -1);
    }
    list(f, "stiffnesses");
    for (int i = 0; i < n; i++) { fprintf(f, " %.0f", r[i].drawn_Npm); }
    fprintf(f, "'\nload plots.'/contact.gp'\nload plots.'/bilateral_force.gp'\n");
    return outfile_close(f);
}
