/* SPDX-License-Identifier: MIT */
/* Mac: a message authentication code, 64 bits of SipHash-2-4. Making it requires the key.
 *
 * Source: J.-P. Aumasson, D. J. Bernstein, "SipHash: a fast short-input PRF", INDOCRYPT 2012. It
 * uses additions, exclusive ors and rotations of four 64-bit words: two rounds per 8 bytes and four
 * at the end, without tables or key set-up. Its time depends on the length alone. Without the key,
 * a guess is right once in 2^64. It is no signature: a receiver can make tags, too. */
#ifndef EXHAND_MAC_H
#define EXHAND_MAC_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define EXH_MAC_KEY_B 16u /* bytes of a key */
#define EXH_MAC_B     8u  /* bytes of a tag */

/* A key: its bytes 0..7 and 8..15, little-endian. */
struct exh_mac_key {
    uint64_t k[2]; /* k0, k1 of the paper */
};

/* The key from 16 random bytes. Do not use a password. */
struct exh_mac_key exh_mac_key(const uint8_t byte[EXH_MAC_KEY_B]);

/* The tag of buf[len_B], len_B >= 0. Sent little-endian. */
uint64_t exh_mac(const struct exh_mac_key *key, const void *buf, size_t len_B);

#ifdef __cplusplus
}
#endif
#endif
