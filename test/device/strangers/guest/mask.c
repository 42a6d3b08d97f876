/* SPDX-License-Identifier: MIT */
/* Channels 2..7 of the S526's A/D: whose error it is that Linux does not read them.
 *
 * The card keeps a result for each channel. A word starts the conversion of the channels whose bits
 * (5 + channel) are set. Its bits 1..4 select the result to read. The mainline driver computes the
 * bit from "channel & 9", so it converts channel 0 or 1 and reads the result that the channel had
 * before.
 */
#include "check.h"
#include "linux.h"
#include "pin.h"
#include "table.h"

#include <stdio.h>
#include <string.h>

enum { ADC = BASE_A + 0x06, ADD = BASE_A + 0x08, ISR = BASE_A + 0x0E };

static void set_volts(int32_t offset_uV)
{
    for (int32_t ch = 0; ch < 8; ch++) { set_pin(PIN_AD + (uint32_t)ch, 1000000 * ch + offset_uV); }
}

static int64_t code(int32_t v_uV)
{
    return (v_uV * INT64_C(2) * 32768 + 10000000) / (2 * 10000000);
}

static int16_t result(unsigned ch)
{
    outw((uint16_t)(ch << 1), ADC);
    return (int16_t)inw(ADD);
}

/* "outw(0x8000 | sum(0x20 << ch) | 1) -> ADC", as the driver set of xPC Target does it. */
static void convert_all(void)
{
    outw(0x0004, ISR);
    outw(0x8000 | 0xFF << 5 | 1, ADC);
    while (!(inw(ISR) & 0x0004)) {}
    outw(0x0004, ISR);
}

static int32_t linux_reads(unsigned ch) { return (int32_t)get(A, S526_AI, ch, 0) - 32768; }

/* How many of channels 2..7 Linux has right. */
static unsigned reads(const char *when)
{
    unsigned right = 0;
    for (unsigned ch = 2; ch < 8; ch++) {
        const int32_t pin_uV = pin(PIN_AD + ch), got = linux_reads(ch);
        printf("      %s: channel %u has %8d uV, code %6d; Linux reads %6d\n", when, ch, pin_uV,
            (int)code(pin_uV), got);
        right += got == code(pin_uV);
    }
    return right;
}

static void check_their_bug(void)
{
    unsigned stale = 0, zero_or_one = 0;
    set_volts(100000);
    for (unsigned ch = 2; ch < 8; ch++) { stale += linux_reads(ch) == 0; }
    say(stale == 6, "never converted, channels 2..7 read 0 V through Linux whatever they have");
    convert_all();
    stale = 0;
    for (unsigned ch = 0; ch < 8; ch++) { stale += result(ch) == code(pin(PIN_AD + ch)); }
    say(stale == 8, "the same card by xPC Target's sequence (mask bits 5 + channel): all 8 right");
    set_volts(300000);
    say(reads("then") == 0, "the voltages moved: Linux has none of channels 2..7 right");
    stale = 0;
    for (unsigned ch = 2; ch < 8; ch++) {
        stale += linux_reads(ch) == code(1000000 * (int)ch + 100000);
    }
    say(stale == 6, "what it reads are the results before, of xPC Target's sequence");
    for (unsigned ch = 2; ch < 8; ch++) {
        set_volts(400000 + 1000 * (int)ch);
        (void)linux_reads(ch);
        zero_or_one += result(ch & 1) == code(pin(PIN_AD + (ch & 1)));
    }
    say(zero_or_one == 6,
        "what it converts for channel 2, 3, 4, .. is channel 0, 1, 0, .. instead");
}

void check_mask(int bug)
{
    int e;
    printf("\nA/D channels 2..7: driver s526\n");
    if (bug) {
        check_their_bug();
        say(detach(A) == 0 && detach(B) == 0 && unload("s526") == 0, "s526 unloaded");
        e = load("/s526-mask.ko", "");
        say(e == 0, "the same module loaded with one byte other, mask 0x0F for 0x09: %s",
            strerror(-e));
        e = attach(A, "s526", BASE_A, 0);
        say(e == 0, "attached again: %s", strerror(-e));
        (void)attach(B, "s526", BASE_B, 0);
    }
    set_volts(-500000);
    say(reads(bug ? "mask 0x0F" : "as it is") == 6, "all of channels 2..7 are right");
}
