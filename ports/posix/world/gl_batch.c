/* SPDX-License-Identifier: MIT */
/* Collects bodies into one array of vertices with colours, so that a picture needs few calls:
 * without a graphics card, a call costs as much as a hundred vertices. Light is computed per
 * vertex: sky from above, a lamp, some from the eye, specular light, darker edges. */
#include "gl.h"

#include "rpy.h"

#include <stdint.h>
#include <stdlib.h>

#define LIFT_M 0.0003 /* a shadow above its floor, to be seen */

const struct v3 gl_light = {-0.40, -0.25, 0.88};

/* What one thing is painted with. */
struct brush {
    const struct draw_item *item;
    struct m3 turn;           /* of the form */
    struct v3 x, y, z, carry; /* columns of place, and where w carries */
    struct v3 eye;
    const struct draw_item *floor; /* not NULL: its shadow there */
};

static double power24(double v)
{
    const double v8 = v * v * v * v * (v * v * v * v);
    return v8 * v8 * v8;
}

static void lit(const struct brush *b, struct v3 p, struct v3 n, float c[4])
{
    const struct v3 u = v3_unit(n), v = v3_unit(v3_sub(b->eye, p));
    const double up = 0.5 + 0.5 * u.z, lamp = fmax(v3_dot(u, gl_light), 0);
    const double face = fmax(v3_dot(u, v), 0), side = 1 - face,
                 edge = 1 - 0.35 * side * side * side;
    const double shine = 0.14 * power24(fmax(v3_dot(u, v3_unit(v3_add(gl_light, v))), 0));
    const double low[3] = {0.24, 0.23, 0.25}, high[3] = {0.22, 0.26, 0.29};
    for (int i = 0; i < 3; i++) {
        c[i] = (float)fmin(
            (double)c[i] * edge * (low[i] + high[i] * up + 0.50 * lamp + 0.22 * face) + shine, 1);
    }
}

static void paint(
    const struct brush *b, const struct gl_corner *k, struct v3 p, struct v3 n, float c[4])
{
    for (int i = 0; i < 4; i++) { c[i] = b->item->colour[i]; }
    switch (b->item->what) {
    case DRAW_PLANE: c[3] = (float)fmin(1, (double)c[3] * (1 + 1.2 * k->carried)); return;
    case DRAW_BAR_SCALE:
    case DRAW_WAY: return;
    case DRAW_BAR:
        for (int i = 0; i < 3; i++) { c[i] *= (float)(0.86 + 0.14 * v3_dot(n, gl_light)); }
        return;
    case DRAW_HAND:
    case DRAW_OBJECT: lit(b, p, n, c); break;
    }
}

static int room(struct gl_batch *g, int vertices, int indices)
{
    if (g->vertices + vertices > g->vertex_room) {
        const int n = 2 * (g->vertices + vertices);
        struct gl_vertex *more = realloc(g->vertex, (size_t)n * sizeof *more);
        if (more == NULL) { return 1; }
        g->vertex = more;
        g->vertex_room = n;
    }
    if (g->indices + indices > g->index_room) {
        const int n = 2 * (g->indices + indices);
        GLuint *more = realloc(g->index, (size_t)n * sizeof *more);
        if (more == NULL) { return 1; }
        g->index = more;
        g->index_room = n;
    }
    return 0;
}

static void one_corner(struct gl_batch *g, const struct brush *b, const struct gl_corner *k)
{
    static const float shade[4] = {0.05F, 0.07F, 0.10F, 0.30F};
    struct gl_vertex *to = &g->vertex[g->vertices++];
    struct v3 p = v3_along(b->item->at.at, k->place.x, b->x), on = k->place;
    p = v3_along(v3_along(v3_along(p, k->place.y, b->y), k->place.z, b->z), k->carried, b->carry);
    if (b->floor) {
        const struct v3 up = b->floor->at.turn.z;
        const double high = v3_dot(up, v3_sub(p, b->floor->at.at)) - LIFT_M;
        p = v3_along(p, -high / v3_dot(up, gl_light), gl_light);
        on = v3_times(pose_back(&b->floor->at, p), 1 / b->floor->size.x);
        for (int i = 0; i < 4; i++) { to->colour[i] = shade[i]; }
    } else {
        paint(b, k, p, m3_by(&b->turn, k->normal), to->colour);
    }
    to->place[0] = (float)p.x;
    to->place[1] = (float)p.y;
    to->place[2] = (float)p.z;
    to->on[0] = (float)on.x;
    to->on[1] = (float)on.y;
}

static int is_round(const struct draw_item *i)
{
    return i->kind == DRAW_SPHERE || i->kind == DRAW_CAPSULE;
}

static int is_long(const struct draw_item *i) { return i->kind == DRAW_CAPSULE && i->size.z > 0; }

