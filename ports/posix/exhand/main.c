/* SPDX-License-Identifier: MIT */
/* The host program. */
#include "commands.h"

int main(int argc, char **argv)
{
    static const struct program exhand = {
        "exhand", {&exhand_commands}, "budget cards diagram faults fit"};
    return program_main(&exhand, argc, argv);
}
