/* SPDX-License-Identifier: MIT */
/* A tick with fewer accesses: monitors, high words and quadrature errors in turn, output pins when
 * they change, a glove's scan in parts. What it may not cost: a count, a code, a fault. */
#include "rig.h"

#include "check.h"

static struct exh_box_config turning(unsigned fingers)
{
    struct exh_box_config c = five();
    c.fingers = (uint8_t)fingers;
    c.monitor = EXH_BOX_LAST;
    c.s526.turns = 1;
    return c;
}

/* Conversions ended while the tick computed. */
static void pass(void)
{
    for (unsigned i = 0; i < 2; i++) {
        bus.s526[i].wait = 0;
        bus.s526[i].isr |= 6;
    }
}

TEST(five_fingers_take_17_and_13_accesses)
{
    opened(turning(5));
    bus.s526[0].ad[0] = 77;
    CHECK_EQ_I64(exh_box_read_drive(&in), 0); /* all that the opening began, and counts in full */
    CHECK_EQ_I64(put(1), 0);
    pass();
    bus_clear();
    bus.s526[0].count[1] = 0x1234;
    CHECK_EQ_I64(exh_box_read_drive(&in), 0);
    CHECK(bus_said(0, "r 2D2 0, r 2DA 1234, r 2E2 0, r 2EA 0, r 292 0, r 2CA FF, r 2DC AA00, "
                      "r 28A 3F, r 298 0, r 2CE 6, w 2CE 6, r 2C8 4D, r 28E 6, w 28E 6, r 288 0, "
                      "w 2C6 8043, w 286 8209, "),
        "otherwise");
    CHECK_EQ_I64(in.enc_raw[1], 0x1234);
    CHECK_EQ_I64(in.mon_raw[0], 77);
    bus_clear();
    CHECK_EQ_I64(put(1), 0);
    CHECK_EQ_I64(bus.n, 13); /* board A's pins are as they were */
}

TEST(one_finger_takes_7_and_4)
{
    opened(turning(1));
    for (int n = 0; n < 9; n++) {
        pass();
        bus_clear();
        CHECK_EQ_I64(exh_box_read_drive(&in), 0);
        if (n > 0) { CHECK_EQ_I64(bus.n, 7); }
        CHECK_EQ_I64(put(1), 0);
        if (n > 0) { CHECK_EQ_I64(bus.n, 11); }
    }
}

/* Up and down over the ends of 16 and of 24 bits, by all steps that are unambiguous. */
TEST(counts_are_those_of_24_bits)
{
    static const int32_t step[] = {
        1, -1, 30, -4000, 32767, -32767, 32767, 32767, -32767, -32767, -32767};
    uint32_t count[5] = {0, 0x7FFFFF, 0x800000, 0xFFFFFF, 0x00FFFF};
    opened(turning(5));
    for (unsigned n = 0; n < 20000; n++) {
        for (unsigned i = 0; i < 5; i++) { bus.s526[i / 4].count[i % 4] = count[i]; }
        pass();
        CHECK_EQ_I64(exh_box_read_drive(&in), 0);
        for (unsigned i = 0; i < 5; i++) {
            CHECK_EQ_I64(in.enc_raw[i], count[i]);
            count[i] =
                (count[i] +
                    (uint32_t)step[(n * (i + 1) + n / 97) % (sizeof step / sizeof step[0])]) &
                0xFFFFFF;
        }
        bus_clear();
    }
}

TEST(a_count_that_jumps_is_found_within_two_turns)
{
    for (unsigned axis = 0; axis < 5; axis++) {
        int err = 0, n;
        opened(turning(5));
        CHECK_EQ_I64(exh_box_read_drive(&in), 0);
        bus.s526[axis / 4].count[axis % 4] = 0x20000;
        for (n = 0; n < 2 * 4 && err == 0; n++) {
            pass();
            err = exh_box_read_drive(&in);
        }
        fails(err, axis / 4, EXH_CARD_FOLLOW);
        if (axis == 2) {
            says(exh_box_error(), "S526 A at 0x02C0: inputs: counter jumped by more than 16 bits "
                                  "in a tick, number 2");
        }
    }
}

