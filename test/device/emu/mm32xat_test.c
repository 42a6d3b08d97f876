/* SPDX-License-Identifier: MIT */
/* The Diamond MM-32X-AT: its detection to the byte, scans, FIFO, timer, D/A, pages. What is
 * quoted is the fact that is checked. */
#include "rig.h"

/* "outb 0x20 -> 8; wait 1 ms; outb 0 -> 7; outb 0 -> 9; outb 0x80 -> 2; outb 0xFF -> 3;
 * outb 0x0C -> 11; wait 100 us" */
static void init(void)
{
    power_on();
    outb(0x20, MM + 8);
    pass_us(1000);
    outb(0x00, MM + 7);
    outb(0x00, MM + 9);
    outb(0x80, MM + 2);
    outb(0xFF, MM + 3);
    outb(0x0C, MM + 11);
    pass_us(100);
}

/* "expect: reg2 = 0x00, reg3 = 0x1F, reg7 = 0x80, reg8 = 0x60, reg9 = 0x00, reg11 = 0x0C.
 * An emulated board must return exactly these." */
TEST(init_and_detect)
{
    init();
    CHECK_EQ_I64(inb(MM + 2), 0x00);
    CHECK_EQ_I64(inb(MM + 3), 0x1F);
    CHECK_EQ_I64(inb(MM + 7), 0x80);
    CHECK_EQ_I64(inb(MM + 8), 0x60);
    CHECK_EQ_I64(inb(MM + 9), 0x00);
    CHECK_EQ_I64(inb(MM + 11), 0x0C);
}

/* A reset takes time: a write that comes too early has no effect. */
TEST(a_reset_takes_time)
{
    power_on();
    outb(0x20, MM + 8);
    outb(0xFF, MM + 3);
    CHECK_EQ_I64(inb(MM + 3), 0);
    pass_us(1000);
    outb(0xFF, MM + 3);
    CHECK_EQ_I64(inb(MM + 3), 0x1F);
}

/* "1. outb 0x02 -> 7; outb 0 -> 2; outb 21 -> 3; outb 0x28 -> 11 (10 us, +-10 V; 0x38 = 4/5 us);
 * outb 0x04 -> 7; outb 0 -> 9. 2. poll reg 11 bit 7 = 0 (about 10 us)" */
static void set_up_scan(uint32_t range)
{
    init();
    outb(0x02, MM + 7);
    outb(0, MM + 2);
    outb(21, MM + 3);
    outb(range, MM + 11);
    outb(0x04, MM + 7);
    outb(0, MM + 9);
    CHECK(poll(MM + 11, 1, 0x80, 0) > 1, "WAIT");
}

static int16_t sample(void)
{
    const uint32_t lo = inb(MM);
    return (int16_t)(inb(MM + 1) << 8 | lo);
}

/* "3. each tick: outb x -> 0; poll reg 8 bit 7 = 0; 22 times: lo = inb 0, hi = inb 1 (or inw 0).
 * 4. check reg 7: EF must be 1 after 22 reads, OVF 0" */
TEST(a_scan_of_22_channels)
{
    set_up_scan(0x38);
    for (int32_t ch = 0; ch < 32; ch++) {
        box.pins.glove_uV[ch] = emu_ad_uV((int16_t)(ch * 1500 - 16000));
    }
    for (int round = 0; round < 3; round++) {
        outb(0, MM);
        CHECK(inb(MM + 8) & 0x80, "busy");
        CHECK(poll(MM + 8, 1, 0x80, 0) > 1, "the scan ends");
        CHECK_EQ_I64(inb(MM + 6), 11); /* "FIFO depth / 2" */
        for (int ch = 0; ch < 22; ch++) {
            CHECK_EQ_I64(inb(MM + 7) & 0x80, 0);
            CHECK_EQ_I64(round == 2 ? (int16_t)inw(MM) : sample(), ch * 1500 - 16000);
        }
        CHECK_EQ_I64(inb(MM + 7), 0x84);
    }
}

