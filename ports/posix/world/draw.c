/* SPDX-License-Identifier: MIT */
#include "draw.h"

#include "rpy.h"

#include <stdlib.h>
#include <string.h>

#define DISC_M 0.022
#define LIFT_M 0.0006 /* a disc above the surface it touches, to be seen */
#define DOT_M  0.0012

static void paint(struct draw_item *i, double r, double g, double b, double opaque)
{
    i->colour[0] = (float)r;
    i->colour[1] = (float)g;
    i->colour[2] = (float)b;
    i->colour[3] = (float)opaque;
}

static void objects(const struct scene *s, double t_s, struct draw_list *list)
{
    static const enum draw_kind kind[] = {
        DRAW_SQUARE, DRAW_SPHERE, DRAW_BOX, DRAW_CAPSULE, DRAW_MESH};
    for (int k = 0; k < s->objects; k++) {
        const struct scene_object *o = &s->object[k];
        const double *c = s->material[o->material].colour;
        struct draw_item *i = draw_add(list, kind[o->shape.kind], DRAW_OBJECT, k);
        i->at = motion_at(&o->motion, &o->stand, t_s);
        i->size = o->shape.kind == SHAPE_PLANE ? v3(o->draw_m, o->draw_m, 0)
                  : o->shape.kind == SHAPE_BOX
                      ? o->shape.half_m
                      : v3(o->shape.radius_m, o->shape.radius_m, o->shape.half_m.z);
        i->mesh = o->shape.mesh;
        i->still = o->motion.kind == MOTION_NONE;
        paint(i, c[0], c[1], c[2], 1);
    }
}

static struct v3 from_q30(const int32_t v[3])
{
    return v3(v[0] * 0x1p-30, v[1] * 0x1p-30, v[2] * 0x1p-30);
}

/* The frame at `at` whose z points along `z`. */
static struct pose looking(struct v3 at, struct v3 z)
{
    struct pose p = {{v3(1, 0, 0), v3(0, 1, 0), v3(0, 0, 1)}, at};
    const struct v3 side = fabs(z.x) < fabs(z.y) ? v3(1, 0, 0) : v3(0, 1, 0);
    frame_from_z(&p.turn, z, side);
    return p;
}

/* Waiting blue, frozen amber, touching red. */
static void state_colour(const struct exh_wire_state *in, int f, struct draw_item *i, double opaque)
{
    if (in->touching >> f & 1) {
        paint(i, 1.0, 0.30, 0.25, opaque);
    } else if (in->frozen >> f & 1) {
        paint(i, 1.0, 0.72, 0.15, opaque);
    } else {
        paint(i, 0.25, 0.65, 1.0, opaque);
    }
}

/* The collision plane as a disc around P_C, and dots from P_F to it. */
static void plane(
    const struct draw_moment *m, const struct pose *hand, int f, struct draw_list *list)
{
    const struct exh_wire_plane *p = &m->out.plane[f];
    const struct v3 n = m3_by(&hand->turn, from_q30(p->normal_q30));
    const struct v3 at = pose_by(hand, from_q30(p->hit_m_q30));
    const struct v3 tip = pose_by(hand, from_q30(m->in.tip_m_q30[f])), way = v3_sub(at, tip);
    const int dots = (int)(v3_len(way) / 0.005);
    struct draw_item *i = draw_add(list, DRAW_DISC, DRAW_PLANE, f);
    i->at = looking(v3_along(at, LIFT_M, n), n);
    i->size.x = DISC_M;
    state_colour(&m->in, f, i, 0.42);
    for (int k = 1; k < dots; k++) {
        i = draw_add(list, DRAW_SPHERE, DRAW_WAY, f);
        i->at.at = v3_along(tip, (double)k / dots, way);
        i->size.x = DOT_M;
        state_colour(&m->in, f, i, 1);
    }
}

/* A bar on the fingertip where the surface pushes. Its height is the force, along the contact's
 * normal. The glass around it shows the highest force of the material. No bar without contact: F0
 * then does not come from a surface. */
static void bar(const struct scene *s, const struct draw_moment *m, const struct finger *f,
    const struct pose *hand, int which, struct draw_list *list)
{
    const struct exh_wire_plane *p = &m->out.plane[which];
    const struct v3 up = v3_unit(m3_by(&hand->turn, from_q30(p->normal_q30)));
    const struct v3 foot = v3_along(pose_by(hand, f->tip), FINGER_PAD_M, up);
    const double high = m->in.force_N_q20[which] * 0x1p-20 * DRAW_BAR_M_PER_N;
    double most = 0;
    struct draw_item *i;
    if (!(high > 0) || !(m->in.touching >> which & 1) || p->kind != EXH_PLANE_HIT) { return; }
    i = draw_add(list, DRAW_BOX, DRAW_BAR, which);
    i->at = looking(v3_along(foot, high / 2, up), up);
    i->size = v3(0.0042, 0.0042, high / 2);
    paint(i, 0.93, 0.07, 0.07, 1);
    if ((int)p->material < s->materials) {
        most = s->material[p->material].f_max * DRAW_BAR_M_PER_N;
    }
    if (!(most > high)) { return; }
    i = draw_add(list, DRAW_BOX, DRAW_BAR_SCALE, which);
    i->at = looking(v3_along(foot, (high + most) / 2, up), up);
    i->size = v3(0.0042, 0.0042, (most - high) / 2);
    paint(i, 1, 0.55, 0.5, 0.28);
}

void world_draw(const struct world *w, const struct draw_moment *m, struct draw_list *list)
{
    list->items = list->texts = list->rects = list->lost = 0;
    list->eye = m->eye;
    list->look = m->look;
    objects(world_scene(w), m->t_s, list);
    draw_hand(w, m, list);
    for (int i = 0; i < FINGERS; i++) {
        struct finger f;
        if (!(m->out.fingers >> i & 1)) { continue; }
        finger_at(&f, world_hand(w), (unsigned)i, m->in.joint_turn_q32[i]);
        bar(world_scene(w), m, &f, &m->hand, i, list);
        if (m->out.plane[i].kind == EXH_PLANE_HIT) { plane(m, &m->hand, i, list); }
    }
    draw_numbers(w, m, list);
}

void draw_free(struct draw_list *list)
{
    free(list->item);
    memset(list, 0, sizeof *list);
}

void draw_write(FILE *to, const struct draw_list *list)
{
    for (int k = 0; k < list->texts; k++) {
        fprintf(to, "text %d %d %s\n", list->text[k].x, list->text[k].y, list->text[k].text);
    }
    for (int k = 0; k < list->items; k++) {
        const struct draw_item *i = &list->item[k];
        fprintf(to, "item %d %d %d %.6f %.6f %.6f\n", (int)i->kind, (int)i->what, i->which,
            i->at.at.x, i->at.at.y, i->at.at.z);
    }
}
