/* SPDX-License-Identifier: MIT */
/* The simulated device as an FMI unit, its source as it is, with values of which a step of the
 * table's length would not do. */
#include "check.h"

#include "../../../ports/fmi/device.c"

#include "base/assign.h"

static uint32_t place_of(const char *name)
{
    struct unit_var v;
    for (uint32_t i = 0; i < unit_vars(); i++) {
        unit_var(i, &v);
        if (strcmp(v.name, name) == 0) { return i; }
    }
    return unit_vars();
}

static int put_in(const char *name, double value) { return unit_set(place_of(name), value); }

static double off_m(void)
{
    const double m = unit_get(place_of("x")) - unit_get(place_of("q"));
    return m < 0 ? -m : m;
}

TEST(a_stiff_device_is_as_steady_as_the_programs)
{
    static const struct {
        const char *name;
        double value;
    } row[] = {{"rotor", 0.0001}, {"cable_k", 1e6}, {"cable_b", 1000}};
    for (size_t i = 0; i < sizeof row / sizeof row[0]; i++) {
        struct sim_device d = sim_device_default();
        const struct sim_device_row *named = NULL;
        const char *which;
        double most_m = 0;
        unit_reset();
        CHECK(put_in(row[i].name, row[i].value) == 0 && put_in("waits", 0) == 0, "%s", row[i].name);
        CHECK(unit_start(&which) == 0, "%s: refused: %s", row[i].name, which);
        CHECK(sim_device_set(&d, row[i].name, row[i].value, &named) == 0 &&
                  assign_step(&d, 0, 0) == 0,
            "%s", row[i].name);
        CHECK(unit_get(place_of("substep")) == d.substep_s, "%s: steps of %g s, the program's %g s",
            row[i].name, unit_get(place_of("substep")), d.substep_s);
        for (int k = 0; k < 3000; k++) {
            CHECK(unit_step() == 0, "%s: step %d", row[i].name, k);
            most_m = off_m() > most_m || !(off_m() < 1) ? off_m() : most_m;
        }
        CHECK(most_m > 0 && most_m < 0.2, "%s: mass and string %g m apart", row[i].name, most_m);
    }
}

TEST(a_step_that_is_given_and_will_not_do_is_refused)
{
    const char *which = "";
    unit_reset();
    CHECK(put_in("rotor", 0.0001) == 0 && put_in("substep", 1e-4) == 0, "values");
    CHECK(unit_start(&which) == -EXH_E_RANGE && strncmp(which, "substep:", 8) == 0, "taken, or: %s",
        which);
    unit_reset();
    CHECK(put_in("rotor", 0.0001) == 0 && put_in("cable_b", 1000) == 0, "values");
    CHECK(unit_start(&which) == -EXH_E_RANGE && strncmp(which, "substep:", 8) == 0,
        "none will do: %s", which);
}

TEST_MAIN("fmi_device", a_stiff_device_is_as_steady_as_the_programs,
    a_step_that_is_given_and_will_not_do_is_refused);