/* "Scan time = 22 x interval: 88 us (4), 110 (5), 220 (10), 330 (15), 440 (20)"; STS "stays 1 for
 * the whole scan" */
TEST(scan_times)
{
    static const uint16_t us[4] = {440, 330, 220, 88};
    for (uint32_t scint = 0; scint < 4; scint++) {
        set_up_scan(0x08 | scint << 4);
        outb(0, MM);
        pass_us(us[scint] - 2u);
        CHECK_EQ_I64(inb(MM + 8) & 0x80, 0x80); /* one microsecond before */
        CHECK_EQ_I64(inb(MM + 8) & 0x80, 0);
    }
    set_up_scan(0x38);
    box.mm.cfg.scan_ns[3] = 5000; /* "4 us expected (250 kS/s) [U]": -AT has 5 */
    outb(0, MM);
    pass_us(108);
    CHECK_EQ_I64(inb(MM + 8) & 0x80, 0x80);
    CHECK_EQ_I64(inb(MM + 8) & 0x80, 0);
}

/* "any value: start conversion (or scan); ignored while busy; disabled while CLKEN=1" */
TEST(a_start_is_ignored_while_busy_and_with_the_clock_on)
{
    set_up_scan(0x38);
    outb(0, MM);
    pass_us(20);
    outb(0, MM);
    pass_us(1000);
    CHECK_EQ_I64(inb(MM + 6), 11);
    outb(0x02, MM + 7);
    outb(0x04, MM + 7);
    outb(0x02, MM + 9);
    outb(0, MM);
    pass_us(1000);
    CHECK_EQ_I64(inb(MM + 7) & 0x80, 0x80);
}

/* When a sample is what it is: a latch at the read, or at the conversion. */
TEST(two_latches)
{
    for (unsigned latch = EMU_LATCH_READ; latch <= EMU_LATCH_CONVERT; latch++) {
        set_up_scan(0x38);
        box.mm.cfg.latch = (uint8_t)latch;
        for (int ch = 0; ch < 22; ch++) { box.pins.glove_uV[ch] = 1000000; }
        outb(0, MM); /* channel i ends 4 (i + 1) us later */
        pass_us(40);
        for (int ch = 0; ch < 22; ch++) { box.pins.glove_uV[ch] = 2000000; }
        pass_us(200);
        for (int ch = 0; ch < 22; ch++) { box.pins.glove_uV[ch] = 3000000; }
        for (int ch = 0; ch < 22; ch++) {
            const int32_t v_uV = latch == EMU_LATCH_READ ? 3000000 : ch < 10 ? 1000000 : 2000000;
            CHECK_EQ_I64(sample(), emu_ad_code(v_uV));
        }
    }
}

/* "low byte must be read before high": the high byte read first is an old one. */
TEST(the_low_byte_moves_the_fifo)
{
    uint32_t hi, lo;
    set_up_scan(0x38);
    for (int ch = 0; ch < 22; ch++) {
        box.pins.glove_uV[ch] = emu_ad_uV((int16_t)(0x100 * ch + 0x40));
    }
    outb(0, MM);
    pass_us(200);
    (void)sample();
    hi = inb(MM + 1);
    lo = inb(MM);
    CHECK_EQ_I64(hi << 8 | lo, 0x0040);
    CHECK_EQ_I64(sample(), 0x0240); /* and that one is lost */
}

/* "empty reads give 0xFF or the last sample (documents differ)" */
TEST(an_empty_fifo)
{
    set_up_scan(0x38);
    CHECK_EQ_I64(sample(), -1);
    box.mm.cfg.empty_last = 1;
    box.pins.glove_uV[21] = emu_ad_uV(777);
    outb(0, MM);
    pass_us(200);
    for (int ch = 0; ch < 22; ch++) { (void)sample(); }
    CHECK_EQ_I64(sample(), 777);
}

