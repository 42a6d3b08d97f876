/* SPDX-License-Identifier: MIT */
#include "advise/region.h"

#include "base/jobs.h"
#include "base/option.h"

#include "posix.h"
#include "sim/eigen.h"

#include <stdlib.h>
#include <string.h>

#define K_MAX_NPM  1e6 /* what a scene takes */
#define B_MAX_NSPM 1e3
#define FEW        4 /* cases of an octave */
#define OCTAVES    4 /* tried at least */
#define VARIANTS   3

/* --- one pair of gains --- */

static void scale_friction(struct sim_device *d, double by)
{
    d->mu_motor *= by;
    d->mu_mass *= by;
    d->coulomb_n *= by;
}

/* Kinds of device that a case is run on in turn: as told, heavier and lighter with less friction;
 * every second time with a margin of friction less. Not always with it: what sticks later chatters
 * less. */
static int kinds(const struct region_opt *o) { return o->off > 0 ? 2 * VARIANTS : 2; }

static struct sim_device kind(const struct region_opt *o, int v)
{
    struct sim_device d = o->device;
    if (v / 2 > 0) {
        d.mass_kg *= v / 2 == 1 ? 1 + o->off : 1 - o->off;
        d.viscous_nspm *= 1 - o->off;
        scale_friction(&d, 1 - o->off);
    }
    if (v % 2) { scale_friction(&d, 1 - o->margin); }
    return d;
}

/* All cases, from the one that failed last: where one pair fails its neighbour does. */
static int holds(struct region *r, double k_Npm, double b_Nspm, int cases)
{
    const int all = kinds(&r->o), n = cases * all / 2;
    struct settle_wall w = r->o.wall;
    w.k_Npm = k_Npm;
    w.b_Nspm = b_Nspm;
    for (int i = 0; i < n; i++) {
        const int c = (r->hint + i) % n;
        const struct sim_device d = kind(&r->o, c % all);
        if (settle_run(&d, &w, settle_case_at(c)) != SETTLE_REST) {
            r->hint = c;
            return 0;
        }
    }
    return 1;
}

/* --- how far it reaches --- */

/* What a tick leaves stable goes with the rate squared: so much lower begins k. */
static double first_k(double T_s)
{
    double k = 250;
    for (double slow_s = 1.0 / 90; slow_s < T_s && k > 1e-3; slow_s *= 2) { k /= 4; }
    return k;
}

static int any_holds(struct region *r, double k, double b, int along_k, int octaves)
{
    double v = along_k ? 0 : first_k(r->o.wall.T_s);
    for (int i = 0; i < octaves && !posix_interrupted(); i++) {
        if (holds(r, along_k ? k : v, along_k ? v : b, FEW)) { return 1; }
        v = v == 0 ? 2 : 2 * v;
    }
    return 0;
}

/* Doubled until nothing holds at it, whatever the other gain. */
static double top(struct region *r, int along_k, double v, double most, int octaves)
{
    int in_vain = 0, seen = 0;
    double last = v;
    for (; v < most && (in_vain == 0 || (!seen && in_vain < OCTAVES)); v *= 2) {
        if (any_holds(r, v, v, along_k, octaves)) {
            seen = 1;
            in_vain = 0;
        } else {
            in_vain++;
        }
        last = v;
    }
    return seen || !along_k ? (in_vain ? last : most) : 0;
}

static int reach(struct region *r)
{
    const double first = first_k(r->o.wall.T_s);
    int octaves = 2;
    r->k_top_Npm = top(r, 1, first, K_MAX_NPM, 10);
    for (double k = first; k < r->k_top_Npm; k *= 2) { octaves++; }
    r->b_top_Nspm = r->k_top_Npm > 0 ? top(r, 0, 2, B_MAX_NSPM, octaves) : 0;
    return r->k_top_Npm > 0;
}

int region_open(struct region *r, const struct region_opt *o)
{
    const size_t nodes = (size_t)(o->columns + 1) * (size_t)(o->rows + 1);
    memset(r, 0, sizeof *r);
    r->o = *o;
    r->node = malloc(nodes);
    if (r->node == NULL) {
        cli_complain("out of memory: a smaller --grid");
        return 1;
    }
    memset(r->node, -1, nodes);
    if (!reach(r) && !posix_interrupted()) {
        cli_complain("%.6g Hz: nothing comes to rest at any stiffness: another --rate or --device",
            1 / o->wall.T_s);
        return 1;
    }
    return posix_interrupted() ? JOBS_INTERRUPTED : 0;
}