TEST(every_quadrature_error_is_counted)
{
    struct exh_box_counts n;
    opened(turning(5));
    for (unsigned i = 0; i < 5; i++) { bus.s526[i / 4].ecap[i % 4] = 1; }
    for (unsigned k = 0; k < 9; k++) {
        pass();
        CHECK_EQ_I64(exh_box_read_drive(&in), 0);
    }
    exh_box_counts(&n);
    for (unsigned i = 0; i < 5; i++) { CHECK_EQ_I64(n.quad[i], 1); }
}

/* Each is at most as many ticks old as its board has channels. */
TEST(monitors_are_handed_over_in_turn)
{
    opened(turning(5));
    for (int t = 0; t < 40; t++) {
        for (unsigned i = 0; i < 5; i++) {
            bus.s526[i / 4].ad[i % 4] = (int16_t)(100 * t + (int)i);
        }
        bus.s526[1].ad[4] = (int16_t)(100 * t + 9);
        pass();
        CHECK_EQ_I64(exh_box_read_drive(&in), 0);
        for (unsigned i = 0; i < 5 && t > 4; i++) {
            const int old = t - (in.mon_raw[i] - (int)i) / 100;
            CHECK(old >= 0 && old <= (i < 4 ? 4 : 2) && in.mon_raw[i] % 100 == (int)i, "%u: %d", i,
                in.mon_raw[i]);
        }
        if (t > 4) { CHECK(in.supply_raw >= 100 * (t - 2) + 9, "supply %d", in.supply_raw); }
    }
}

TEST(output_pins_are_written_when_they_change_and_every_16_times)
{
    struct exh_drive_out out = {{32768, 32768, 32768, 32768, 32768}, 0x1F, 0};
    unsigned written = 0;
    opened(turning(5));
    CHECK_EQ_I64(exh_box_write_drive(&out), 0);
    for (int n = 0; n < 160; n++) {
        bus_clear();
        CHECK_EQ_I64(exh_box_write_drive(&out), 0);
        written += bus.n - 12;
    }
    CHECK_EQ_I64(written, 20);
    bus_clear();
    out.enable = 0x1E;
    CHECK_EQ_I64(exh_box_write_drive(&out), 0);
    CHECK_EQ_I64(bus.s526[0].dio & 0xF0, 0xE0);
    exh_box_safe();
    bus_clear();
    CHECK_EQ_I64(exh_box_write_drive(&out), 0); /* safe is left: they are written again */
    CHECK_EQ_I64(bus.s526[0].dio & 0xF0, 0xE0);
}

TEST(pins_that_do_not_follow_are_a_fault_as_ever)
{
    opened(turning(5));
    CHECK_EQ_I64(put(1), 0);
    pass();
    CHECK_EQ_I64(exh_box_read_drive(&in), 0);
    bus.s526[0].dio = 0x800; /* the card forgot */
    pass();
    fails(exh_box_read_drive(&in), EXH_BOX_A, EXH_CARD_LINES);
}

/* ---- the glove's scan, overlapped ----------------------------------------------------------- */

static struct exh_box_config parts(unsigned slice)
{
    struct exh_box_config c = turning(5);
    c.glove = EXH_BOX_LAST;
    c.mm32xat.slice = (uint8_t)slice;
    return c;
}

/* At 10 kHz on the bus's clock, with a frame every 20 ticks: no access waits for a converter.
 * No tick reads more than a slice. Each frame is of one scan. */
static unsigned most_accesses(unsigned slice)
{
    unsigned most = 0, frames = 0;
    opened(parts(slice));
    for (unsigned i = 0; i < 2; i++) {
        bus.s526[i].settle_us = 15;
        bus.s526[i].channel_us = 10;
    }
    bus.mm.sample_us = 10;
    bus.time_us += 100;
    for (unsigned t = 0; t < 2000; t++) {
        const uint32_t from_us = bus.time_us;
        bus_clear();
        if (t % 20 == 0) {
            for (int k = 0; k < 22; k++) { bus.mm.in[k] = (int16_t)(t + (unsigned)k); }
        }
        CHECK_EQ_I64(exh_box_read_drive(&in), 0);
        if (t % 20 == 0) {
            CHECK_EQ_I64(exh_box_read_glove(&glove), 0);
            CHECK_EQ_I64(glove.age_ticks, t ? 20 : UINT16_MAX);
            for (int k = 0; k < 22 && t; k++) { CHECK_EQ_I64(glove.raw[k], (int)t - 20 + k); }
            frames++;
        }
        CHECK_EQ_I64(put(1), 0);
        if (t > 0) { most = bus.n > most ? bus.n : most; }
        CHECK(bus.time_us - from_us == bus.n, "an access waited");
        while (bus.time_us - from_us < 100) { bus.time_us++; }
    }
    CHECK_EQ_I64(bus.mm.scans - 1, frames); /* one more: the self-test's */
    return most;
}

