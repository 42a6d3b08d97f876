/* SPDX-License-Identifier: MIT */
#include "ahead.h"

#include "rpy.h"

#include <stddef.h>

#define TOUCH_M      1e-4 /* this near it touches */
#define STEP_M       5e-4 /* no step is shorter: a pad that leaves a surface comes away from it */
#define STEPS        128
#define FAR_M        1.0
#define LATER_S      1.5  /* no way is followed further */
#define RESTS_MPS    0.02 /* slower, and the glove's codes do not say where it goes */
#define GRAZE_FROM_M (3 * FINGER_PAD_M)
#define NEAR_M       0.015 /* no controller freezes at a plane farther off than this */
/* Of joints 1 and 2 while a finger closes: 1 rad/s. */
#define CLOSES_TURN_Q32PS (1 / RAD_PER_TURN_Q32)

/* How fast the tip can be by each joint: m a radian. The last two joints bend alike. */
static const double arm_m[3] = {FINGER_SPAN_M, FINGER_SPAN_M, 0.075};

/* One way of the pad's middle. */
struct way {
    const struct ahead *a;
    const double *turn_q32ps;
    int with_hand;
    double mps; /* at most */
};

static double turn_in(double v, unsigned joint)
{
    const double lo = finger_lo_rad[joint] / RAD_PER_TURN_Q32,
                 hi = finger_hi_rad[joint] / RAD_PER_TURN_Q32;
    return v < lo ? lo : v > hi ? hi : v;
}

static struct v3 tip_at(const struct way *w, double later_s)
{
    const struct ahead *a = w->a;
    int32_t turn_q32[3];
    struct finger f;
    for (unsigned j = 0; j < 3; j++) {
        const double by = w->turn_q32ps ? later_s * w->turn_q32ps[j] : 0;
        turn_q32[j] =
            by == 0 ? a->joint_turn_q32[j] : (int32_t)turn_in(a->joint_turn_q32[j] + by, j);
    }
    finger_at(&f, a->hand, a->finger, turn_q32);
    if (w->with_hand && later_s > 0) {
        const struct pose now = a->hand_at(a->ctx, 0), then = a->hand_at(a->ctx, later_s);
        return pose_back(&now, pose_by(&then, f.tip));
    }
    return f.tip;
}

/* The pad's distance from the nearest body; FAR_M and -1 in *body where none is nearer. Of two at
 * one distance the lower object is it, so that the order of the bodies does not matter. */
static double gap_m(const struct ahead *a, struct v3 p, int *body, struct ahead_stats *s)
{
    double least = FAR_M + FINGER_PAD_M;
    *body = -1;
    for (int i = 0; i < a->bodies; i++) {
        const struct body *b = &a->body[i];
        const double far = a->cull ? least : ENDLESS, away = body_away_m(b, p, far);
        s->culled += b->is.kind != SHAPE_PLANE && away >= far;
        if (away < least || (away == least && *body >= 0 && b->object < a->body[*body].object)) {
            least = away;
            *body = i;
        }
    }
    s->tested += (unsigned long)a->bodies;
    return least - FINGER_PAD_M;
}

/* Where the way first touches: the body, the middle of the pad there, and how long the way is;
 * -1: nowhere. Nothing that is farther off than look_m decides: whether it is in the list or not,
 * the answer has the same bits. */
static int touch(const struct way *w, struct v3 *p, double *way_m, struct ahead_stats *s)
{
    const double half_m = 0.5 * w->a->look_m,
                 most_s = w->with_hand ? fmin(LATER_S, half_m / w->a->hand_mps) : LATER_S;
    double later_s = 0;
    int body;
    *way_m = 0;
    *p = tip_at(w, 0);
    for (int i = 0; i < STEPS && later_s < most_s; i++) {
        const double gap = gap_m(w->a, *p, &body, s);
        struct v3 next;
        if (gap < TOUCH_M) { return body; }
        later_s += fmin(fmax(gap, STEP_M), half_m) / w->mps;
        next = tip_at(w, later_s);
        *way_m += v3_len(v3_sub(next, *p));
        *p = next;
    }
    return -1;
}

static void patch(const struct ahead *a, int body, struct v3 p, struct ahead_patch *to)
{
    to->body = body;
    if (body < 0) { return; }
    to->normal = body_plane(&a->body[body], p, &to->offset_m);
    to->point = v3_along(p, to->offset_m - v3_dot(to->normal, p), to->normal);
}

/* What the way touches first, if the pad is well before its plane now. */
static int on_way(const struct way *w, struct v3 tip, struct ahead_patch *to, struct ahead_stats *s)
{
    struct v3 p;
    double way_m, gap;
    const int body = touch(w, &p, &way_m, s);
    if (body < 0) { return 0; }
    patch(w->a, body, p, to);
    gap = v3_dot(to->normal, tip) - to->offset_m - FINGER_PAD_M;
    if (gap < (way_m > GRAZE_FROM_M ? fmin(w->a->graze * way_m, NEAR_M) : 0)) {
        patch(w->a, body, tip, to);
    }
    return 1;
}

static double mps_of(const double turn_q32ps[3])
{
    double mps = 0;
    for (int j = 0; j < 3; j++) { mps += arm_m[j] * fabs(turn_q32ps[j]) * RAD_PER_TURN_Q32; }
    return mps;
}

void ahead_look(const struct ahead *a, struct ahead_patch *to, struct ahead_stats *s)
{
    static const double alike[3] = {0, CLOSES_TURN_Q32PS, CLOSES_TURN_Q32PS};
    const double *closes =
        a->pull_turn_q32ps && mps_of(a->pull_turn_q32ps) > 0 ? a->pull_turn_q32ps : alike;
    const double own_mps = a->turn_q32ps ? mps_of(a->turn_q32ps) : 0;
    const struct way goes = {a, a->turn_q32ps, a->hand_at != NULL, own_mps + a->hand_mps},
                     close = {a, closes, 0, mps_of(closes)};
    const struct v3 tip = tip_at(&goes, 0);
    int body;
    const double gap = gap_m(a, tip, &body, s);
    const int rests = goes.mps < RESTS_MPS;
    to->body = -1;
    if (gap < TOUCH_M) {
        patch(a, body, tip, to);
        return;
    }
    if (!rests && on_way(&goes, tip, to, s)) { return; }
    if (on_way(&close, tip, to, s)) { return; }
    if (rests && gap < a->look_m) { patch(a, body, tip, to); }
}
