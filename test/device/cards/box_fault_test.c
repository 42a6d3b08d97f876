/* SPDX-License-Identifier: MIT */
/* The box against a scripted bus: faults, safe outputs from anywhere, opening and its words. */
#include "check.h"
#include "rig.h"

#include "exhand/error.h"

#include <limits.h>

/* ---- faults of a tick -------------------------------------------------------------------- */

/* From every access of a tick on, each card in turn: an error by the end of the next tick, its
 * name, the other board safe. */
TEST(a_board_that_dies_is_found_within_a_tick)
{
    for (unsigned k = 0; k < 2; k++) {
        for (unsigned from = 0; from < 44; from++) {
            int err;
            opened(five());
            CHECK_EQ_I64(put(1), 0);
            bus_clear();
            bus.dead_card = k;
            bus.dead_from = from;
            err = exh_box_read_drive(&in);
            if (err == 0) { err = put(1); }
            if (err == 0) { err = exh_box_read_drive(&in); }
            CHECK_EQ_I64(err, -EXH_E_IO);
            CHECK_EQ_I64(exh_box_error()->card, k);
            CHECK_EQ_I64(exh_box_error()->fault.what, EXH_CARD_EMPTY);
            bus.s526[k].base = 0;
            CHECK(bus_safe(), "the other board is not safe, from %u", from);
        }
    }
}

TEST(a_conversion_that_is_lost_ends_in_time_and_in_safe_outputs)
{
    for (unsigned k = 0; k < 4; k++) {
        opened(five());
        CHECK_EQ_I64(put(1), 0);
        bus.stopped = k & 1;
        bus.s526[k / 2].mute = 4;
        bus_clear();
        bus.time_us = 0;
        CHECK_EQ_I64(exh_box_read_drive(&in), -EXH_E_IO);
        CHECK(bus.n < (k & 1 ? 8200u : 700u), "%u accesses", bus.n);
        fails(-EXH_E_IO, k / 2, EXH_CARD_AD_TIMEOUT);
        CHECK_EQ_I64(exh_box_error()->fault.phase, EXH_CARD_MONITOR);
    }
}

TEST(updates_that_do_not_end_are_a_fault)
{
    int n = 0, err = 0;
    opened(five());
    bus.s526[1].mute = 2;
    for (; n < 10 && err == 0; n++) {
        err = put(1);
        if (err == 0) { err = exh_box_read_drive(&in); }
    }
    CHECK_EQ_I64(n, 4); /* the first after opening has a separate flag */
    fails(err, EXH_BOX_B, EXH_CARD_DA_TIMEOUT);
}

TEST(an_enable_that_does_not_go_off_is_a_fault)
{
    opened(five());
    bus.s526[0].pins_stuck = 0x40;
    CHECK_EQ_I64(put(1), 0); /* all on: not visible */
    CHECK_EQ_I64(exh_box_read_drive(&in), 0);
    exh_box_safe();
    fails(exh_box_read_drive(&in), EXH_BOX_A, EXH_CARD_LINES);
    CHECK_EQ_I64(exh_box_error()->fault.got, 0x40);
}

TEST(illegal_transitions_are_counted_and_too_many_are_a_fault)
{
    struct exh_box_counts n;
    int err = 0, ticks = 0;
    opened(five());
    bus.s526[0].ecap[2] = 1;
    for (int k = 0; k < 20; k++) { CHECK_EQ_I64(exh_box_read_drive(&in), 0); }
    exh_box_counts(&n);
    CHECK_EQ_I64(n.quad[2], 1);
    CHECK_EQ_I64(n.quad[0] + n.quad[1] + n.quad[3] + n.quad[4], 0);
    bus.s526[1].ecap[0] = bus.s526[1].ecap_set[0] = 1;
    while (err == 0 && ticks < 100) {
        err = exh_box_read_drive(&in);
        ticks++;
    }
    CHECK_EQ_I64(ticks, 17);
    fails(err, EXH_BOX_B, EXH_CARD_QUADRATURE);
    exh_box_counts(&n);
    CHECK_EQ_I64(n.quad[4], 17);
}

