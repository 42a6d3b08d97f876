/* SPDX-License-Identifier: MIT */
/* PROVES: link with a key
 * Any bytes of any length up to 64, and of none that is too long for a packet, into any state of
 * one end. Any packet into buffers of any size. A datagram raises one count, and the packet passed
 * on lies within it.
 *
 * EVA: -eva-slevel 30
 * PLANT: lib/src/talk/keyed.c: if (len_B < EXH_WIRE_OVERHEAD) { return refuse(&s->damaged, EXH_E_SHORT); } -> (void)0;
 * PLANT: lib/src/talk/keyed.c: if (len_B != whole_B + EXH_KEYED_B) -> if (len_B != whole_B)
 * PLANT: lib/src/talk/keyed.c: if (cap_B < EXH_KEYED_B || len_B > cap_B - EXH_KEYED_B) { return -EXH_E_SHORT; } -> (void)0;
 */
#include "talk/keyed.c"

#include "any.h"

#define BUF_B 64u

/* Their proofs are units mac and bytes: any value, of what may be read. */
uint64_t exh_mac(const struct exh_mac_key *key, const void *buf, size_t len_B)
{
    (void)key;
    /*@ assert tag_of: len_B == 0 || \valid_read((char *)buf + (0 .. len_B - 1)); */
    return any_u64();
}

uint32_t exh_crc32(uint32_t crc, const void *buf, size_t len_B)
{
    (void)crc;
    /*@ assert sum_of: len_B == 0 || \valid_read((char *)buf + (0 .. len_B - 1)); */
    return any_u32();
}

int main(void)
{
    static struct exh_keyed s;
    static uint8_t buf[BUF_B];
    const struct exh_mac_key key = {{any_u64(), any_u64()}};
    exh_keyed_setup(&s, &key, any8() & 1 ? EXH_WIRE_WORLD : EXH_WIRE_CONTROLLER, any_u64());
    for (size_t len_B = 0; len_B <= BUF_B; len_B++) {
        int32_t n;
        ANY(buf);
        ANY(s);
        n = exh_keyed_decode(&s, buf + BUF_B - len_B, len_B);
        /*@ assert within: n <= 0 || n <= len_B - 24; */
        ANY(s);
        (void)exh_keyed_encode(
            &s, buf + BUF_B - len_B, Frama_C_unsigned_int_interval(0, UINT32_MAX), len_B);
    }
    END();
    return 0;
}
