/* SPDX-License-Identifier: MIT */
/* 8254, channel 0, mode 2: one interrupt every `divisor` counts, reloaded by the hardware, so
 * that periods do not drift whatever the software does. */
#include "pc104.h"

#include "exhand/error.h"
#include "io.h"

enum { PIT_COUNT0 = 0x40, PIT_MODE = 0x43 };
#define MODE_RATE   0x34u /* channel 0, low then high byte, mode 2 */
#define MODE_LATCH  0x00u /* channel 0, hold the count for reading */
#define DIVISOR_MAX 65535u
#define PROBE_READS 100000u /* 0.1 s and more on ISA; one count takes 0.84 us */

void pc104_pit_load(uint32_t divisor)
{
    pc104_out8(PIT_MODE, MODE_RATE);
    pc104_out8(PIT_COUNT0, (uint8_t)(divisor & 0xFFu)); /* 65536 is written as 0 */
    pc104_out8(PIT_COUNT0, (uint8_t)(divisor >> 8 & 0xFFu));
}

uint32_t pc104_pit_count(void)
{
    pc104_out8(PIT_MODE, MODE_LATCH);
    const uint32_t low = pc104_in8(PIT_COUNT0);
    return low | (uint32_t)pc104_in8(PIT_COUNT0) << 8;
}

int pc104_pit_open(struct pc104_timer *t, const char **why)
{
    uint32_t first;
    *t = (struct pc104_timer){"8254", PC104_PIT_HZ, DIVISOR_MAX};
    *why = "stands still";
    pc104_pit_load(65536);
    first = pc104_pit_count();
    for (uint32_t i = 0; i < PROBE_READS; i++) {
        if (pc104_pit_count() != first) { return 0; }
    }
    return -EXH_E_IO;
}