/* The frame of a body's form. Round: x to the eye, but z along its axis. Flat: z to the eye. Its
 * outline: z to the lamp and x along the axis. */
static void set_round(struct brush *b, struct gl_forms *f, int form)
{
    const struct draw_item *i = b->item;
    const struct v3 to = v3_sub(b->eye, i->at.at), axis = i->at.turn.z;
    const int round = f->form[form].strips > 0;
    const struct v3 main = form == GL_FORM_SHADE || form == GL_FORM_DIM ? gl_light
                           : is_long(i)                                 ? axis
                                                                        : to;
    const struct v3 next = round && is_long(i) ? to : axis;
    struct m3 *t = &b->turn;
    if (frame_from_z(t, main, next) && frame_from_z(t, main, v3(1, 0, 0))) {
        frame_from_z(t, main, v3(0, 1, 0));
    }
    if (!is_long(i) && round) { *t = (struct m3){t->z, t->x, t->y}; }
    if (round) { gl_form_face(f, form, atan2(v3_dot(to, t->z), v3_dot(to, t->x))); }
    b->x = v3_times(t->x, i->size.x);
    b->y = v3_times(t->y, i->size.x);
    b->z = v3_times(t->z, i->size.x);
    b->carry = v3_times(axis, is_long(i) ? i->size.z : 0);
}

static void set_brush(struct brush *b)
{
    const struct draw_item *i = b->item;
    const int flat = i->kind == DRAW_SQUARE || i->kind == DRAW_DISC;
    b->turn = i->at.turn;
    b->x = v3_times(b->turn.x, i->size.x);
    b->y = v3_times(b->turn.y, flat ? i->size.x : i->size.y);
    b->z = v3_times(b->turn.z, i->size.z);
    b->carry = v3(0, 0, 0);
}

/* A round form without the ends that are hidden, or of a ball without the middle. */
static struct gl_form seen_of(const struct gl_form *f, const struct draw_item *i)
{
    struct gl_form m = *f;
    const int wide = m.steps + 1, end = 6 * (m.steps - 1) * m.strips;
    if (m.strips == 0) { return m; }
    if (!is_long(i)) {
        m.indices -= 6 * m.steps;
        return m;
    }
    m.index += i->hidden * end;
    m.indices -= i->hidden * end;
    if (i->hidden > 0) { m.corner += m.strips * wide, m.corners -= m.strips * wide; }
    if (i->hidden > 1) { m.corners -= m.strips * wide; }
    return m;
}

void gl_batch_add(struct gl_batch *g, struct gl_forms *f, const struct draw_item *i, int form,
    struct v3 eye, const struct draw_item *floor)
{
    struct brush b = {.item = i, .eye = eye, .floor = floor};
    const struct gl_form m = seen_of(&f->form[form], i);
    const GLuint first = (GLuint)(g->vertices - m.corner);
    if (room(g, m.corners, m.indices)) { return; }
    if (is_round(i)) {
        set_round(&b, f, form);
    } else {
        set_brush(&b);
    }
    for (int k = 0; k < m.corners; k++) { one_corner(g, &b, &f->corner[m.corner + k]); }
    for (int k = 0; k < m.indices; k++) { g->index[g->indices++] = first + f->index[m.index + k]; }
}

void gl_batch_paint(struct gl_batch *g, GLenum kind, int from, int to)
{
    if (to <= from) { return; }
    glDrawElements(kind, to - from, GL_UNSIGNED_INT,
        (const void *)(uintptr_t)((size_t)from * sizeof *g->index));
}

void gl_batch_send(struct gl_batch *g)
{
    glBindBuffer(GL_ARRAY_BUFFER, g->buffer[0]);
    glBufferData(
        GL_ARRAY_BUFFER, g->vertices * (GLsizeiptr)sizeof *g->vertex, g->vertex, GL_STREAM_DRAW);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, g->buffer[1]);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, g->indices * (GLsizeiptr)sizeof *g->index, g->index,
        GL_STREAM_DRAW);
}

void gl_batch_bind(const struct gl_batch *g)
{
    for (GLuint i = 0; i < 3; i++) { glEnableVertexAttribArray(i); }
    glBindBuffer(GL_ARRAY_BUFFER, g->buffer[0]);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, g->buffer[1]);
    glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof *g->vertex, (const void *)0);
    glVertexAttribPointer(
        1, 4, GL_FLOAT, GL_FALSE, sizeof *g->vertex, (const void *)(3 * sizeof(float)));
    glVertexAttribPointer(
        2, 2, GL_FLOAT, GL_FALSE, sizeof *g->vertex, (const void *)(7 * sizeof(float)));
}

void gl_batch_close(struct gl_batch *g)
{
    free(g->vertex);
    free(g->index);
}
