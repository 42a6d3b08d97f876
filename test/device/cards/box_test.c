/* SPDX-License-Identifier: MIT */
/* The box against a scripted bus: accesses of a tick, wiring, the glove. */
#include "check.h"
#include "rig.h"

#include "exhand/error.h"

/* ---- accesses of a tick ------------------------------------------------------------- */

/* The published figures; docs/CARDS.md has the same. */
TEST(five_fingers_take_30_and_14_accesses)
{
    opened(five());
    bus.s526[0].count[1] = 0x123456;
    bus.s526[1].ad[4] = 9000;
    CHECK_EQ_I64(exh_box_read_drive(&in), 0);
    CHECK(bus_said(0,
              "w 2C6 81E1, w 286 8221, r 2D2 0, r 2D4 AA00, r 2DA 3456, r 2DC AA12, "
              "r 2E2 0, r 2E4 AA00, r 2EA 0, r 2EC AA00, r 292 0, r 294 AA00, "
              "r 2CA F, r 2D8 0, r 28A F, r 298 0, "
              "r 2CE 6, w 2CE 6, r 2C8 0, w 2C6 2, r 2C8 0, w 2C6 4, r 2C8 0, w 2C6 6, r 2C8 0, "
              "r 28E 6, w 28E 6, r 288 0, w 286 8, r 288 2328"),
        "otherwise");
    CHECK_EQ_I64(bus.n, 30);
    CHECK_EQ_I64(in.enc_raw[1], 0x123456);
    CHECK_EQ_I64(in.supply_raw, 9000);
    bus_clear();
    CHECK_EQ_I64(put(1), 0);
    CHECK(bus_said(0, "w 2C4 0, w 2C8 8064, w 2C4 2, w 2C8 80C8, w 2C4 4, w 2C8 812C, w 2C4 6, "
                      "w 2C8 8190, w 284 0, w 288 81F4, w 2C4 1, w 284 1, w 2CA 8F0, w 28A 830"),
        "otherwise");
    CHECK_EQ_I64(bus.n, 14);
}

TEST(one_finger_takes_10_and_4_of_one_board)
{
    opened(one());
    CHECK_EQ_I64(report.used[EXH_BOX_B] + report.used[EXH_BOX_GLOVE], 0);
    bus.s526[0].ad[0] = -5;
    bus.s526[0].ad[4] = 9000;
    CHECK_EQ_I64(exh_box_read_drive(&in), 0);
    CHECK(bus_said(0, "w 2C6 8221, r 2D2 0, r 2D4 AA00, r 2CA F, r 2D8 0, r 2CE 6, w 2CE 6, "
                      "r 2C8 FFFB, w 2C6 8, r 2C8 2328"),
        "otherwise");
    CHECK_EQ_I64(in.mon_raw[0], -5);
    CHECK_EQ_I64(in.supply_raw, 9000);
    bus_clear();
    CHECK_EQ_I64(put(1), 0);
    CHECK(bus_said(0, "w 2C4 0, w 2C8 8064, w 2C4 1, w 2CA 830"), "otherwise");
}

/* With monitors of the tick before there is nothing to wait for. */
TEST(monitors_of_the_last_tick_take_no_wait)
{
    struct exh_box_config c = five();
    c.monitor = EXH_BOX_LAST;
    opened(c);
    bus.s526[0].late = bus.s526[1].late = 3;
    for (int16_t n = 0; n < 5; n++) {
        bus.s526[0].ad[2] = (int16_t)(1000 + n);
        CHECK_EQ_I64(exh_box_read_drive(&in), 0);
        CHECK_EQ_I64(in.mon_raw[2], n > 0 ? 1000 + n - 1 : 0); /* 0: of the opening */
        CHECK_EQ_I64(bus.n, 30);
        bus.s526[0].wait = bus.s526[1].wait = 0; /* the rest of the tick is long enough */
        bus.s526[0].isr |= 4;
        bus.s526[1].isr |= 4;
        bus_clear();
    }
    CHECK(bus_safe(), "no output was written");
}

TEST(monitors_in_the_tick_are_that_tick_s)
{
    opened(five());
    bus.s526[0].late = bus.s526[1].late = 4;
    for (int16_t n = 0; n < 5; n++) {
        bus_clear();
        bus.s526[0].ad[2] = (int16_t)(1000 + n);
        CHECK_EQ_I64(exh_box_read_drive(&in), 0);
        CHECK_EQ_I64(in.mon_raw[2], 1000 + n);
        CHECK_EQ_I64(bus.n, 36); /* three polls more a board */
    }
}