/* "FIFO samples: 1024 enhanced, 512 normal"; "[5] FF full [4] OVF"; FIFORST 0x02 */
TEST(the_fifo_overflows)
{
    set_up_scan(0x38);
    for (int scan = 0; scan < 23; scan++) { /* 506 */
        outb(0, MM);
        pass_us(100);
    }
    CHECK_EQ_I64(inb(MM + 7) & 0x30, 0);
    CHECK_EQ_I64(inb(MM + 6), 253);
    outb(0, MM);
    pass_us(100);
    CHECK_EQ_I64(inb(MM + 7) & 0x30, 0x30);
    CHECK_EQ_I64(inb(MM + 5) & 1, 1); /* "[0] = FIFO depth bit 9" */
    CHECK_EQ_I64(inb(MM + 7) & 0x30, 0x20);
    outb(0x02, MM + 7);
    CHECK_EQ_I64(inb(MM + 7), 0x80);
    outb(0x03, MM + 8); /* page 3: "0xA6 enhanced on" */
    outb(0xA6, MM + 15);
    outb(0x04, MM + 7);
    for (int scan = 0; scan < 24; scan++) {
        outb(0, MM);
        pass_us(100);
    }
    CHECK_EQ_I64(inb(MM + 7) & 0x30, 0);
}

/* "FIFO threshold / 2"; "[6] TF at/over threshold" */
TEST(the_threshold)
{
    set_up_scan(0x38);
    outb(11, MM + 6);
    CHECK_EQ_I64(inb(MM + 7) & 0x40, 0);
    outb(0, MM);
    pass_us(100);
    CHECK_EQ_I64(inb(MM + 7) & 0x40, 0x40);
    (void)sample();
    CHECK_EQ_I64(inb(MM + 7) & 0x40, 0);
}

/* "WAIT about 10 us" after a channel or range write; "writing +2 or +11 restarts the 10 us WAIT":
 * what is converted before is the input that was there. */
TEST(an_unsettled_input)
{
    init();
    box.pins.glove_uV[0] = 1000000;
    box.pins.glove_uV[5] = 5000000;
    outb(0x08, MM + 11);
    pass_us(20);
    outb(5, MM + 2);
    CHECK_EQ_I64(inb(MM + 8), 0x65); /* "also sets current channel" */
    outb(0, MM);
    pass_us(20);
    CHECK_EQ_I64(sample(), emu_ad_code(1000000));
    outb(5, MM + 2);
    CHECK(poll(MM + 11, 1, 0x80, 0) > 5, "WAIT");
    outb(0, MM);
    pass_us(20);
    CHECK_EQ_I64(sample(), emu_ad_code(5000000));
}

/* "0 +-5, 1 +-2.5, 2 +-1.25, 3 +-0.625, 8 +-10 V, 9 +-5, 10 +-2.5, 11 +-1.25, 12 0-10, 13 0-5,
 * 14 0-2.5, 15 0-1.25" */
TEST(ranges)
{
    static const struct {
        uint8_t code;
        int32_t fs_uV;
        uint8_t unipolar;
    } row[] = {{0, 5000000, 0}, {1, 2500000, 0}, {2, 1250000, 0}, {3, 625000, 0}, {8, 10000000, 0},
        {9, 5000000, 0}, {10, 2500000, 0}, {11, 1250000, 0}, {12, 10000000, 1}, {13, 5000000, 1},
        {14, 2500000, 1}, {15, 1250000, 1}};
    for (size_t i = 0; i < DIM(row); i++) {
        set_up_scan(0x30u | row[i].code);
        box.pins.glove_uV[0] = row[i].fs_uV / 4;
        box.pins.glove_uV[1] = -row[i].fs_uV / 2;
        outb(0, MM);
        pass_us(200);
        CHECK_EQ_I64(sample(), row[i].unipolar ? -16384 : 8192);
        CHECK_EQ_I64(sample(), row[i].unipolar ? -32768 : -16384);
    }
}

/* "0x56 -> 15, 200 -> 13; 0xB6 -> 15, lo, hi -> 14; outb 0x83 -> 9. Stop: outb 0 -> 9";
 * "2 kHz -> 25"; "one ADINT per finished scan"; ADINT "cleared by INTRST" */