/* docs/CARDS.md */
TEST(the_glove_converts_while_ticks_compute)
{
    CHECK_EQ_I64(most_accesses(4), 40);
    CHECK_EQ_I64(most_accesses(2), 36);
}

TEST(a_scan_in_parts_is_as_sound_as_one_in_a_piece)
{
    struct exh_box_counts n;
    for (unsigned slice = 1; slice <= 32; slice++) {
        opened(parts(slice));
        for (unsigned t = 0; t < 200; t++) {
            pass();
            bus.mm.drop = t >= 50 && t < 100;
            bus.mm.more = t >= 100 && t < 150;
            CHECK_EQ_I64(exh_box_read_drive(&in), 0);
            if (t % 50 == 0) { CHECK_EQ_I64(exh_box_read_glove(&glove), 0); }
        }
        exh_box_counts(&n);
        CHECK_EQ_I64(n.glove_frames, 2);
        CHECK_EQ_I64(n.glove_short, 1);
        CHECK_EQ_I64(n.glove_long, 1);
        CHECK_EQ_I64(n.glove_waits, 0);
    }
}

/* A request before the scan has ended: it gives the last frame again, and the scan goes on. */
TEST(a_scan_in_parts_that_still_runs_is_counted)
{
    struct exh_box_counts n;
    opened(parts(4));
    for (unsigned t = 0; t < 40; t++) {
        pass();
        CHECK_EQ_I64(exh_box_read_drive(&in), 0);
        if (t % 2 == 0) { CHECK_EQ_I64(exh_box_read_glove(&glove), 0); }
    }
    exh_box_counts(&n);
    CHECK(n.glove_waits > 0 && n.glove_frames > 0 && n.glove_waits + n.glove_frames == 19,
        "%" PRIu32 " waits, %" PRIu32 " frames", n.glove_waits, n.glove_frames);
    bus.mm.base = 0;
    for (unsigned k = 0; k < 20 && exh_box_error()->code == 0; k++) {
        pass();
        (void)exh_box_read_drive(&in);
        (void)exh_box_read_glove(&glove);
    }
    CHECK(exh_box_error()->card == EXH_BOX_GLOVE && exh_box_error()->fault.what == EXH_CARD_EMPTY,
        "%s", exh_card_what_text(exh_box_error()->fault.what));
}

/* Without the check of quadrature errors every turn is of the counters. */
TEST(turns_of_counters_alone)
{
    struct exh_box_config c = turning(5);
    struct exh_box_counts n;
    int err = 0;
    c.s526.quad_check = 0;
    opened(c);
    for (unsigned i = 0; i < 5; i++) { bus.s526[i / 4].ecap[i % 4] = 1; }
    for (unsigned k = 0; k < 9; k++) {
        pass();
        CHECK_EQ_I64(exh_box_read_drive(&in), 0);
    }
    exh_box_counts(&n);
    for (unsigned i = 0; i < 5; i++) { CHECK_EQ_I64(n.quad[i], 0); }
    bus.s526[0].count[3] = 0x20000;
    for (unsigned k = 0; k < 8 && err == 0; k++) {
        pass();
        err = exh_box_read_drive(&in);
    }
    fails(err, EXH_BOX_A, EXH_CARD_FOLLOW);
}

TEST_MAIN("turns", five_fingers_take_17_and_13_accesses, one_finger_takes_7_and_4,
    counts_are_those_of_24_bits, a_count_that_jumps_is_found_within_two_turns,
    every_quadrature_error_is_counted, monitors_are_handed_over_in_turn,
    output_pins_are_written_when_they_change_and_every_16_times,
    pins_that_do_not_follow_are_a_fault_as_ever, the_glove_converts_while_ticks_compute,
    a_scan_in_parts_is_as_sound_as_one_in_a_piece, a_scan_in_parts_that_still_runs_is_counted,
    turns_of_counters_alone);
