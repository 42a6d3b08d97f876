/* SPDX-License-Identifier: MIT */
/* Keyed: a link on which only who has the key is heard, and only now (docs/WIRE.md, "With a key").
 *
 * It stands between a socket and whoever reads wire packets: what goes out gets 24 bytes behind
 * it, what comes in is checked and loses them. Behind it all is as without a key: a scene, its log
 * and a replay know nothing of one. Little-endian:
 *
 *    0  the packet, whole (wire.h)
 *    n  u64 number of this packet, one more than the one before; bit 63: enum exh_wire_role
 *  +8   u64 echo: the newest number heard of the other end; 0: none
 *  +16  u64 tag of all before (mac.h)
 *
 * A number never comes again under a key: at a start it begins anywhere, at random. A run of the
 * other end is believed once it has echoed a number that we sent since the last one was believed,
 * which no recorded packet can have. Of a run each number is taken once, as long as it lasts: no
 * silence opens it; and none that echoes one of ours from 65536 ago or longer (EXH_WIRE_AHEAD). */
#ifndef EXHAND_KEYED_H
#define EXHAND_KEYED_H

#include "exhand/mac.h"
#include "exhand/wire.h"

#ifdef __cplusplus
extern "C" {
#endif

#define EXH_KEYED_B     EXH_WIRE_SEAL_B                /* behind a packet */
#define EXH_KEYED_MAX_B (EXH_WIRE_MAX_B + EXH_KEYED_B) /* of a packet with it, at most */

/* One end. Its counts are modulo 2^32; each datagram raises one of them. */
struct exh_keyed {
    struct exh_mac_key key; /* of both ends */
    uint64_t next;          /* number of the next packet that goes out */
    uint64_t since;         /* `next` when the run was believed: an echo before is no proof */
    uint64_t heard;         /* newest number with a right tag, of whatever run; 0: none */
    uint64_t newest;        /* of the run that is believed; 0: there is none */
    uint64_t seen;          /* bit k: newest - k came, or was before it was believed */
    uint32_t taken;         /* handed on */
    uint32_t no_key;        /* whole packets without number, echo and tag */
    uint32_t other_key;     /* a tag that is wrong, of a whole packet */
    uint32_t unproved;      /* a right tag, but no echo of us: it begins, or was recorded */
    uint32_t again;         /* came before, too late to tell, or our own */
    uint32_t damaged;       /* all else */
};

/* start: any number that has not been used under this key; 63 random bits, or a clock that goes on
 * while the power is off. Counts begin at 0. */
void exh_keyed_setup(
    struct exh_keyed *s, const struct exh_mac_key *key, enum exh_wire_role ours, uint64_t start);

/* The packet in buf, len_B long, gets its number, echo and tag: what is to be sent, B; or
 * -EXH_E_SHORT: not len_B + EXH_KEYED_B in cap_B, nothing is used up. */
int32_t exh_keyed_encode(struct exh_keyed *s, void *buf, size_t len_B, size_t cap_B);

/* A datagram: how many bytes of it are the packet, to be read as if they alone had come; 0:
 * unproved, its sender has the key and is to hear of us; or -EXH_E_VERSION (no key), -EXH_E_CRC
 * (another key), -EXH_E_STALE (again) or -EXH_E_SHORT (damaged). What is refused changes a count
 * alone; what is unproved, the next echo, too. Reads len_B bytes at most. */
int32_t exh_keyed_decode(struct exh_keyed *s, const void *buf, size_t len_B);

#ifdef __cplusplus
}
#endif
#endif
