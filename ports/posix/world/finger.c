/* SPDX-License-Identifier: MIT */
#include "finger.h"

#include "rpy.h"

#include "sim/lag.h"

/* The published robot description of the hand (FFH): position and rotation of each finger's base in
 * the palm. The four fingers have pitch -90 degrees; only their roll differs. */
static const struct {
    struct v3 at_m, rpy_rad;
} base[FINGERS] = {
    {{0.06217593, 0.044372912, 0.078734808}, {0.225810, -1.083656, 0.411355}},
    {{-0.002529881, 0.03680013, 0.107783545}, {3.054326, -1.570796326794896619, 0}},
    {{-0.0037, 0.01, 0.117783545}, {3.141592653589793116, -1.570796326794896619, 0}},
    {{0, -0.01680013, 0.11258354}, {-3.054326, -1.570796326794896619, 0}},
    {{0.000971571, -0.0433963, 0.093583545}, {-2.967060, -1.570796326794896619, 0}},
};

static const double length_m[3] = {0.055, 0.025, 0.025};

const char *const finger_name[FINGERS] = {"thumb", "index", "middle", "ring", "little"};
const double finger_radius_m[3] = {0.0116, 0.0109, FINGER_PAD_M};
const double finger_lo_rad[3] = {-0.261799, 0, 0};
const double finger_hi_rad[3] = {0.261799, 1.48353, 1.13446};

void hand_hit2(struct hand *h)
{
    for (unsigned i = 0; i < FINGERS; i++) {
        h->base[i].turn = rpy_turn(base[i].rpy_rad);
        h->base[i].at = base[i].at_m;
    }
}

/* Turning by a sum of angles costs four products, a sine eighteen. */
struct angle {
    double c, s;
};

static struct angle angle(int32_t turn_q32)
{
    const double rad = turn_q32 * RAD_PER_TURN_Q32;
    const struct angle a = {sim_cos(rad), sim_sin(rad)};
    return a;
}

static struct angle sum(struct angle a, struct angle b)
{
    const struct angle c = {a.c * b.c - a.s * b.s, a.s * b.c + a.c * b.s};
    return c;
}

void finger_at(
    struct finger *f, const struct hand *h, unsigned which, const int32_t joint_turn_q32[3])
{
    const struct pose *b = &h->base[which];
    const struct angle q0 = angle(joint_turn_q32[0]), q2 = angle(joint_turn_q32[2]);
    struct angle bent = angle(joint_turn_q32[1]);
    double out = 0, up = 0; /* in the plane the finger bends in */
    for (int i = 0; i < 3; i++) {
        f->joint[i] = pose_by(b, v3(q0.c * out, q0.s * out, up));
        out += length_m[i] * bent.c;
        up += length_m[i] * bent.s;
        if (i < 2) { bent = sum(bent, q2); }
    }
    f->tip = pose_by(b, v3(q0.c * out, q0.s * out, up));
}
