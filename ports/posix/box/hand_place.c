/* SPDX-License-Identifier: MIT */
/* Where things are: the glove's calibration, a finger by its string, walls, first touch. */
#include "box/hand.h"

#include "world/world.h"

#include <math.h>
#include <string.h>

#define TWO_PI  6.283185307179586
#define DEG     (TWO_PI / 360)
#define STEP_M  1e-4
#define TOP_M   0.08
#define SENSORS EXH_GLOVE_SENSORS

/* Nearest. */
static int32_t fixed(double v, int frac)
{
    return (int32_t)floor(v * (double)(INT64_C(1) << frac) + 0.5);
}

/* --- the glove --- */

void bilateral_cal_of(struct exh_glove_cal *cal, const struct sim_glove_par *p)
{
    *cal = exh_glove_cal_default;
    cal->present = (1u << SENSORS) - 1;
    for (unsigned i = 0; i < SENSORS; i++) {
        const struct sim_glove_sensor *n = &sim_glove_sensor[i];
        struct exh_glove_sensor *s = &cal->sensor[i];
        const double per_rad = (n->hi - n->lo) / ((n->hi_deg - n->lo_deg) * DEG);
        const double raw_per_share = p->gain * p->excite_V * (1 - 2 * p->dead) * 32768 / p->span_V;
        const double raw_at_0 =
            (p->gain * p->excite_V * (p->dead + (1 - 2 * p->dead) * n->lo) + p->offset_V) * 32768 /
                p->span_V -
            n->lo_deg * DEG * per_rad * raw_per_share;
        const double raw_per_turn = per_rad * raw_per_share * TWO_PI;
        const double lo = raw_at_0 + n->lo_deg * DEG * per_rad * raw_per_share;
        const double hi = raw_at_0 + n->hi_deg * DEG * per_rad * raw_per_share;
        s->zero_raw_q15 = fixed(raw_at_0, 15);
        s->gain_turnpraw_q38 = fixed(1 / raw_per_turn, 38);
        s->low_raw = (int16_t)floor(lo < hi ? lo : hi);
        s->high_raw = (int16_t)ceil(lo < hi ? hi : lo);
        for (int k = 0; k < 2; k++) {
            const int bent = n->bend[k] >= 0 && p->couple != 0;
            s->of[k] = bent ? (uint8_t)n->bend[k] : EXH_GLOVE_NONE;
            s->cross_q30[k] = bent ? fixed(-p->couple / 2, 30) : 0;
        }
    }
}

/* --- a finger --- */

/* Flexion sensors, as sim/exo.c bends them: knuckle, and what is beyond it. */
static const signed char bends[BILATERAL_FINGERS][3] = {
    {1, 2, -1}, {4, 5, 6}, {7, 8, 9}, {11, 12, 13}, {15, 16, 17}};

/* What each call of drawn_out() would find anew. */
static struct {
    struct exh_hand_finger hand[BILATERAL_FINGERS];
    int32_t turn_q32[SENSORS];
    int pose, set;
} known;

static void know(int pose)
{
    const struct exh_hand_par par = {
        exh_hand_rows[0].dflt, exh_hand_rows[1].dflt, exh_hand_rows[2].dflt, exh_hand_rows[3].dflt};
    if (known.set && known.pose == pose) { return; }
    for (unsigned f = 0; f < BILATERAL_FINGERS; f++) {
        (void)exh_hand_setup(&known.hand[f], &exh_hit2_bones[f], &par); /* the defaults are good */
    }
    for (int i = 0; i < SENSORS; i++) {
        known.turn_q32[i] = fixed(sim_pose[pose].deg[i] / 360, 32);
    }
    known.pose = pose;
    known.set = 1;
}

