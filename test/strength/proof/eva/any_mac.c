/* SPDX-License-Identifier: MIT */
/* PROVES: tag
 * Any key, any bytes of length 0 to 32. Nothing outside them is read, and nothing overflows.
 *
 * EVA: -eva-slevel 40
 * PLANT: lib/src/talk/mac.c: for (; len_B >= 8; len_B -= 8, p += 8) -> for (; len_B >= 7; len_B -= 8, p += 8)
 */
#include "talk/mac.c"

#include "any.h"

int main(void)
{
    static uint8_t byte[32];
    ANY(byte);
    for (size_t len_B = 0; len_B <= sizeof byte; len_B++) {
        const struct exh_mac_key key = exh_mac_key(byte + 16);
        /* Its end is the end of the array. */
        (void)exh_mac(&key, byte + sizeof byte - len_B, len_B);
    }
    END();
    return 0;
}