TEST(without_monitors_a_board_is_asked_for_its_name)
{
    struct exh_box_config c = five();
    c.monitor = EXH_BOX_NEVER;
    c.s526.quad_check = 0;
    opened(c);
    CHECK_EQ_I64(exh_box_read_drive(&in), 0);
    CHECK_EQ_I64(bus.n, 14); /* 10 of counters, 2 of lines, 2 of signatures */
    bus.s526[1].base = 0;
    fails(exh_box_read_drive(&in), EXH_BOX_B, EXH_CARD_EMPTY);
}

/* What the cards ask of a tick, at 1 us an access, 15 us of settling and 10 us a channel, glove
 * samples 10 us apart: the table of docs/CARDS.md. Ticks follow each other without a pause or
 * every period_us. */
struct figure {
    uint8_t fingers, monitor, glove;
    uint16_t period_us, accesses, time_us; /* the most a tick took */
};

static void figure(const struct figure *want)
{
    struct exh_box_config c = five();
    unsigned accesses = 0, time_us = 0;
    c.fingers = want->fingers;
    c.monitor = want->monitor;
    c.glove = want->glove;
    opened(c);
    for (unsigned i = 0; i < 2; i++) {
        bus.s526[i].settle_us = 15;
        bus.s526[i].channel_us = 10;
    }
    bus.mm.sample_us = 10;
    for (int n = 0; n < 50; n++) {
        const uint32_t from_us = bus.time_us;
        bus_clear();
        CHECK_EQ_I64(exh_box_read_drive(&in), 0);
        if (c.glove) { CHECK_EQ_I64(exh_box_read_glove(&glove), 0); }
        CHECK_EQ_I64(put(1), 0);
        accesses = bus.n > accesses ? bus.n : accesses;
        time_us = bus.time_us - from_us > time_us ? bus.time_us - from_us : time_us;
        while (bus.time_us - from_us < want->period_us) { bus.time_us++; }
    }
    CHECK(accesses == want->accesses && time_us == want->time_us,
        "%u fingers, monitors %u, glove %u: %u accesses, %u us", c.fingers, c.monitor, c.glove,
        accesses, time_us);
}

TEST(figures_of_a_tick)
{
    static const struct figure figures[] = {
        {1, EXH_BOX_NEVER, EXH_BOX_NEVER, 50, 9, 9},
        {1, EXH_BOX_NOW, EXH_BOX_NEVER, 50, 44, 44},
        {1, EXH_BOX_LAST, EXH_BOX_NEVER, 50, 14, 14},
        {5, EXH_BOX_NEVER, EXH_BOX_NEVER, 100, 30, 30},
        {5, EXH_BOX_NOW, EXH_BOX_NEVER, 100, 83, 83},
        {5, EXH_BOX_LAST, EXH_BOX_NEVER, 100, 44, 44},
        {5, EXH_BOX_NOW, EXH_BOX_LAST, 500, 132, 132},
        {5, EXH_BOX_LAST, EXH_BOX_LAST, 500, 93, 93},
        {5, EXH_BOX_NOW, EXH_BOX_NOW, 500, 351, 351},
    };
    for (unsigned i = 0; i < sizeof figures / sizeof figures[0]; i++) { figure(&figures[i]); }
}

/* ---- wiring --------------------------------------------------------------------------- */

TEST(every_finger_has_its_counter_monitor_and_output)
{
    opened(five());
    for (unsigned i = 0; i < EXH_FINGERS; i++) {
        bus.s526[i / 4].count[i % 4] = 0xFF0000 + i;
        bus.s526[i / 4].ad[i % 4] = (int16_t)(-100 * (int)i);
    }
    CHECK_EQ_I64(exh_box_read_drive(&in), 0);
    CHECK_EQ_I64(put(-1), 0);
    for (int i = 0; i < EXH_FINGERS; i++) {
        CHECK_EQ_I64(in.enc_raw[i], 0xFF0000 + i);
        CHECK_EQ_I64(in.mon_raw[i], -100 * i);
        CHECK_EQ_I64(bus.s526[i / 4].da_out[i % 4], 32768 - 100 * (i + 1));
    }
}

