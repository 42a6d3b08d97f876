/* SPDX-License-Identifier: MIT */
/* The end of an image, for any of its files: the code for emulators is kept, the board halts. */
#include "pc104.h"

uint8_t pc104_exit_code;

void pc104_halt(uint8_t code, const char *why)
{
    pc104_exit_code = code;
    exh_board_halt(why);
}
