/* SPDX-License-Identifier: MIT */
/* The bus, its time, and every misbehaviour at the registers: what a driver can see of it. */
#include "rig.h"

static uint32_t isr_after_us(unsigned at, uint32_t us)
{
    pass_us(us);
    return inw(at + 0x0E);
}

static void start_scan(void)
{
    outb(0x02, MM + 7);
    outb(0, MM + 2);
    outb(21, MM + 3);
    outb(0x38, MM + 11);
    outb(0x04, MM + 7);
    outb(0, MM + 9);
    pass_us(20);
    outb(0, MM);
}

/* "0x2F4 reads 0xFFFF (16 bit), 0x300 reads 0xFF" */
TEST(where_no_card_is_all_ones)
{
    struct emu_config c = emu_box_config();
    c.mm.present = 0;
    c.s526[1].base = 0x240;
    emu_box_open(&box, &c);
    for (unsigned port = 0x280; port < 0x2C0; port++) { CHECK_EQ_I64(inw(port), 0xFFFF); }
    for (unsigned port = 0x300; port < 0x310; port++) { CHECK_EQ_I64(inb(port), 0xFF); }
    CHECK_EQ_I64(inw(0x240 + 0x34), 0x526A);
    CHECK_EQ_I64(inw(0x3F8), 0xFFFF);
    outw(0x1234, 0x3F8);
}

/* "base multiple of 0x40", 64 bytes; 16 bytes: no overlap, no gap */
TEST(each_card_has_its_ports)
{
    power_on();
    CHECK_EQ_I64(inw(A + 0x34), 0x526A);
    CHECK_EQ_I64(inw(B + 0x34), 0x526A);
    CHECK_EQ_I64(inb(MM + 8), 0x60);
    CHECK_EQ_I64(inb(MM - 1), 0xFF);
    CHECK_EQ_I64(inb(MM + 16), 0xFF);
    CHECK_EQ_I64(inw(B - 2), 0xFFFF);
}

TEST(accesses_take_time)
{
    struct emu_config c = emu_box_config();
    uint64_t t_ns;
    c.access8_ns = 1300;
    c.access16_ns = 700;
    emu_box_open(&box, &c);
    t_ns = box.time_ns;
    (void)inw(A);
    outw(0, A);
    (void)inb(MM);
    outb(0, MM + 4);
    CHECK_EQ_I64((int64_t)(box.time_ns - t_ns), 2 * 700 + 2 * 1300);
    CHECK_EQ_I64(box.accesses, 4);
    emu_hasten(&box);
    t_ns = box.time_ns;
    outw(0x8000 | 0x20 | 1, A + 0x06);
    CHECK_EQ_I64(inw(A + 0x0E), 4);
    outb(0x04, MM + 7);
    outb(21, MM + 3);
    outb(0, MM);
    CHECK_EQ_I64(inb(MM + 8) & 0x80, 0);
    CHECK_EQ_I64(inb(MM + 6), 11);
    CHECK_EQ_I64((int64_t)(box.time_ns - t_ns), 0);
}

/* "reads 0xFF"; nothing stays driven */
TEST(absent)
{
    struct emu_config c = emu_box_config();
    c.fault = (struct emu_fault){.kind = EMU_ABSENT, .card = EMU_S526_A, .phase = EMU_PHASE_WRITE};
    emu_box_open(&box, &c);
    outw(40000, A + 0x08);
    outw(1, A + 0x04);
    outw(0x0CFF, A + 0x0A);
    CHECK(box.pins.da_uV[0][0] > 0 && box.pins.dout[0] == 0xFF, "driven");
    emu_enter(&box, EMU_PHASE_WRITE);
    CHECK_EQ_I64(inw(A + 0x34), 0xFFFF);
    CHECK(box.pins.da_uV[0][0] == 0 && box.pins.dout[0] == 0, "dark");
    CHECK_EQ_I64(inw(B + 0x34), 0x526A);
    power_on_with(EMU_ABSENT, EMU_MM32XAT, 0);
    for (unsigned i = 0; i < 16; i++) { CHECK_EQ_I64(inb(MM + i), 0xFF); }
    CHECK_EQ_I64(inw(MM), 0xFFFF);
}