/* Two to four fingers: B has none, but the supply, the stop and the dead-man. */
TEST(a_board_without_a_finger_has_the_rest)
{
    for (uint8_t fingers = 2; fingers < 5; fingers++) {
        struct exh_box_config c = five();
        c.fingers = fingers;
        opened(c);
        bus.s526[1].ad[4] = 4321;
        bus.s526[1].pins = 0xE;
        CHECK_EQ_I64(exh_box_read_drive(&in), 0);
        CHECK_EQ_I64(bus.n, 9 + 4 * fingers); /* B: start, pins, flags and their end, result */
        CHECK_EQ_I64(in.supply_raw, 4321);
        CHECK_EQ_I64(in.din, EXH_DIN_ESTOP | EXH_DIN_DEADMAN | EXH_DIN_WATCHDOG | EXH_DIN_CARDS |
                                 ((1u << fingers) - 1) * EXH_DIN_DRIVE0);
        bus_clear();
        CHECK_EQ_I64(put(1), 0);
        CHECK_EQ_I64(bus.n, 2 * fingers + 3); /* no update of B */
        c.supply = 0;
        opened(c);
        CHECK_EQ_I64(exh_box_read_drive(&in), 0);
        CHECK_EQ_I64(in.supply_raw, 0);
        bus.s526[1].base = 0;
        fails(exh_box_read_drive(&in), EXH_BOX_B, EXH_CARD_EMPTY);
    }
}

/* Of every frame that is handed over. */
#define CARDS ((uint32_t)EXH_DIN_CARDS)

static uint32_t din_of(unsigned pins_a, unsigned pins_b)
{
    bus.s526[0].pins = (uint8_t)pins_a;
    bus.s526[1].pins = (uint8_t)pins_b;
    CHECK_EQ_I64(exh_box_read_drive(&in), 0);
    return in.din;
}

TEST(every_input_pin_has_its_meaning)
{
    struct exh_box_config c = five();
    opened(c);
    for (unsigned k = 0; k < 4; k++) {
        CHECK_EQ_I64(din_of(1u << k, 0), CARDS | (uint32_t)EXH_DIN_DRIVE0 << k);
    }
    CHECK_EQ_I64(din_of(0, 1), CARDS | (EXH_DIN_DRIVE0 << 4));
    CHECK_EQ_I64(din_of(0, 2), CARDS | EXH_DIN_ESTOP);
    CHECK_EQ_I64(din_of(0, 4), CARDS | EXH_DIN_DEADMAN);
    CHECK_EQ_I64(din_of(0, 8), CARDS | EXH_DIN_WATCHDOG);
    c.din_invert[0] = 0x0F;
    c.din_invert[1] = 0x01;
    opened(c);
    CHECK_EQ_I64(din_of(0, 0x6), CARDS | EXH_DIN_ESTOP | EXH_DIN_DEADMAN | EXH_DIN_DRIVE0 * 0x1F);
    c.watchdog = 0; /* no such contact: the pin means nothing */
    opened(c);
    CHECK_EQ_I64(din_of(0, 0x1), CARDS | EXH_DIN_WATCHDOG | EXH_DIN_DRIVE0 * 0xF);
    CHECK_EQ_I64(din_of(0, 0x9), CARDS | EXH_DIN_WATCHDOG | EXH_DIN_DRIVE0 * 0xF);
    opened(one());
    CHECK_EQ_I64(din_of(1, 0), CARDS | EXH_DIN_DRIVE0);
    CHECK_EQ_I64(din_of(2, 0), CARDS | EXH_DIN_ESTOP);
    CHECK_EQ_I64(din_of(4, 0), CARDS | EXH_DIN_DEADMAN);
    CHECK_EQ_I64(din_of(8, 0), CARDS | EXH_DIN_WATCHDOG);
}

static void lines_are(unsigned enable, unsigned alive_now, unsigned a, unsigned b)
{
    struct exh_drive_out out = {
        {32768, 32768, 32768, 32768, 32768}, (uint8_t)enable, (uint8_t)alive_now};
    CHECK_EQ_I64(exh_box_write_drive(&out), 0);
    CHECK_EQ_I64(bus.s526[0].dio, 0x800 | a);
    CHECK_EQ_I64(bus.s526[1].dio, 0x800 | b);
}

