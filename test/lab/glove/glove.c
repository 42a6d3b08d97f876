/* SPDX-License-Identifier: MIT */
/* exhand-lab glove: the paper's Table I of noise at rest, and the scan's skew. */
#include "lab/glove/glove.h"
#include "lab/lab.h"

#include <string.h>

static struct {
    int selftest, skew;
    struct rest_options rest;
} is;

static int check(struct glove_options *o)
{
    const int recorded = is.selftest && (o->csv || is.rest.log);
    const struct {
        int wrong;
        const char *why;
    } row[] = {
        {!is.selftest && !o->csv && !is.skew && !o->record && !o->serial,
            "what to do is missing: --selftest, --csv, --skew, --record or --serial"},
        {(is.skew != 0) + (o->record || o->serial) + (is.selftest || o->csv) > 1,
            "--skew, --record or --serial, and --selftest or --csv: one at a time"},
        {is.rest.log && !is.selftest, "--log: goes with --selftest"},
        {o->csv && is.rest.log, "--csv and --log: one of them"},
        {is.rest.log && o->rate_Hz > 0, "--rate: a log knows its own"},
        {(is.rest.from_s > 0 || is.rest.to_s > 0) && !recorded,
            "--from and --to: go with --selftest of a recording"},
        {o->seconds > 0 && is.rest.log, "--seconds: a recording is as long as it is"},
        {is.skew && (o->rate_Hz > 0 || o->seconds > 0 || o->calibration),
            "--skew: does not depend on --rate, --seconds or --calibration"},
    };
    o->study = is.selftest || is.skew;
    for (size_t i = 0; i < sizeof row / sizeof row[0]; i++) {
        if (row[i].wrong) { return glove_bad(row[i].why); }
    }
    return 0;
}

static int run(const struct glove_options *o)
{
    return is.skew ? glove_skew(o) : glove_table1(o, &is.rest);
}

int lab_glove(int argc, char **argv)
{
    static const struct cli_option option[] = {
        {"selftest", CLI_FLAG, &is.selftest, 0, 0, NULL,
            "the paper's Table I, on the board or a recording"},
        {"log", CLI_TEXT, &is.rest.log, 0, 0, "FILE", "a log made by --record"},
        {"skew", CLI_FLAG, &is.skew, 0, 0, NULL, "what the scan's skew does to the fingertips"},
        {"from", CLI_REAL, &is.rest.from_s, 0, 1e6, "S",
            "selftest: a recording is at rest from here"},
        {"to", CLI_REAL, &is.rest.to_s, 0, 1e6, "S", "to here"},
        {"span", CLI_REAL, &is.rest.span_V, 0.001, 20, "V",
            "all that a joint's signal can be (20)"},
        {"travel", CLI_REAL, &is.rest.travel_m, 1e-6, 2, "M", "a finger's string (0.034)"},
        {"span-current", CLI_REAL, &is.rest.span_A, 0.001, 100, "A",
            "all that a motor's current can be (6.6)"},
    };
    static const struct glove_study study = {
        {option, (int)(sizeof option / sizeof option[0]), NULL}, check, run};
    memset(&is, 0, sizeof is);
    is.rest.span_V = 20;
    is.rest.travel_m = 0.034;
    is.rest.span_A = 6.6;
    return glove_command(argc, argv, &study);
}
