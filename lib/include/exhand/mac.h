/* SPDX-License-Identifier: MIT */
/* Mac: a tag that only who has the key can make of bytes, 64 bits of SipHash-2-4.
 *
 * Source: J.-P. Aumasson, D. J. Bernstein, "SipHash: a fast short-input PRF", INDOCRYPT 2012. It
 * needs no table and no set-up of a key: additions, exclusive ors and turns of four words of 64
 * bits, two rounds for 8 bytes and six at the end. Its time depends on the length alone. Who lacks
 * the key guesses a tag once in 2^64. It is for short messages and short tags; a signature it is
 * not, since whoever checks a tag could have made it. */
#ifndef EXHAND_MAC_H
#define EXHAND_MAC_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define EXH_MAC_KEY_B 16u /* of a key */
#define EXH_MAC_B     8u  /* of a tag */

/* A key: its bytes 0..7 and 8..15, each least significant first. */
struct exh_mac_key {
    uint64_t k[2]; /* k0, k1 of the paper */
};

/* Of 16 bytes, all of them random: a word for people is no key. */
struct exh_mac_key exh_mac_key(const uint8_t byte[EXH_MAC_KEY_B]);

/* The tag of len_B bytes, 0 and more; sent least significant byte first. Reads len_B bytes. */
uint64_t exh_mac(const struct exh_mac_key *key, const void *buf, size_t len_B);

#ifdef __cplusplus
}
#endif
#endif