TEST(every_counter_s_illegal_transitions_are_seen)
{
    struct exh_box_counts n;
    opened(five());
    for (unsigned k = 0; k < EXH_FINGERS; k++) { bus.s526[k / 4].ecap[k % 4] = 1; }
    for (int k = 0; k < 4; k++) { CHECK_EQ_I64(exh_box_read_drive(&in), 0); }
    exh_box_counts(&n);
    for (unsigned k = 0; k < EXH_FINGERS; k++) { CHECK_EQ_I64(n.quad[k], 1); }
}

/* What is found opened anew works again, and starts with nothing counted. */
TEST(opening_anew_ends_a_fault)
{
    struct exh_box_config c = five();
    opened(c);
    bus.s526[0].mute = 4;
    CHECK_EQ_I64(exh_box_read_drive(&in), -EXH_E_IO);
    CHECK_EQ_I64(exh_box_open(&c, NULL), -EXH_E_IO);
    CHECK_EQ_I64(put(1), -EXH_E_IO);
    bus.s526[0].mute = 0;
    CHECK_EQ_I64(exh_box_open(&c, NULL), 0);
    CHECK_EQ_I64(exh_box_error()->code, 0);
    CHECK_EQ_I64(exh_box_read_drive(&in), 0);
    CHECK_EQ_I64(put(1), 0);
    CHECK_EQ_I64(bus.s526[1].da_out[0], 32768 + 500);
}

/* Also what the box before used and this one does not. */
TEST(opening_makes_safe_what_was_used_before)
{
    struct exh_box_config c = one();
    opened(five());
    CHECK_EQ_I64(put(1), 0);
    c.s526_base[0] = 0x280;
    CHECK_EQ_I64(exh_box_open(&c, NULL), 0);
    CHECK(bus_safe(), "board A left on");
}

TEST(what_is_not_certain_can_be_left_out)
{
    struct exh_box_config c = five();
    c.s526.line_check = c.s526.da_check = c.s526.quad_check = 0;
    bus_reset();
    bus.s526[0].pins_stuck = 0x40;
    bus.s526[1].ecap[0] = bus.s526[1].ecap_set[0] = 1;
    CHECK_EQ_I64(exh_box_open(&c, NULL), 0);
    bus.s526[0].mute = 2;
    bus_clear();
    for (int n = 0; n < 100; n++) {
        CHECK_EQ_I64(exh_box_read_drive(&in), 0);
        CHECK_EQ_I64(put(1), 0);
    }
    CHECK_EQ_I64(bus.n, 100 * 42);
}

/* ---- safe ----------------------------------------------------------------------------------- */

TEST(safe_takes_20_accesses_a_board_and_may_be_repeated)
{
    opened(five());
    CHECK_EQ_I64(put(1), 0);
    bus_clear();
    exh_box_safe();
    CHECK_EQ_I64(bus.n, 2 * EXH_S526_SAFE_ACCESSES);
    CHECK(bus.log[0].port == 0x2CA && bus.log[0].value == 0x800 && bus.log[1].port == 0x28A &&
              bus.log[1].value == 0x800,
        "enables not first");
    CHECK(bus_safe(), "outputs on");
    exh_box_safe();
    CHECK(bus_safe(), "outputs on");
    CHECK_EQ_I64(put(1), 0); /* it latches nothing */
    CHECK(!bus_safe(), "outputs off");
}

TEST(safe_touches_no_port_where_no_board_was_found)
{
    struct exh_box_config c = five();
    bus_reset();
    bus.s526[0].base = bus.s526[1].base = 0;
    CHECK_EQ_I64(exh_box_open(&c, &report), -EXH_E_ABSENT);
    bus_clear();
    exh_box_safe();
    CHECK_EQ_I64(bus.n, 0);
    CHECK_EQ_I64(exh_box_read_drive(&in), -EXH_E_IO);
    CHECK_EQ_I64(put(1), -EXH_E_IO);
    CHECK_EQ_I64(bus.n, 0);
}

