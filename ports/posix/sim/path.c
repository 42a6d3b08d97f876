/* SPDX-License-Identifier: MIT */
/* Every parameter of a scripted approach, with unit, range and how sure we are.
 *
 * paper   read in the ICRA 2013 paper
 * ours    a choice of the simulation
 */
#include "path.h"

#include <string.h>

#define FAR_S       1e30
#define RATE_MIN_HZ 0.01

const struct sim_device_row sim_path_row[] = {
    {"start", "m", 0.005, 0, 0.08, "ours", "string out at rest; 0 is the straight finger"},
    {"believed", "m", 0.030, 0, 0.08, "ours", "string out where the object is believed to be"},
    {"push", "m", 0.015, 0.001, 0.08, "ours", "it aims so far beyond: times K, the pressing force"},
    {"speed", "m_per_s", 0.87, 0.001, 3, "paper",
        "where the object is believed to be, if it is not there"},
    {"first", "s", 0.7, 0.01, 100, "ours", "rest before the first approach: armed by then"},
    {"hold", "s", 1, 0, 100, "ours", "pressed for so long"},
    {"back", "s", 0.5, 0.02, 10, "ours", "the withdrawal takes"},
    {"rest", "s", 1, 0.01, 100, "ours", "rest between two approaches"},
    {"vary", "", 0.1, 0, 0.5, "ours",
        "all but `believed` and `first` vary by +- this from one to the next"},
    {"approaches", "", 0, 0, 1e9, "ours", "how many; 0: for ever"},
};
SIM_ROWS(sim_path_par, sim_path_row);

struct sim_path_par sim_path_default(void)
{
    struct sim_path_par p;
    sim_rows_default(&p, sim_path_row, sim_path_rows);
    return p;
}

int sim_path_set(
    struct sim_path_par *p, const char *name, double value, const struct sim_device_row **row)
{
    return sim_rows_set(p, sim_path_row, sim_path_rows, name, value, row);
}

/* The paper has no figures for its three, but one contact at "medium speed (0.87 m/s)". Slow: a
 * third of a millimetre in 1/60 s. Fast: the whole string in 1/10 s, unsure. */
double sim_path_speed(const char *name)
{
    static const struct {
        const char *name;
        double mps;
    } speed[] = {{"slow", 0.02}, {"natural", 0.87}, {"fast", 1.2}};
    for (size_t i = 0; i < sizeof speed / sizeof speed[0]; i++) {
        if (strcmp(name, speed[i].name) == 0) { return speed[i].mps; }
    }
    return 0;
}

/* --- what is wanted, and what leads it --- */

/* From x->start_s on; x is a polynomial, m, c and f the load. */
static void follow(struct sim_path *p, const struct sim_curve *x, double m, double c, double f)
{
    struct sim_curve g = *x;
    for (int k = 0; k < SIM_CURVE_TERMS; k++) {
        const double first = k + 1 < SIM_CURVE_TERMS ? (k + 1) * x->c[k + 1] : 0;
        const double second = k + 2 < SIM_CURVE_TERMS ? (k + 1) * (k + 2) * x->c[k + 2] : 0;
        g.c[k] = (m * second + c * first + (k == 0 ? f : 0)) / p->load.k_Npm;
    }
    p->x = *x;
    p->terms = sim_poly_terms(x->c);
    sim_lag_follow(&p->e, &g);
}

static void stay(struct sim_path *p, double start_s)
{
    const struct sim_curve x = {start_s, {p->at_m}, 0, 0, 0};
    follow(p, &x, 0, 0, 0);
}

/* (10 - 15 u + 6 u^2) u^3 of the way, u = s / move_s. */
static void move(struct sim_path *p, double start_s, double to_m, double move_s)
{
    const double u = 1 / move_s, u3 = u * u * u, way = to_m - p->at_m;
    const struct sim_curve x = {
        start_s, {p->at_m, 0, 0, 10 * way * u3, -15 * way * u3 * u, 6 * way * u3 * u * u}, 0, 0, 0};
    if (way > 0) {
        follow(p, &x, p->load.out_kg, p->load.out_Nspm, p->load.out_N);
    } else {
        follow(p, &x, p->load.in_kg, 0, 0);
    }
    p->at_m = to_m;
    p->end_s = start_s + move_s;
}

double sim_path_wanted(const struct sim_path *p, double t_s)
{
    return sim_poly(p->x.c, p->terms, t_s - p->x.start_s);
}

double sim_path_at(const struct sim_path *p, double t_s)
{
    return sim_path_wanted(p, t_s) + sim_lag_at(&p->e, t_s);
}

double sim_path_left(const struct sim_path *p, double t_s, double left)
{
    return sim_path_wanted(p, t_s) + sim_lag_left(&p->e, t_s, left);
}

/* --- approaches --- */

static double varied(struct sim_path *p, double v)
{
    return v * (1 + p->par.vary * (2 * sim_random_unit(&p->rng) - 1));
}

/* How long a way takes that is passed at `share` of it with this speed. */
static double duration_s(double way_m, double share, double speed_mps)
{
    double lo = 0, hi = 1, u = 0.5;
    if (!(share > 0.5)) { return 1.875 * way_m / speed_mps; } /* no faster than at its middle */
    for (int i = 0; i < 60; i++) {
        u = 0.5 * (lo + hi);
        if (u * u * u * (10 - 15 * u + 6 * u * u) < share) {
            lo = u;
        } else {
            hi = u;
        }
    }
    return way_m * 30 * u * u * (1 - u) * (1 - u) / speed_mps;
}

