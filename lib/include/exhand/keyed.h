/* SPDX-License-Identifier: MIT */
/* Keyed: authenticates the packets of a link with a shared key, and rejects replayed ones
 * (docs/WIRE.md, "With a key").
 *
 * It works between the socket and the reader of wire packets: it appends 24 bytes to outgoing
 * packets, and checks and removes them on incoming ones. Scene, log and replay do not see them.
 * Little-endian:
 *
 *    0    the packet, whole (wire.h), of n bytes
 *    n    u64 number of this packet, one more than the previous; bit 63: enum exh_wire_role
 *    n+8  u64 echo: the newest number received from the other end; 0: none
 *    n+16 u64 tag of all bytes before it (mac.h)
 *
 * A number is never reused under a key: each run starts at a random number. A run of the other end
 * is accepted once it echoes a number that we sent after accepting the last run. No recorded packet
 * can do that. Each number of a run is accepted once. Silence does not relax these rules. An echo
 * of our packet from 65536 or more packets ago (EXH_WIRE_AHEAD) is refused. */
#ifndef EXHAND_KEYED_H
#define EXHAND_KEYED_H

#include "exhand/mac.h"
#include "exhand/wire.h"

#ifdef __cplusplus
extern "C" {
#endif

#define EXH_KEYED_B     EXH_WIRE_SEAL_B                /* bytes after a packet */
#define EXH_KEYED_MAX_B (EXH_WIRE_MAX_B + EXH_KEYED_B) /* longest packet with them */

/* One end of the link. Each datagram increments one of the counters, which are modulo 2^32. */
struct exh_keyed {
    struct exh_mac_key key; /* key of both ends */
    uint64_t next;          /* number of the next outgoing packet */
    uint64_t since;         /* next when the run was accepted; older echoes prove nothing */
    uint64_t heard;         /* newest number with a correct tag, of any run; 0: none */
    uint64_t newest;        /* newest number of the accepted run; 0: none */
    uint64_t seen;          /* bit k: newest - k was received, or precedes the run */
    uint32_t taken;         /* packets passed on */
    uint32_t no_key;        /* whole packets without number, echo and tag */
    uint32_t other_key;     /* whole packets with a wrong tag */
    uint32_t unproved;      /* correct tag without an echo of ours: new run or recording */
    uint32_t again;         /* received before, too old, or our own */
    uint32_t damaged;       /* all others */
};

/* start is a number not yet used under this key: 63 random bits, or a battery-backed clock. */
void exh_keyed_setup(
    struct exh_keyed *s, const struct exh_mac_key *key, enum exh_wire_role ours, uint64_t start);

/* Appends number, echo and tag to the packet of len_B bytes in buf. Returns the bytes to send, or
 * -EXH_E_SHORT if cap_B is below len_B + EXH_KEYED_B; then no number is used. */
int32_t exh_keyed_encode(struct exh_keyed *s, void *buf, size_t len_B, size_t cap_B);

/* Checks a datagram of len_B bytes and reads no more. Returns the length of the packet in it. 0
 * means unproved: the sender has the key and must first receive a packet of ours. Errors:
 * -EXH_E_VERSION (no key), -EXH_E_CRC (another key), -EXH_E_STALE (again), -EXH_E_SHORT (damaged).
 * A refused datagram changes a counter only, an unproved one also the next echo. */
int32_t exh_keyed_decode(struct exh_keyed *s, const void *buf, size_t len_B);

#ifdef __cplusplus
}
#endif
#endif