/* exh_box_safe() is called before every access of a write, a read and an opening. At the end of
 * that call the outputs are safe. After it only a few accesses find unsafe outputs: those of an
 * interrupted write, until it compares safe_calls. */
TEST(safe_may_come_before_any_access)
{
    struct exh_box_config c = five();
    unsigned hot_most = 0;
    for (unsigned k = 0; k < 32; k++) {
        const unsigned at = k % 16, all = k < 16 ? 14 : 13; /* accesses of a write */
        c.s526.turns = (uint8_t)(k / 16);
        opened(c);
        CHECK_EQ_I64(put(-1), 0);
        CHECK_EQ_I64(exh_box_read_drive(&in), 0);
        bus_clear();
        bus.safe_at = at;
        CHECK_EQ_I64(put(1), 0);
        if (bus.safe_at == at) { /* after the last */
            exh_box_safe();
        }
        CHECK(bus_safe(), "outputs on after safe before access %u of a write", at);
        if (at < all) {
            struct exh_box_counts n;
            exh_box_counts(&n);
            CHECK_EQ_I64(n.overtaken, 1);
        }
        if (at < all && bus.hot > hot_most) { hot_most = bus.hot; }
        CHECK_EQ_I64(exh_box_read_drive(&in), 0); /* and no fault of it */
    }
    check_note("an output that safe overtook was on again for %u accesses at the most", hot_most);
    CHECK(hot_most <= 4, "%u", hot_most);
    c.s526.turns = 0;
    for (unsigned at = 0; at < 30; at++) {
        opened(c);
        CHECK_EQ_I64(put(1), 0);
        bus_clear();
        bus.safe_at = at;
        CHECK_EQ_I64(exh_box_read_drive(&in), 0);
        CHECK(bus_safe(), "outputs on after safe before access %u of a read", at);
    }
}

/* ---- opening and its words ------------------------------------------------------------------- */

TEST(all_cards_that_are_absent_are_named)
{
    struct exh_box_config c = gloved(EXH_BOX_LAST);
    c.s526_base[1] = 0x1240;
    bus_reset();
    bus.mm.base = 0;
    CHECK_EQ_I64(exh_box_open(&c, &report), -EXH_E_ABSENT);
    says(&report.error[EXH_BOX_A], "S526 A at 0x02C0: in order");
    says(&report.error[EXH_BOX_B], "S526 B at 0x1240: detect: no answer, all ones");
    says(&report.error[EXH_BOX_GLOVE], "MM-32X-AT at 0x0300: detect: no answer, all ones");
    CHECK_EQ_I64(exh_box_error()->card, EXH_BOX_B);
    CHECK_EQ_I64(report.s526[0].signature, 0x526A);
}

TEST(faults_by_example)
{
    struct exh_box_config c = five();
    bus_reset();
    bus.s526[0].signature = 0x1234;
    CHECK_EQ_I64(exh_box_open(&c, &report), -EXH_E_ABSENT);
    says(exh_box_error(),
        "S526 A at 0x02C0: detect: another card's signature: 0x1234 (0x526A or 0x526B)");
    bus_reset();
    bus_double(&bus.s526[0].ee[16], 1, 3, 0);
    CHECK_EQ_I64(exh_box_open(&c, &report), -EXH_E_IO);
    says(exh_box_error(),
        "S526 A at 0x02C0: EEPROM: D/A gain implausible, 0.001 codes per volt, number 2: "
        "-3000 (3087000 .. 3411000)");
    bus_reset();
    bus.s526[0].mode_stuck = 0x80;
    CHECK_EQ_I64(exh_box_open(&c, &report), -EXH_E_IO);
    says(exh_box_error(),
        "S526 A at 0x02C0: self-test: register does not read back, offset 22: 0x0400 (0x0480)");
}

