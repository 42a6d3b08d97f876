/* SPDX-License-Identifier: MIT */
/* Turning about fixed axes: first roll about x, then pitch about y, then yaw about z. */
#ifndef WORLD_RPY_H
#define WORLD_RPY_H

#include "vec.h"

#define RAD_PER_DEG      0.017453292519943295
#define RAD_PER_TURN_Q32 1.4629180792671596e-9 /* 2 pi / 2^32 */

/* rpy.x is roll, rpy.y pitch, rpy.z yaw, in radians. */
struct m3 rpy_turn(struct v3 rpy_rad);

/* The frame whose z axis points along z, and whose x axis as near to x as is square to it.
 * 0, or 1 if the two are parallel or one has no length. */
int frame_from_z(struct m3 *m, struct v3 z, struct v3 x);

#endif
