/* SPDX-License-Identifier: MIT */
/* The Sensoray 526: sequences A to G as their sources write them, and the traps beside them.
 * What is quoted is the fact that is checked. */
#include "rig.h"

#define X4 0x0480u

static const unsigned base[2] = {A, B};

/* Waits as the sources do, "poll inw(ISR) & bit", and clears it by writing it. */
static uint32_t done(unsigned at, uint32_t bit)
{
    const uint32_t polls = poll(at + 0x0E, 2, bit, bit);
    outw(bit, at + 0x0E);
    return polls;
}

static uint32_t count(unsigned at, unsigned n)
{
    const uint32_t lo = inw(at + 0x12 + 8 * n);
    return (inw(at + 0x14 + 8 * n) & 0xFF) << 16 | lo;
}

/* "read of 0x34 returns 0x526A or 0x526B" */
TEST(signature)
{
    struct emu_config c = emu_box_config();
    power_on();
    CHECK_EQ_I64(inw(A + 0x34), 0x526A);
    CHECK_EQ_I64(inw(B + 0x34), 0x526A);
    c.s526[1].signature = 0x526B;
    emu_box_open(&box, &c);
    CHECK_EQ_I64(inw(B + 0x34), 0x526B);
}

/* "Registers end at 0x35", "0x36..0x3F unused"; "all registers 16-bit, even offsets" */
TEST(what_is_no_register_reads_all_ones)
{
    power_on();
    for (unsigned off = 0x36; off < 0x40; off++) { CHECK_EQ_I64(inw(A + off), 0xFFFF); }
    CHECK_EQ_I64(inw(A + 0x35), 0xFFFF);
    CHECK_EQ_I64(inb(A + 0x34), 0xFF);
    outb(0xFF, A + 0x04);
    CHECK_EQ_I64(inw(A + 0x04), 0);
}

/* Sequence A: "outw(mode, CnM); if mode[4:2]==0: outw(0x8000, CnC). Count starts at 0." */
TEST(sequence_a_counts_from_zero)
{
    power_on();
    for (unsigned card = 0; card < 2; card++) {
        for (unsigned n = 0; n < 4; n++) {
            box.pins.enc_cnt[card][n] = 1000;
            outw(X4, base[card] + 0x16 + 8 * n);
            outw(0x8000, base[card] + 0x18 + 8 * n);
            CHECK_EQ_I64(count(base[card], n), 0);
            CHECK_EQ_I64(inw(base[card] + 0x16 + 8 * n), X4); /* "mode readback works" */
            box.pins.enc_cnt[card][n] += 70000 + (int32_t)n;
            CHECK_EQ_I64(count(base[card], n), 70000 + n);
            box.pins.enc_cnt[card][n] -= 70000 + 2 * (int32_t)n;
            CHECK_EQ_I64(count(base[card], n), (0u - n) & 0xFFFFFF); /* "modulo 2^24" */
        }
    }
}

static void preload(unsigned c, uint32_t pr, uint32_t value)
{
    outw(pr, c + 0x16);
    outw(value >> 16, c + 0x14);
    outw(value & 0xFFFF, c + 0x12);
}

/* Sequence B: both preloads with s, load, both with r, mode on. */
TEST(sequence_b_counts_from_a_start_value)
{
    const uint32_t s = 0x123456, r = 0x000777;
    power_on();
    for (unsigned n = 0; n < 4; n++) {
        const unsigned c = A + 8 * n;
        preload(c, 0x0000, s);
        preload(c, 0x4000, s);
        outw(0x4000, c + 0x18);
        preload(c, 0x0000, r);
        preload(c, 0x4000, r);
        outw(0x400 | 0x0080, c + 0x16);
        CHECK_EQ_I64(count(A, n), s);
        box.pins.enc_cnt[0][n] = 5;
        CHECK_EQ_I64(count(A, n), s + 5);
    }
}

