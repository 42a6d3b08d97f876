/* SPDX-License-Identifier: MIT */
/* Triangle meshes from OBJ files, and the point nearest to another one by Embree. Embree is loaded
 * with the first mesh; a world without meshes does not need it. */
#ifndef WORLD_MESH_H
#define WORLD_MESH_H

#include "shape.h"

#include <stddef.h>

#define MESH_TRIANGLES_MAX 4000000

struct triangle {
    int corner[3]; /* counter-clockwise seen from outside */
};

struct mesh {
    struct v3 *point;
    struct triangle *triangle;
    int points, triangles;
    double bound_m; /* of the ball around the origin that holds it */
    void *tree;     /* what mesh_away_m() needs */
};

/* Reads v and f lines of an OBJ file (polygons become fans; everything else is passed over) and
 * scales it. NULL on failure, with "file:line: what: what to do" in error. */
struct mesh *mesh_read(const char *path, double scale, char *error, size_t error_B);
void mesh_free(struct mesh *m);

/* Makes ready for being asked; 0, or 1 with the reason in error: which package is missing. */
int mesh_ready(struct mesh *m, char *error, size_t error_B);
void mesh_unready(struct mesh *m);

/* The distance of p (in the mesh's frame) from the surface, m; below 0: p is on the inner side of
 * the nearest triangle. `most` where none is nearer. */
double mesh_away_m(const struct mesh *m, struct v3 p, double most);

/* The plane that touches the mesh where it is nearest to p: its outward normal and a point on it.
 * Nearest to the inside of a triangle, both are the triangle's, whatever p is. */
void mesh_tangent(const struct mesh *m, struct v3 p, struct v3 *n, struct v3 *on);

/* Of one triangle: its outward normal, and a point on it. */
static inline struct v3 mesh_normal(const struct mesh *m, int triangle, struct v3 *on)
{
    const int *c = m->triangle[triangle].corner;
    const struct v3 a = m->point[c[0]];
    *on = a;
    return v3_unit(v3_cross(v3_sub(m->point[c[1]], a), v3_sub(m->point[c[2]], a)));
}

#endif
