/* SPDX-License-Identifier: MIT */
#include "lab/drop/sweep.h"

#include "base/jobs.h"
#include "base/option.h"
#include "base/param.h"
#include "lab/drop/plane.h"
#include "box/table2.h"

#include "sim/linear.h"

#include "drop/drop.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define SETTINGS_B 3072

/* --- what a file is made with --- */

static void add(char *to, const char *name, double value)
{
    const size_t n = strlen(to);
    snprintf(to + n, SETTINGS_B - n, " %s=%.12g", name, value);
}

static void settings_of(char to[SETTINGS_B], const struct sweep_opt *o)
{
    const unsigned char *device = (const unsigned char *)&o->base.board.device;
    to[0] = '\0';
    strcpy(to, "# exhand drop --sweep");
    add(to, "version", 1);
    add(to, "falls", o->base.board.falls);
    add(to, "seed", (double)o->base.board.seed);
    add(to, "columns", o->columns);
    add(to, "rows", o->rows);
    for (int i = 0; i < sim_device_rows; i++) {
        double v;
        memcpy(&v, device + (size_t)i * sizeof v, sizeof v);
        add(to, sim_device_row[i].name, v);
    }
    for (int i = 0; i < o->base.settings; i++) {
        add(to, o->base.setting[i].name, o->base.setting[i].value);
    }
}

/* --- running cells --- */

struct batch {
    const struct sweep_opt *o;
    const struct plane_want *want;
    const char *path;
    int fd;
};

struct ran {
    int done, error;
    struct cell cell;
};

static void work(const void *ctx, int i, void *result)
{
    const struct batch *b = ctx;
    const struct plane_want *w = &b->want[i];
    struct ran ran;
    int error;
    memset(&ran, 0, sizeof ran);
    ran.cell = sweep_cell(&b->o->base, w->rate_Hz, w->k_Npm, w->b_Nspm, &error);
    ran.error = error > 0;
    ran.done = error == 0 && cells_append(b->fd, b->path, &ran.cell) == 0;
    memcpy(result, &ran, sizeof ran);
}

/* All cells wanted. 0, or an exit status. */
static int run_batch(const struct batch *b, int n, struct cells *cells)
{
    struct ran *ran = calloc((size_t)n, sizeof *ran);
    const struct jobs jobs = {n, b->o->jobs, sizeof *ran, ran, work, b, "cells", posix_interrupt};
    int no_memory = 0, status = ran == NULL ? 1 : jobs_run(&jobs);
    if (status == 0 && posix_interrupted()) {
        status = JOBS_INTERRUPTED;
    } /* before jobs listened */
    for (int i = 0; ran != NULL && i < n; i++) {
        if (ran[i].done) { no_memory |= cells_add(cells, &ran[i].cell); }
        if (!ran[i].done && status == 0) { status = 1; }
    }
    cells_sort(cells);
    free(ran);
    return no_memory ? 1 : status;
}

/* --- the sweep --- */

/* Between two batches nobody else listens. */
static void on_signal(int sig)
{
    (void)sig;
    posix_interrupt();
}

static void take_signals(struct sigaction was[2])
{
    struct sigaction a;
    memset(&a, 0, sizeof a);
    sigemptyset(&a.sa_mask);
    a.sa_handler = on_signal;
    a.sa_flags = SA_RESTART;
    sigaction(SIGINT, &a, &was[0]);
    sigaction(SIGTERM, &a, &was[1]);
}

static void give_signals_back(const struct sigaction was[2])
{
    sigaction(SIGINT, &was[0], NULL);
    sigaction(SIGTERM, &was[1], NULL);
}

static int load_shards(struct cells *cells, const char *dir)
{
    DIR *d = opendir(dir);
    int err = 0;
    struct dirent *e = NULL;
    if (d == NULL) {
        cli_complain("--out: %s: can't be read: %s", dir, strerror(errno));
        return 1;
    }
    while (err == 0 && (errno = 0, e = readdir(d)) != NULL) {
        char path[TABLE2_PATH_B];
        int shard, shards, end = 0;
        if (sscanf(e->d_name, "stability.%d-of-%d.csv%n", &shard, &shards, &end) == 2 && end > 0 &&
            e->d_name[end] == '\0') {
            snprintf(path, sizeof path, "%.700s/%.255s", dir, e->d_name);
            err = cells_load(cells, path);
        }
    }
    if (err == 0 && errno != 0) {
        cli_complain("--out: %s: can't be read: %s", dir, strerror(errno));
        err = 1;
    }
    closedir(d);
    return err;
}

static int sweep(const struct sweep_opt *o, struct cells *cells, const char *path)
{
    struct batch b = {o, NULL, path, -1};
    int n, err = 0, known = cells->n;
    struct sigaction was[2];

    if (cells_save(cells, path)) { return 1; } /* without a line that was cut off */
    b.fd = open(path, O_WRONLY | O_APPEND);
    if (b.fd < 0) {
        cli_complain("%s: %s", path, strerror(errno));
        return 1;
    }
    if (known > 0) { fprintf(stderr, "%s: goes on from %d cells\n", path, known); }
    take_signals(was);
    while (err == 0) {
        struct plane_want *want = NULL;
        n = plane_wants(cells, o, &want);
        b.want = want;
        err = n < 0 ? 1 : posix_interrupted() ? JOBS_INTERRUPTED : 0;
        if (n > 0 && err == 0) { err = run_batch(&b, n, cells); }
        free(want);
        if (n <= 0) { break; }
    }
    give_signals_back(was);
    close(b.fd);
    if (err == JOBS_INTERRUPTED) {
        cli_complain(
            "interrupted: %d cells are kept in %s: the same command goes on", cells->n, path);
        return err;
    }
    return err ? err : cells_save(cells, path);
}

int sweep_run(const struct sweep_opt *o)
{
    static char settings[SETTINGS_B];
    char path[TABLE2_PATH_B];
    struct cells cells = {NULL, 0, 0, settings};
    int err;

    settings_of(settings, o);
    err = sweep_open_dir(o->dir, "sweep");
    if (err == 0 && o->shards > 1) {
        snprintf(path, sizeof path, "%s/stability.%d-of-%d.csv", o->dir, o->shard, o->shards);
    } else if (err == 0) {
        snprintf(path, sizeof path, "%s/stability.csv", o->dir);
        err = load_shards(&cells, o->dir);
    }
    if (err == 0) { err = cells_load(&cells, path); }
    if (err == 0) { err = sweep(o, &cells, path); }
    if (err == 0 && o->shards == 1) { err = plane_report(&cells, o); }
    cells_free(&cells);
    return err;
}
