/* SPDX-License-Identifier: MIT */
/* The log as datagrams. */
#include "exhand/run/stream.h"

#include <string.h>

static struct {
    uint32_t session, number, place;
} out;

static void put32(uint8_t *at, uint32_t v)
{
    for (unsigned i = 0; i < 4; i++) { at[i] = (uint8_t)(v >> 8 * i); }
}

static uint32_t get32(const uint8_t *at)
{
    return (uint32_t)at[0] | (uint32_t)at[1] << 8 | (uint32_t)at[2] << 16 | (uint32_t)at[3] << 24;
}

void stream_open(uint32_t session)
{
    out.session = session;
    out.number = out.place = 0;
}

size_t stream_piece(uint8_t to[STREAM_PIECE_B], const uint8_t *byte, unsigned n, int last)
{
    put32(to, STREAM_MAGIC);
    put32(to + 4, out.session);
    put32(to + 8, out.number);
    put32(to + 12, out.place);
    put32(to + 16, last != 0);
    memcpy(to + STREAM_HEAD_B, byte, n);
    return STREAM_HEAD_B + n;
}

void stream_sent(unsigned n)
{
    out.number++;
    out.place += n;
}

uint32_t stream_pieces(void) { return out.number; }

int stream_read(struct stream_piece *p, const uint8_t *datagram, size_t len_B)
{
    if (len_B < STREAM_HEAD_B || len_B > STREAM_PIECE_B || get32(datagram) != STREAM_MAGIC ||
        get32(datagram + 16) > 1) {
        return 0;
    }
    *p = (struct stream_piece){get32(datagram + 4), get32(datagram + 8), get32(datagram + 12),
        get32(datagram + 16), datagram + STREAM_HEAD_B, len_B - STREAM_HEAD_B};
    return 1;
}
