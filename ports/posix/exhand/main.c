/* SPDX-License-Identifier: MIT */
#include "base/cli.h"

#include "base/option.h"

#include "exhand/board.h"
#include "exhand/exhand.h"

#include <stdio.h>
#include <string.h>

static const struct {
    const char *name, *what;
    int (*run)(int argc, char **argv);
} command[] = {
    {"advise", "freeze: where q_lim stands still, how far to look; gains: stable k, b", cli_advise},
    {"bilateral", "hand, glove, link and world: contacts as in the paper's second experiment",
     cli_bilateral},
    {"bringup", "first power-up, step by step, rehearsed on the simulated device", cli_bringup},
    {"budget", "the highest rate of the loop that the box can hold, bound by bound", cli_budget},
    {"calibrate", "known masses, F0 and home: tables of force and current; or --glove, poses",
     cli_calibrate},
    {"faults", "every fault in every state of the box, and any fault at any time", cli_faults},
    {"cards", "every misbehaviour of a card in every phase of its driver, and how it ends",
     cli_cards},
    {"drop", "the paper's falling-mass experiment on the simulated device", cli_drop},
    {"fit", "a plant that does what the paper's device did, by every reading", cli_fit},
    {"glove", "glove codes to stable angles and fingertips; the paper's Table I", cli_glove},
    {"csv", "a log as comma-separated values", cli_csv},
    {"listen", "the log of a box that sends it over the network, as a file", cli_listen},
    {"run", "a box that goes on: live values and parameters, over Modbus too", cli_run},
    {"regs", "the Modbus registers of a scene: address, name, unit, range", cli_regs},
    {"watch", "live values, state and faults of a running box, and a picture of them", cli_watch},
    {"replay", "the recorded inputs again, every output compared bit for bit", cli_replay},
    {"diagram", "a block diagram made from the signal and device tables", cli_diagram},
    {"quad", "samples of an encoder's two lines: count, edges, illegal steps", cli_quad},
};
#define COMMANDS (sizeof command / sizeof command[0])

static void help(FILE *to)
{
    fprintf(to, "usage: exhand COMMAND [options]\n");
    for (size_t i = 0; i < COMMANDS; i++) {
        fprintf(to, "  %-10s %s\n", command[i].name, command[i].what);
    }
    fprintf(to, "  --version  versions of library, record, board, parameter image, calibration\n"
                "`exhand COMMAND --help` lists the options of one.\n"
                "Exit status: 0 ok, 1 a check failed, 2 bad usage, 3 something is missing,\n"
                "130 interrupted.\n");
}

int main(int argc, char **argv)
{
    const char *name = argc > 1 ? argv[1] : "";
    for (size_t i = 0; i < COMMANDS; i++) {
        if (strcmp(name, command[i].name) == 0) {
            return cli_finish(command[i].run(argc - 1, argv + 1));
        }
    }
    if (strcmp(name, "--version") == 0) {
        printf("exhand %d.%d.%d, record %d, board %d, parameters %d, calibration %d, of the glove "
               "%d, wire %d\n",
               EXH_VERSION_MAJOR, EXH_VERSION_MINOR, EXH_VERSION_PATCH, EXH_RECORD_VERSION,
               EXH_BOARD_VERSION, EXH_PARAMS_VERSION, EXH_CALIB_VERSION, EXH_GLOVE_CAL_VERSION,
               EXH_WIRE_VERSION);
        return cli_finish(0);
    }
    if (strcmp(name, "--help") == 0 || strcmp(name, "-h") == 0) {
        help(stdout);
        return cli_finish(0);
    }
    if (name[0] != '\0') { fprintf(stderr, "exhand: %s: no such command\n", name); }
    help(stderr);
    return 2;
}
