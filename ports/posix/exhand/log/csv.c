/* SPDX-License-Identifier: MIT */
/* exhand csv: a log as comma-separated values. */
#include "base/cli.h"
#include "base/csv.h"
#include "base/names.h"
#include "base/option.h"

int cli_csv(int argc, char **argv)
{
    int all = 0, falls = 0;
    const char *out = NULL, *name = NULL;
    int finger = CSV_IN_USE;
    const struct cli_option option[] = {
        {"out", CLI_TEXT, &out, 0, 0, "FILE", "write there instead of standard output"},
        {"finger", CLI_TEXT, &name, 0, 0, "F",
            "of this finger alone (those in use; of several, names end in the finger's)"},
        {"all", CLI_FLAG, &all, 0, 0, NULL,
            "limits, state and faults too, of every finger; of a glove, its codes"},
        {"falls", CLI_FLAG, &falls, 0, 0, NULL,
            "only the observed part of falls, with a gap in t_s between two: the data of Table II"},
    };
    const struct cli_command c = {
        "csv", "LOG [options]", "A log as comma-separated values.", option, 4, 1};
    const char *log = NULL;
    const int err = cli_parse(&c, argc, argv, &log);

    if (err) { return err == 1 ? 0 : err; }
    if (name != NULL && (finger = names_find(&names_finger, name)) < 0) {
        cli_complain("--finger: %s: give thumb, index, middle, ring or little", name);
        return 2;
    }
    return csv_write(log, out, (all ? CSV_ALL : 0u) | (falls ? CSV_FALLS : 0u), finger);
}
