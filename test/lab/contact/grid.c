/* SPDX-License-Identifier: MIT */
/* exhand-lab bilateral --hands and --crisp: the experiment over fingers and hands, and over k and
 * b. */
#include "lab/contact/hands.h"
#include "lab/contact/studies.h"

#include "base/option.h"
#include "base/outfile.h"

#include <stdlib.h>
#include <string.h>

#define KEEP      64     /* contacts of a cell */
#define HALF_MS   0.5e-3 /* "approximately 25 ms" */
#define CRISP_MPS 0.2    /* faster, and the drive's limit is what is felt, not k and b */

struct cell {
    double at[3];                                       /* mass, hand_k, hand_b; or k, b */
    int done, contacts, settled, rested, missed, quick; /* quick: at rest in the paper's time */
    double settle_s, rest_s, stiffness_Npm, rise_per_mps, speed_mps; /* medians; stiffness of all */
    double quickest_s;                                               /* to rest */
};

static int by_size(const void *a, const void *b)
{
    const double d = *(const double *)a - *(const double *)b;
    return d < 0 ? -1 : d > 0;
}

static double median(double *v, int n)
{
    qsort(v, (size_t)n, sizeof *v, by_size);
    return n ? v[n / 2] : 0;
}

static void measure(const struct bilateral_run_cfg *c, struct cell *to)
{
    static struct bilateral_contact contact[KEEP];
    double settle[KEEP], rest[KEEP], rise[KEEP], speed[KEEP];
    struct bilateral_run r;
    unsigned f = 0;
    int n;
    while (!(c->board.exo.fingers >> f & 1)) { f++; }
    if (bilateral_run(c, &r) < 0) {
        bilateral_run_free(&r);
        return;
    }
    to->done = !posix_interrupted();
    n = bilateral_judge(&r, f, contact, KEEP);
    for (int i = 0; i < n && i < KEEP; i++) {
        const struct bilateral_contact *k = &contact[i];
        to->missed += k->missed;
        if (k->t_s <= 0 || k->speed_mps <= 0) { continue; }
        rise[to->contacts] = k->rise_Nps / k->speed_mps;
        speed[to->contacts++] = k->speed_mps;
        if (k->settle_s >= 0) { settle[to->settled++] = k->settle_s; }
        if (k->rest_s >= 0) { rest[to->rested++] = k->rest_s; }
        to->quick += k->rest_s >= 0 && k->rest_s <= PAPER_SETTLING_S + HALF_MS;
    }
    to->settle_s = median(settle, to->settled);
    to->rest_s = median(rest, to->rested);
    to->quickest_s = to->rested ? rest[0] : 0; /* sorted now */
    to->rise_per_mps = median(rise, to->contacts);
    to->speed_mps = median(speed, to->contacts);
    to->stiffness_Npm = bilateral_stiffness(&r, f, 0, NULL).k_Npm;
    bilateral_run_free(&r);
}

/* At the speed of the options, if there is one. */
static double speed_of(const struct bilateral_options *o, double otherwise_mps)
{
    return o->speeds == 1 ? o->speed[0].mps : otherwise_mps;
}

static struct bilateral_run_cfg base(const struct bilateral_options *o, double otherwise_mps)
{
    struct bilateral_run_cfg c = bilateral_at_speed(o, speed_of(o, otherwise_mps));
    unsigned f = 0;
    while (!(c.board.exo.fingers >> f & 1)) { f++; }
    c.board.exo.fingers = 1u << f;
    c.keep = 1;
    if (o->approaches > KEEP) { c.board.exo.path[f].approaches = KEEP; }
    return c;
}

static int run_cells(struct cell *cell, int n, void (*work)(const void *, int, void *),
    const struct bilateral_options *o)
{
    const struct jobs jobs = {
        n, (int)o->jobs, sizeof *cell, cell, work, o, "cells", posix_interrupt};
    int err = jobs_run(&jobs);
    for (int i = 0; err == 0 && i < n; i++) { err = !cell[i].done; }
    return err;
}