static void refused(struct exh_box_config c, unsigned row)
{
    bus_reset();
    bus_clear();
    CHECK_EQ_I64(exh_box_open(&c, &report), -EXH_E_RANGE);
    CHECK_EQ_I64(exh_box_error()->fault.what, EXH_CARD_BAD_VALUE);
    CHECK_EQ_I64(exh_box_error()->fault.at, row);
    CHECK_EQ_I64(exh_box_error()->card, EXH_BOX_CARDS);
}

#define REFUSED(row, change) \
    do { \
        struct exh_box_config c = gloved(EXH_BOX_LAST); \
        change; \
        refused(c, row); \
    } while (0)

TEST(configurations_are_refused_by_name)
{
    REFUSED(EXH_BOX_ROW_FINGERS, c.fingers = 0);
    REFUSED(EXH_BOX_ROW_FINGERS, c.fingers = 6);
    REFUSED(EXH_BOX_ROW_MONITOR, c.monitor = 3);
    REFUSED(EXH_BOX_ROW_GLOVE, c.glove = 3);
    REFUSED(EXH_BOX_ROW_SPAN, c.dac_span_raw = 32768);
    REFUSED(EXH_BOX_ROW_BASE_A, c.s526_base[0] = 0x2C2);
    REFUSED(EXH_BOX_ROW_BASE_A, c.s526_base[0] = 0xC0);
    REFUSED(EXH_BOX_ROW_BASE_B, c.s526_base[1] = 0x281);
    REFUSED(EXH_BOX_ROW_BASE_GLOVE, c.mm32xat_base = 0x310);
    REFUSED(EXH_BOX_ROW_OVERLAP, c.s526_base[1] = 0x2C0);
    REFUSED(EXH_BOX_ROW_OVERLAP, c.mm32xat_base = 0x280);
    REFUSED(EXH_BOX_ROW_OVERLAP, c.s526_base[0] = 0x300);
    REFUSED(EXH_BOX_ROW_WAIT, c.s526.ad_wait_us = 0);
    REFUSED(EXH_BOX_ROW_WAIT, c.s526.ee_wait_us = 60001);
    REFUSED(EXH_BOX_ROW_WAIT, c.mm32xat.scan_wait_us = 0);
    REFUSED(EXH_BOX_ROW_WAIT, c.s526.da_wait_us = 0);
    REFUSED(EXH_BOX_ROW_WAIT, c.mm32xat.settle_us = 0);
    REFUSED(EXH_BOX_ROW_WAIT, c.mm32xat.reset_us = 0);
    REFUSED(EXH_BOX_ROW_WAIT, c.mm32xat.set_us = 60001);
    REFUSED(EXH_BOX_ROW_SCAN, c.mm32xat.slice = 33);
    REFUSED(EXH_BOX_ROW_SPAN, c.dac_rest_raw = 12185);
    REFUSED(EXH_BOX_ROW_PINS, c.watchdog = 2);
    REFUSED(EXH_BOX_ROW_FULL, c.full = 2);
    for (unsigned bit = 0; bit < 4; bit++) {
        REFUSED(EXH_BOX_ROW_PINS, c.out_invert[0] = (uint8_t)(1u << bit));
        REFUSED(EXH_BOX_ROW_PINS, c.out_invert[1] = (uint8_t)(1u << bit));
        REFUSED(EXH_BOX_ROW_PINS, c.din_invert[0] = (uint8_t)(0x10u << bit));
        REFUSED(EXH_BOX_ROW_PINS, c.din_invert[1] = (uint8_t)(0x10u << bit));
    }
    REFUSED(EXH_BOX_ROW_SCAN, c.mm32xat.channels = 32);
    REFUSED(EXH_BOX_ROW_SCAN, c.mm32xat.channels = 21);
    REFUSED(EXH_BOX_ROW_SCAN, c.mm32xat.interval = 4);
    REFUSED(EXH_BOX_ROW_SCAN, c.mm32xat.lost_limit = 0);
    CHECK_EQ_I64(bus.n, 0);
    CHECK_EQ_I64(put(1), -EXH_E_IO);
    says(exh_box_error(),
        "box: configuration: channels, interval or lost_limit of the scan: value not allowed: 22");
}

