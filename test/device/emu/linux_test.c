/* SPDX-License-Identifier: MIT */
/* What Linux does: the port accesses that Debian's drivers s526 and dmm32at were seen to make
 * (test/device/strangers), made again here, where no kernel is. Every reading must be what it was
 * there.
 */
#include "rig.h"

struct access {
    uint8_t sequence;
    char kind;
    uint8_t width_B;
    uint16_t port, value;
};

static const struct access seen[] = {
#include "linux_trace.inc"
};

#define SEQUENCES 12

/* As guest/trace.c of test/device/strangers sets them. */
static void set_pins(void)
{
    box.pins.enc_cnt[0][1] = 0;
    box.pins.ad_uV[0][0] = 1234567;
    box.pins.ad_uV[0][1] = -7654321;
    for (int ch = 0; ch < 22; ch++) { box.pins.glove_uV[ch] = 370000 * ch - 4000000; }
    box.pins.glove_uV[5] = 2500000;
    box.pins.glove_uV[21] = -3000000;
    box.pins.din[0] = 0xA5;
}

/* A register that is read until it is as wanted; what Linux reads in an interrupt, when it comes.
 */
static int polled(unsigned port)
{
    return port == A + 0x0E || port == MM + 4 || port == MM + 8 || port == MM + 9 ||
           port == MM + 11;
}

static uint32_t read_as(const struct access *a)
{
    uint32_t v = emu_in(&box, a->port, a->width_B);
    for (int n = 0; n < 1000 && v != a->value && polled(a->port); n++) {
        pass_us(a->port == MM + 9 ? 1000 : 1);
        v = emu_in(&box, a->port, a->width_B);
    }
    return v;
}

static unsigned play(unsigned sequence)
{
    unsigned accesses = 0;
    for (unsigned i = 0; i < DIM(seen); i++) {
        const struct access *a = &seen[i];
        if (a->sequence != sequence) { continue; }
        accesses++;
        if (a->kind == 'w') {
            emu_out(&box, a->port, a->width_B, a->value);
            if (a->port == MM + 8 || a->port == MM + 11) { pass_us(1000); } /* as it does */
        } else {
            CHECK_EQ_I64(read_as(a), a->value);
        }
    }
    return accesses;
}

TEST(all_that_linux_was_seen_to_do)
{
    unsigned accesses = 0;
    power_on();
    set_pins();
    for (unsigned s = 1; s <= SEQUENCES; s++) {
        if (s == 4) { box.pins.enc_cnt[0][1] = -1234567; }
        accesses += play(s);
    }
    CHECK_EQ_I64(accesses, DIM(seen));
    CHECK(accesses >= 230, "%u accesses", accesses);
    CHECK_EQ_I64(box.pins.da_uV[0][2], emu_da_uV(0x9ABC));
    CHECK_EQ_I64(box.mm.da_out[3], 0xABC);
    CHECK_EQ_I64(box.mm.port[0], 0x5A);
    CHECK_EQ_I64(box.pins.dout[0], 0x60);
}

/* The other tests here are written from sequences in the facts. Linux has the same sequences:
 * kinds, ports and, except for results, values. */
static void check_fact(const struct access *fact, unsigned n)
{
    unsigned at = 0;
    while (at < DIM(seen) && seen[at].sequence != fact->sequence) { at++; }
    CHECK(at + n <= DIM(seen), "%u", at);
    for (unsigned i = 0; i < n && at + i < DIM(seen); i++) {
        CHECK_EQ_I64(seen[at + i].sequence, fact[i].sequence);
        CHECK_EQ_I64(seen[at + i].kind, fact[i].kind);
        CHECK_EQ_I64(seen[at + i].port, fact[i].port);
        if (fact[i].width_B) { CHECK_EQ_I64(seen[at + i].value, fact[i].value); }
    }
}

/* "outb 0x20 -> 8; outb 0 -> 7; outb 0 -> 9; outb 0x80 -> 2; outb 0xFF -> 3; outb 0x0C -> 11". Then
 * reg 2, 3, 7, 8, 9, 11: "An emulated board must return exactly these". */