void region_free(struct region *r)
{
    free(r->node);
    memset(r, 0, sizeof *r);
}

/* --- the lattice --- */

double region_k(const struct region *r, int i)
{
    return r->k_top_Npm * (i > 0 ? i : 0.25) / r->o.columns;
}

double region_b(const struct region *r, int j) { return r->b_top_Nspm * j / r->o.rows; }

static signed char *node_at(const struct region *r, int i, int j)
{
    return &r->node[j * (r->o.columns + 1) + i];
}

static int node(struct region *r, int i, int j)
{
    signed char *n = node_at(r, i, j);
    if (*n < 0) { *n = (signed char)holds(r, region_k(r, i), region_b(r, j), r->o.cases); }
    return *n;
}

int region_piece(struct region *r, int i, int j)
{
    if (i < 0 || j < 0 || i >= r->o.columns || j >= r->o.rows) { return 0; }
    return node(r, i + 1, j + 1) && node(r, i + 1, j) && node(r, i, j + 1) && node(r, i, j);
}

int region_find(const struct region *r, double k_Npm, double b_Nspm, int *i, int *j)
{
    if (k_Npm < region_k(r, 0) || b_Nspm < 0) { return 0; }
    for (*i = 0; *i < r->o.columns && region_k(r, *i + 1) < k_Npm;) { ++*i; }
    for (*j = 0; *j < r->o.rows && region_b(r, *j + 1) < b_Nspm;) { ++*j; }
    return *i < r->o.columns && *j < r->o.rows;
}

static int on(double v, double edge) { return v - edge <= 1e-9 * edge && edge - v <= 1e-9 * edge; }

int region_allows(struct region *r, double k_Npm, double b_Nspm)
{
    int i, j, right, up;
    if (!region_find(r, k_Npm, b_Nspm, &i, &j)) { return 0; }
    right = on(k_Npm, region_k(r, i + 1));
    up = on(b_Nspm, region_b(r, j + 1));
    return region_piece(r, i, j) && (!right || region_piece(r, i + 1, j)) &&
           (!up || region_piece(r, i, j + 1)) && (!right || !up || region_piece(r, i + 1, j + 1));
}

/* --- all of it --- */

struct row {
    signed char node[REGION_MAX + 1];
};

static void work(const void *ctx, int j, void *result)
{
    struct region r = *(const struct region *)ctx; /* its hint is its own */
    struct row row;
    memset(&row, -1, sizeof row);
    for (int i = 0; i <= r.o.columns && !posix_interrupted(); i++) {
        row.node[i] = *node_at(&r, i, j);
        if (row.node[i] < 0) {
            row.node[i] = (signed char)holds(&r, region_k(&r, i), region_b(&r, j), r.o.cases);
        }
    }
    memcpy(result, &row, sizeof row);
}

int region_fill(struct region *r)
{
    const int n = r->o.rows + 1;
    struct row *row = calloc((size_t)n, sizeof *row);
    const struct jobs jobs = {n, r->o.jobs, sizeof *row, row, work, r, "rows", posix_interrupt};
    int status;
    if (row == NULL) {
        cli_complain("out of memory: a smaller --grid");
        return 1;
    }
    status = jobs_run(&jobs);
    for (int j = 0; j < n && status == 0; j++) {
        for (int i = 0; i <= r->o.columns; i++) { *node_at(r, i, j) = row[j].node[i]; }
    }
    free(row);
    return posix_interrupted() ? JOBS_INTERRUPTED : status;
}

#define PI 3.14159265358979323846

int region_energy(const struct region_opt *o, double k_Npm, double b_Nspm)
{
    const struct sim_device *d = &o->device;
    const double w_radps = sim_sqrt(k_Npm / (d->mass_kg + d->rotor_kg));
    const double late_s = o->wall.T_s / 2 + d->delay_tick * o->wall.T_s + d->delay_s +
                          0.5 / d->servo_hz + 1 / (2 * PI * d->current_hz);
    const double lead_s = (b_Nspm + d->viscous_nspm) / k_Npm;
    return d->mu_motor + d->mu_mass > PI / 2 * w_radps * (late_s - lead_s);
}