/* With a box wired for five fingers the lines have other meanings. One finger is refused there
 * before any write. It runs if the configuration says that the box is full. */
TEST(one_finger_on_a_full_box_has_to_be_said)
{
    struct exh_box_config c = one();
    struct exh_drive_out out = {{32868, 32868, 32868, 32868, 32868}, 0x1F, 1};
    bus_reset();
    CHECK_EQ_I64(exh_box_open(&c, &report), -EXH_E_RANGE);
    says(exh_box_error(), "box: configuration: full, which is 1 where board B answers: value not "
                          "allowed: 0");
    bus_clear();
    CHECK_EQ_I64(exh_box_open(&c, &report), -EXH_E_RANGE);
    CHECK(bus_said(0, "r 2B4 526B"), "more than one look");
    c.full = 1;
    opened(c);
    CHECK_EQ_I64(exh_box_write_drive(&out), 0);
    CHECK_EQ_I64(bus.s526[0].dio, 0x810); /* finger 0 and no other */
    CHECK_EQ_I64(bus.s526[1].dio, 0x820); /* alive */
    CHECK_EQ_I64(bus.s526[0].da_out[0], 32868);
    CHECK_EQ_I64(bus.s526[0].da_out[1], 32768);
    CHECK_EQ_I64(bus.s526[1].da_out[0], 32768);
    bus.s526[0].pins = 0x0F;
    bus.s526[1].pins = 0x0C; /* drive 4 is not asked; the e-stop is pressed */
    CHECK_EQ_I64(exh_box_read_drive(&in), 0);
    CHECK_EQ_I64(in.din, EXH_DIN_DRIVE0 | EXH_DIN_DEADMAN | EXH_DIN_WATCHDOG | EXH_DIN_CARDS);
    bus_reset();
    bus.s526[1].base = 0;
    CHECK_EQ_I64(exh_box_open(&c, &report), -EXH_E_ABSENT);
    CHECK_EQ_I64(exh_box_error()->card, EXH_BOX_B);
}

/* A scene whose 0 A is another code: nothing of it goes out, whatever its own limits say. */
TEST(a_current_for_a_drive_that_is_off_is_a_fault)
{
    for (unsigned i = 0; i < EXH_FINGERS; i++) {
        struct exh_drive_out out = {{33768, 33768, 31768, 31768, 32768}, 0, 0};
        opened(five());
        CHECK_EQ_I64(exh_box_write_drive(&out), 0);
        out.dac_raw[i] = i & 1 ? 33769 : 31767;
        out.enable = (uint8_t)(1u << i);
        CHECK_EQ_I64(exh_box_write_drive(&out), 0);
        out.enable = (uint8_t)(0x1F ^ out.enable);
        fails(exh_box_write_drive(&out), EXH_BOX_CARDS, EXH_CARD_REST);
        CHECK_EQ_I64(exh_box_error()->fault.at, i);
    }
    says(exh_box_error(),
        "box: configuration: D/A code of a drive that is off is no 0 A, number 4: "
        "31767 (31768 .. 33768)");
}

TEST(every_place_of_the_glove_s_jumpers_is_found)
{
    static const uint16_t base[] = {0x100, 0x140, 0x180, 0x200, 0x280, 0x300, 0x340, 0x380};
    for (unsigned i = 0; i < 8; i++) {
        struct exh_box_config c = gloved(EXH_BOX_NOW);
        c.s526_base[1] = 0xFFC0;
        c.mm32xat_base = base[i];
        bus_reset();
        bus.s526[1].base = c.s526_base[1];
        bus.mm.base = base[i];
        CHECK_EQ_I64(exh_box_open(&c, &report), 0);
    }
}

