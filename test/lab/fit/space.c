/* SPDX-License-Identifier: MIT */
#include "lab/fit/space.h"

#include "sim/ln.h"
#include "sim/plant.h"

#include <string.h>

/* The ranges are what a hand-sized cable exoskeleton with small motors can be, not
 * what the fit likes; a row that ends at a bound is reported. */
const struct space_row space_row[SPACE_ROWS] = {
    {"rotor", SPACE_DEVICE, 0.01, 0.25, SPACE_LOG, 0.0609,
        "small DC motors of 1..20e-6 kg m2 on pulleys of 5..15 mm"},
    {"cable_k", SPACE_DEVICE, 1e3, 1e5, SPACE_LOG, 2875,
        "1 kN/m: long sheath and exoskeleton give way; 100 kN/m: short bare steel string"},
    {"cable_b", SPACE_DEVICE, 0.5, 80, SPACE_LOG, 5.56, "0.02..0.5 of critical over cable_k"},
    {"mu_motor", SPACE_DEVICE, 0, 0.5, SPACE_LINEAR, 0.1297,
        "capstan exp(mu theta) - 1: mu 0.05..0.2 over up to 2 rad"},
    {"mu_mass", SPACE_DEVICE, 0, 0.5, SPACE_LINEAR, 0.1031, "the same at the other end"},
    {"coulomb", SPACE_DEVICE, 0.02, 2, SPACE_LOG, 0.0505,
        "brushes and bearings, 0.2..20 mNm at 10 mm"},
    {"viscous", SPACE_DEVICE, 0.02, 5, SPACE_LOG, 3.557,
        "above 5 Ns/m the mass would not fall: 4.9 N / 5 Ns/m = 1 m/s"},
    {"kf", SPACE_DEVICE, 2.4, 9, SPACE_LOG, 3.339,
        "2.4: 3.3 A still give the 7.9 N of continuous string force; 9: 0.09 Nm/A at 10 mm"},
    {"current_bw", SPACE_DEVICE, 300, 2000, SPACE_LOG, 1427, "half the drive's 4 kHz at most"},
    {"delay_tick", SPACE_DEVICE, 0, 1, SPACE_LINEAR, 0.343,
        "0: output at once; 1: model step latched to the next tick"},
    {"delay", SPACE_DEVICE, 20e-6, 400e-6, SPACE_LOG, 126.7e-6, "conversions and port accesses"},
    {"mon_lag", SPACE_DEVICE, 1e-5, 3e-3, SPACE_LOG, 566e-6,
        "from no filter to one of 50 Hz behind the monitor"},
    {"step", SPACE_DEVICE, 31.4e-6, 94.2e-6, SPACE_LOG, 66.32e-6,
        "1000 lines on pulleys of 5..15 mm"},
    {"f0", SPACE_F0, 0.02, 1.5, SPACE_LOG, 0.107,
        "enough to pull the string back; the paper tuned it, value unknown"},
    {"vel_p", SPACE_WINDOW, 0, 5, SPACE_WHOLE, 1, "1, 2, 4, 8 or 16 ticks, what the library has"},
    {"vel_tau", SPACE_TAU, 1e-4, 5e-3, SPACE_LOG, 5e-4,
        "0.1 ms: nothing at 2 kHz; 5 ms: half a tick of 90 Hz"},
};

double space_value(int row, double u)
{
    const struct space_row *r = &space_row[row];
    if (r->scale == SPACE_LOG) { return r->hi * sim_exp_neg((1 - u) * sim_ln(r->hi / r->lo)); }
    if (r->scale == SPACE_WHOLE) { /* the upper end is not reached */
        const double v = (double)(int)(r->lo + u * (r->hi - r->lo));
        return v < r->hi ? v : r->hi - 1;
    }
    return r->lo + u * (r->hi - r->lo);
}

double space_unit(int row, double value)
{
    const struct space_row *r = &space_row[row];
    if (r->scale == SPACE_LOG) { return 1 - sim_ln(r->hi / value) / sim_ln(r->hi / r->lo); }
    if (r->scale == SPACE_WHOLE) { return (value + 0.5 - r->lo) / (r->hi - r->lo); }
    return (value - r->lo) / (r->hi - r->lo);
}

int space_exact(int row, double value)
{
    return space_row[row].scale != SPACE_WHOLE ||
           (value < space_row[row].hi && value == (double)(int)value);
}

struct plant_point space_start(void)
{
    struct plant_point p;
    for (int i = 0; i < SPACE_ROWS; i++) { p.u[i] = space_unit(i, space_row[i].start); }
    return p;
}

int space_apply(const struct plant_point *p, enum estimate_kind kind, struct sim_device *d,
    struct settle_wall *w)
{
    const struct sim_device_row *ignored;
    const struct settle_wall scene = {
        .f0_band_m = 200e-6, .f_max_N = 40, .slew_Nps = 200000, .velocity = {.kind = kind}};
    *d = sim_device_default();
    *w = scene;
    for (int i = 0; i < SPACE_ROWS; i++) {
        const double v = space_value(i, p->u[i]);
        switch (space_row[i].kind) {
        case SPACE_DEVICE: sim_device_set(d, space_row[i].name, v, &ignored); break;
        case SPACE_F0: w->f0_N = v; break;
        case SPACE_WINDOW: w->velocity.window = 1 << (int)v; break;
        case SPACE_TAU: w->velocity.tau_s = v; break;
        }
    }
    return plant_take_step(d, 0, 0);
}

int space_find(const char *name)
{
    for (int i = 0; i < SPACE_ROWS; i++) {
        if (strcmp(space_row[i].name, name) == 0) { return i; }
    }
    return -1;
}
