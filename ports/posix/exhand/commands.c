/* SPDX-License-Identifier: MIT */
/* The commands of the host program: what people do with a box and with what it leaves behind. */
#include "commands.h"

#include "base/cli.h"

#include <string.h>

/* The glove's calibration is another: its options are its own. */
static int calibrate(int argc, char **argv)
{
    for (int i = 1; i < argc; i++) {
        if (strcmp(argv[i], "--glove") == 0) { return cli_calibrate_glove(argc, argv); }
    }
    return cli_calibrate(argc, argv);
}

static const struct program_command command[] = {
    {"advise", "freeze: where q_lim stands still, how far to look; gains: stable k, b", cli_advise},
    {"bilateral", "hand, glove, link and world: contacts as in the paper's second experiment",
        cli_bilateral},
    {"bringup", "first power-up, step by step, rehearsed on the simulated device", cli_bringup},
    {"calibrate", "known masses, F0 and home: tables of force and current; or --glove, poses",
        calibrate},
    {"drop", "the paper's falling-mass experiment on the simulated device", cli_drop},
    {"glove", "glove codes to stable angles and fingertips; the paper's Table I", cli_glove},
    {"identify", "inertia, friction, stiffness and delay of a device, with intervals",
        cli_identify},
    {"csv", "a log as comma-separated values", cli_csv},
    {"listen", "write the log of a box on the network to a file", cli_listen},
    {"run", "a box in continuous operation: live values, parameters, Modbus", cli_run},
    {"regs", "the Modbus registers of a scene: address, name, unit, range", cli_regs},
    {"watch", "live values, state and faults of a running box, and a picture of them", cli_watch},
    {"replay", "run recorded inputs again and compare every output bit", cli_replay},
    {"quad", "samples of an encoder's two lines: count, edges, illegal steps", cli_quad},
};

const struct program_commands exhand_commands = {command, sizeof command / sizeof command[0]};
