/* SPDX-License-Identifier: MIT */
#include "advise/region.h"

#include "base/jobs.h"
#include "base/option.h"

#include "posix.h"
#include "sim/eigen.h"

#include <string.h>

#define K_MAX_NPM  1e6 /* what a scene takes */
#define B_MAX_NSPM 1e3
#define FEW        4    /* cases on the way up */
#define COARSE     1.19 /* k from pair to pair on the way up: a quarter of an octave */
#define FINE       1.02 /* and at the end of a row */
#define SEARCH     16   /* octaves of k above the first in which something has to hold */
#define SLIVER     0.01 /* of the area: so little may be left out at large b */
#define DIP        0.25 /* of the rows beside it: what begins behind so little counts, */
#define ISLANDS    4    /* of so many that begin there */
#define ENOUGH     0.75 /* of the largest b: longer rows get a new grid */

/* --- one pair of gains --- */

/* The cases of one row, of which the next row has others: what neither's cases would show does
 * not hide in both. */
struct draw {
    int first; /* even: with and without the margin in turn */
    int hint;  /* the one that failed last: where one pair fails its neighbour does */
};

static struct draw draw_of(const struct region_opt *o, int n)
{
    return (struct draw){n * (o->cases + o->cases % 2), 0};
}

/* Devices in turn, every second time with a margin of friction less. Not always with it: what
 * sticks later chatters less. */
static struct sim_device device_of(const struct region_opt *o, int c)
{
    struct sim_device d = o->device[c / 2 % o->devices];
    const double by = c % 2 ? 1 - o->margin : 1;
    d.mu_motor *= by;
    d.mu_mass *= by;
    d.coulomb_n *= by;
    return d;
}

static struct settle_case case_of(const struct region_opt *o, int c)
{
    struct settle_case at = settle_case_at(c);
    if (o->at_phase) { at.wall = o->phase; }
    return at;
}

static int rests(const struct region_opt *o, double k_Npm, double b_Nspm, int c)
{
    const struct sim_device d = device_of(o, c);
    struct settle_wall w = o->wall;
    w.k_Npm = k_Npm;
    w.b_Nspm = b_Nspm;
    return settle_run(&d, &w, case_of(o, c)) == SETTLE_REST;
}

/* n of the cases, spread over all of them, from the one that failed last. */
static int holds(const struct region_opt *o, double k_Npm, double b_Nspm, int n, struct draw *draw)
{
    const int stride = o->cases / n | 1; /* odd: with and without the margin */
    for (int i = 0; i < n; i++) {
        const int c = (draw->hint + i * stride) % o->cases;
        if (posix_interrupted()) { return 0; }
        if (!rests(o, k_Npm, b_Nspm, draw->first + c)) {
            draw->hint = c;
            return 0;
        }
    }
    return 1;
}

int region_holds(const struct region_opt *o, double k_Npm, double b_Nspm, int draw)
{
    struct draw all = draw_of(o, draw);
    return holds(o, k_Npm, b_Nspm, o->cases, &all);
}

struct region_pair region_try(const struct region_opt *o, double k_Npm, double b_Nspm)
{
    struct region_pair p;
    memset(&p, 0, sizeof p);
    for (; p.falls < o->cases; p.falls++) {
        const int ok = rests(o, k_Npm, b_Nspm, p.falls);
        if (!ok && p.rest == p.falls) {
            p.at = case_of(o, p.falls);
            p.device = p.falls / 2 % o->devices;
        }
        p.rest += ok;
    }
    return p;
}

/* --- one row --- */

/* What a tick leaves stable goes with the rate squared: so much lower begins k. */
static double first_k(double T_s)
{
    double k = 62.5;
    for (double slow_s = 1.0 / 90; slow_s < T_s && k > 1e-3; slow_s *= 2) { k /= 4; }
    return k;
}

static int is_few(const struct region_opt *o) { return o->cases < FEW ? o->cases : FEW; }

static int is_half(const struct region_opt *o) { return (o->cases + 1) / 2; }

/* The weakest wall not below k that holds the mass at this b; 0: none. */
static double weakest(const struct region_opt *o, double k, double b, struct draw *draw)
{
    for (int i = 0; i < 2 * SEARCH && k < K_MAX_NPM; i++, k *= COARSE * COARSE) {
        if (holds(o, k, b, is_few(o), draw) && holds(o, k, b, is_half(o), draw)) { return k; }
    }
    return 0;
}

/* The stiffest pair not above k that does not hold, of those looked at: k and, against islands,
 * some way below it by half of the cases. 0: all hold. */
static double failing(const struct region_opt *o, double low, double k, double b, struct draw *draw)
{
    static const double down[] = {1, 1.05, 1.15, 1.35};
    for (size_t i = 0; i < sizeof down / sizeof down[0] && k / down[i] >= low; i++) {
        if (!holds(o, k / down[i], b, i ? is_half(o) : o->cases, draw)) { return k / down[i]; }
    }
    return 0;
}

/* All that hangs together from the weakest wall not below k on. */
static struct region_row span(const struct region_opt *o, double k, double b, struct draw *draw)
{
    struct region_row row = {b, weakest(o, k, b, draw), 0};
    double fails;
    if (row.low_Npm <= 0) { return row; }
    k = COARSE * row.low_Npm;
    while (k < K_MAX_NPM && holds(o, k, b, is_few(o), draw)) { k *= COARSE; }
    while (k > row.low_Npm && (fails = failing(o, row.low_Npm, k, b, draw)) > 0) {
        k = fails / FINE;
    }
    row.high_Npm = k > row.low_Npm ? k : row.low_Npm;
    return row;
}

