#include "assign.h"

#include "option.h"

#include <stdlib.h>
#include <string.h>

int assign_split(const char *option, const char *text, char name[ASSIGN_NAME_B], double *value)
{
    const char *equals = strchr(text, '=');
    const size_t len = equals ? (size_t)(equals - text) : ASSIGN_NAME_B;
    char *end = NULL;
    if (equals != NULL) { *value = strtod(equals + 1, &end); }
    if (len == 0 || len >= ASSIGN_NAME_B || end == equals + 1 || *end != '\0') {
        cli_complain("--%s: %s: give NAME=VALUE", option, text);
        return 2;
    }
    memcpy(name, text, len);
    name[len] = '\0';
    return 0;
}

int assign_refused(const char *command, const char *name, double value, const struct sim_device_row *row)
{
    if (row != NULL) {
        cli_complain("--device: %s: %.12g (allowed %.12g..%.12g%s%s): choose a value in that range", name,
                     value, row->min, row->max, row->unit[0] ? " " : "", row->unit);
    } else {
        cli_complain("--device: %s: no such value of the device: `exhand %s --params` lists them", name,
                     command);
    }
    return 2;
}
