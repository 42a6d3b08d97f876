/* SPDX-License-Identifier: MIT */
/* The simulated device: all its parameters, from one commented table (device.c). */
#ifndef SIM_DEVICE_H
#define SIM_DEVICE_H

/* Doubles only, in the order of the table. Down, and string pulled out, is positive. */
struct sim_device {
    /* the falling mass */
    double mass_kg, height_m, height_jitter_m;
    /* string, rotor, friction */
    double rotor_kg, cable_npm, cable_nspm, mu_motor, mu_mass, coulomb_n, viscous_nspm;
    /* motor, drive, timing */
    double kf_npa, current_hz, servo_hz, peak_a, delay_tick, delay_s;
    /* codes */
    double dac_perA, dac_zero, mon_apc, mon_lag_s, mon_noise_a;
    /* encoder */
    double step_m, decode, enc_start;
    /* the drives' supply */
    double rail_v, rail_ohm, rail_vpc;
    /* the run */
    double observe_s, substep_s;
};

struct sim_device_row {
    const char *name, *unit;
    double value, min, max;
    const char *sure; /* how sure we are, and the source */
    const char *help;
};

/* The number of rows of a table, one for each double of a struct, in its order. */
#define SIM_ROWS(par, row) \
    const int row##s = (int)(sizeof row / sizeof row[0]); \
    typedef char \
        row##s_match[sizeof(struct par) / sizeof(double) == sizeof row / sizeof row[0] ? 1 : -1]

/* Rows in the order of struct sim_device. */
extern const struct sim_device_row sim_device_row[];
extern const int sim_device_rows;

/* The committed values. */
struct sim_device sim_device_default(void);

/* Sets one by name. 0, or -1 with *row the nearest row by name or NULL: unknown
 * name (NULL) or a value outside min..max. */
int sim_device_set(
    struct sim_device *d, const char *name, double value, const struct sim_device_row **row);

/* The same for any struct of doubles in the order of its table of n rows. */
void sim_rows_default(void *values, const struct sim_device_row *rows, int n);
int sim_rows_set(void *values, const struct sim_device_row *rows, int n, const char *name,
    double value, const struct sim_device_row **row);

#endif
