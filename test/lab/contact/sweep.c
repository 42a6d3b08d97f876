/* SPDX-License-Identifier: MIT */
/* exhand-lab bilateral --sweep: what is felt over delay, jitter and loss. */
#include "lab/contact/studies.h"

#include "base/option.h"
#include "base/outfile.h"

#include <stdlib.h>
#include <string.h>

#define DELAYS  12
#define JITTERS 3
#define LOSSES  4
#define CELLS   (DELAYS * JITTERS * LOSSES)

/* One way, s; jitter as a share of the delay. */
static const double delay_s[DELAYS] = {
    0, 0.0025, 0.005, 0.0075, 0.01, 0.0125, 0.015, 0.0175, 0.02, 0.025, 0.035, 0.05};
static const double jitter[JITTERS] = {0, 0.5, 1};
static const double loss[LOSSES] = {0, 0.1, 0.3, 0.6};

#define TRIES_MAX 32

/* Each approach is a separate run with another seed. A string that is slack after a missed contact
 * does not affect the next one. */
struct cell {
    int tries, done, felt, missed, early, unfrozen;
    float stiffness_Npm[TRIES_MAX];
    uint32_t digest[TRIES_MAX]; /* 0: nothing was felt */
};

static void one_try(struct bilateral_run_cfg *c, unsigned f, struct cell *to, int k)
{
    struct bilateral_contact contact;
    struct bilateral_run r;
    c->board.seed += (uint64_t)k;
    c->board.exo.path[f].approaches = 1;
    c->board.exo.path[f].hold_s = 0.3;
    if (bilateral_run(c, &r) == 0 && bilateral_judge(&r, f, &contact, 1) == 1) {
        to->done++;
        to->felt += contact.t_s > 0;
        to->missed += contact.missed;
        to->early += contact.early;
        to->unfrozen += r.finger[f].unfrozen > 0;
        to->stiffness_Npm[k] = (float)contact.stiffness_Npm;
        to->digest[k] = contact.t_s > 0 ? r.finger[f].digest : 0;
    }
    bilateral_run_free(&r);
}

static void work(const void *ctx, int i, void *result)
{
    const struct bilateral_options *o = ctx;
    struct bilateral_run_cfg c = bilateral_at_speed(o, o->speed[0].mps);
    struct cell *to = result;
    unsigned f = 0;
    while (!(c.board.exo.fingers >> f & 1)) { f++; }
    c.board.exo.fingers = 1u << f;
    for (int w = 0; w < SIM_LINK_WAYS; w++) {
        struct sim_link_par *p = &c.board.line.way[w];
        p->delay_s = delay_s[i / (JITTERS * LOSSES)];
        p->jitter = SIM_LINK_UNIFORM;
        p->jitter_s = p->delay_s * jitter[i / LOSSES % JITTERS];
        p->loss = loss[i % LOSSES];
    }
    c.keep = 1;
    memset(to, 0, sizeof *to);
    to->tries = (int)o->approaches;
    for (int k = 0; k < to->tries && !posix_interrupted(); k++) {
        struct bilateral_run_cfg one = c;
        one_try(&one, f, to, k);
    }
}

/* Of what was felt, beside the same approaches over the first cell's link, the best; < 0: nothing
 * was felt. */
static double share(const struct cell *cell, int i)
{
    double ours = 0, best = 0;
    for (int k = 0; k < cell[i].tries; k++) {
        if (cell[i].digest[k] && cell[0].digest[k]) {
            ours += (double)cell[i].stiffness_Npm[k];
            best += (double)cell[0].stiffness_Npm[k];
        }
    }
    return best > 0 ? ours / best : -1;
}

/* How many of those felt have every bit of the first cell's. */
static int same(const struct cell *cell, int i)
{
    int n = 0;
    for (int k = 0; k < cell[i].tries; k++) {
        n += cell[i].digest[k] && cell[i].digest[k] == cell[0].digest[k];
    }
    return n;
}

/* The longest round-trip delay that the advice for the ray allows. A plane is sent at the latest
 * 1/fps and a state later. It must arrive before the finger is at d_lim. */
static double allowed_s(const struct bilateral_options *o)
{
    struct bilateral_run_cfg c = bilateral_at_speed(o, o->speed[0].mps);
    struct bilateral_run r;
    const struct bilateral_par *par = (const void *)exh_scene_bilateral.params->active;
    const struct sim_exo_par *e = &o->run.board.exo;
    unsigned f = 0;
    double tip_mps, left_m, scale = 1;
    while (!(e->fingers >> f & 1)) { f++; }
    for (unsigned i = 0; i < BILATERAL_FINGERS; i++) { c.board.exo.path[i].approaches = 1; }
    if (bilateral_run(&c, &r) == 0 && r.finger[f].freezes) { scale = r.finger[f].scale; }
    bilateral_run_free(&r);
    tip_mps = o->speed[0].mps * (1 + e->path[f].vary) / scale;
    left_m = o->run.ray_m + par->precontact[f].d_lim_m_q30 / 1073741824.0;
    return left_m / tip_mps - 1 / o->run.fps - (1.0 + par->own.state_every) / o->run.rate_Hz;
}

