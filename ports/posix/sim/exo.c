/* SPDX-License-Identifier: MIT */
#include "exo.h"

#include "grid.h"

#include <string.h>

#define POINT_S 600e-6 /* between two points the fingers move on straight lines */

/* Sensors that bend: the knuckle's, and those of the joints beyond it; -1: none. */
static const signed char bends[SIM_FINGERS][3] = {
    {1, 2, -1}, {4, 5, 6}, {7, 8, 9}, {11, 12, 13}, {15, 16, 17}};

struct sim_exo_par sim_exo_default(void)
{
    struct sim_exo_par p;
    memset(&p, 0, sizeof p);
    for (unsigned i = 0; i < SIM_FINGERS; i++) {
        p.finger[i] = sim_finger_default();
        p.path[i] = sim_path_default();
    }
    return p;
}

static int used(const struct sim_exo *e, unsigned i) { return (int)(e->fingers >> i & 1); }

/* --- the fingers --- */

static void keep_point(struct sim_exo *e, double t_s)
{
    struct sim_exo_point *p;
    if (!e->gloved) { return; }
    if (e->points == SIM_EXO_POINTS) { /* no reader for long: drop the oldest */
        e->first = (e->first + 1) % SIM_EXO_POINTS;
        e->points--;
        e->torn = 1;
    }
    p = &e->point[(e->first + e->points) % SIM_EXO_POINTS];
    e->points++;
    p->t_s = t_s;
    e->newest_s = t_s;
    for (unsigned k = 0; k < e->used; k++) { p->x_m[e->at[k]] = e->finger[e->at[k]].plant.x_m; }
}

int sim_exo_start(struct sim_exo *e, const struct sim_exo_par *p, const struct sim_device *d,
    uint64_t seed, int gloved)
{
    double later_s = 0;
    if (p->fingers >> SIM_FINGERS) { return -1; }
    e->fingers = p->fingers;
    e->gloved = gloved;
    e->used = e->first = e->points = 0;
    e->torn = 0;
    e->newest_s = 0;
    memset(&e->way, 0, sizeof e->way);
    for (unsigned i = 0; i < SIM_FINGERS; i++) {
        struct sim_path_par path = p->path[i];
        if (!used(e, i)) { continue; }
        e->at[e->used++] = (unsigned char)i;
        path.first_s += later_s;
        later_s += p->apart_s;
        /* A separate seed: each finger is independent of the others. */
        sim_finger_start(&e->finger[i], &p->finger[i], &path, &p->record[i], d,
            seed ^ UINT64_C(0x9E6C63D0876A9A47) * (i + 1));
    }
    keep_point(e, 0);
    return 0;
}

void sim_exo_advance(struct sim_exo *e, double until_s)
{
    const unsigned n = e->used;
    double to_s;
    do {
        const double next_s = e->newest_s + POINT_S;
        to_s = e->gloved && next_s < until_s ? next_s : until_s;
        for (unsigned k = 0; k < n; k++) { sim_finger_advance(&e->finger[e->at[k]], to_s); }
        if (to_s > e->newest_s) { keep_point(e, to_s); }
    } while (to_s < until_s);
}

int sim_exo_done(const struct sim_exo *e)
{
    for (unsigned k = 0; k < e->used; k++) {
        if (e->finger[e->at[k]].path.phase != SIM_PATH_DONE) { return 0; }
    }
    return 1;
}

void sim_exo_latch(struct sim_exo *e, double at_s, const double ref_A[SIM_FINGERS])
{
    const unsigned n = e->used;
    if (e->gloved && e->newest_s + POINT_S < at_s) { sim_exo_advance(e, at_s); } /* points first */
    for (unsigned k = 0; k < n; k++) {
        sim_finger_latch(&e->finger[e->at[k]], at_s, ref_A[e->at[k]]);
    }
}

/* --- the glove --- */

