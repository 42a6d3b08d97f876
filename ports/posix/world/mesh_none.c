/* SPDX-License-Identifier: MIT */
/* Built without Embree: meshes can be read and drawn, but no ray can be cast into them. */
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

int mesh_cast(const struct mesh *m, const struct ray *r, double *t, int *triangle)
{
    (void)m, (void)r, (void)t, (void)triangle;
    return 0;
}
