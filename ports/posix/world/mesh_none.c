/* SPDX-License-Identifier: MIT */
/* Built without Embree: meshes can be read, but nothing can touch them. */
#include "mesh.h"

#include <stdio.h>

int mesh_ready(struct mesh *m, char *error, size_t error_B)
{
    (void)m;
    snprintf(error, error_B,
        "a mesh needs Embree, which was missing when this program was built: install "
        "it (Debian: libembree-dev) and run make again");
    return 1;
}

void mesh_unready(struct mesh *m) { (void)m; }

double mesh_away_m(const struct mesh *m, struct v3 p, double most)
{
    (void)m, (void)p;
    return most;
}

void mesh_tangent(const struct mesh *m, struct v3 p, struct v3 *n, struct v3 *on)
{
    (void)m;
    *n = v3(0, 0, 1);
    *on = p;
}
