/* SPDX-License-Identifier: MIT */
/* exhand bringup: the first power-up of docs/BRINGUP.md, rehearsed on the simulated device. */
#include "base/cli.h"

#include "bench/bringup_run.h"
#include "base/option.h"
#include "base/param.h"

#include "exhand/error.h"

#include <string.h>

static int take_wrong(void *ctx, const char *text)
{
    struct bringup_run_cfg *c = ctx;
    for (int i = 0; i < BRINGUP_WRONGS; i++) {
        if (strcmp(bringup_wrong_row[i].name, text) == 0) {
            c->wrong = (enum bringup_wrong)i;
            return 0;
        }
    }
    cli_complain("--wrong: %s (one of those that `exhand bringup --params` lists)", text);
    return 2;
}

static void print_params(void)
{
    exh_scene_bringup.defaults();
    printf("Parameters of the scene (--boot \"NAME=VALUE ...\")\n");
    cli_signal_print(stdout, exh_scene_bringup.params->table, NULL);
    printf("\nWhat may be wrong (--wrong NAME)\n");
    for (int i = 0; i < BRINGUP_WRONGS; i++) {
        printf("  %-17s %s\n", bringup_wrong_row[i].name, bringup_wrong_row[i].what);
    }
}

int cli_bringup(int argc, char **argv)
{
    static struct bringup_run_cfg c;
    static struct bringup_run r;
    int64_t rate_Hz = 1000, seed = 1, phase = -1;
    int list = 0, faults = 0, cards = 0, pace = 0, err;
    struct cli_call fault = {take_wrong, &c};
    const struct cli_option option[] = {
        {"boot", CLI_TEXT, &c.boot, 0, 0, "LINE",
            "\"name=value ...\", as on the image's command line"},
        {"rate", CLI_INT, &rate_Hz, 20, 20000, "HZ", "loop rate (1000)"},
        {"seed", CLI_INT, &seed, 0, 1e9, "N", "random seed of the simulation (1)"},
        {"cards", CLI_FLAG, &cards, 0, 0, NULL,
            "through the drivers and emulated cards; results do not change"},
        {"pace", CLI_FLAG, &pace, 0, 0, NULL, "run in real time"},
        {"wrong", CLI_CALL, &fault, 0, 0, "NAME", "something is wrong"},
        {"phase", CLI_INT, &phase, 0, 9, "N",
            "from 0.2 s into this phase on, the first is 0 (power-on)"},
        {"faults", CLI_FLAG, &faults, 0, 0, NULL, "print a table of every mistake in every stage"},
        {"params", CLI_FLAG, &list, 0, 0, NULL, "list the parameters, and what may be wrong"},
    };
    const struct cli_command command = {"bringup", "[options]",
        "First power-up, a stage a run (docs/BRINGUP.md), on the simulated device.", option,
        (int)(sizeof option / sizeof option[0]), 0};

    memset(&c, 0, sizeof c); /* a test calls more than once */
    c.boot = "stage=1";
    err = cli_parse(&command, argc, argv, NULL);
    if (err) { return err == 1 ? 0 : err; }
    if (list) {
        print_params();
        return 0;
    }
    c.rate_Hz = (uint32_t)rate_Hz;
    c.wrong_phase = (int)phase;
    c.board = posix_config_default();
    c.board.seed = (uint64_t)seed;
    c.board.log = stdout;
    c.board.pace = pace;
    c.board.cards.how = cards ? POSIX_CARDS_INSTANT : POSIX_CARDS_NONE;
    if (faults) { return bringup_faults(stdout, &c); }
    err = bringup_run(&c, &r);
    if (err < 0) { return err == -EXH_E_IO ? 1 : 2; }
    return r.result == EXH_PROBE_DONE ? 0 : 1;
}
