/* SPDX-License-Identifier: MIT */
#include "operator.h"

#include <string.h>

#define DEG (6.283185307179586 / 360)

/* Thumb: rotation, MPJ, IJ, abduction; index, middle with abduction to the index, ring,
 * little: MPJ, PIJ, DIJ, abduction; palm arch, wrist pitch, wrist yaw. */
const struct sim_pose sim_pose[] = {
    {"flat", "hand flat on the table, fingers together",
        {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}},
    {"fist", "make a fist, thumb beside it",
        {0, 0, 45, 0, 90, 90, 70, 90, 90, 70, 0, 90, 90, 70, 0, 90, 90, 70, 0, 20, 0, 0}},
    {"spread", "hand flat, fingers and thumb as far apart as they go",
        {0, 0, 0, 50, 0, 0, 0, 0, 0, 0, 30, 0, 0, 0, 30, 0, 0, 0, 40, 0, 0, 0}},
    {"hook", "fingers straight at the knuckles, rolled up beyond them",
        {0, 0, 0, 0, 0, 90, 90, 0, 90, 90, 0, 0, 90, 90, 0, 0, 90, 90, 0, 0, 0, 0}},
    {"table", "fingers straight, at a right angle to the palm",
        {0, 0, 0, 0, 90, 0, 0, 90, 0, 0, 0, 90, 0, 0, 0, 90, 0, 0, 0, 0, 0, 0}},
    {"thumb_out", "hand flat, thumb stretched back and out",
        {-60, -30, 0, 50, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}},
    {"thumb_in", "hand flat, thumb bent across the palm",
        {60, 30, 90, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}},
    {"cup", "the palm as hollow as it goes",
        {30, 0, 20, 20, 30, 20, 10, 30, 20, 10, 0, 30, 20, 10, 0, 30, 20, 10, 0, 40, 0, 0}},
    {"pinch", "tips of thumb and index together, the others open",
        {40, 10, 30, 30, 50, 45, 25, 10, 10, 5, 10, 10, 10, 5, 5, 10, 10, 5, 10, 10, 0, 0}},
    {"point", "the index straight, the others a fist",
        {20, 10, 45, 0, 0, 0, 0, 90, 90, 70, 0, 90, 90, 70, 0, 90, 90, 70, 0, 20, 0, 0}},
    {"wrist_up", "hand flat, bent up at the wrist",
        {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 40, 0}},
    {"wrist_down", "hand flat, bent down at the wrist",
        {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, -30, 0}},
    {"wrist_in", "hand flat, turned in at the wrist",
        {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, -30}},
    {"wrist_out", "hand flat, turned out at the wrist",
        {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 10}},
};
const int sim_poses = (int)(sizeof sim_pose / sizeof sim_pose[0]);

#define FLAT 0
#define FIST 1

int sim_pose_find(const char *name)
{
    for (int i = 0; i < sim_poses; i++) {
        if (strcmp(sim_pose[i].name, name) == 0) { return i; }
    }
    return -1;
}

struct sim_operator_par sim_operator_default(void)
{
    const struct sim_operator_par p = {SIM_REST, FLAT, 0.5, 0.5, 1, 0, NULL, 0, 0};
    return p;
}

/* Where joint i is in a pose, this time. */
static double pose_rad(struct sim_operator *o, int pose, int i)
{
    double off = 0;
    if (o->par.off_rad > 0) { off = o->par.off_rad * (2 * sim_random_unit(&o->rng) - 1); }
    return sim_pose[pose].deg[i] * DEG + off;
}

/* (10 - 15 u + 6 u^2) u^3 of the way, u = s / move_s. */
static void move_to(struct sim_operator *o, struct sim_glove *g, int pose, double start_s)
{
    const double u = 1 / o->par.move_s, u3 = u * u * u;
    for (int i = 0; i < SIM_GLOVE_SENSORS; i++) {
        const double to = pose_rad(o, pose, i), way = to - o->at_rad[i];
        const struct sim_curve x = {start_s,
            {o->at_rad[i], 0, 0, 10 * way * u3, -15 * way * u3 * u, 6 * way * u3 * u * u}, 0, 0, 0};
        sim_glove_move(g, (unsigned)i, &x);
        o->at_rad[i] = to;
    }
    o->to = pose;
    o->begin_s = start_s;
    o->end_s = start_s + o->par.move_s;
    o->step++;
}

