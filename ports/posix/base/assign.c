/* SPDX-License-Identifier: MIT */
#include "base/assign.h"

#include "base/names.h"
#include "base/near.h"
#include "base/option.h"

#include "sim/plant.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int assign_split(const char *option, const char *text, char name[ASSIGN_NAME_B], double *value)
{
    const char *equals = strchr(text, '=');
    const size_t len = equals ? (size_t)(equals - text) : ASSIGN_NAME_B;
    if (len == 0 || len >= ASSIGN_NAME_B) {
        cli_complain("--%s: %.60s: give NAME=VALUE", option, text[0] ? text : "nothing");
        return 2;
    }
    if (!cli_number(equals + 1, 0, value)) {
        cli_complain("--%s: %.60s: the value is no number: give it in plain digits, without a unit",
            option, text);
        return 2;
    }
    memcpy(name, text, len);
    name[len] = '\0';
    return 0;
}

int assign_refused(
    const char *command, const char *name, double value, const struct sim_device_row *row)
{
    struct near n = near_to(name, strlen(name));
    char mean[NEAR_B];
    for (int i = 0; i < sim_device_rows; i++) { near_try(&n, sim_device_row[i].name); }
    if (row != NULL) {
        cli_complain("--device: %s: %.12g (allowed %.12g..%.12g%s%s): choose a value in that range",
            name, value, row->min, row->max, row->unit[0] ? " " : "", names_unit(row->unit));
    } else {
        cli_complain("--device: %s: no such value of the device%s: `exhand %s --params` lists them",
            name, near_text(mean, &n, ""), command);
    }
    return 2;
}

int assign_device(struct sim_device *d, const char *command, const char *text)
{
    const struct sim_device_row *row;
    char name[ASSIGN_NAME_B];
    double value;
    if (assign_split("device", text, name, &value)) { return 2; }
    return sim_device_set(d, name, value, &row) ? assign_refused(command, name, value, row) : 0;
}

const char *assign_hint(const char *name, size_t len)
{
    for (int i = 0; i < sim_device_rows; i++) {
        const char *row = sim_device_row[i].name;
        if (strlen(row) == len && strncmp(row, name, len) == 0) { return row; }
    }
    return NULL;
}

int assign_step(struct sim_device *d, double hand_npm, double hand_nspm)
{
    const double enough_s = plant_step_that_will_do(d, hand_npm, hand_nspm);
    if (plant_take_step(d, hand_npm, hand_nspm) == 0) { return 0; }
    if (enough_s > 0) {
        cli_complain("--device: substep: %.6g s is too long for this string, rotor and mass, whose "
                     "oscillation it "
                     "would not follow: give --device substep=%g",
            d->substep_s, enough_s);
    } else {
        cli_complain("--device: substep: none is short enough for this string, rotor and mass: a "
                     "heavier rotor, or "
                     "less of cable_k and cable_b");
    }
    return 2;
}

int assign_grid(const char *text, int *columns, int *rows)
{
    char more;
    if (sscanf(text, "%dx%d%c", columns, rows, &more) == 2 && *columns >= 2 && *rows >= 2 &&
        *columns <= ASSIGN_GRID_MAX && *rows <= ASSIGN_GRID_MAX) {
        return 0;
    }
    cli_complain("--grid: %s (two numbers, 2..%d each): e.g. --grid 16x6", text, ASSIGN_GRID_MAX);
    return 2;
}