/* "the load on CNTLOAD sometimes comes from PR0 and sometimes from PR1" */
TEST(a_load_comes_from_either_preload)
{
    uint32_t got[4];
    power_on();
    preload(A, 0x0000, 100);
    preload(A, 0x4000, 200);
    outw(X4, A + 0x16);
    for (int i = 0; i < 4; i++) {
        outw(0x4000, A + 0x18);
        got[i] = count(A, 0);
    }
    CHECK(got[0] != got[1] && got[1] != got[2], "%" PRIu32 " %" PRIu32, got[0], got[1]);
    CHECK_EQ_I64(got[0] + got[1], 300);
}

/* "PR0/PR1 take effect on the low-word write": the high word alone is none. */
TEST(a_preload_is_high_word_then_low)
{
    power_on();
    preload(A, 0x0000, 0x010002);
    preload(A, 0x4000, 0x010002);
    outw(0x0000, A + 0x16);
    outw(0x55, A + 0x14);
    outw(0x4000, A + 0x18);
    CHECK_EQ_I64(count(A, 0), 0x010002);
}

/* Sequence C: "lo = inw(c+0x12) FIRST (this read latches all 24 bits); hi = inw & 0xFF" */
TEST(sequence_c_latches_at_the_low_word)
{
    uint32_t lo, hi;
    power_on();
    outw(X4, A + 0x16);
    outw(0x8000, A + 0x18);
    box.pins.enc_cnt[0][0] = 0xFFFF;
    lo = inw(A + 0x12);
    box.pins.enc_cnt[0][0] = 0x10000;
    hi = inw(A + 0x14);
    CHECK_EQ_I64((hi & 0xFF) << 16 | lo, 0xFFFF);
    CHECK(hi > 0xFF, "the upper byte must be masked: %" PRIx32, hi);
    hi = inw(A + 0x14); /* "Never read high first": it is an old one */
    lo = inw(A + 0x12);
    CHECK_EQ_I64((hi & 0xFF) << 16 | lo, 0);
    CHECK_EQ_I64(count(A, 0), 0x10000);
}

/* "latch control: 0 latch on read, 1 latch on event" */
TEST(a_counter_that_latches_on_an_event_stands_still)
{
    power_on();
    outw(X4 | 0x2000, A + 0x16);
    box.pins.enc_cnt[0][0] = 99;
    CHECK_EQ_I64(count(A, 0), 0);
    outw(X4, A + 0x16);
    CHECK_EQ_I64(count(A, 0), 99);
}

/* "clock source: quadrature: 0 = x1, 1 = x2, 2 = x4, 3 = x4 too"; "count enable: 0 off" */
TEST(x1_x2_x4_and_off)
{
    static const struct {
        uint32_t mode;
        int32_t up, back;
    } row[] = {{0x0080, 25, 0xFFFFFF - 24}, {0x0280, 50, 0xFFFFFF - 49},
        {0x0480, 100, 0xFFFFFF - 99}, {0x0680, 100, 0xFFFFFF - 99}, {0x0400, 0, 0}, {0x1480, 0, 0}};
    for (size_t i = 0; i < DIM(row); i++) {
        power_on();
        outw(row[i].mode, A + 0x16);
        outw(0x8000, A + 0x18);
        box.pins.enc_cnt[0][0] = 100;
        CHECK_EQ_I64(count(A, 0), row[i].up);
        box.pins.enc_cnt[0][0] = -100;
        CHECK_EQ_I64(count(A, 0), row[i].back);
    }
}

/* "3: clear RCAP / rollover captured": kept until a 1 is written */
TEST(a_rollover_is_captured)
{
    power_on();
    outw(X4, A + 0x16);
    box.pins.enc_cnt[0][0] = -1;
    CHECK_EQ_I64(inw(A + 0x18) & 0xF, 0x8);
    outw(0x0001, A + 0x18);
    CHECK_EQ_I64(inw(A + 0x18) & 0xF, 0x8);
    outw(0x0008, A + 0x18);
    CHECK_EQ_I64(inw(A + 0x18) & 0xF, 0);
}