void sim_exo_glove(struct sim_exo *e, struct sim_glove *g, const struct sim_glove_par *p,
    uint64_t seed, const double rest_rad[SIM_GLOVE_SENSORS])
{
    double at_rad[SIM_GLOVE_SENSORS];
    memcpy(at_rad, rest_rad, sizeof at_rad);
    for (unsigned i = 0; i < SIM_FINGERS; i++) {
        for (int j = 0; j < 3 && used(e, i); j++) {
            const struct sim_finger *f = &e->finger[i];
            if (bends[i][j] >= 0) { at_rad[bends[i][j]] = f->bend_radpm[j > 0] * f->plant.x_m; }
        }
    }
    sim_glove_start(g, p, seed, at_rad);
    for (unsigned i = 0; i < SIM_FINGERS; i++) {
        const double *radpm = e->finger[i].bend_radpm;
        for (int j = 1; j < 3 && used(e, i) && bends[i][j] >= 0; j++) {
            sim_glove_follow(g, (unsigned)bends[i][j], (unsigned)bends[i][0], radpm[1] / radpm[0]);
        }
    }
    e->knuckles = e->seen = 0;
    for (unsigned k = 0; k < e->used; k++) {
        e->knuckles |= UINT32_C(1) << bends[e->at[k]][0];
        e->seen |= g->seen[bends[e->at[k]][0]];
    }
}

/* The knuckles stay from a on, as if they had settled. After a gap all that was before has died
 * out: it is many lags long. */
static void settle(struct sim_exo *e, struct sim_glove *g, const struct sim_exo_point *a)
{
    for (unsigned k = 0; k < e->used; k++) {
        const unsigned i = e->at[k];
        struct sim_lag *l = &g->angle_rad[bends[i][0]];
        const double torn_rad = e->finger[i].bend_radpm[0] * a->x_m[i];
        sim_lag_start(l, l->tau_s, e->torn ? torn_rad : sim_lag_at(l, a->t_s));
        l->x.start_s = a->t_s;
    }
    e->torn = 0;
    g->line_s = a->t_s;
    g->stays &= ~e->knuckles;
}

/* Moves the glove from the oldest point to the next, and drops the oldest. All knuckles begin their
 * lines together, so they share the rest of their low-pass. */
static void feed(struct sim_exo *e, struct sim_glove *g)
{
    const struct sim_exo_point *a = &e->point[e->first];
    const struct sim_exo_point *b = &e->point[(e->first + 1) % SIM_EXO_POINTS];
    const double start_s = a->t_s, step_s = b->t_s - start_s;
    const unsigned n = e->used;
    double left;
    if (e->torn || e->knuckles & ~g->lines) { settle(e, g, a); }
    left = sim_decay_at(&e->way, g->tau_s, sim_grid_s(g->line_s, start_s));
    for (unsigned k = 0; k < n; k++) {
        const unsigned i = e->at[k];
        const double radpm = e->finger[i].bend_radpm[0];
        const struct sim_line way = {
            start_s, radpm * a->x_m[i], radpm * ((b->x_m[i] - a->x_m[i]) / step_s)};
        sim_lag_line(&g->angle_rad[bends[i][0]], &way, left);
    }
    g->line_s = start_s;
    g->lines = e->knuckles;
    g->moves |= e->seen;
    e->first = (e->first + 1) % SIM_EXO_POINTS;
    e->points--;
}

void sim_exo_frame(
    struct sim_exo *e, struct sim_glove *g, double tick_s, int16_t raw[SIM_GLOVE_SENSORS])
{
    const double last_s = sim_glove_held_s(&g->par, SIM_GLOVE_SENSORS - 1, tick_s);
    unsigned i = 0, end;
    while (i < SIM_GLOVE_SENSORS) {
        const double held_s = sim_glove_held_s(&g->par, i, tick_s);
        const struct sim_exo_point *next;
        while (e->points > 1 && e->point[e->first].t_s <= held_s) { feed(e, g); }
        next = &e->point[e->first];
        end = SIM_GLOVE_SENSORS;
        if (e->points > 1 && next->t_s <= last_s) { /* in the midst of the frame */
            for (end = i + 1; sim_glove_held_s(&g->par, end, tick_s) < next->t_s; end++) {}
        }
        sim_glove_scan(g, i, end, tick_s);
        i = end;
    }
    memcpy(raw, g->code, sizeof g->code);
}
