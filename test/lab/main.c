/* SPDX-License-Identifier: MIT */
/* exhand-lab: all that exhand has, and what proves or studies. */
#include "commands.h"
#include "lab/lab.h"

static const struct program_command command[] = {
    {"advise", "as exhand does; gains: against a simulated map of --sweep", lab_advise},
    {"bilateral", "the contact experiment, and over links, hands, gains; beside the one before",
        lab_bilateral},
    {"budget", "the highest rate of the loop that the box can hold, bound by bound", cli_budget},
    {"cards", "every misbehaviour of a card in every phase of its driver, and how it ends",
        cli_cards},
    {"certificate", "random devices: identified, advised, and whether that holds", cli_certificate},
    {"diagram", "a block diagram made from the signal and device tables", cli_diagram},
    {"drop", "the falling mass, and its spread, readings, stability map; beside the one before",
        lab_drop},
    {"faults", "every fault in every state of the box, and any fault at any time", cli_faults},
    {"fit", "a plant that does what the paper's device did, by every reading", cli_fit},
    {"glove", "as exhand does; the paper's Table I, and the scan's skew", lab_glove},
};

int main(int argc, char **argv)
{
    static const struct program_commands studies = {command, sizeof command / sizeof command[0]};
    static const struct program lab = {"exhand-lab", {&studies, &exhand_commands}, NULL};
    return program_main(&lab, argc, argv);
}