static void approach(struct sim_path *p, double start_s)
{
    const double speed_mps = varied(p, p->par.speed_mps);
    const double to_m = p->par.believed_m + varied(p, p->par.push_m);
    const double way_m = to_m - p->at_m;
    p->number++;
    p->phase = SIM_PATH_APPROACH;
    if (way_m > 0) {
        move(p, start_s, to_m, duration_s(way_m, (p->par.believed_m - p->at_m) / way_m, speed_mps));
    } else {
        p->end_s = start_s;
    }
}

/* Starts the phase after the one that has just ended. */
static void next_phase(struct sim_path *p)
{
    const double t_s = p->end_s;
    if (p->phase == SIM_PATH_APPROACH) {
        p->phase = SIM_PATH_HOLD;
        stay(p, t_s);
        p->end_s = t_s + varied(p, p->par.hold_s);
    } else if (p->phase == SIM_PATH_HOLD) {
        const double to_m = varied(p, p->par.start_m);
        p->phase = SIM_PATH_WITHDRAW;
        move(p, t_s, to_m, varied(p, p->par.back_s));
    } else if (p->phase == SIM_PATH_WITHDRAW) {
        const int last = p->par.approaches > 0 && (double)p->number >= p->par.approaches;
        p->phase = last ? SIM_PATH_DONE : SIM_PATH_REST;
        stay(p, t_s);
        p->end_s = last ? FAR_S : t_s + varied(p, p->par.rest_s);
    } else {
        approach(p, t_s);
    }
}

/* --- a recording --- */

static double control(const struct sim_path_record *r, long n)
{
    const long last = r->again ? n % r->rows : r->rows - 1;
    return r->string_m[n < 0 ? 0 : n < r->rows ? n : last];
}

/* Moves from row `number` to the next, or near them; constant before the first and after the
 * last. */
static void play(struct sim_path *p)
{
    const struct sim_path_record *r = &p->record;
    const long n = p->number;
    const double a = control(r, n - 1), b = control(r, n), c = control(r, n + 1),
                 d = control(r, n + 2), hz = r->row_hz;
    const struct sim_curve x = {(double)(n + 1) / hz,
        {(a + 4 * b + c) / 6, (c - a) / 2 * hz, (a - 2 * b + c) / 2 * hz * hz,
            (d - a + 3 * (b - c)) / 6 * hz * hz * hz, 0, 0},
        0, 0, 0};
    follow(p, &x, p->load.out_kg, p->load.out_Nspm, 0); /* one load all along: no jump in it */
    p->number++;
    p->end_s = (double)(p->number + 1) / hz;
}

static void next_row(struct sim_path *p)
{
    if (p->record.again || p->number < p->record.rows) {
        play(p);
        return;
    }
    p->phase = SIM_PATH_DONE;
    p->at_m = control(&p->record, p->record.rows - 1);
    stay(p, p->end_s);
    p->end_s = FAR_S;
}

/* Flexion sensors: the joint at the knuckle, and those beyond it. */
static const signed char bends[5][3] = {
    {1, 2, 2}, {4, 5, 6}, {7, 8, 9}, {11, 12, 13}, {15, 16, 17}};

double sim_path_string(
    const double row_rad[SIM_SENSORS], unsigned finger, double sign, const double arm_m[3])
{
    double sum = 0;
    for (int j = 0; j < 3; j++) {
        const double bent_rad = sign * row_rad[bends[finger][j]];
        if (bent_rad > 0) { sum += arm_m[j] * bent_rad; }
    }
    return sum;
}

double sim_path_sign(const double (*row_rad)[SIM_SENSORS], long rows)
{
    double sum = 0;
    for (long n = 0; n < rows; n++) {
        for (unsigned f = 1; f < 5; f++) {
            for (int j = 0; j < 3; j++) { sum += row_rad[n][bends[f][j]]; }
        }
    }
    return sum < 0 ? -1 : 1;
}

/* --- both --- */

void sim_path_start(struct sim_path *p, const struct sim_path_par *par,
    const struct sim_path_load *load, const struct sim_path_record *record, uint64_t seed)
{
    memset(p, 0, sizeof *p);
    p->par = *par;
    p->load = *load;
    p->rng.state = seed;
    sim_lag_start(&p->e, load->b_Nspm / load->k_Npm, 0);
    if (record != NULL && record->rows > 0) {
        p->record = *record;
        if (!(p->record.row_hz > RATE_MIN_HZ)) { p->record.row_hz = RATE_MIN_HZ; }
        p->phase = SIM_PATH_PLAY;
        p->number = -1; /* a row of standing still, then the first */
        p->at_m = control(record, 0);
    } else {
        p->phase = SIM_PATH_REST;
        p->at_m = par->start_m;
        p->end_s = par->first_s;
    }
    stay(p, 0);
}

void sim_path_advance(struct sim_path *p, double t_s)
{
    while (p->phase != SIM_PATH_DONE && t_s >= p->end_s) {
        if (p->phase == SIM_PATH_PLAY) {
            next_row(p);
        } else {
            next_phase(p);
        }
    }
}

double sim_path_next_s(const struct sim_path *p)
{
    return p->phase == SIM_PATH_DONE ? FAR_S : p->end_s;
}