/* Sequence D: "outw(0x8000 | sum(0x20<<ch) | 1) -> ADC; poll inw(ISR) & 0x04; outw 0x0004 -> ISR;
 * for each ch: outw(ch<<1) -> ADC; v = (int16)inw(ADD)" */
TEST(sequence_d_scans_and_keeps_a_result_per_channel)
{
    power_on();
    for (int ch = 0; ch < 8; ch++) {
        box.pins.ad_uV[0][ch] = emu_ad_uV((int16_t)(-20000 + 5000 * ch));
    }
    outw(0x0004, A + 0x0E);
    outw(0x8000 | 0x20 * 0xFF | 1, A + 0x06);
    for (int ch = 0; ch < 8; ch++) { box.pins.ad_uV[0][ch] = 0; } /* held at the start */
    CHECK(done(A, 0x04) > 1, "it takes time");
    for (unsigned ch = 0; ch < 8; ch++) {
        outw(ch << 1, A + 0x06);
        CHECK_EQ_I64((int16_t)inw(A + 0x08), -20000 + 5000 * (int)ch);
    }
    CHECK_EQ_I64(inw(A + 0x0E) & 0x04, 0);
    /* Two of them again: "Results are kept per channel" */
    outw(0x8000 | 0x20 << 2 | 0x20 << 7 | 1, A + 0x06);
    (void)done(A, 0x04);
    outw(2 << 1, A + 0x06);
    CHECK_EQ_I64((int16_t)inw(A + 0x08), 0);
    outw(3 << 1, A + 0x06);
    CHECK_EQ_I64((int16_t)inw(A + 0x08), -5000);
}

/* "15 us once if bit 15, plus 10 us per enabled channel" (proposed, uncertain) */
TEST(a_conversion_takes_its_time)
{
    power_on();
    outw(0x8000 | 0x20 * 3 | 1, A + 0x06);
    pass_us(33); /* the read takes one more: 34 of 35 */
    CHECK_EQ_I64(inw(A + 0x0E) & 0x04, 0);
    CHECK_EQ_I64(inw(A + 0x0E) & 0x04, 0x04);
    outw(0x04, A + 0x0E);
    outw(0x20 | 1, A + 0x06);
    pass_us(8);
    CHECK_EQ_I64(inw(A + 0x0E) & 0x04, 0);
    CHECK_EQ_I64(inw(A + 0x0E) & 0x04, 0x04);
}

/* Sequence E: "outw((0x20<<ch) | ch<<1 | 1 [| 0x8000 first time]) -> ADC; poll/clear ISR bit 2;
 * inw(ADD)" */
TEST(sequence_e_single_channel)
{
    power_on();
    for (unsigned ch = 0; ch < 8; ch++) {
        box.pins.ad_uV[1][ch] = -1000000 * (int32_t)ch;
        outw(0x20u << ch | ch << 1 | 1 | 0x8000, B + 0x06);
        CHECK(done(B, 0x04) != 0, "channel %u", ch);
        CHECK_EQ_I64((int16_t)inw(B + 0x08), emu_ad_code(-1000000 * (int32_t)ch));
    }
}

static uint64_t double_at(unsigned at, unsigned address)
{
    uint64_t v = 0;
    for (unsigned i = 0; i < 4; i++) { /* "least significant word at the lowest address" */
        outw(0x0080, at + 0x0E);
        outw((address + i) << 3 | 5, at + 0x34);
        CHECK(poll(at + 0x0E, 2, 0x80, 0x80) > 1, "word %u", address + i);
        outw(0x0080, at + 0x0E);
        v |= (uint64_t)inw(at + 0x32) << 16 * i;
    }
    return v;
}

/* "Read word: outw 0x0080 -> ISR; outw(addr<<3 | 5) -> EEC; poll ISR bit 7; outw 0x0080 -> ISR; w =
 * inw(EED)". "DAC ch k gain a at 8k..8k+3, offset b at 8k+4..8k+7; A/D Vref at 0x20..0x23" */