TEST(every_output_pin_has_its_meaning)
{
    struct exh_box_config c = five();
    opened(c);
    for (unsigned k = 0; k < 4; k++) { lines_are(1u << k, 0, 0x10u << k, 0); }
    lines_are(0x10, 0, 0, 0x10);
    lines_are(0, 1, 0, 0x20);
    lines_are(0xFF, 0xFF, 0xF0, 0x30);
    lines_are(0, 2, 0, 0);
    c.out_invert[0] = 0xF0;
    opened(c);
    CHECK_EQ_I64(bus.s526[0].dio, 0x8F0); /* off */
    lines_are(5, 0, 0xA0, 0);
    exh_box_safe();
    CHECK_EQ_I64(bus.s526[0].dio, 0x8F0);
    opened(one());
    bus.s526[1].dio = 0x800;
    lines_are(1, 1, 0x30, 0);
    lines_are(2, 0, 0, 0);
}

/* All outputs change at one write a board, and not before. */
TEST(codes_are_applied_together)
{
    opened(five());
    bus.s526[0].updates = bus.s526[1].updates = 0;
    CHECK_EQ_I64(put(1), 0);
    CHECK_EQ_I64(bus.s526[0].updates, 1);
    CHECK_EQ_I64(bus.s526[1].updates, 1);
    for (unsigned n = 0; n < 10; n++) {
        CHECK_EQ_I64(bus.log[n].value & 1 && bus.log[n].port == 0x2C4, 0);
    }
}

TEST(codes_beyond_the_drive_s_range_are_clamped_and_counted)
{
    struct exh_drive_out out = {{0, 65535, 32768 - 12184, 32768 + 12185, 32768}, 0x1F, 0};
    struct exh_box_counts n;
    opened(five());
    CHECK_EQ_I64(exh_box_write_drive(&out), 0);
    CHECK_EQ_I64(bus.s526[0].da_out[0], 32768 - 12184);
    CHECK_EQ_I64(bus.s526[0].da_out[1], 32768 + 12184);
    CHECK_EQ_I64(bus.s526[0].da_out[2], 32768 - 12184);
    CHECK_EQ_I64(bus.s526[0].da_out[3], 32768 + 12184);
    exh_box_counts(&n);
    CHECK_EQ_I64(n.clamped, 3);
}

/* ---- glove ------------------------------------------------------------------------------------
 */

static void tick(int16_t codes)
{
    for (int k = 0; k < 22; k++) { bus.mm.in[k] = (int16_t)(codes + k); }
    CHECK_EQ_I64(exh_box_read_drive(&in), 0);
    bus_clear();
    CHECK_EQ_I64(exh_box_read_glove(&glove), 0);
}

TEST(a_scan_in_the_tick_is_that_tick_s)
{
    opened(gloved(EXH_BOX_NOW));
    for (int16_t n = 0; n < 4; n++) {
        tick((int16_t)(100 * n));
        CHECK_EQ_I64(glove.raw[21], 100 * n + 21);
        CHECK_EQ_I64(glove.age_ticks, 0);
        CHECK_EQ_I64(bus.n, 53); /* 4 polls more than the last */
    }
}

/* With a scan of the tick before, of the opening at first; that one is over. */
static void opened_with_scan(void)
{
    opened(gloved(EXH_BOX_LAST));
    bus.mm.busy = 0;
}

TEST(a_scan_of_the_tick_before_takes_no_wait)
{
    opened_with_scan();
    for (int16_t n = 0; n < 4; n++) {
        tick((int16_t)(100 * n));
        CHECK_EQ_I64(glove.raw[21], n ? 100 * (n - 1) + 21 : 0);
        CHECK_EQ_I64(glove.age_ticks, 1);
        CHECK_EQ_I64(bus.n, 49);
        bus.mm.busy = 0; /* the rest of the tick is long enough */
    }
}

/* The first one, too: there is no frame yet. */
TEST(a_scan_of_the_opening_that_still_runs_is_no_frame)
{
    opened(gloved(EXH_BOX_LAST));
    bus.mm.busy = 2;
    tick(100);
    CHECK_EQ_I64(bus.n, 1);
    CHECK_EQ_I64(glove.raw[0], 0);
    CHECK_EQ_I64(glove.age_ticks, UINT16_MAX);
    tick(200);
    CHECK_EQ_I64(glove.age_ticks, 2);
}

