/* SPDX-License-Identifier: MIT */
#include "mesh.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define CORNERS_MAX 64 /* of one polygon */

struct reading {
    struct mesh *m;
    int point_room, triangle_room, line;
    const char *path;
    char *error;
    size_t error_B;
};

static int complain(const struct reading *r, const char *what)
{
    snprintf(r->error, r->error_B, "%s:%d: %s", r->path, r->line, what);
    return 1;
}

/* Makes room for one more; 0, or 1 if there is no memory. */
static int grow(void **array, int *room, int n, size_t size_B)
{
    void *more;
    if (n < *room) { return 0; }
    more = realloc(*array, (size_t)(*room ? 2 * *room : 256) * size_B);
    if (more == NULL) { return 1; }
    *array = more;
    *room = *room ? 2 * *room : 256;
    return 0;
}

static int take_point(struct reading *r, const char *s, double scale)
{
    double c[3];
    char *end;
    for (int i = 0; i < 3; i++) {
        c[i] = strtod(s, &end) * scale;
        if (end == s || !(fabs(c[i]) < 1e3)) {
            return complain(
                r, "v: three coordinates within 1 km are needed: export the mesh in metres");
        }
        s = end;
    }
    if (grow((void **)&r->m->point, &r->point_room, r->m->points, sizeof *r->m->point)) {
        return complain(r, "v: no memory for so many points: use a smaller mesh");
    }
    r->m->point[r->m->points++] = v3(c[0], c[1], c[2]);
    r->m->bound_m = fmax(r->m->bound_m, v3_len(r->m->point[r->m->points - 1]));
    return 0;
}

static int take_triangle(struct reading *r, int a, int b, int c)
{
    struct mesh *m = r->m;
    const struct triangle t = {{a, b, c}};
    const struct v3 n =
        v3_cross(v3_sub(m->point[b], m->point[a]), v3_sub(m->point[c], m->point[a]));
    if (!(v3_len(n) > 0)) { return 0; } /* without area it has no normal */
    if (m->triangles == MESH_TRIANGLES_MAX ||
        grow((void **)&m->triangle, &r->triangle_room, m->triangles, sizeof *m->triangle)) {
        return complain(r, "f: too many triangles: use a smaller mesh");
    }
    m->triangle[m->triangles++] = t;
    return 0;
}

/* "f 1/2/3 4 -1": the first number of each corner, from 1, or from the last point backwards. */
static int take_polygon(struct reading *r, const char *s)
{
    int corner[CORNERS_MAX], n = 0;
    for (;;) {
        char *end;
        const long v = strtol(s, &end, 10), i = v < 0 ? r->m->points + v : v - 1;
        if (end == s) { break; }
        if (i < 0 || i >= r->m->points) {
            return complain(r, "f: a corner that is no point so far: list points first, from 1");
        }
        if (n == CORNERS_MAX) { return complain(r, "f: more than 64 corners: split the polygon"); }
        corner[n++] = (int)i;
        for (s = end; *s && *s != ' ' && *s != '\t'; s++) {}
    }
    if (n < 3) { return complain(r, "f: fewer than 3 corners: a face has three or more"); }
    for (int k = 2; k < n; k++) {
        if (take_triangle(r, corner[0], corner[k - 1], corner[k])) { return 1; }
    }
    return 0;
}

static int read_lines(struct reading *r, FILE *f, double scale)
{
    char line[1024];
    while (fgets(line, sizeof line, f)) {
        int bad = 0;
        r->line++;
        if (strlen(line) == sizeof line - 1) {
            return complain(r, "a line of more than 1022 bytes: is this an OBJ file?");
        }
        if (line[0] == 'v' && (line[1] == ' ' || line[1] == '\t')) {
            bad = take_point(r, line + 2, scale);
        } else if (line[0] == 'f' && (line[1] == ' ' || line[1] == '\t')) {
            bad = take_polygon(r, line + 2);
        }
        if (bad) { return 1; }
    }
    if (ferror(f)) { return complain(r, strerror(errno)); }
    if (r->m->triangles == 0) {
        return complain(r, "no triangles: is this an OBJ file with f lines?");
    }
    return 0;
}

struct mesh *mesh_read(const char *path, double scale, char *error, size_t error_B)
{
    struct reading r = {.path = path, .error = error, .error_B = error_B};
    FILE *f = fopen(path, "r");
    int bad;
    if (f == NULL) {
        snprintf(error, error_B, "%s: %s: name a file beside the scene", path, strerror(errno));
        return NULL;
    }
    r.m = calloc(1, sizeof *r.m);
    bad = r.m == NULL ? complain(&r, "no memory") : read_lines(&r, f, scale);
    fclose(f);
    if (bad) {
        mesh_free(r.m);
        return NULL;
    }
    return r.m;
}

void mesh_free(struct mesh *m)
{
    if (m == NULL) { return; }
    mesh_unready(m);
    free(m->point);
    free(m->triangle);
    free(m);
}
