/* SPDX-License-Identifier: MIT */
/* The log as datagrams. */
#include "exhand/run/stream.h"

#include "exhand/bytes.h"

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
    put32(to + STREAM_HEAD_B + n, exh_crc32(0, to, STREAM_HEAD_B + n));
    return STREAM_HEAD_B + n + STREAM_CRC_B;
}

void stream_sent(unsigned n)
{
    out.number++;
    out.place += n;
}

uint32_t stream_pieces(void) { return out.number; }

enum stream_is stream_read(struct stream_piece *p, const uint8_t *datagram, size_t len_B)
{
    const size_t all_B = len_B - STREAM_CRC_B; /* that the CRC is of */
    if (len_B < STREAM_HEAD_B) { return STREAM_NONE; }
    if (get32(datagram) == STREAM_MAGIC_1) { return STREAM_OLD; }
    if (get32(datagram) != STREAM_MAGIC) { return STREAM_NONE; }
    if (len_B < STREAM_HEAD_B + STREAM_CRC_B || len_B > STREAM_PIECE_B ||
        get32(datagram + all_B) != exh_crc32(0, datagram, all_B) || get32(datagram + 16) > 1) {
        return STREAM_DAMAGED;
    }
    *p = (struct stream_piece){get32(datagram + 4), get32(datagram + 8), get32(datagram + 12),
        get32(datagram + 16), datagram + STREAM_HEAD_B, all_B - STREAM_HEAD_B};
    return STREAM_PIECE;
}