/* Faster ticks than scans: the last frame again, older each time, for one access. */
TEST(a_scan_that_still_runs_is_not_waited_for)
{
    struct exh_box_counts n;
    opened_with_scan();
    tick(50);
    bus.mm.busy = 4;
    for (unsigned k = 2; k < 5; k++) {
        tick(100);
        CHECK_EQ_I64(bus.n, 1);
        CHECK_EQ_I64(glove.raw[0], 0);
        CHECK_EQ_I64(glove.age_ticks, k);
    }
    tick(200);
    CHECK_EQ_I64(glove.raw[0], 50);   /* of the first tick: the scan began there, */
    CHECK_EQ_I64(glove.age_ticks, 4); /* and is 4 ticks old */
    exh_box_counts(&n);
    CHECK_EQ_I64(n.glove_waits, 3);
    CHECK_EQ_I64(n.glove_frames, 2);
}

TEST(a_scan_that_is_lost_leaves_the_last_frame_older)
{
    struct exh_box_counts n;
    opened_with_scan();
    tick(50);
    bus.mm.busy = 0;
    bus.mm.samples--;
    tick(100);
    CHECK_EQ_I64(glove.raw[21], 0);
    CHECK_EQ_I64(glove.age_ticks, 2);
    bus.mm.busy = 0;
    tick(200);
    CHECK_EQ_I64(glove.raw[21], 121);
    CHECK_EQ_I64(glove.age_ticks, 1);
    exh_box_counts(&n);
    CHECK_EQ_I64(n.glove_short, 1);
    CHECK_EQ_I64(n.glove_frames, 2);
}

TEST(a_glove_that_fails_makes_the_drives_safe)
{
    opened(gloved(EXH_BOX_NOW));
    CHECK_EQ_I64(exh_box_read_drive(&in), 0);
    CHECK_EQ_I64(put(1), 0);
    bus.mm.stuck = 1;
    fails(exh_box_read_glove(&glove), EXH_BOX_GLOVE, EXH_CARD_SCAN_TIMEOUT);
    opened(five());
    CHECK_EQ_I64(exh_box_read_glove(&glove), -EXH_E_ABSENT);
    CHECK_EQ_I64(bus.n, 0);
}

/* The first of all: nothing was ever opened. */
TEST(before_the_opening_there_is_nothing)
{
    struct exh_box_counts n;
    bus_reset();
    bus_clear();
    memset(&n, 0xFF, sizeof n);
    exh_box_counts(&n);
    for (unsigned i = 0; i < EXH_FINGERS; i++) { CHECK_EQ_I64(n.quad[i], 0); }
    CHECK_EQ_I64(exh_box_read_drive(&in), -EXH_E_ABSENT);
    CHECK_EQ_I64(put(1), -EXH_E_ABSENT);
    CHECK_EQ_I64(exh_box_read_glove(&glove), -EXH_E_ABSENT);
    CHECK_EQ_I64(bus.n, 0);
}

TEST(scans_lost_in_a_row_make_the_drives_safe)
{
    int err = 0;
    opened(gloved(EXH_BOX_NOW));
    CHECK_EQ_I64(put(1), 0);
    bus.mm.drop = 1;
    for (unsigned t = 0; t < 3; t++) {
        CHECK_EQ_I64(err, 0);
        CHECK_EQ_I64(exh_box_read_drive(&in), 0);
        err = exh_box_read_glove(&glove);
    }
    fails(err, EXH_BOX_GLOVE, EXH_CARD_SCAN_LOST);
    CHECK_EQ_I64(exh_box_read_glove(&glove), -EXH_E_IO);
}

TEST_MAIN("box", before_the_opening_there_is_nothing, five_fingers_take_30_and_14_accesses,
    one_finger_takes_10_and_4_of_one_board, monitors_of_the_last_tick_take_no_wait,
    monitors_in_the_tick_are_that_tick_s, without_monitors_a_board_is_asked_for_its_name,
    figures_of_a_tick, every_finger_has_its_counter_monitor_and_output,
    a_board_without_a_finger_has_the_rest, every_input_pin_has_its_meaning,
    every_output_pin_has_its_meaning, codes_are_applied_together,
    codes_beyond_the_drive_s_range_are_clamped_and_counted, a_scan_in_the_tick_is_that_tick_s,
    a_scan_of_the_tick_before_takes_no_wait, a_scan_of_the_opening_that_still_runs_is_no_frame,
    a_scan_that_still_runs_is_not_waited_for, a_scan_that_is_lost_leaves_the_last_frame_older,
    a_glove_that_fails_makes_the_drives_safe, scans_lost_in_a_row_make_the_drives_safe);
