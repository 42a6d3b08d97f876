/* SPDX-License-Identifier: MIT */
/* exhand-lab faults: every fault in every state, and any fault at any tick. */
#include "lab/lab.h"
#include "lab/faults/part.h"
#include "base/jobs.h"
#include "base/option.h"

#include <inttypes.h>

int cli_faults(int argc, char **argv)
{
    int64_t times = 0, seed = 1, rate_Hz = 0, run = -1, parallel = jobs_cores();
    int states = 0;
    const char *out = NULL;
    int err;
    const struct cli_option option[] = {
        {"times", CLI_INT, &times, 1, 1e7, "N",
            "so many random faults at random times, instead of the table"},
        {"rate", CLI_INT, &rate_Hz, 20, 20000, "HZ", "the table at this rate (90, 1000 and 2000)"},
        {"seed", CLI_INT, &seed, 0, 1e9, "N", "of these (1)"},
        {"run", CLI_INT, &run, 0, 1e6, "N", "of these the times of one run, as WRONG names it"},
        {"states", CLI_FLAG, &states, 0, 0, NULL,
            "the state machine as the library has it, and every name in it"},
        {"out", CLI_TEXT, (void *)&out, 0, 0, "DIR",
            "write what the picture needs there, instead of the table"},
        {"jobs", CLI_INT, &parallel, 1, 1024, "N", "processes at a time (one a core)"},
    };
    const struct cli_command c = {"faults", "[options]",
        "Every fault in every state of the box, from its source, and how it ends: the table of\n"
        "docs/FAULTS.md. Or random faults at random times in closed loop. Status 1: something\n"
        "did not end as it must.",
        option, (int)(sizeof option / sizeof option[0]), 0};
    err = cli_parse(&c, argc, argv, NULL);
    if (err) { return err == 1 ? 0 : err; }
    if (states + (times > 0) + (out != NULL) > 1) {
        cli_complain("--times, --states, --out: each instead of the table: give one of them");
        return 2;
    }
    if (run >= 0 && times == 0) {
        cli_complain("--run: %" PRId64 ": goes with --times, of which it is one", run);
        return 2;
    }
    if (rate_Hz && (states || times || out)) {
        cli_complain(
            "--rate: %" PRId64 ": of the table: leave out --times, --states, --out", rate_Hz);
        return 2;
    }
    if (states) { return faults_states(stdout); }
    if (times) {
        return faults_random(stdout, (int)times, (uint64_t)seed, (int)run, (int)parallel);
    }
    if (out) { return faults_pictures(out); }
    err = faults_matrix(stdout, (uint32_t)rate_Hz, (int)parallel);
    return err > 1 ? err : err | faults_refusals(stdout, (uint32_t)rate_Hz, (int)parallel);
}
