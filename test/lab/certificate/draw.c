/* SPDX-License-Identifier: MIT */
#include "lab/certificate/draw.h"

#include "sim/random.h"

#include <math.h>
#include <stddef.h>

/* Evenly, or evenly in its logarithm. */
static const struct {
    const char *name;
    double low, high;
    int log;
} range[] = {
    {"rotor", 0.02, 0.25, 1},
    {"cable_k", 1000, 60000, 1},
    {"cable_b", 1, 80, 1},
    {"mu_motor", 0.02, 0.4, 0},
    {"mu_mass", 0.02, 0.3, 0},
    {"coulomb", 0.02, 1.5, 1},
    {"viscous", 0.1, 5, 1},
    {"kf", 2.4, 9, 1},
    {"current_bw", 400, 1200, 0},
    {"delay_tick", 0, 1, 0},
    {"delay", 20e-6, 400e-6, 0},
    {"mon_lag", 0, 1e-3, 0},
    {"step", 31e-6, 94e-6, 1},
};

struct sim_device draw_device(uint64_t seed)
{
    struct sim_random r = {seed ^ 0x6365727469666961};
    struct sim_device d = sim_device_default();
    const struct sim_device_row *row;
    for (size_t i = 0; i < sizeof range / sizeof range[0]; i++) {
        const double u = sim_random_unit(&r), a = range[i].low, b = range[i].high;
        (void)sim_device_set(
            &d, range[i].name, range[i].log ? a * exp(u * log(b / a)) : a + u * (b - a), &row);
    }
    d.decode = sim_random_unit(&r) < 0.5 ? 1 : sim_random_unit(&r) < 0.5 ? 2 : 4;
    return d;
}
