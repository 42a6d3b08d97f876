/* SPDX-License-Identifier: MIT */
/* What the picture of the reactions needs: force around a fault, released and cut. */
#include "lab/faults/part.h"

#include "base/option.h"
#include "base/outfile.h"
#include "posix.h"

#include <inttypes.h>

#define BEFORE_S  0.010
#define AFTER_S   0.045
#define GIVE_UP_S 10u /* it never presses */
#define PATH_B    1024

static const uint32_t rate_Hz[] = {90, 200, 500, 1000, 2000};
#define RATES (sizeof rate_Hz / sizeof rate_Hz[0])

struct take {
    struct faults_base base;
    const char *dir;
    int pressed, err;
};

static FILE *open_trace(const struct take *t, const char *how)
{
    char name[64];
    snprintf(name, sizeof name, "faults_%" PRIu32 "Hz_%s.csv", t->base.rate_Hz, how);
    return outfile_in(t->dir, name);
}

/* 1 in the branch. */
static int branch(
    struct take *t, uint8_t source, const char *how, uint32_t tick, const struct faults_view *v)
{
    const uint32_t before = (uint32_t)(BEFORE_S * t->base.rate_Hz) + 1;
    struct faults_case c = {.what = {{source, before, 0, 0, 0}},
        .follow_ticks = before + (uint32_t)(AFTER_S * t->base.rate_Hz) + 1};
    struct faults_seen s;
    c.trace = open_trace(t, how);
    if (c.trace == NULL) {
        t->err = 1;
        return 0;
    }
    fprintf(c.trace, "t_s,force_n,coded_a,motor_a,state\n");
    if (faults_branch(&t->base, &c, tick, v, &s)) { return 1; }
    t->err |= outfile_close(c.trace) != 0 || s.bad != 0;
    return 0;
}

static void at(void *ctx, uint32_t tick, const struct faults_view *v)
{
    struct take *t = ctx;
    const int runs = v->state == EXH_STATE_RUN || v->state == EXH_STATE_LIMIT;
    const int presses = runs && v->force_N_q20[FAULTS_FINGER] > EXH_Q(2, 1, EXH_Q_FORCE);
    if (tick > GIVE_UP_S * t->base.rate_Hz) {
        t->err = 1;
        posix_stop();
    }
    t->pressed = presses ? t->pressed + 1 : 0;
    if ((uint32_t)t->pressed < t->base.rate_Hz / 16 + 1) { return; }
    if (branch(t, FAULTS_DEADMAN, "release", tick, v)) { return; }
    if (branch(t, FAULTS_ESTOP, "cut", tick, v)) { return; }
    posix_stop();
}

static void script(FILE *f, const void *ctx)
{
    (void)ctx;
    fprintf(f, "# Made by exhand faults. Inside this directory, PLOTS the way to "
               "ports/posix/plot:\n"
               "#   gnuplot -c faults.gp PLOTS\nplots=ARG1\nrates='");
    for (size_t r = 0; r < RATES; r++) { fprintf(f, " %" PRIu32, rate_Hz[r]); }
    fprintf(f, "'\nload plots.'/faults.gp'\n");
}

int faults_pictures(const char *dir)
{
    int err = outfile_dir(dir, "faults_2000Hz_release.csv");
    for (size_t r = 0; r < RATES && err == 0; r++) {
        struct take t = {.base = {.scene = FAULTS_BILATERAL, .gentle = 1, .seed = 7}, .dir = dir};
        t.base.rate_Hz = rate_Hz[r];
        err = faults_run(&t.base, at, &t) < 0 || t.err;
    }
    return err ? err : outfile_write(dir, "faults.gp", script, NULL);
}