/* Joints and tip when it has drawn so much string out. */
static void drawn_out(const struct bilateral_finger_is *w, double x_m,
    int32_t joint_turn_q32[EXH_HAND_JOINTS], struct exh_vec3 *tip_m_q30)
{
    const double rest = w->arm_m[1] + w->arm_m[2], square = w->arm_m[0] * w->arm_m[0] + rest * rest;
    int32_t turn_q32[SENSORS];
    know(w->pose);
    memcpy(turn_q32, known.turn_q32, sizeof turn_q32);
    for (int j = 0; j < 3; j++) {
        const double rad = x_m * (j ? rest : w->arm_m[0]) / square;
        if (bends[w->f][j] >= 0) { turn_q32[bends[w->f][j]] = fixed(rad / TWO_PI, 32); }
    }
    exh_hand_joints(&exh_hit2_map, w->f, turn_q32, joint_turn_q32);
    exh_hand_tip(&known.hand[w->f], joint_turn_q32, tip_m_q30);
}

/* The fingertip's way from here to there, as n and how far; m, q30. */
static double tip_way(const struct bilateral_finger_is *w, double from_m, double to_m, double n[3])
{
    int32_t joint[EXH_HAND_JOINTS];
    struct exh_vec3 a, b;
    drawn_out(w, from_m, joint, &a);
    drawn_out(w, to_m, joint, &b);
    n[0] = (double)a.x - b.x;
    n[1] = (double)a.y - b.y;
    n[2] = (double)a.z - b.z;
    return sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
}

double bilateral_scale(const struct bilateral_finger_is *w, double x_m, double d_m)
{
    double from_m = x_m, tip_m, n[3];
    do {
        from_m -= STEP_M;
        tip_m = ldexp(tip_way(w, from_m, x_m, n), -EXH_Q_POS);
    } while (from_m > 0 && tip_m < d_m);
    return (x_m - from_m) / tip_m;
}

void bilateral_wall(struct exh_wire_plane *to, const struct bilateral_finger_is *w, double x_m)
{
    int32_t joint[EXH_HAND_JOINTS];
    struct exh_vec3 a;
    double n[3], offset;
    const double length = tip_way(w, x_m - STEP_M, x_m + STEP_M, n);
    drawn_out(w, x_m, joint, &a);
    offset = (n[0] * a.x + n[1] * a.y + n[2] * a.z) / length - exh_hand_rows[3].dflt;
    memset(to, 0, sizeof *to);
    to->kind = EXH_PLANE_HIT;
    to->object = (uint16_t)w->f;
    for (int i = 0; i < 3; i++) {
        to->normal_q30[i] = fixed(n[i] / length, 30);
        to->point_m_q30[i] = fixed(n[i] / length * offset, 0);
        to->hit_m_q30[i] = to->point_m_q30[i];
    }
}

double bilateral_gap_m(
    const struct peer_world *world, const struct bilateral_finger_is *w, double x_m, double t_s)
{
    int32_t joint[EXH_HAND_JOINTS], tip_q30[3];
    struct exh_vec3 tip;
    drawn_out(w, x_m, joint, &tip);
    tip_q30[0] = tip.x;
    tip_q30[1] = tip.y;
    tip_q30[2] = tip.z;
    return world->scene ? -world_gap_m(world->scene, w->f, joint, t_s)
                        : peer_gap_m(&world->wall.plane[w->f], tip_q30);
}

double bilateral_string_m(
    const struct peer_world *world, const struct bilateral_finger_is *w, double t_s, double d_m)
{
    double lo, hi, x = 0;
    while (x <= TOP_M && bilateral_gap_m(world, w, x, t_s) < d_m) { x += STEP_M; }
    if (x > TOP_M) { return -1; }
    lo = x - STEP_M;
    hi = x;
    for (int i = 0; i < 30; i++) {
        const double mid = 0.5 * (lo + hi);
        if (bilateral_gap_m(world, w, mid, t_s) < d_m) {
            lo = mid;
        } else {
            hi = mid;
        }
    }
    return hi;
}

void bilateral_leave_out(const struct bilateral_run_cfg *c)
{
    struct bilateral_cfg *scene;
    if (c->board.log || c->board.log_put || c->blackbox || c->more) { return; }
    (void)bilateral_memory(&scene);
    sim_glove_reads(posix_glove(), scene->sensors);
}