/* Phase and access at which it begins: of this card, in this phase; then it stays. */
TEST(a_fault_begins_where_it_is_asked_to)
{
    struct emu_config c = emu_box_config();
    c.fault = (struct emu_fault){
        .kind = EMU_ABSENT, .card = EMU_S526_B, .phase = EMU_PHASE_READ, .after = 2};
    emu_box_open(&box, &c);
    for (int i = 0; i < 5; i++) { CHECK_EQ_I64(inw(B + 0x34), 0x526A); }
    emu_enter(&box, EMU_PHASE_READ);
    CHECK_EQ_I64(inw(B + 0x34), 0x526A);
    for (int i = 0; i < 5; i++) { CHECK_EQ_I64(inw(A + 0x34), 0x526A); }
    emu_enter(&box, EMU_PHASE_WRITE);
    for (int i = 0; i < 5; i++) { CHECK_EQ_I64(inw(B + 0x34), 0x526A); }
    emu_enter(&box, EMU_PHASE_READ);
    CHECK_EQ_I64(inw(B + 0x34), 0x526A);
    CHECK_EQ_I64(inw(B + 0x34), 0xFFFF);
    emu_enter(&box, EMU_PHASE_SAFE);
    CHECK_EQ_I64(inw(B + 0x34), 0xFFFF);
    CHECK_EQ_I64(inw(A + 0x34), 0x526A);
}

TEST(stuck_busy)
{
    power_on_with(EMU_BUSY, EMU_S526_A, 0);
    outw(0x20 | 1, A + 0x06);
    outw(1, A + 0x04);
    outw(5, A + 0x34);
    CHECK_EQ_I64(isr_after_us(A, 100000), 0);
    power_on_with(EMU_BUSY, EMU_MM32XAT, 0);
    start_scan();
    pass_us(100000);
    CHECK_EQ_I64(inb(MM + 8) & 0x80, 0x80);
    CHECK_EQ_I64(inb(MM + 11) & 0x80, 0x80);
    CHECK_EQ_I64(inb(MM + 4) & 0x80, 0x80);
    CHECK_EQ_I64(inb(MM + 7) & 0x80, 0x80);
}

TEST(lost_conversion)
{
    struct emu_config c = emu_box_config();
    power_on_with(EMU_LOST, EMU_S526_B, 0);
    outw(0x20 | 1, B + 0x06);
    CHECK_EQ_I64(isr_after_us(B, 1000), 0);
    outw(0x20 | 1, B + 0x06);
    CHECK_EQ_I64(isr_after_us(B, 1000), 0);
    c.fault = (struct emu_fault){.kind = EMU_LOST, .card = EMU_S526_B, .times = 1};
    emu_box_open(&box, &c);
    outw(0x20 | 1, B + 0x06);
    CHECK_EQ_I64(isr_after_us(B, 1000), 0);
    outw(0x20 | 1, B + 0x06);
    CHECK_EQ_I64(isr_after_us(B, 1000), 4);
    power_on_with(EMU_LOST, EMU_MM32XAT, 0);
    start_scan();
    pass_us(1000);
    for (int i = 0; i < 21; i++) {
        CHECK_EQ_I64(inb(MM + 7) & 0x80, 0);
        (void)inw(MM);
    }
    CHECK_EQ_I64(inb(MM + 7) & 0x80, 0x80);
}

TEST(fifo_overflow)
{
    power_on_with(EMU_OVERFLOW, EMU_MM32XAT, 0);
    start_scan();
    CHECK_EQ_I64(inb(MM + 7) & 0xB0, 0x80);
    pass_us(1000);
    CHECK_EQ_I64(inb(MM + 7) & 0xB0, 0x30);
    CHECK_EQ_I64(inb(MM + 6), 0); /* 512 / 2, without its ninth bit */
}

