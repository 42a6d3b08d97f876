/* What Linux does: the port accesses that Debian's drivers s526 and dmm32at were seen to make
 * (test/strangers), made again here, where no kernel is. Every reading must be what it was there.
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

/* As guest/trace.c of test/strangers sets them. */
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

/* A register that is read until it is as wanted; what Linux reads in an interrupt, when it comes. */
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

/* The sequences that the facts tell, and that the other tests here are written from, are what
 * Linux does: "outb 0x20 -> 8; outb 0 -> 7; outb 0 -> 9; outb 0x80 -> 2; outb 0xFF -> 3;
 * outb 0x0C -> 11", then reg 2, 3, 7, 8, 9, 11. */
TEST(its_detection_is_the_facts)
{
    static const struct access fact[] = {
        {2, 'w', 1, 0x308, 0x20}, {2, 'w', 1, 0x307, 0x00}, {2, 'w', 1, 0x309, 0x00},
        {2, 'w', 1, 0x302, 0x80}, {2, 'w', 1, 0x303, 0xFF}, {2, 'w', 1, 0x30B, 0x0C},
        {2, 'r', 1, 0x302, 0x00}, {2, 'r', 1, 0x303, 0x1F}, {2, 'r', 1, 0x307, 0x80},
        {2, 'r', 1, 0x308, 0x60}, {2, 'r', 1, 0x309, 0x00}, {2, 'r', 1, 0x30B, 0x0C}};
    unsigned at = 0;
    while (at < DIM(seen) && seen[at].sequence != 2) { at++; }
    CHECK(at + DIM(fact) <= DIM(seen), "%u", at);
    for (unsigned i = 0; i < DIM(fact); i++) {
        CHECK_EQ_I64(seen[at + i].kind, fact[i].kind);
        CHECK_EQ_I64(seen[at + i].port, fact[i].port);
        CHECK_EQ_I64(seen[at + i].value, fact[i].value);
    }
}

/* Sequences A, C, E and F of the facts about the 526, with the driver's mask in E: channel 3
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
          its_mask_converts_another_channel);