TEST(a_scan_paced_by_the_timer)
{
    set_up_scan(0x38);
    outb(0, MM + 10);
    outb(0, MM + 8);
    outb(0x56, MM + 15);
    outb(200, MM + 13);
    outb(0xB6, MM + 15);
    outb(25, MM + 14);
    outb(0, MM + 14);
    outb(0x83, MM + 9);
    CHECK_EQ_I64(inb(MM + 9), 0x03);
    pass_us(500 + 88);
    CHECK_EQ_I64(inb(MM + 9), 0x83);
    CHECK_EQ_I64(inb(MM + 6), 11);
    outb(0x08, MM + 8);
    CHECK_EQ_I64(inb(MM + 9), 0x03);
    pass_us(10 * 500 - 50);
    outb(0, MM + 9);
    pass_us(5000);
    CHECK_EQ_I64(inb(MM + 6), 11 * 11);
}

/* "wait reg 4 bit 7 = 0; outb code[7:0] -> 4; outb (ch<<6 | code[11:8]) -> 5; wait reg 4 bit 7 = 0
 * (10 us); inb 5 (updates outputs)" */
TEST(the_da)
{
    init();
    for (uint32_t ch = 0; ch < 4; ch++) {
        CHECK_EQ_I64(inb(MM + 4) & 0x80, 0);
        outb(0x21 + ch, MM + 4);
        outb(ch << 6 | 0x7, MM + 5);
        CHECK(poll(MM + 4, 1, 0x80, 0) > 1, "DACBUSY");
        CHECK_EQ_I64(box.mm.da_out[ch], 0);
    }
    (void)inb(MM + 5);
    for (uint32_t ch = 0; ch < 4; ch++) { CHECK_EQ_I64(box.mm.da_out[ch], 0x721 + ch); }
    outb(0x10, MM + 8); /* "RESETD same without D/A" */
    pass_us(1000);
    CHECK_EQ_I64(box.mm.da_out[3], 0x724);
    outb(0x20, MM + 8);
    CHECK_EQ_I64(box.mm.da_out[3], 0);
}

/* "[2:0] page"; "DX says a write of INTRST leaves the page alone; the 2026 Linux fix says 0x08
 * sets page 0"; page 1: "0x9B all inputs" */
TEST(pages)
{
    init();
    outb(1, MM + 8);
    CHECK_EQ_I64(inb(MM + 7) & 3, 1);
    CHECK_EQ_I64(inb(MM + 15), 0x9B);
    outb(0x5A, MM + 12);
    CHECK_EQ_I64(inb(MM + 12), 0x5A);
    outb(0x08, MM + 8);
    CHECK_EQ_I64(inb(MM + 7) & 3, 0);
    box.mm.cfg.intrst_page0 = 0;
    outb(1, MM + 8);
    outb(0x08, MM + 8);
    CHECK_EQ_I64(inb(MM + 7) & 3, 1);
}

/* "writing +11 ... SCINT (enhanced only, else 0)" */
TEST(scint_reads_back_only_in_enhanced_mode)
{
    set_up_scan(0x38);
    CHECK_EQ_I64(inb(MM + 11), 0x08);
    outb(3, MM + 8);
    outb(0xA6, MM + 15);
    CHECK_EQ_I64(inb(MM + 11), 0x38);
    outb(0xA7, MM + 15);
    CHECK_EQ_I64(inb(MM + 11), 0x08);
}

TEST_MAIN("emu/mm32xat", init_and_detect, a_reset_takes_time, a_scan_of_22_channels, scan_times,
    a_start_is_ignored_while_busy_and_with_the_clock_on, two_latches, the_low_byte_moves_the_fifo,
    an_empty_fifo, the_fifo_overflows, the_threshold, an_unsettled_input, ranges,
    a_scan_paced_by_the_timer, the_da, pages, scint_reads_back_only_in_enhanced_mode);
