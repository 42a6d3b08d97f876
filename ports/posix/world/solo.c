/* SPDX-License-Identifier: MIT */
#include "solo.h"

#include "rpy.h"

#include <string.h>

#define SPEED    0.8  /* of the whole bend, a second */
#define STRING_M 0.07 /* that runs out over the whole bend */
#define FREEZE_M 0.003
#define SOFT_N   40.0 /* per whole bend that is wanted too much */

void solo_script(struct solo *s, double t_s)
{
    const double t = t_s - 6 * floor(t_s / 6);
    for (int f = 0; f < FINGERS; f++) {
        const double begin = 0.3 + 0.25 * f, in = (t - begin) / 1.8, out = (5.6 - t) / 1.2;
        const double v = fmin(fmin(in, out), 1);
        s->want[f] = v > 0 ? v * v * (3 - 2 * v) : 0;
    }
}

static int32_t turn_q32(double rad) { return (int32_t)floor(rad / RAD_PER_TURN_Q32 + 0.5); }

static int32_t scaled(double v, double one)
{
    return (int32_t)floor(fmin(fmax(v * one, -2147483648.0), 2147483647.0) + 0.5);
}

static double distance(const struct exh_wire_plane *p, struct v3 tip)
{
    const double n[3] = {
        p->normal_q30[0] * 0x1p-30, p->normal_q30[1] * 0x1p-30, p->normal_q30[2] * 0x1p-30};
    return (p->point_m_q30[0] * 0x1p-30 - tip.x) * n[0] +
           (p->point_m_q30[1] * 0x1p-30 - tip.y) * n[1] +
           (p->point_m_q30[2] * 0x1p-30 - tip.z) * n[2] + FINGER_PAD_M;
}

static void pose_finger(const struct solo *s, const struct world *w, int f,
    struct exh_wire_state *out, struct finger *at)
{
    const double b = s->bend[f];
    out->joint_turn_q32[f][0] = 0;
    out->joint_turn_q32[f][1] = turn_q32(b * finger_hi_rad[1] * 0.82);
    out->joint_turn_q32[f][2] =
        turn_q32(b * finger_hi_rad[2] * (f == 0 ? 1 : 0.80)); /* a thumb meets the others */
    finger_at(at, world_hand(w), (unsigned)f, out->joint_turn_q32[f]);
}

static void one_finger(struct solo *s, const struct world *w, const struct exh_wire_plane *p,
    double dt_s, int f, struct exh_wire_state *out)
{
    const struct scene *sc = world_scene(w);
    const double before = s->bend[f], most = SPEED * dt_s;
    double d = -1, force = 0;
    struct finger at;
    s->bend[f] += fmin(fmax(s->want[f] - before, -most), most);
    pose_finger(s, w, f, out, &at);
    if (p->kind == EXH_PLANE_HIT) { d = distance(p, at.tip); }
    s->armed[f] = p->kind == EXH_PLANE_HIT && (s->armed[f] || d < -FREEZE_M);
    if (s->armed[f] && d >= 0 && s->bend[f] > before) { /* what is touched stops it */
        s->bend[f] = before;
        pose_finger(s, w, f, out, &at);
        d = distance(p, at.tip);
    }
    if (s->armed[f] && d > -0.001 && s->want[f] > s->bend[f] && p->material < sc->materials) {
        force = fmin(SOFT_N * (s->want[f] - s->bend[f]), sc->material[p->material].f_max);
    }
    out->tip_m_q30[f][0] = scaled(at.tip.x, 0x1p30);
    out->tip_m_q30[f][1] = scaled(at.tip.y, 0x1p30);
    out->tip_m_q30[f][2] = scaled(at.tip.z, 0x1p30);
    out->d_m_q30[f] = scaled(d, 0x1p30);
    out->q_m_q30[f] = scaled(s->bend[f] * STRING_M, 0x1p30);
    out->q_lim_m_q30[f] = scaled(s->bend[f] * STRING_M - d, 0x1p30);
    out->force_N_q20[f] = scaled(force, 0x1p20);
    if (s->armed[f] && d > -FREEZE_M) { out->frozen |= (uint8_t)(1u << f); }
    if (force > 0) { out->touching |= (uint8_t)(1u << f); }
}

void solo_step(struct solo *s, const struct world *w, const struct exh_wire_planes *last,
    double dt_s, struct exh_wire_state *out)
{
    const uint32_t tick = out->tick + 1;
    memset(out, 0, sizeof *out);
    out->tick = tick;
    out->fingers = (uint8_t)world_scene(w)->fingers;
    for (int f = 0; f < FINGERS; f++) { one_finger(s, w, &last->plane[f], dt_s, f, out); }
}
