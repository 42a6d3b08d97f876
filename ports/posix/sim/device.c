/* SPDX-License-Identifier: MIT */
/* Every parameter of the simulated device, with unit, range and how sure we are.
 *
 * - paper: read in the ICRA 2013 paper.
 * - card: read in a data sheet or driver of the card.
 * - fit: found by random search (exhand-lab fit). The paper's six points come to rest and 1.5x both
 *   gains does not, for any place of the wall between two encoder counts. The point farthest inside
 *   was taken. Stiffness was not fitted. The values are plausible, but no data of the device are
 *   public. The tests use other cases and seeds.
 * - ours: a choice of the simulation.
 */
#include "device.h"

#include <stddef.h>
#include <string.h>

const struct sim_device_row sim_device_row[] = {
    {"mass", "kg", 0.5, 0.001, 5, "paper", "falling mass"},
    {"height", "m", 0.07, 0.001, 0.5, "paper", "free fall before the virtual contact"},
    {"height_jitter", "m", 0.001, 0, 0.01, "ours", "height varies by +- this from fall to fall"},

    {"rotor", "kg", 0.0464, 0.0001, 1, "fit", "rotor and pulley, reflected to the string"},
    {"cable_k", "n_per_m", 2969, 100, 1000000, "fit", "string, sheath and exoskeleton in series"},
    {"cable_b", "ns_per_m", 6.195, 0, 1000, "fit", "their damping"},
    {"mu_motor", "", 0.1835, 0, 2, "fit", "friction per tension at the motor side (capstan)"},
    {"mu_mass", "", 0.08795, 0, 2, "fit", "friction per tension at the mass side"},
    {"coulomb", "n", 0.02659, 0, 10, "fit", "dry friction of the motor"},
    {"viscous", "ns_per_m", 3.411, 0, 100, "fit", "viscous friction of motor and sheath"},

    {"kf", "n_per_a", 3.339, 0.5, 50, "fit", "string force per motor current"},
    {"current_bw", "hz", 1005, 50, 20000, "fit", "bandwidth of the current loop"},
    {"servo_rate", "hz", 4000, 500, 100000, "paper", "rate of the drive's current loop"},
    {"peak", "a", 6.6, 0, 20, "paper", "the drive's own peak limit"},
    {"delay_tick", "", 0.3699, 0, 3, "fit", "output delay, share of a tick"},
    {"delay", "s", 157.9e-6, 0, 0.01, "fit", "output delay besides"},

    {"dac_scale", "per_a", 3249 / 1.76, 1, 32767, "card", "S526 codes per volt over drive gain"},
    {"dac_zero", "", 32768, 0, 65535, "card", "S526 is offset binary"},
    {"mon_scale", "a", 305.2e-6 / 0.591, 1e-6, 1, "card", "ampere per monitor code"},
    {"mon_lag", "s", 321.6e-6, 0, 0.1, "fit", "lag of the current monitor"},
    {"mon_noise", "a", 0.0472, 0, 1, "paper", "monitor noise, peak to peak"},

    {"step", "m", 66.32e-6, 1e-6, 480e-6, "fit", "string per encoder line; 512 lines are 34 mm"},
    {"decode", "", 1, 1, 4, "paper", "counts per line; 1 gives the paper's 9 stable bits"},
    {"enc_start", "", 0, 0, 16777215, "ours", "counter value at the start (24-bit counter)"},

    {"rail", "v", 24, 0, 100, "paper", "the drives' supply without load"},
    {"rail_ohm", "ohm", 0.1, 0, 10, "ours", "it falls by this times the sum of the currents"},
    {"rail_scale", "v", 4 * 10 / 32768.0, 1e-6, 1, "ours",
        "volt per code of its monitor, through 1:4"},

    {"observe", "s", 5, 0.6, 100, "ours", "each fall is observed this long from first contact"},
    {"substep", "s", 250e-6, 1e-7, 1e-3, "ours",
        "longest integration step; unless given, shorter where string and rotor want it"},
};
SIM_ROWS(sim_device, sim_device_row);

void sim_rows_default(void *values, const struct sim_device_row *rows, int n)
{
    unsigned char *to = values;
    for (int i = 0; i < n; i++) {
        memcpy(to + (size_t)i * sizeof(double), &rows[i].value, sizeof(double));
    }
}

int sim_rows_set(void *values, const struct sim_device_row *rows, int n, const char *name,
    double value, const struct sim_device_row **row)
{
    unsigned char *to = values;
    *row = NULL;
    for (int i = 0; i < n; i++) {
        if (strcmp(rows[i].name, name) != 0) { continue; }
        *row = &rows[i];
        if (!(value >= (*row)->min && value <= (*row)->max)) { return -1; }
        memcpy(to + (size_t)i * sizeof(double), &value, sizeof value);
        return 0;
    }
    return -1;
}

struct sim_device sim_device_default(void)
{
    struct sim_device d;
    sim_rows_default(&d, sim_device_row, sim_device_rows);
    return d;
}

int sim_device_set(
    struct sim_device *d, const char *name, double value, const struct sim_device_row **row)
{
    return sim_rows_set(d, sim_device_row, sim_device_rows, name, value, row);
}