static void hold(struct sim_operator *o, struct sim_glove *g, double start_s)
{
    for (int i = 0; i < SIM_GLOVE_SENSORS; i++) {
        const struct sim_curve x = {start_s, {o->at_rad[i]}, 0, 0, 0};
        sim_glove_move(g, (unsigned)i, &x);
    }
}

/* Thumb, index, middle, ring, little, palm and wrist: which is how late. */
static int finger_of(int sensor)
{
    return sensor < 4 ? 0 : sensor < 7 ? 1 : sensor < 19 ? 2 + (sensor - 7) / 4 : 0;
}

static void wave(struct sim_operator *o, struct sim_glove *g)
{
    const double turn = 6.283185307179586;
    for (int i = 0; i < SIM_GLOVE_SENSORS; i++) {
        const double mid = (sim_pose[FLAT].deg[i] + sim_pose[FIST].deg[i]) / 2 * DEG;
        const double amp = (sim_pose[FIST].deg[i] - sim_pose[FLAT].deg[i]) / 2 * DEG;
        const struct sim_curve x = {0, {mid}, amp, turn * o->par.wave_hz, -turn / 8 * finger_of(i)};
        sim_glove_move(g, (unsigned)i, &x);
    }
}

/* From row `step` to the next. */
static void play(struct sim_operator *o, struct sim_glove *g)
{
    const double(*row)[SIM_GLOVE_SENSORS] = o->par.row_rad + o->step;
    const double start_s = (double)o->step / o->par.row_hz;
    const int last = o->step + 1 >= o->par.rows;
    for (int i = 0; i < SIM_GLOVE_SENSORS; i++) {
        const double slope = last ? 0 : (row[1][i] - row[0][i]) * o->par.row_hz;
        const struct sim_curve x = {start_s, {row[0][i], slope}, 0, 0, 0};
        sim_glove_move(g, (unsigned)i, &x);
    }
    o->step++;
    o->begin_s = start_s;
    o->end_s = (double)o->step / o->par.row_hz;
}

void sim_operator_start(struct sim_operator *o, const struct sim_operator_par *p,
    struct sim_glove *g, const struct sim_glove_par *gp, uint64_t seed)
{
    memset(o, 0, sizeof *o);
    o->par = *p;
    o->rng.state = seed;
    o->asked = -1;
    o->to = p->pose;
    for (int i = 0; i < SIM_GLOVE_SENSORS; i++) {
        o->at_rad[i] = p->does == SIM_RECORD ? p->row_rad[0][i] : pose_rad(o, p->pose, i);
    }
    sim_glove_start(g, gp, seed ^ UINT64_C(0x676C6F7665), o->at_rad);
    if (p->does == SIM_WAVE) { wave(o, g); }
}

/* The next pose of an operator that continues automatically. */
static int next_pose(const struct sim_operator *o)
{
    if (o->par.does == SIM_GRASP) { return o->to == FIST ? FLAT : FIST; }
    return (o->to + 1) % sim_poses;
}

void sim_operator_advance(struct sim_operator *o, struct sim_glove *g, double t_s)
{
    const int by_itself = o->par.does == SIM_POSES || o->par.does == SIM_GRASP;
    const double rest_s = o->par.does == SIM_POSES ? o->par.rest_s : 0;
    for (;;) {
        if (o->par.does == SIM_RECORD) {
            if (o->step >= o->par.rows || t_s < o->end_s) { return; }
            play(o, g);
        } else if (o->step % 2 && t_s >= o->end_s) { /* a movement is over */
            hold(o, g, o->end_s);
            o->step++;
        } else if (by_itself && o->step % 2 == 0 && t_s >= o->end_s + rest_s) {
            move_to(o, g, next_pose(o), o->end_s + rest_s);
        } else if (o->asked >= 0 && o->step % 2 == 0) {
            move_to(o, g, o->asked, t_s);
            o->asked = -1;
        } else {
            return;
        }
    }
}

void sim_operator_go(struct sim_operator *o, int pose) { o->asked = pose; }

int sim_operator_at_rest(const struct sim_operator *o, double t_s)
{
    return o->asked < 0 && t_s >= o->end_s;
}

void sim_operator_frame(
    struct sim_operator *o, struct sim_glove *g, double tick_s, int16_t raw[SIM_GLOVE_SENSORS])
{
    for (unsigned i = 0; i < SIM_GLOVE_SENSORS; i++) {
        const double held_s = sim_glove_held_s(&g->par, i, tick_s);
        sim_operator_advance(o, g, held_s);
        sim_glove_scan(g, i, i + 1, tick_s);
    }
    memcpy(raw, g->code, sizeof g->code);
}