/* --- hands --- */

#define NEAR 0.25 /* of the paper's stiffness */

static void work_hands(const void *ctx, int i, void *result)
{
    struct bilateral_run_cfg c = base(ctx, sim_path_speed("natural"));
    struct cell *to = result;
    memset(to, 0, sizeof *to);
    lab_hand(&c, i, to->at);
    measure(&c, to);
}

static void print_ms(double s, int there)
{
    if (there) {
        printf(" %8.1f", 1e3 * s);
    } else {
        printf(" %8s", "-");
    }
}

static int has_line(const struct cell *c) { return c->stiffness_Npm > 0; }

static int is_near(const struct cell *c)
{
    return c->stiffness_Npm >= (1 - NEAR) * PAPER_STIFFNESS_NPM &&
           c->stiffness_Npm <= (1 + NEAR) * PAPER_STIFFNESS_NPM;
}

static void say_hands(const struct cell *cell)
{
    double rest[HANDS], stiff[HANDS];
    int rests = 0, stiffs = 0, quick = 0, near = 0, contacts = 0, rested = 0, both = 0, half = 0;
    for (int i = 0; i < HANDS; i++) {
        if (cell[i].rested) { rest[rests++] = cell[i].rest_s; }
        if (has_line(&cell[i])) { stiff[stiffs++] = cell[i].stiffness_Npm; }
        contacts += cell[i].contacts;
        rested += cell[i].rested;
        quick += cell[i].quick;
        near += is_near(&cell[i]);
        both += is_near(&cell[i]) && cell[i].quick > 0;
        half += cell[i].contacts > 0 && 2 * cell[i].quick >= cell[i].contacts;
    }
    if (rests == 0 || stiffs == 0) { return; }
    (void)median(rest, rests);
    (void)median(stiff, stiffs);
    printf("\nrest, median of a hand: %.0f .. %.0f ms, half of them by %.0f; paper 25 ms\n"
           "contacts: %d, at rest before the end of the hold %d, in 25 ms %d; hands with one such "
           "contact and within\n"
           "%.0f %% of the paper's stiffness %d, with half of their contacts in 25 ms %d\n"
           "stiffness: %.0f .. %.0f N/m, median %.0f, %d of %d with a line, %d within %.0f %% of "
           "the paper's 41250 N/m\n",
        1e3 * rest[0], 1e3 * rest[rests - 1], 1e3 * rest[rests / 2], contacts, rested, quick,
        100 * NEAR, both, half, stiff[0], stiff[stiffs - 1], stiff[stiffs / 2], stiffs, HANDS, near,
        100 * NEAR);
}

static int leave(const struct bilateral_options *o, const struct cell *cell, int n,
    const char *name, const char *columns, int at)
{
    char file[64];
    FILE *f, *g;
    snprintf(file, sizeof file, "%s.csv", name);
    f = bilateral_out_file(o->out, file);
    snprintf(file, sizeof file, "%s.gp", name);
    g = f ? bilateral_out_file(o->out, file) : NULL;
    if (g == NULL) {
        outfile_abandon(f);
        return 1;
    }
    fprintf(f,
        "%s,contacts,settled,rested,settle_s,rest_s,stiffness_n_per_m,rise_n_per_m,speed_m_per_"
        "s,quick,quickest_s\n",
        columns);
    for (int i = 0; i < n; i++) {
        const struct cell *c = &cell[i];
        for (int k = 0; k < at; k++) { fprintf(f, "%.9g,", c->at[k]); }
        fprintf(f, "%d,%d,%d,", c->contacts, c->settled, c->rested);
        if (c->settled) { fprintf(f, "%.9g", c->settle_s); }
        fputc(',', f);
        if (c->rested) { fprintf(f, "%.9g", c->rest_s); }
        fputc(',', f);
        if (c->stiffness_Npm > 0) { fprintf(f, "%.9g", c->stiffness_Npm); }
        fprintf(f, ",%.9g,%.9g,%d,", c->rise_per_mps, c->speed_mps, c->quick);
        if (c->rested) { fprintf(f, "%.9g", c->quickest_s); }
        fputc('\n', f);
    }
    fprintf(g,
        "# Made by exhand bilateral --%s: gnuplot -c %s.gp PLOTS\nplots=ARG1\ndata='%s.csv'\n"
        "k='%.6g'; b='%.6g'; speed='%.3g'\nload plots.'/bilateral_%s.gp'\n",
        name, name, name, o->run.k_Npm, o->run.b_Nspm,
        speed_of(o, at == 3 ? sim_path_speed("natural") : CRISP_MPS), name);
    return outfile_close(f) | outfile_close(g);
}

