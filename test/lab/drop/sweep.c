/* SPDX-License-Identifier: MIT */
#include "lab/drop/sweep.h"

#include "base/jobs.h"
#include "base/option.h"
#include "base/outfile.h"
#include "base/param.h"
#include "lab/drop/plane.h"
#include "drop/options.h"

#include "sim/linear.h"

#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

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
    add(to, "version", 2);
    add(to, "falls", o->base.board.falls);
    add(to, "seed", (double)o->base.board.seed);
    add(to, "rays", o->rays);
    add(to, "per_octave", o->per_octave);
    for (int i = 0; i < sim_device_rows; i++) {
        double v;
        memcpy(&v, device + (size_t)i * sizeof v, sizeof v);
        add(to, sim_device_row[i].name, v);
    }
    for (int i = 0; i < o->base.settings; i++) {
        add(to, o->base.setting[i].name, o->base.setting[i].value);
    }
}

/* --- running rays --- */

struct batch {
    const struct sweep_opt *o;
    const struct cells *known;
    const struct reach *reach;
    const char *path;
    int fd;
};

/* One ray on its way. */
struct on_ray {
    const struct batch *b;
    int ray;
};

static int known_or_run(void *ctx, const struct ray *r, double gain, int *rest, int *falls)
{
    const struct on_ray *x = ctx;
    const struct sweep_opt *o = x->b->o;
    const struct cell *known = cells_find(x->b->known, r->rate_Hz, x->ray, gain);
    struct cell c = {
        r->rate_Hz, x->ray, gain, gain * r->k_Npm, gain * r->b_Nspm, 0, o->base.board.falls, -1};
    if (known == NULL) {
        c.resting = study_rest(&o->base, c.rate_Hz, c.k_Npm, c.b_Nspm);
        if (c.resting < 0) { return c.resting; }
        c.rho = linear_rho(
            &o->base.board.device, 1 / c.rate_Hz, c.k_Npm, c.b_Nspm, sweep_window(&o->base));
        if (cells_append(x->b->fd, x->b->path, &c)) { return -1; }
    }
    *rest = known ? known->resting : c.resting;
    *falls = known ? known->falls : c.falls;
    return 0;
}

/* The i-th ray of this shard: they are dealt in turn, so all take about as long. */
static int ours(const struct sweep_opt *o, int i) { return o->shard - 1 + i * o->shards; }

static int how_many(const struct sweep_opt *o)
{
    return (o->rates * o->rays - o->shard + o->shards) / o->shards;
}

struct ran {
    int done, error;
};

static void work(const void *ctx, int i, void *result)
{
    const struct batch *b = ctx;
    const int n = ours(b->o, i), rate_i = n / b->o->rays;
    struct on_ray x = {b, n % b->o->rays};
    const struct ray r = plane_ray(b->o, b->o->rate_Hz[rate_i], b->reach[rate_i], x.ray);
    const struct ray_border border = ray_border(&r, known_or_run, &x);
    const struct ran ran = {border.error == 0, border.error == -1};
    memcpy(result, &ran, sizeof ran);
}

static int run_rays(const struct batch *b)
{
    const int n = how_many(b->o);
    struct ran *ran = calloc((size_t)n + 1, sizeof *ran);
    const struct jobs jobs = {n, b->o->jobs, sizeof *ran, ran, work, b, "rays", posix_interrupt};
    int status = ran == NULL ? 1 : jobs_run(&jobs);
    if (status == 0 && posix_interrupted()) { status = JOBS_INTERRUPTED; }
    for (int i = 0; i < n && status == 0; i++) { status = !ran[i].done; }
    free(ran);
    return status;
}

/* --- the sweep --- */

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

static int sweep(
    const struct sweep_opt *o, struct cells *cells, const struct reach *reach, const char *path)
{
    struct batch b = {o, cells, reach, path, -1};
    int err, again;
    FILE *f = cells_grow(cells, path); /* without a line that was cut off */
    if (f == NULL) { return 1; }
    b.fd = fileno(f);
    if (cells->n > 0) { fprintf(stderr, "%s: goes on from %d cells\n", path, cells->n); }
    err = run_rays(&b);
    outfile_abandon(f); /* the file stays at its name, unchanged */
    again = cells_load(cells, path);
    if (err == JOBS_INTERRUPTED) {
        cli_complain(
            "interrupted: %d cells are kept in %s: the same command goes on", cells->n, path);
        return err;
    }
    return err || again ? 1 : cells_save(cells, path);
}

/* Nowhere linear, as with a delay of ticks: the paper's gains are a measure, too. */
static void reaches(const struct sweep_opt *o, struct reach *reach)
{
    for (int i = 0; i < o->rates; i++) {
        const struct table2_row *row = table2_gains(o->rate_Hz[i]);
        reach[i] = reach_of(&o->base.board.device, o->rate_Hz[i], sweep_window(&o->base));
        if (reach[i].k_Npm > 0) { continue; }
        reach[i] = (struct reach){row->k_Npm, row->b_Nspm > 10 ? row->b_Nspm : 10};
    }
}

int sweep_run(const struct sweep_opt *o)
{
    static char settings[SETTINGS_B];
    static struct reach reach[DROP_RATES_MAX];
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
    if (err == 0) { reaches(o, reach); }
    if (err == 0) { err = sweep(o, &cells, reach, path); }
    if (err == 0 && o->shards == 1) { err = plane_report(&cells, o, reach); }
    cells_free(&cells);
    return err;
}