/* "never interleave two readers of one counter": the high word is another's. */
TEST(somebody_else_reads)
{
    int wrong = 0;
    power_on_with(EMU_READ_ORDER, EMU_S526_A, 0);
    outw(0x0480, A + 0x16);
    for (int i = 0; i < 100; i++) {
        const uint32_t lo = inw(A + 0x12), hi = inw(A + 0x14) & 0xFF;
        wrong += (hi << 16 | lo) != 0;
    }
    CHECK(wrong > 20 && wrong < 80, "%d", wrong);
    power_on_with(EMU_READ_ORDER, EMU_MM32XAT, 0);
    wrong = 0;
    for (int scan = 0; scan < 20; scan++) {
        start_scan();
        pass_us(1000);
        for (int i = 0; i < 22; i++) { (void)inw(MM); }
        wrong += box.mm.popped == -1; /* read beyond the end */
    }
    CHECK(wrong > 5, "%d", wrong);
}

static uint32_t counted(int32_t cnt)
{
    uint32_t lo;
    box.pins.enc_cnt[0][2] = cnt;
    lo = inw(A + 0x22);
    return (inw(A + 0x24) & 0xFF) << 16 | lo;
}

/* With one line alone a quadrature counter steps to and fro. */
TEST(stuck_line)
{
    int moves = 0;
    uint32_t last;
    power_on_with(EMU_LINE_STUCK, EMU_S526_A, 2);
    outw(0x0480, A + 0x26);
    last = counted(0);
    for (int32_t cnt = 1; cnt < 1000; cnt++) {
        const uint32_t now = counted(cnt);
        const uint32_t step = (now - last) & 0xFFFFFF;
        CHECK(step <= 1 || step == 0xFFFFFF, "step %" PRIu32, step);
        moves += step != 0;
        last = now;
    }
    CHECK_EQ_I64(moves, 499); /* line B changes at every second count */
    CHECK(last + 1 <= 2 || last == 0xFFFFFF, "%" PRIu32, last);
}

/* "ECAP quadrature error captured", kept until a 1 is written */
TEST(noisy_line)
{
    int away = 0;
    power_on_with(EMU_LINE_NOISY, EMU_S526_A, 2);
    outw(0x0480, A + 0x26);
    outw(0x8000, A + 0x28);
    for (int i = 0; i < 300; i++) {
        const uint32_t d = (counted(50000) - 50000 + 2) & 0xFFFFFF;
        CHECK(d <= 4, "%" PRIu32, d);
        away += d != 2;
    }
    CHECK(away > 50, "%d", away);
    CHECK_EQ_I64(inw(A + 0x28) & 1, 1);
    CHECK_EQ_I64(inw(A + 0x18) & 1, 0);
}

TEST(da_never_updates)
{
    for (unsigned mute = 0; mute < 2; mute++) {
        power_on_with(mute ? EMU_DA_MUTE : EMU_DA_DEAD, EMU_S526_A, 0);
        outw(0, A + 0x04);
        outw(40000, A + 0x08);
        outw(1, A + 0x04);
        CHECK_EQ_I64(box.pins.da_uV[0][0], 0);
        CHECK_EQ_I64(isr_after_us(A, 1000) & 2, mute ? 2 : 0);
    }
}

TEST(eeprom_garbage)
{
    int good = 0;
    power_on_with(EMU_EEPROM, EMU_S526_A, 0);
    for (unsigned i = 0; i < 64; i++) {
        outw(i << 3 | 5, A + 0x34);
        CHECK_EQ_I64(isr_after_us(A, 100) & 0x80, 0x80);
        outw(0x80, A + 0x0E);
        good += inw(A + 0x32) == box.s526[0].cfg.eeprom[i];
    }
    CHECK(good < 4, "%d", good);
}

TEST(words_for_people)
{
    for (unsigned i = 0; i < EMU_KINDS; i++) {
        CHECK(!check_same_text(emu_kind_text(i), "?"), "%u", i);
    }
    for (unsigned i = 0; i < EMU_PHASES; i++) {
        CHECK(!check_same_text(emu_phase_text(i), "?"), "%u", i);
    }
    CHECK(check_same_text(emu_kind_text(EMU_KINDS), "?"), "beyond");
    CHECK(check_same_text(emu_phase_text(EMU_PHASES), "?"), "beyond");
}

TEST_MAIN("emu/box", where_no_card_is_all_ones, each_card_has_its_ports, accesses_take_time, absent,
    a_fault_begins_where_it_is_asked_to, stuck_busy, lost_conversion, fifo_overflow,
    somebody_else_reads, stuck_line, noisy_line, da_never_updates, eeprom_garbage,
    words_for_people);
