/* SPDX-License-Identifier: MIT */
/* The forms that all is put together from, as corners and triangles. */
#include "gl.h"

#include <stdlib.h>

static int corner(struct gl_forms *m, struct v3 p, double carried, struct v3 n)
{
    struct gl_corner *c = &m->corner[m->corners];
    c->place = p;
    c->carried = carried;
    c->normal = n;
    return m->corners++;
}

static void triangle(struct gl_forms *m, int a, int b, int c)
{
    const int corners[3] = {a, b, c};
    for (int i = 0; i < 3; i++) { m->index[m->indices++] = (unsigned short)corners[i]; }
}

/* The half of a ball that is visible from x: `strips` strips on either side of the middle, of
 * `steps` steps from one pole, -y, to the other. gl_form_face() places the vertices. The middle
 * strip, the last one, separates a capsule's ends along z; a ball has none. */
static void make_round(struct gl_forms *m, struct gl_form *f, int steps, int strips)
{
    const int first = m->corners, wide = steps + 1, rows = 2 * strips + 1;
    f->steps = steps;
    f->strips = strips;
    for (int i = 0; i < (rows + 1) * wide; i++) {
        corner(m, v3(0, 0, 0), i < (strips + 1) * wide ? -1 : 1, v3(0, 0, 0));
    }
    for (int i = 0; i < rows; i++) {
        const int middle = i == rows - 1, r = middle ? strips : i < strips ? i : i + 1;
        for (int s = 0; s < steps; s++) {
            const int k = first + r * wide + s;
            if (middle || s < steps - 1) { triangle(m, k, k + 1, k + wide + 1); }
            if (middle || s > 0) { triangle(m, k, k + wide + 1, k + wide); }
        }
    }
}

void gl_form_face(struct gl_forms *m, int form, double angle)
{
    const struct gl_form *f = &m->form[form];
    struct gl_corner *c = &m->corner[f->corner];
    const double half = 1.5707963267948966;
    for (int r = 0; r < 2 * (f->strips + 1); r++) {
        const int k = r - f->strips; /* 0, 1: the middle */
        const double a =
            k > 0 ? (half + angle) * (k - 1) / f->strips : (half - angle) * k / f->strips;
        const double x = cos(a), z = sin(a);
        for (int s = 0; s <= f->steps; s++, c++) {
            const double b = half * (2 * s - f->steps) / f->steps;
            c->normal = c->place = v3(x * cos(b), sin(b), z * cos(b));
        }
    }
}

static void quad(struct gl_forms *m, struct v3 o, struct v3 x, struct v3 y, struct v3 n)
{
    const int a = corner(m, v3_sub(v3_sub(o, x), y), 0, n);
    corner(m, v3_sub(v3_add(o, x), y), 0, n);
    corner(m, v3_add(v3_add(o, x), y), 0, n);
    corner(m, v3_add(v3_sub(o, x), y), 0, n);
    triangle(m, a, a + 1, a + 2);
    triangle(m, a, a + 2, a + 3);
}

static void make_box(struct gl_forms *m)
{
    const struct v3 axis[3] = {v3(1, 0, 0), v3(0, 1, 0), v3(0, 0, 1)};
    for (int i = 0; i < 6; i++) {
        const struct v3 n = v3_times(axis[i / 2], i % 2 ? -1 : 1), x = axis[(i / 2 + 1) % 3];
        quad(m, n, x, v3_cross(n, x), n);
    }
}

/* What is between an arc of `steps` steps, a power of two, and its chord: by ever longer chords, as
 * slivers from one corner would cost more. */
static void fill_arc(struct gl_forms *m, int first, int steps)
{
    for (int d = 1; 2 * d <= steps; d *= 2) {
        for (int k = 0; k < steps; k += 2 * d) {
            triangle(m, first + k, first + k + d, first + k + 2 * d);
        }
    }
}

static void make_disc(struct gl_forms *m, int steps, double radius)
{
    const int first = m->corners;
    for (int s = 0; s <= steps; s++) {
        const double a = s * (6.283185307179586 / steps);
        corner(m, v3(radius * cos(a), radius * sin(a), 0), 0, v3(0, 0, 1));
    }
    fill_arc(m, first, steps);
}

/* A ring of `steps` quads between two radii, w at each. */
static void make_ring(
    struct gl_forms *m, int steps, double in, double w_in, double out, double w_out)
{
    const struct v3 up = v3(0, 0, 1);
    for (int s = 0; s <= steps; s++) {
        const double a = s * (6.283185307179586 / steps);
        const int k = corner(m, v3(in * cos(a), in * sin(a), 0), w_in, up);
        corner(m, v3(out * cos(a), out * sin(a), 0), w_out, up);
        if (s == steps) { continue; }
        triangle(m, k, k + 1, k + 3);
        triangle(m, k, k + 3, k + 2);
    }
}

/* A square whose middle, which is opaque, comes first: blending costs. */
static void make_floor(struct gl_forms *m)
{
    static const double at[] = {-1, -GL_FLOOR_OPAQUE, GL_FLOOR_OPAQUE, 1};
    const int first = m->corners;
    for (int i = 0; i < 16; i++) { corner(m, v3(at[i % 4], at[i / 4], 0), 0, v3(0, 0, 1)); }
    for (int n = 0; n < 9; n++) {
        const int i = n == 0 ? 4 : n <= 4 ? n - 1 : n, k = first + i / 3 * 4 + i % 3;
        triangle(m, k, k + 1, k + 5);
        triangle(m, k, k + 5, k + 4);
    }
}

/* What of a ball or capsule a lamp far along z sees the outline of: two half discs, carried apart
 * along x. */
static void make_shade(struct gl_forms *m, int steps)
{
    const int first = m->corners;
    for (int half = 0; half < 2; half++) {
        for (int s = 0; s <= steps; s++) {
            const double a = (half - 0.5 + (double)s / steps) * 3.141592653589793;
            corner(m, v3(cos(a), sin(a), 0), half ? -1 : 1, v3(0, 0, 1));
        }
    }
    fill_arc(m, first, steps);
    fill_arc(m, first + steps + 1, steps);
    triangle(m, first, first + steps, first + steps + 1);
    triangle(m, first, first + steps + 1, first + 2 * steps + 1);
}

static void make_form(struct gl_forms *m, int form)
{
    switch (form) {
    case GL_FORM_FINE: make_round(m, &m->form[form], 16, 5); break;
    case GL_FORM_BALL: make_round(m, &m->form[form], 8, 2); break;
    case GL_FORM_TUBE: make_round(m, &m->form[form], 8, 1); break;
    case GL_FORM_DOT: make_disc(m, 8, 1); break;
    case GL_FORM_SHADE: make_shade(m, 8); break;
    case GL_FORM_DIM: make_shade(m, 4); break;
    case GL_FORM_FLOOR: make_floor(m); break;
    case GL_FORM_BOX: make_box(m); break;
    case GL_FORM_DISC:
        make_disc(m, 32, 0.88);
        make_ring(m, 32, 0.88, 1, 1, 1);
        break;
    default: break;
    }
}

void gl_forms_make(struct gl_forms *m)
{
    for (int i = 0; i < GL_FORMS; i++) {
        m->form[i].corner = m->corners;
        m->form[i].index = m->indices;
        make_form(m, i);
        m->form[i].corners = m->corners - m->form[i].corner;
        m->form[i].indices = m->indices - m->form[i].index;
    }
}
