/* SPDX-License-Identifier: MIT */
#include "reach.h"

#include <stdlib.h>

/* Rounding of distances of up to some 100 m. */
#define SLACK_M 1e-9

static double farthest(const struct hand *h, unsigned fingers, struct v3 centre)
{
    double most = 0;
    for (unsigned f = 0; f < FINGERS; f++) {
        if (fingers >> f & 1) { most = fmax(most, v3_len(v3_sub(h->base[f].at, centre))); }
    }
    return most;
}

int reach_start(struct reach *r, const struct scene *s, const struct hand *h)
{
    const size_t n = (size_t)s->objects + 1;
    int used = 0;
    r->centre = v3(0, 0, 0);
    for (unsigned f = 0; f < FINGERS; f++) {
        if (s->fingers >> f & 1) {
            r->centre = v3_add(r->centre, h->base[f].at);
            used++;
        }
    }
    r->centre = v3_times(r->centre, 1.0 / used);
    r->span_m = farthest(h, s->fingers, r->centre) + FINGER_SPAN_M + SLACK_M;
    r->radius_m = r->span_m + FINGER_PAD_M + s->look_m;
    r->speed = motion_speed(&s->motion) + motion_turning(&s->motion) * v3_len(r->centre);
    r->asleep = calloc(n, sizeof *r->asleep);
    r->near = calloc(n, sizeof *r->near);
    r->placed = calloc(n, 1);
    if (r->asleep == NULL || r->near == NULL || r->placed == NULL) { return 1; }
    reach_wake(r, s);
    return 0;
}

void reach_stop(struct reach *r)
{
    free(r->asleep);
    free(r->near);
    free(r->placed);
}

/* --- the heap --- */

static void sleep_till(struct reach *r, unsigned object, double wake_s)
{
    int i = r->sleepers++;
    while (i > 0 && r->asleep[(i - 1) / 2].wake_s > wake_s) {
        r->asleep[i] = r->asleep[(i - 1) / 2];
        i = (i - 1) / 2;
    }
    r->asleep[i].wake_s = wake_s;
    r->asleep[i].object = object;
}

static unsigned wake_first(struct reach *r)
{
    const unsigned object = r->asleep[0].object;
    const struct sleeper last = r->asleep[--r->sleepers];
    int i = 0;
    for (;;) {
        int c = 2 * i + 1;
        if (c + 1 < r->sleepers && r->asleep[c + 1].wake_s < r->asleep[c].wake_s) { c++; }
        if (c >= r->sleepers || r->asleep[c].wake_s >= last.wake_s) { break; }
        r->asleep[i] = r->asleep[c];
        i = c;
    }
    r->asleep[i] = last;
    return object;
}

void reach_wake(struct reach *r, const struct scene *s)
{
    r->nears = 0;
    r->sleepers = 0;
    r->t_s = -ENDLESS;
    for (int i = 0; i < s->objects; i++) { sleep_till(r, (unsigned)i, -ENDLESS); }
}

/* --- near or asleep --- */

/* How far the object is out of reach of the hand; below 0: within. */
static double gap(const struct reach *r, const struct shape *is, const struct pose *at)
{
    const struct v3 to = v3_sub(r->centre, at->at);
    if (is->kind == SHAPE_PLANE) { return v3_dot(to, at->turn.z) - r->radius_m; }
    return v3_len(to) - is->bound_m - r->radius_m;
}

/* Places near[i], or puts its object to sleep: 0. */
static int place(struct reach *r, const struct scene *s, const struct pose *hand, double t_s, int i)
{
    const unsigned object = r->near[i].object;
    const struct scene_object *o = &s->object[object];
    const struct pose world = motion_at(&o->motion, &o->stand, t_s), at = pose_in(hand, &world);
    const double apart = gap(r, &o->shape, &at);
    if (apart > 0 && !r->all) {
        double speed = r->speed + motion_speed(&o->motion), wake_s = ENDLESS;
        /* a plane also tilts: no bound, so it is asked again in every frame */
        if (o->shape.kind == SHAPE_PLANE &&
            motion_turning(&o->motion) + motion_turning(&s->motion) > 0) {
            speed = ENDLESS;
        }
        if (speed > 0) {
            wake_s = fmax(t_s + apart / (speed * (1 + 1e-9)), nextafter(t_s, wake_s));
        }
        sleep_till(r, object, wake_s);
        r->nears--;
        r->near[i] = r->near[r->nears];
        r->placed[i] = r->placed[r->nears];
        return 0;
    }
    body_set(&r->near[i], &o->shape, &at, object);
    r->placed[i] = s->motion.kind == MOTION_NONE && o->motion.kind == MOTION_NONE;
    return 1;
}

unsigned reach_update(struct reach *r, const struct scene *s, const struct pose *hand, double t_s)
{
    unsigned moved = 0;
    if (t_s < r->t_s) { reach_wake(r, s); }
    r->t_s = t_s;
    for (int i = 0; i < r->nears;) {
        if (r->placed[i]) {
            i++;
        } else {
            moved++;
            i += place(r, s, hand, t_s, i);
        }
    }
    while (r->sleepers > 0 && r->asleep[0].wake_s <= t_s) {
        r->near[r->nears].object = wake_first(r);
        moved++;
        place(r, s, hand, t_s, r->nears++);
    }
    return moved;
}