TEST(the_eeprom_describes_the_card)
{
    power_on();
    for (unsigned k = 0; k < 4; k++) {
        CHECK(double_at(A, 8 * k) == UINT64_C(0x40A9620000000000), "3249");
        CHECK(double_at(A, 8 * k + 4) == UINT64_C(0x40E0000000000000), "32768");
    }
    CHECK(double_at(B, 0x20) == UINT64_C(0x4023D80000000000), "9.921875");
    CHECK_EQ_I64(inw(A + 0x34), 0x526A); /* "0x34 is signature on read and command on write" */
}

/* "outw(0x8000|0x4000|0x2000|1) -> ADC, wait; outw 0x12 -> ADC, c0 = inw(ADD); outw 0x10 -> ADC,
 * c10 = inw(ADD)"; "V = Vref*(c - c0)/(c10 - c0)" */
TEST(calibration_by_the_references)
{
    struct emu_config c = emu_box_config();
    int32_t c0, c10;
    power_on();
    outw(0x8000 | 0x4000 | 0x2000 | 1, A + 0x06);
    CHECK(done(A, 0x04) > 1, "done");
    outw(0x12, A + 0x06);
    CHECK_EQ_I64((int16_t)inw(A + 0x08), 0);
    outw(0x10, A + 0x06);
    CHECK_EQ_I64((int16_t)inw(A + 0x08), 32512); /* 9.921875 V, exact */

    c.s526[0].ad_gain_q16 = 65000;
    c.s526[0].ad_offset_raw = 123;
    emu_box_open(&box, &c);
    box.pins.ad_uV[0][5] = 4000000;
    outw(0x8000 | 0x4000 | 0x2000 | 0x20 << 5 | 1, A + 0x06);
    (void)done(A, 0x04);
    outw(0x12, A + 0x06);
    c0 = (int16_t)inw(A + 0x08);
    outw(0x10, A + 0x06);
    c10 = (int16_t)inw(A + 0x08);
    outw(5 << 1, A + 0x06);
    CHECK_EQ_I64(c0, 123);
    {
        const int64_t v_uV = (int64_t)9921875 * ((int16_t)inw(A + 0x08) - c0) / (c10 - c0);
        CHECK(v_uV > 4000000 - 310 && v_uV < 4000000 + 310, "%" PRId64 " uV", v_uV);
    }
}

/* Sequence F: "outw(ch<<1) -> DAC; outw(code) -> ADD; outw(ch<<1 | 1) -> DAC; poll ISR bit 1;
 * outw 0x0002 -> ISR" */
TEST(sequence_f_one_output)
{
    power_on();
    for (unsigned ch = 0; ch < 4; ch++) {
        outw(ch << 1, A + 0x04);
        outw(32768 + 3249 * ch, A + 0x08);
        CHECK_EQ_I64(box.pins.da_uV[0][ch], 0);
        outw(ch << 1 | 1, A + 0x04);
        CHECK_EQ_I64(box.pins.da_uV[0][ch], 1000000 * (int)ch); /* at the write */
        CHECK(done(A, 0x02) > 1, "done");
        CHECK_EQ_I64(inw(A + 0x0E) & 0x02, 0);
    }
    CHECK_EQ_I64(box.pins.da_uV[1][3], 0);
}

/* Sequence G: "per ch: outw(ch<<1) -> DAC, outw(code) -> ADD; finally outw 0x0001 -> DAC":
 * "all selected outputs change together" */
TEST(sequence_g_many_outputs_together)
{
    power_on();
    for (unsigned ch = 0; ch < 4; ch++) {
        outw(ch << 1, A + 0x04);
        outw(32768 - 3249 * ch, A + 0x08);
        for (unsigned k = 0; k < 4; k++) { CHECK_EQ_I64(box.pins.da_uV[0][k], 0); }
    }
    outw(0x0001, A + 0x04);
    for (unsigned ch = 0; ch < 4; ch++) { CHECK_EQ_I64(box.pins.da_uV[0][ch], -1000000 * (int)ch); }
    outw(0x0008, A + 0x04); /* "Reset writes 0x0008; resulting output 0 V [U]" */
    for (unsigned ch = 0; ch < 4; ch++) { CHECK_EQ_I64(box.pins.da_uV[0][ch], 0); }
}