int bilateral_hands(const struct bilateral_options *o)
{
    static struct cell cell[HANDS];
    const int err = run_cells(cell, HANDS, work_hands, o);
    if (err) { return err; }
    printf("finger   hand K   hand B  contacts  settled, ms  rest, ms  quickest, ms  came to rest  "
           "in 25 ms  stiffness\n"
           "    kg      N/m     Ns/m                                                               "
           "              N/m\n");
    for (int i = 0; i < HANDS; i++) {
        const struct cell *c = &cell[i];
        printf("%6.2f %8.0f %8.0f %9d    ", c->at[0], c->at[1], c->at[2], c->contacts);
        print_ms(c->settle_s, c->settled > 0);
        print_ms(c->rest_s, c->rested > 0);
        printf("     ");
        print_ms(c->quickest_s, c->rested > 0);
        printf(" %7d of %-3d %9d", c->rested, c->contacts, c->quick);
        if (has_line(c)) { printf(" %10.0f", c->stiffness_Npm); }
        printf("\n");
    }
    say_hands(cell);
    return o->out ? leave(o, cell, HANDS, "hands", "mass_kg,hand_k_n_per_m,hand_b_ns_per_m", 3) : 0;
}

/* --- crispness --- */

#define COLUMNS 13
#define ROWS    11
#define K_TOP   36000.0
#define B_TOP   100.0

static void work_crisp(const void *ctx, int i, void *result)
{
    struct bilateral_run_cfg c = base(ctx, CRISP_MPS);
    struct cell *to = result;
    memset(to, 0, sizeof *to);
    c.k_Npm = to->at[0] = i % COLUMNS ? K_TOP * (i % COLUMNS) / (COLUMNS - 1) : 500;
    c.b_Nspm = to->at[1] = B_TOP * (i / COLUMNS) / (ROWS - 1);
    measure(&c, to);
}

int bilateral_crisp(const struct bilateral_options *o)
{
    static struct cell cell[COLUMNS * ROWS];
    const int err = run_cells(cell, COLUMNS * ROWS, work_crisp, o);
    if (err) { return err; }
    printf("Crispness: steepest millisecond of F_mon in the first three of a contact, per speed, "
           "kN/m; () did\n"
           "not always come to rest.\n\n  b, Ns/m \\ k, kN/m\n       ");
    for (int k = 0; k < COLUMNS; k++) { printf(" %6.1f", cell[k].at[0] / 1e3); }
    printf("\n");
    for (int b = ROWS - 1; b >= 0; b--) {
        printf("%6.0f ", cell[b * COLUMNS].at[1]);
        for (int k = 0; k < COLUMNS; k++) {
            const struct cell *c = &cell[b * COLUMNS + k];
            const int rests = c->contacts > 0 && c->rested == c->contacts;
            printf(rests ? " %5.1f " : " (%4.1f)", c->rise_per_mps / 1e3);
        }
        printf("\n");
    }
    return o->out ? leave(o, cell, COLUMNS * ROWS, "crisp", "k_n_per_m,b_ns_per_m", 2) : 0;
}
