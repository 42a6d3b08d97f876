/* SPDX-License-Identifier: MIT */
/* One module's golden vectors on an AVR. avr_run.c writes the rates behind a mark in the image. It
 * reads what ran, and the CRC of the digests, from a register. */
#include "modules.h"

#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/pgmspace.h>
#include <avr/sleep.h>

#define RUN__(name)  golden_##name
#define RUN_(name)   RUN__(name)
#define NAME__(name) #name
#define NAME_(name)  NAME__(name)

int metal_putchar(int c);

/* The mark, then first rate, last, and step. */
static const volatile struct {
    char mark[8];
    uint32_t rate[3];
} asked PROGMEM = {"EXHRATES", {1, GOLDEN_RATES, 1}};

static uint32_t rate(unsigned i) { return pgm_read_dword((const char *)(uintptr_t)&asked.rate[i]); }

int metal_putchar(int c)
{
    GPIOR0 = (uint8_t)c;
    return c;
}

int main(void)
{
    static struct golden g;
    const uint32_t lo = rate(0), hi = rate(1), step = rate(2);
    uint32_t crc = 0;
    uint32_t ran = 0;
    for (uint32_t at = lo; at <= hi; at += step) {
        (void)memset(&g, 0, sizeof g);
        RUN_(METAL_MODULE)(&g, at);
        crc = golden_crc_u32(crc, g.crc);
        ran++;
    }
    check_note("cells: %s %" PRIu32 "..%" PRIu32 ":%" PRIu32 " %" PRIu32 " %08" PRIx32,
        NAME_(METAL_MODULE), lo, hi, step, ran, crc);
    cli();
    sleep_enable();
    sleep_cpu(); /* without interrupts: the emulator's end */
    return 0;
}
