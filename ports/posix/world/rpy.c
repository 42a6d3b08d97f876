/* SPDX-License-Identifier: MIT */
#include "rpy.h"

#include "sim/lag.h"

struct m3 rpy_turn(struct v3 rpy_rad)
{
    const double cr = sim_cos(rpy_rad.x), sr = sim_sin(rpy_rad.x);
    const double cp = sim_cos(rpy_rad.y), sp = sim_sin(rpy_rad.y);
    const double cy = sim_cos(rpy_rad.z), sy = sim_sin(rpy_rad.z);
    struct m3 m;
    m.x = v3(cy * cp, sy * cp, -sp);
    m.y = v3(cy * sp * sr - sy * cr, sy * sp * sr + cy * cr, cp * sr);
    m.z = v3(cy * sp * cr + sy * sr, sy * sp * cr - cy * sr, cp * cr);
    return m;
}

int frame_from_z(struct m3 *m, struct v3 z, struct v3 x)
{
    const struct v3 y = v3_cross(z, x);
    if (!(v3_len(y) > 1e-6 * v3_len(x) * v3_len(z))) { return 1; }
    m->z = v3_unit(z);
    m->y = v3_unit(y);
    m->x = v3_cross(m->y, m->z);
    return 0;
}