TEST(its_detection_is_the_facts)
{
    static const struct access fact[] = {{2, 'w', 1, MM + 8, 0x20}, {2, 'w', 1, MM + 7, 0x00},
        {2, 'w', 1, MM + 9, 0x00}, {2, 'w', 1, MM + 2, 0x80}, {2, 'w', 1, MM + 3, 0xFF},
        {2, 'w', 1, MM + 11, 0x0C}, {2, 'r', 1, MM + 2, 0x00}, {2, 'r', 1, MM + 3, 0x1F},
        {2, 'r', 1, MM + 7, 0x80}, {2, 'r', 1, MM + 8, 0x60}, {2, 'r', 1, MM + 9, 0x00},
        {2, 'r', 1, MM + 11, 0x0C}};
    check_fact(fact, DIM(fact));
}

/* "A: outw(mode, CnM); if mode[4:2]==0: outw(0x8000, CnC). C: lo = inw(c+0x12) FIRST; hi. E:
 * outw((0x20<<ch) | ch<<1 | 1 [| 0x8000 first time]) -> ADC; poll/clear ISR bit 2; inw(ADD). F:
 * outw(ch<<1) -> DAC; outw(code) -> ADD; outw(ch<<1 | 1) -> DAC; poll ISR bit 1; outw 0x0002." */
TEST(its_s526_sequences_are_the_facts)
{
    static const struct access a[] = {{3, 'w', 2, A + 0x1E, 0x0480}, {3, 'w', 2, A + 0x20, 0x8000}};
    static const struct access c[] = {{4, 'r', 0, A + 0x1A, 0}, {4, 'r', 0, A + 0x1C, 0}};
    static const struct access e[] = {{5, 'w', 2, A + 6, 0x8021}, {5, 'r', 2, A + 14, 4},
        {5, 'w', 2, A + 14, 4}, {5, 'r', 0, A + 8, 0}, {5, 'w', 2, A + 6, 0x0021}};
    static const struct access f[] = {{6, 'w', 2, A + 4, 4}, {6, 'w', 2, A + 8, 0x9ABC},
        {6, 'w', 2, A + 4, 5}, {6, 'r', 2, A + 14, 2}, {6, 'w', 2, A + 14, 2}};
    check_fact(a, DIM(a));
    check_fact(c, DIM(c));
    check_fact(e, DIM(e));
    check_fact(f, DIM(f));
}

/* "Timer-paced scan: outb 0 -> 10; page 0; 0x56 -> 15, 200 -> 13; 0xB6 -> 15, lo, hi -> 14;
 * outb 0x83 -> 9": every 40 ms, value 2000. Samples: "lo = inb 0, hi = inb 1", "then outb 0x08 ->
 * 8". */
TEST(its_scans_are_the_facts)
{
    static const struct access fact[] = {{12, 'w', 1, MM + 7, 0x02}, {12, 'w', 1, MM + 7, 0x04},
        {12, 'w', 1, MM + 2, 0}, {12, 'w', 1, MM + 3, 21}, {12, 'w', 1, MM + 11, 0x08},
        {12, 'w', 1, MM + 8, 0x08}, {12, 'r', 1, MM + 11, 0x08}, {12, 'w', 1, MM + 10, 0},
        {12, 'w', 1, MM + 8, 0}, {12, 'w', 1, MM + 15, 0x56}, {12, 'w', 1, MM + 13, 200},
        {12, 'w', 1, MM + 15, 0xB6}, {12, 'w', 1, MM + 14, 0xD0}, {12, 'w', 1, MM + 14, 0x07},
        {12, 'w', 1, MM + 9, 0x83}, {12, 'r', 1, MM + 9, 0x83}, {12, 'r', 0, MM, 0},
        {12, 'r', 0, MM + 1, 0}};
    check_fact(fact, DIM(fact));
}

/* Sequence E with the driver's mask: channel 3
 * starts a conversion of channel 1 (bit 6) and reads the result of channel 3. */
TEST(its_mask_converts_another_channel)
{
    unsigned found = 0;
    for (unsigned i = 0; i < DIM(seen); i++) {
        if (seen[i].kind == 'w' && seen[i].port == A + 6 && (seen[i].value >> 1 & 0xF) == 3) {
            CHECK_EQ_I64(seen[i].value, 0x8000 | 0x20 << 1 | 3 << 1 | 1);
            CHECK(seen[i].value != (0x8000 | 0x20 << 3 | 3 << 1 | 1), "the bug is mended");
            found++;
        }
    }
    CHECK_EQ_I64(found, 1);
}

TEST_MAIN("Linux", all_that_linux_was_seen_to_do, its_detection_is_the_facts,
    its_s526_sequences_are_the_facts, its_scans_are_the_facts, its_mask_converts_another_channel);
