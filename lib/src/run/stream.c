/* SPDX-License-Identifier: MIT */
/* The log as datagrams. */
#include "exhand/run/stream.h"

#include "exhand/bytes.h"

#include <string.h>

static struct {
    uint32_t session, number, place;
    struct exh_mac_key key;
    int keyed;
} out;

static void put32(uint8_t *at, uint32_t v)
{
    for (unsigned i = 0; i < 4; i++) { at[i] = (uint8_t)(v >> 8 * i); }
}

static uint32_t get32(const uint8_t *at)
{
    return (uint32_t)at[0] | (uint32_t)at[1] << 8 | (uint32_t)at[2] << 16 | (uint32_t)at[3] << 24;
}

void stream_key(const struct exh_mac_key *key)
{
    out.keyed = key != NULL;
    if (key) { out.key = *key; }
}

void stream_open(uint32_t session)
{
    out.session = session;
    out.number = out.place = 0;
}

size_t stream_piece(uint8_t to[STREAM_PIECE_B], const uint8_t *byte, unsigned n, int last)
{
    size_t len_B = STREAM_HEAD_B + n;
    put32(to, out.keyed ? STREAM_MAGIC_K : STREAM_MAGIC);
    put32(to + 4, out.session);
    put32(to + 8, out.number);
    put32(to + 12, out.place);
    put32(to + 16, last != 0);
    memcpy(to + STREAM_HEAD_B, byte, n);
    put32(to + len_B, exh_crc32(0, to, len_B));
    len_B += STREAM_CRC_B;
    if (out.keyed) {
        const uint64_t tag = exh_mac(&out.key, to, len_B);
        put32(to + len_B, (uint32_t)(tag & UINT32_MAX));
        put32(to + len_B + 4, (uint32_t)(tag >> 32));
        len_B += EXH_MAC_B;
    }
    return len_B;
}

void stream_sent(unsigned n)
{
    out.number++;
    out.place += n;
}

uint32_t stream_pieces(void) { return out.number; }

static int has_tag(const uint8_t *datagram, size_t len_B, const struct exh_mac_key *key)
{
    const uint64_t tag = exh_mac(key, datagram, len_B);
    return get32(datagram + len_B) == (tag & UINT32_MAX) &&
           get32(datagram + len_B + 4) == tag >> 32;
}

enum stream_is stream_read(
    struct stream_piece *p, const uint8_t *datagram, size_t len_B, const struct exh_mac_key *key)
{
    const uint32_t magic = len_B < STREAM_HEAD_B ? 0 : get32(datagram);
    const size_t tail_B = STREAM_CRC_B + (magic == STREAM_MAGIC_K ? EXH_MAC_B : 0);
    const size_t all_B = len_B - tail_B; /* bytes covered by the CRC */
    if (magic == STREAM_MAGIC_1) { return STREAM_OLD; }
    if (magic != STREAM_MAGIC && magic != STREAM_MAGIC_K) { return STREAM_NONE; }
    if (len_B < STREAM_HEAD_B + tail_B || all_B > STREAM_HEAD_B + STREAM_DATA_B ||
        get32(datagram + all_B) != exh_crc32(0, datagram, all_B) || get32(datagram + 16) > 1) {
        return STREAM_DAMAGED;
    }
    if (magic == STREAM_MAGIC_K && key == NULL) { return STREAM_KEYED; }
    if (magic == STREAM_MAGIC && key) { return STREAM_NO_KEY; }
    if (key && !has_tag(datagram, all_B + STREAM_CRC_B, key)) { return STREAM_OTHER_KEY; }
    *p = (struct stream_piece){get32(datagram + 4), get32(datagram + 8), get32(datagram + 12),
        get32(datagram + 16), datagram + STREAM_HEAD_B, all_B - STREAM_HEAD_B};
    return STREAM_PIECE;
}