static int files(const struct bilateral_options *o, const struct cell *cell, double allowed_ms)
{
    FILE *f = bilateral_out_file(o->out, "sweep.csv");
    FILE *g = f ? bilateral_out_file(o->out, "sweep.gp") : NULL;
    if (g == NULL) {
        outfile_abandon(f);
        return 1;
    }
    fprintf(f, "delay_s,jitter,loss,approaches,felt,missed,early,same_bits,share\n");
    for (int i = 0; i < CELLS; i++) {
        const struct cell *c = &cell[i];
        fprintf(f, "%.9g,%.9g,%.9g,%d,%d,%d,%d,%d,", delay_s[i / (JITTERS * LOSSES)],
            jitter[i / LOSSES % JITTERS], loss[i % LOSSES], c->tries, c->felt, c->missed, c->early,
            same(cell, i));
        if (share(cell, i) >= 0) { fprintf(f, "%.9g", share(cell, i)); }
        fputc('\n', f);
    }
    fprintf(g,
        "# Made by exhand bilateral --sweep: gnuplot -c sweep.gp PLOTS\nplots=ARG1\n"
        "data='sweep.csv'; speed='%.3g'; ray_mm='%.3g'; fps='%.4g'; allowed_ms=%.4g\n"
        "jitters='0 0.5 1'; losses='0 0.1 0.3 0.6'\nload plots.'/bilateral_sweep.gp'\n",
        o->speed[0].mps, 1e3 * o->run.ray_m, o->run.fps, allowed_ms);
    return outfile_close(f) | outfile_close(g);
}

static void print(const struct cell *cell)
{
    printf("%-22s", "delay there and back");
    for (int l = 0; l < LOSSES; l++) { printf("      loss %3.0f %%", 100 * loss[l]); }
    printf("\n%-22s", "ms, jitter");
    for (int l = 0; l < LOSSES; l++) { printf("  share missed"); }
    printf("\n");
    for (int i = 0; i < CELLS; i += LOSSES) {
        const double ms = 2e3 * delay_s[i / (JITTERS * LOSSES)];
        printf("%8.0f +- %-8.1f  ", ms, ms * jitter[i / LOSSES % JITTERS]);
        for (int l = 0; l < LOSSES; l++) {
            const struct cell *c = &cell[i + l];
            if (share(cell, i + l) >= 0) {
                printf("  %5.3f%c", share(cell, i + l), same(cell, i + l) == c->felt ? '=' : ' ');
            } else {
                printf("      - ");
            }
            printf(" %2d/%-2d", c->missed, c->tries);
        }
        printf("\n");
    }
    printf("share: stiffness of what was felt, beside the same approaches in the first cell; = the "
           "same bits in\neach, from the freeze on.\n");
}

int bilateral_sweep(const struct bilateral_options *given)
{
    static struct cell cell[CELLS];
    static struct bilateral_options o;
    const struct jobs jobs = {
        CELLS, (int)given->jobs, sizeof cell[0], cell, work, &o, "cells", posix_interrupt};
    int ran, err = 0, unfrozen = 0;
    double allowed_ms;
    o = *given;
    if (o.speeds > 1) { (void)snprintf(o.speed[0].name, BILATERAL_NAME_B, "natural"); }
    if (o.speeds > 1) { o.speed[0].mps = sim_path_speed("natural"); }
    if (o.approaches > TRIES_MAX) { o.approaches = TRIES_MAX; }
    if (o.run.ray_m <= 0 && o.run.scene == NULL) { o.run.ray_m = 0.04; }
    ran = jobs_run(&jobs);
    if (ran) { return ran; }
    allowed_ms = 1e3 * allowed_s(&o);
    print(cell);
    if (o.run.scene == NULL) {
        printf("walls are seen from %.0f mm: by the advice in time up to %.1f ms there and back, "
               "jitter and lost\npackets' waits included\n",
            1e3 * o.run.ray_m, allowed_ms);
    }
    for (int i = 0; i < CELLS; i++) {
        unfrozen += cell[i].unfrozen || cell[i].done < cell[i].tries;
    }
    if (o.out) { err = files(&o, cell, allowed_ms); }
    return unfrozen ? 1 : err;
}
