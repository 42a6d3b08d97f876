/* SPDX-License-Identifier: MIT */
/* The virtual hand: a palm of rounded bars, and three capsules a finger. A finger that is not in
 * use is as of glass. */
#include "draw.h"

#define KNUCKLE_M 0.0130

static struct draw_item *capsule(struct draw_list *list, const struct pose *hand, int which,
    struct v3 from, struct v3 to, double radius, const float colour[4])
{
    const struct v3 a = pose_by(hand, from), b = pose_by(hand, to), way = v3_sub(b, a);
    struct draw_item *i = draw_add(list, DRAW_CAPSULE, DRAW_HAND, which);
    const struct v3 z = v3_len(way) > 1e-9 ? v3_unit(way) : v3(0, 0, 1);
    const struct v3 side = fabs(z.x) < 0.8 ? v3(1, 0, 0) : v3(0, 1, 0);
    i->at.at = v3_times(v3_add(a, b), 0.5);
    i->at.turn.z = z;
    i->at.turn.y = v3_unit(v3_cross(z, side));
    i->at.turn.x = v3_cross(i->at.turn.y, z);
    i->size = v3(radius, radius, v3_len(way) / 2);
    for (int k = 0; k < 4; k++) { i->colour[k] = colour[k]; }
    return i;
}

/* Corners of the palm, and the wrist, in {R}. */
static void palm(struct draw_list *list, const struct pose *hand, const struct hand *h)
{
    static const float shell[4] = {0.42F, 0.45F, 0.50F, 1}, joint[4] = {0.20F, 0.22F, 0.26F, 1};
    const struct v3 heel[5] = {{0.012, 0.030, 0.030}, {-0.004, 0.026, 0.022},
        {-0.006, 0.009, 0.018}, {-0.006, -0.009, 0.018}, {-0.004, -0.027, 0.022}};
    for (int f = 0; f < FINGERS; f++) {
        const struct v3 base = h->base[f].at;
        const struct v3 stop = v3_along(heel[f], f == 0 ? 0.85 : 0.88, v3_sub(base, heel[f]));
        capsule(list, hand, -1, heel[f], stop, f == 0 ? 0.0155 : 0.0148, shell);
        capsule(list, hand, -1, stop, base, 0.0112, joint)->hidden = 2;
    }
    capsule(list, hand, -1, v3(-0.002, 0.022, 0.036), v3(-0.002, -0.026, 0.036), 0.017, shell);
    capsule(list, hand, -1, v3(-0.003, 0, 0.012), v3(-0.003, 0, -0.030), 0.021, joint);
}

void draw_hand(const struct world *w, const struct draw_moment *m, struct draw_list *list)
{
    palm(list, &m->hand, world_hand(w));
    for (int i = 0; i < FINGERS; i++) {
        const int on = m->out.fingers >> i & 1;
        const float link[4] = {0.90F, 0.90F, 0.92F, on ? 1 : 0.35F};
        const float tip[4] = {0.26F, 0.29F, 0.34F, on ? 1 : 0.35F};
        struct finger f;
        finger_at(&f, world_hand(w), (unsigned)i, m->in.joint_turn_q32[i]);
        for (int k = 0; k < 3; k++) {
            capsule(list, &m->hand, i, f.joint[k], f.joint[k], KNUCKLE_M, tip);
        }
        capsule(list, &m->hand, i, f.joint[0], f.joint[1], finger_radius_m[0], link)->hidden = 2;
        capsule(list, &m->hand, i, f.joint[1], f.joint[2], finger_radius_m[1], link)->hidden = 2;
        capsule(list, &m->hand, i, f.joint[2], f.tip, finger_radius_m[2], tip)->hidden = 1;
    }
}
