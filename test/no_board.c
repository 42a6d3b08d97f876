/* SPDX-License-Identifier: MIT */
/* A board without hardware, for programs that run only a scene's tick. It belongs to no port, so
 * counted instructions include none of a port. */
#include "exhand/board.h"

const struct exh_board_info exh_board_info = {.name = "nobody"};

int exh_board_read_glove(struct exh_glove_in *in)
{
    (void)in;
    return 0;
}

int exh_board_link_send(const void *buf, size_t len_B)
{
    (void)buf;
    (void)len_B;
    return 0;
}

int exh_board_link_recv(void *buf, size_t cap_B)
{
    (void)buf;
    (void)cap_B;
    return 0;
}

uint32_t exh_board_cycles(void) { return 1; }
