/* SPDX-License-Identifier: MIT */
/* The log as datagrams that carry pieces of a byte stream. A listener detects lost pieces by their
 * position. Nothing is sent again, but the log repeats its header (log.h). Little-endian:
 *
 *    0  u32 "EXL2"    4  u32 session    8  u32 number of the piece, from 0
 *   12  u32 position of its first byte in the stream, modulo 2^32
 *   16  u32 1: the last piece    20  bytes, then u32 CRC-32 of all bytes before it
 *
 * With a key the first word is "EXL3", and a u64 tag of all bytes before (mac.h) follows the CRC.
 * There is no return path, so nothing proves that a packet is new. A log recorded under the same
 * key can be replayed to a listener who waits for a start; no byte of it can be changed. The host's
 * `exhand listen` uses the same file. */
#ifndef EXHAND_RUN_STREAM_H
#define EXHAND_RUN_STREAM_H

#include "exhand/mac.h"

#include <stddef.h>
#include <stdint.h>

#define STREAM_HEAD_B  20u
#define STREAM_DATA_B  1408u
#define STREAM_CRC_B   4u
#define STREAM_PIECE_B (STREAM_HEAD_B + STREAM_DATA_B + STREAM_CRC_B + EXH_MAC_B)
#define STREAM_MAGIC   0x324C5845u
#define STREAM_MAGIC_1 0x4C485845u /* "EXHL": version 1, without CRC */
#define STREAM_MAGIC_K 0x334C5845u /* "EXL3": with a tag */

/* --- out: one stream --- */
void stream_open(uint32_t session);
/* Adds a tag to all later pieces; NULL: none. The key is copied. */
void stream_key(const struct exh_mac_key *key);
/* Makes the next piece from n <= STREAM_DATA_B bytes; returns its length. It stays the next piece
 * until stream_sent(). */
size_t stream_piece(uint8_t to[STREAM_PIECE_B], const uint8_t *byte, unsigned n, int last);
void stream_sent(unsigned n);
uint32_t stream_pieces(void);

/* --- in --- */
struct stream_piece {
    uint32_t session, number, place, last;
    const uint8_t *byte;
    size_t n;
};
/* The kind of a datagram. */
enum stream_is {
    STREAM_NONE,
    STREAM_PIECE,
    STREAM_DAMAGED,
    STREAM_OLD,
    STREAM_KEYED,    /* has a tag, but we have no key */
    STREAM_NO_KEY,   /* has no tag, but we have a key */
    STREAM_OTHER_KEY /* undamaged, but with a wrong tag */
};
/* Decodes a datagram. key NULL: none. */
enum stream_is stream_read(
    struct stream_piece *p, const uint8_t *datagram, size_t len_B, const struct exh_mac_key *key);

#endif
