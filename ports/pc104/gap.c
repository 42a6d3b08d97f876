/* SPDX-License-Identifier: MIT */
/* Measures the longest time for which the processor was not available: reads a counter repeatedly,
 * as Linux's hwlat does. Firmware (SMI), another thread of the core or an emulator's host appear as
 * a gap. Waking from sleep (C-states) does not; tick_wake shows that (load.c). Portable:
 * test/closed/sim/pc104_gap_test.c. */
#include "pc104.h"

struct pc104_gap pc104_gap_look(uint32_t (*now)(void), uint64_t counts, uint32_t most)
{
    struct pc104_gap g = {0, 0};
    uint64_t passed = 0;
    uint32_t last = now();
    while (passed < counts) {
        const uint32_t at = now(), gap = at - last;
        g.longest = gap > g.longest ? gap : g.longest;
        g.beyond += gap > most;
        passed += gap;
        last = at;
    }
    return g;
}
