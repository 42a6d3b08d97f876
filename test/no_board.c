/* SPDX-License-Identifier: MIT */
/* A board that nobody is at, for programs that run a scene's tick and nothing else. No port's, so
 * that what is counted holds nothing of one. */
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