TEST(what_is_not_used_may_be_anything)
{
    struct exh_box_config c = one();
    int32_t value;
    c.s526_base[1] = 3;
    c.mm32xat_base = 0x2C0;
    c.mm32xat.channels = 0;
    opened(c);
    c.s526_base[1] = 0xC0; /* where no board can be */
    opened(c);
    c = gloved(EXH_BOX_LAST);
    c.fingers = 1;
    c.mm32xat_base = c.s526_base[1];
    CHECK_EQ_I64(exh_box_check(&c, &value), EXH_BOX_ROWS);
    c.full = 1;
    CHECK_EQ_I64(exh_box_check(&c, &value), EXH_BOX_ROW_OVERLAP);
}

/* Alive but no more the card it was: the fault is what was found first. */
TEST(a_card_that_changes_its_name_is_not_dead)
{
    opened(five());
    bus.s526[0].signature = 0x1234;
    bus.s526[0].mute = 4;
    fails(exh_box_read_drive(&in), EXH_BOX_A, EXH_CARD_AD_TIMEOUT);
}

TEST(every_fault_has_its_words)
{
    static const struct {
        struct exh_card_fault fault;
        const char *want;
    } row[] = {
        {{EXH_CARD_SELFTEST, EXH_CARD_COUNTER, 3, 5, 7, 7},
            "?: self-test: counter does not hold what was loaded, number 3: 5 (7)"},
        {{EXH_CARD_EEPROM, EXH_CARD_EE_TIMEOUT, 9, 0, 0, 0},
            "?: EEPROM: word does not come, number 9"},
        {{EXH_CARD_EEPROM, EXH_CARD_DA_OFFSET, 1, 1, -5, 0},
            "?: EEPROM: D/A offset implausible, 0.001 codes, number 1: 1 (-5 .. 0)"},
        {{EXH_CARD_INPUT, EXH_CARD_QUADRATURE, 2, 9, 0, 8},
            "?: inputs: illegal transitions of the encoder lines, number 2: 9 (0 .. 8)"},
        {{EXH_CARD_INPUT, EXH_CARD_LINES, 2, 0x10, 0, 0},
            "?: inputs: digital outputs are not as written: 0x0010 (0x0000)"},
        {{EXH_CARD_CONFIG, EXH_CARD_BAD_VALUE, EXH_BOX_ROWS, 7, 0, 0},
            "?: configuration: value not allowed: 7"},
        {{EXH_CARD_PHASES, EXH_CARD_WHATS, 0, 0, 0, 0}, "?: ?: ?"},
    };
    /* of a card that is none */
    for (unsigned i = 0; i < sizeof row / sizeof row[0]; i++) {
        struct exh_box_error e = {0};
        e.card = EXH_BOX_CARDS + 1;
        e.code = -EXH_E_IO;
        e.fault = row[i].fault;
        says(&e, row[i].want);
    }
}

TEST_MAIN("box fault", a_board_that_dies_is_found_within_a_tick,
    a_conversion_that_is_lost_ends_in_time_and_in_safe_outputs, updates_that_do_not_end_are_a_fault,
    an_enable_that_does_not_go_off_is_a_fault,
    illegal_transitions_are_counted_and_too_many_are_a_fault,
    every_counter_s_illegal_transitions_are_seen, opening_anew_ends_a_fault,
    opening_makes_safe_what_was_used_before, what_is_not_certain_can_be_left_out,
    safe_takes_20_accesses_a_board_and_may_be_repeated,
    safe_touches_no_port_where_no_board_was_found, safe_may_come_before_any_access,
    all_cards_that_are_absent_are_named, faults_by_example, configurations_are_refused_by_name,
    every_place_of_the_glove_s_jumpers_is_found, what_is_not_used_may_be_anything,
    one_finger_on_a_full_box_has_to_be_said, a_current_for_a_drive_that_is_off_is_a_fault,
    a_card_that_changes_its_name_is_not_dead, every_fault_has_its_words);
