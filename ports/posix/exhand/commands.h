/* SPDX-License-Identifier: MIT */
/* The commands of the host program. */
#ifndef EXHAND_COMMANDS_H
#define EXHAND_COMMANDS_H

#include "base/program.h"

extern const struct program_commands exhand_commands;

#endif