/* "code = a*V + b with a, b doubles per channel in EEPROM" */
TEST(an_output_is_what_its_eeprom_says)
{
    struct emu_config c = emu_box_config();
    c.s526[0].da_gain_q16[2] = 3200 * 65536;
    c.s526[0].da_zero_q16[2] = -5 * 65536;
    emu_s526_describe(&c.s526[0]);
    emu_box_open(&box, &c);
    CHECK(double_at(A, 16) == UINT64_C(0x40A9000000000000), "3200");
    CHECK(double_at(A, 20) == UINT64_C(0x40DFFEC000000000), "32763");
    outw(2 << 1, A + 0x04);
    outw(32763 + 3200, A + 0x08);
    outw(1, A + 0x04);
    CHECK_EQ_I64(box.pins.da_uV[0][2], 1000000);
    outw(2 << 1, A + 0x04);
    outw(32763 - 1600, A + 0x08);
    outw(1, A + 0x04);
    CHECK_EQ_I64(box.pins.da_uV[0][2], -500000);
}

/* "A/D codes are signed, D/A codes are offset binary"; "0x08 is A/D result on read and D/A preload
 * on write" */
TEST(add_is_two_registers)
{
    power_on();
    outw(40000, A + 0x08);
    CHECK_EQ_I64(inw(A + 0x08), 0);
}

/* "DIO: write [7:0] output data, [10] group 1 (DIO0-3) output, [11] group 2 (DIO4-7) output;
 * reading: [7:0] pin states" */
TEST(digital_lines)
{
    power_on();
    box.pins.din[0] = 0xA5;
    CHECK_EQ_I64(inw(A + 0x0A) & 0xFF, 0xA5);
    outw(0x0800 | 0x3C, A + 0x0A);
    CHECK_EQ_I64(box.pins.dout[0], 0x30);
    CHECK_EQ_I64(inw(A + 0x0A) & 0xFF, 0x35);
    outw(0x0400 | 0x3C, A + 0x0A);
    CHECK_EQ_I64(box.pins.dout[0], 0x0C);
    CHECK_EQ_I64(inw(A + 0x0A) & 0xFF, 0xAC);
}

/* "ISR: Clear by writing the same bit mask"; flags come whether or not IER enables them */
TEST(isr_is_cleared_by_ones)
{
    power_on();
    outw(0x20 | 1, A + 0x06);
    outw(1, A + 0x04);
    outw(5, A + 0x34);
    pass_us(100);
    CHECK_EQ_I64(inw(A + 0x0E), 0x86);
    outw(0xFF79, A + 0x0E);
    CHECK_EQ_I64(inw(A + 0x0E), 0x86);
    outw(0x0002, A + 0x0E);
    CHECK_EQ_I64(inw(A + 0x0E), 0x84);
    outw(0x0004, A + 0x0E);
    CHECK_EQ_I64(inw(A + 0x0E), 0x80);
    outw(0x0080, A + 0x0E);
    CHECK_EQ_I64(inw(A + 0x0E), 0);
}

TEST_MAIN("emu/s526", signature, what_is_no_register_reads_all_ones, sequence_a_counts_from_zero,
    sequence_b_counts_from_a_start_value, a_load_comes_from_either_preload,
    a_preload_is_high_word_then_low, sequence_c_latches_at_the_low_word,
    a_counter_that_latches_on_an_event_stands_still, x1_x2_x4_and_off, a_rollover_is_captured,
    sequence_d_scans_and_keeps_a_result_per_channel, a_conversion_takes_its_time,
    sequence_e_single_channel, the_eeprom_describes_the_card, calibration_by_the_references,
    sequence_f_one_output, sequence_g_many_outputs_together, an_output_is_what_its_eeprom_says,
    add_is_two_registers, digital_lines, isr_is_cleared_by_ones);