/* If the first part is almost empty, the next part counts. */
static struct region_row row_at(const struct region *r, int j)
{
    const double b = r->row[j].b_Nspm;
    struct draw draw = draw_of(&r->o, j);
    const struct region_row first = span(&r->o, first_k(r->o.wall.T_s), b, &draw);
    struct region_row next;
    if (first.high_Npm > COARSE * COARSE * first.low_Npm || first.low_Npm <= 0) { return first; }
    next = span(&r->o, COARSE * COARSE * first.high_Npm, b, &draw);
    return next.high_Npm - next.low_Npm > first.high_Npm - first.low_Npm ? next : first;
}

static double larger(double a, double b) { return a > b ? a : b; }

/* A few k that do not hold leave a row little, and would end the rule there. */
static void fill_dips(struct region *r)
{
    for (int j = 2; j <= REGION_ROWS - 2; j++) {
        struct region_row *row = &r->row[j];
        const double before = larger(row[-1].high_Npm, row[-2].high_Npm);
        const double after = larger(row[1].high_Npm, row[2].high_Npm);
        const double most = DIP * (before < after ? before : after);
        struct region_row next = *row;
        for (int i = 0; i < ISLANDS && next.low_Npm > 0 && next.high_Npm < most; i++) {
            struct draw draw = draw_of(&r->o, j);
            next = span(&r->o, COARSE * COARSE * next.high_Npm, row->b_Nspm, &draw);
        }
        if (next.high_Npm >= most) { *row = next; }
    }
}

/* --- all of them --- */

/* The largest b at which something holds, to a hundredth. */
static double top_b(const struct region_opt *o)
{
    const double k = first_k(o->wall.T_s);
    double low = -1, high = 1;
    struct draw draw = draw_of(o, 0);
    int vain = 0;
    if (weakest(o, k, 0, &draw) > 0) { low = 0; }
    for (; high < B_MAX_NSPM && (low < 0 || vain < 2) && !posix_interrupted(); high *= 1.5) {
        if (weakest(o, k, high, &draw) > 0) {
            low = high;
            vain = 0;
        } else if (low >= 0) {
            vain++;
        }
    }
    if (low < 0) { return low; }
    high = low > 0 ? 1.5 * low : 1;
    while (high - low > 0.01 * high && !posix_interrupted()) {
        const double mid = (low + high) / 2;
        if (weakest(o, k, mid, &draw) > 0) {
            low = mid;
        } else {
            high = mid;
        }
    }
    return low < B_MAX_NSPM ? low : B_MAX_NSPM;
}

/* Every fourth row, or those between. */
static int row_of(int n, int coarse) { return coarse ? 4 * n : n / 3 * 4 + n % 3 + 1; }

static void coarse_row(const void *ctx, int n, void *result)
{
    const struct region *r = ctx;
    const struct region_row row = row_at(r, row_of(n, 1));
    memcpy(result, &row, sizeof row);
}

static void fine_row(const void *ctx, int n, void *result)
{
    const struct region *r = ctx;
    const struct region_row row = row_at(r, row_of(n, 0));
    memcpy(result, &row, sizeof row);
}

/* 0, or why it ended before. */
static int rows(struct region *r, int coarse)
{
    static struct region_row row[REGION_ROWS];
    const int n = coarse ? REGION_ROWS / 4 + 1 : REGION_ROWS / 4 * 3;
    const struct jobs jobs = {n, r->o.jobs, sizeof *row, row, coarse ? coarse_row : fine_row, r,
        coarse ? "rows, every fourth" : "rows", posix_interrupt};
    const int status = jobs_run(&jobs);
    for (int i = 0; i < n && status == 0; i++) { r->row[row_of(i, coarse)] = row[i]; }
    return posix_interrupted() ? JOBS_INTERRUPTED : status;
}

/* The b of a coarse row beyond which next to nothing is allowed: islands of weak walls reach far.
 */
static double worth(const struct region *r)
{
    double area[REGION_ROWS + 1], all = 0, beyond = 0;
    int j = REGION_ROWS;
    for (int i = 0; i <= REGION_ROWS; i += 4) {
        area[i] = r->row[i].high_Npm - r->row[i].low_Npm;
        all += area[i];
    }
    while (j > 4 && beyond + area[j] < SLIVER * all) {
        beyond += area[j];
        j -= 4;
    }
    return r->row[j < REGION_ROWS ? j + 4 : j].b_Nspm;
}

int region_fill(struct region *r, const struct region_opt *o)
{
    double b_top = top_b(o), was;
    int status;
    memset(r, 0, sizeof *r);
    r->o = *o;
    if (posix_interrupted()) { return JOBS_INTERRUPTED; }
    if (b_top < 0) {
        cli_complain("%.6g Hz: nothing comes to rest at any stiffness: another --rate or --device",
            1 / o->wall.T_s);
        return 1;
    }
    do {
        for (int j = 0; j <= REGION_ROWS; j++) { r->row[j].b_Nspm = b_top * j / REGION_ROWS; }
        status = rows(r, 1);
        was = b_top;
        b_top = worth(r);
    } while (status == 0 && b_top < ENOUGH * was);
    if (status == 0) { status = rows(r, 0); }
    if (status == 0) { fill_dips(r); }
    return status;
}

#define PI 3.14159265358979323846

int region_energy(const struct region_opt *o, double k_Npm, double b_Nspm)
{
    const struct sim_device *d = &o->device[0];
    const double w_radps = sim_sqrt(k_Npm / (d->mass_kg + d->rotor_kg));
    const double late_s = o->wall.T_s / 2 + d->delay_tick * o->wall.T_s + d->delay_s +
                          0.5 / d->servo_hz + 1 / (2 * PI * d->current_hz);
    const double lead_s = (b_Nspm + d->viscous_nspm) / k_Npm;
    return d->mu_motor + d->mu_mass > PI / 2 * w_radps * (late_s - lead_s);
}
