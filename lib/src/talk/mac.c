/* SPDX-License-Identifier: MIT */
/* SipHash-2-4, from the paper (section 2). */
#include "exhand/mac.h"

#include "../num/word.h"

/* Constant rotations, since 32-bit compilers call a helper for a variable one. */
#define TURN(v, by) ((v) = (v) << (by) | (v) >> (64 - (by)))

struct words {
    uint64_t a, b, c, d; /* v0..v3 of the paper */
};

static uint64_t low_first(const uint8_t *p) { return (uint64_t)word_at(p + 4) << 32 | word_at(p); }

static void rounds(struct words *to, unsigned n)
{
    struct words v = *to;
    for (; n > 0; n--) {
        v.a += v.b;
        v.c += v.d;
        TURN(v.b, 13);
        TURN(v.d, 16);
        v.b ^= v.a;
        v.d ^= v.c;
        TURN(v.a, 32);
        v.c += v.b;
        v.a += v.d;
        TURN(v.b, 17);
        TURN(v.d, 21);
        v.b ^= v.c;
        v.d ^= v.a;
        TURN(v.c, 32);
    }
    *to = v;
}

static void add(struct words *v, uint64_t m)
{
    v->d ^= m;
    rounds(v, 2);
    v->a ^= m;
}

struct exh_mac_key exh_mac_key(const uint8_t byte[EXH_MAC_KEY_B])
{
    const struct exh_mac_key key = {{low_first(byte), low_first(byte + 8)}};
    return key;
}

uint64_t exh_mac(const struct exh_mac_key *key, const void *buf, size_t len_B)
{
    const uint8_t *p = (const uint8_t *)buf;
    /* "somepseudorandomlygeneratedbytes", in the paper */
    struct words v = {key->k[0] ^ UINT64_C(0x736F6D6570736575),
        key->k[1] ^ UINT64_C(0x646F72616E646F6D), key->k[0] ^ UINT64_C(0x6C7967656E657261),
        key->k[1] ^ UINT64_C(0x7465646279746573)};
    uint8_t last[8] = {0, 0, 0, 0, 0, 0, 0, (uint8_t)(len_B & 0xFF)};
    for (; len_B >= 8; len_B -= 8, p += 8) { add(&v, low_first(p)); }
    for (unsigned i = 0; i < len_B; i++) { last[i] = p[i]; }
    add(&v, low_first(last));
    v.c ^= 0xFF;
    rounds(&v, 4);
    return v.a ^ v.b ^ v.c ^ v.d;
}
