/* The box against a scripted bus: wiring, accesses of a tick, faults, safe outputs from anywhere. */
#include "bus.h"
#include "check.h"

#include "cards/box.h"

#include "exhand/error.h"

#include <limits.h>

static struct exh_box_report report;
static struct exh_drive_in in;
static struct exh_glove_in glove;
static uint8_t alive;

static struct exh_box_config five(void)
{
    return exh_box_default;
}

static struct exh_box_config one(void)
{
    struct exh_box_config c = exh_box_default;
    c.fingers = 1;
    return c;
}

static void opened(struct exh_box_config c)
{
    bus_reset();
    alive = 0;
    CHECK_EQ_I64(exh_box_open(&c, &report), 0);
    bus_clear();
}

/* D/A codes 100 (i + 1) above 0, all enabled. */
static int put(int sign)
{
    struct exh_drive_out out = {{0}, 0x1F, ++alive};
    for (int i = 0; i < EXH_FINGERS; i++) {
        out.dac_raw[i] = (uint16_t)(32768 + sign * 100 * (i + 1));
    }
    return exh_box_write_drive(&out);
}

static void fails(int err, unsigned card_no, unsigned what)
{
    const struct exh_box_error *e = exh_box_error();
    CHECK_EQ_I64(err, -EXH_E_IO);
    CHECK(e->code == -EXH_E_IO && e->card == card_no && e->fault.what == what, "%d: %s: %s",
          e->code, exh_box_card_text(e->card), exh_card_what_text(e->fault.what));
    CHECK(bus_safe() || bus.dead_card == card_no, "outputs left on");
    CHECK_EQ_I64(put(1), -EXH_E_IO);
    CHECK_EQ_I64(exh_box_read_drive(&in), -EXH_E_IO);
    CHECK(bus_safe() || bus.dead_card == card_no, "outputs on again");
}

/* ---- accesses of a tick ------------------------------------------------------------- */

/* The published figures; docs/CARDS.md has the same. */
TEST(five_fingers_take_30_and_14_accesses)
{
    opened(five());
    bus.s526[0].count[1] = 0x123456;
    bus.s526[1].ad[4] = 9000;
    CHECK_EQ_I64(exh_box_read_drive(&in), 0);
    CHECK(bus_said(
              0, "w 2C6 81E1, w 286 8221, r 2D2 0, r 2D4 AA00, r 2DA 3456, r 2DC AA12, "
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
        CHECK_EQ_I64(in.mon_raw[2], 1000 + (n > 0 ? n - 1 : 0));
        bus.s526[0].wait = bus.s526[1].wait = 0; /* the rest of the tick is long enough */
        bus.s526[0].isr |= 4;
        bus.s526[1].isr |= 4;
        if (n > 0) { CHECK_EQ_I64(bus.n, 30); }
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
        if (n >= 10) { /* the first waits for what it starts, and holds up those behind it */
            accesses = bus.n > accesses ? bus.n : accesses;
            time_us = bus.time_us - from_us > time_us ? bus.time_us - from_us : time_us;
        }
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
        bus.s526[1].pins = 6;
        CHECK_EQ_I64(exh_box_read_drive(&in), 0);
        CHECK_EQ_I64(bus.n, 9 + 4 * fingers); /* B: start, pins, flags and their end, result */
        CHECK_EQ_I64(in.supply_raw, 4321);
        CHECK_EQ_I64(in.din,
                     EXH_DIN_ESTOP | EXH_DIN_DEADMAN | ((1u << fingers) - 1) * EXH_DIN_DRIVE0);
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
        CHECK_EQ_I64(din_of(1u << k, 0), (uint32_t)EXH_DIN_DRIVE0 << k);
    }
    CHECK_EQ_I64(din_of(0, 1), EXH_DIN_DRIVE0 << 4);
    CHECK_EQ_I64(din_of(0, 2), EXH_DIN_ESTOP);
    CHECK_EQ_I64(din_of(0, 4), EXH_DIN_DEADMAN);
    CHECK_EQ_I64(din_of(0, 8), 0);
    c.din_invert[0] = 0x0F;
    c.din_invert[1] = 0x01;
    opened(c);
    CHECK_EQ_I64(din_of(0, 0x6), EXH_DIN_ESTOP | EXH_DIN_DEADMAN | EXH_DIN_DRIVE0 * 0x1F);
    opened(one());
    CHECK_EQ_I64(din_of(1, 0), EXH_DIN_DRIVE0);
    CHECK_EQ_I64(din_of(2, 0), EXH_DIN_ESTOP);
    CHECK_EQ_I64(din_of(4, 0), EXH_DIN_DEADMAN);
    CHECK_EQ_I64(din_of(8, 0), 0);
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
    struct exh_drive_out out = {{0, 65535, 32768 - 12184, 32768 + 12185, 32768}, 0, 0};
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
    CHECK_EQ_I64(n, 4); /* the first after opening has a flag of its own */
    fails(err, EXH_BOX_B, EXH_CARD_DA_TIMEOUT);
}

TEST(an_enable_that_does_not_go_off_is_a_fault)
{
    opened(five());
    bus.s526[0].pins_stuck = 0x40;
    CHECK_EQ_I64(put(1), 0); /* all on: nobody can tell */
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

/* Before every access of a write, a read, an opening: at the end of that call outputs are safe,
 * and after it no access but a few finds one that is not: those of a write that was overtaken,
 * until it has seen that. */
TEST(safe_may_come_before_any_access)
{
    struct exh_box_config c = five();
    unsigned hot_most = 0;
    for (unsigned at = 0; at < 16; at++) {
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
        if (at < 14 && bus.hot > hot_most) { hot_most = bus.hot; }
        CHECK_EQ_I64(exh_box_read_drive(&in), 0); /* and no fault of it */
    }
    check_note("an output that safe overtook was on again for %u accesses at the most", hot_most);
    CHECK(hot_most <= 4, "%u", hot_most);
    for (unsigned at = 0; at < 30; at++) {
        opened(c);
        CHECK_EQ_I64(put(1), 0);
        bus_clear();
        bus.safe_at = at;
        CHECK_EQ_I64(exh_box_read_drive(&in), 0);
        CHECK(bus_safe(), "outputs on after safe before access %u of a read", at);
    }
}

/* ---- glove ------------------------------------------------------------------------------------ */

static struct exh_box_config gloved(unsigned when)
{
    struct exh_box_config c = five();
    c.glove = (uint8_t)when;
    return c;
}

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

TEST(a_scan_of_the_tick_before_takes_no_wait)
{
    opened(gloved(EXH_BOX_LAST));
    for (int16_t n = 0; n < 4; n++) {
        tick((int16_t)(100 * n));
        CHECK_EQ_I64(glove.raw[21], 100 * (n ? n - 1 : 0) + 21);
        CHECK_EQ_I64(glove.age_ticks, n ? 1 : 0);
        if (n) { CHECK_EQ_I64(bus.n, 49); }
        bus.mm.busy = 0; /* the rest of the tick is long enough */
    }
}

/* Faster ticks than scans: the last frame again, older each time, for one access. */
TEST(a_scan_that_still_runs_is_not_waited_for)
{
    struct exh_box_counts n;
    opened(gloved(EXH_BOX_LAST));
    tick(0);
    bus.mm.busy = 4;
    for (unsigned k = 1; k < 4; k++) {
        tick(100);
        CHECK_EQ_I64(bus.n, 1);
        CHECK_EQ_I64(glove.raw[0], 0);
        CHECK_EQ_I64(glove.age_ticks, k);
    }
    tick(200);
    CHECK_EQ_I64(glove.raw[0], 0); /* of tick 0 too: the scan began there, */
    CHECK_EQ_I64(glove.age_ticks, 4); /* and is 4 ticks old */
    exh_box_counts(&n);
    CHECK_EQ_I64(n.glove_waits, 3);
    CHECK_EQ_I64(n.glove_frames, 2);
}

TEST(a_scan_that_is_lost_leaves_the_last_frame_older)
{
    struct exh_box_counts n;
    opened(gloved(EXH_BOX_LAST));
    tick(0);
    bus.mm.busy = 0;
    bus.mm.samples--;
    tick(100);
    CHECK_EQ_I64(glove.raw[21], 21);
    CHECK_EQ_I64(glove.age_ticks, 1);
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

/* ---- opening and its words ------------------------------------------------------------------- */

static void says(const struct exh_box_error *e, const char *want)
{
    char text[160];
    const size_t n = exh_box_error_text(text, sizeof text, e);
    CHECK(check_same_text(text, want), "\"%s\", want \"%s\"", text, want);
    CHECK_EQ_I64(text[n], 0);
    for (size_t cap = 1; cap <= n + 1; cap++) { /* cut, but terminated */
        char part[160];
        memset(part, 'x', sizeof part);
        CHECK(exh_box_error_text(part, cap, e) == cap - 1, "of %u", (unsigned)cap);
        CHECK(part[cap - 1] == '\0' && part[cap] == 'x' && memcmp(part, text, cap - 1) == 0, "%u",
              (unsigned)cap);
    }
    CHECK(exh_box_error_text(text, 0, e) == 0, "nowhere to write");
}

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
    struct exh_box_config c = one();
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
    REFUSED(EXH_BOX_ROW_SCAN, c.mm32xat.channels = 21);
    REFUSED(EXH_BOX_ROW_SCAN, c.mm32xat.interval = 4);
    REFUSED(EXH_BOX_ROW_SCAN, c.mm32xat.lost_limit = 0);
    CHECK_EQ_I64(bus.n, 0);
    CHECK_EQ_I64(put(1), -EXH_E_IO);
    says(exh_box_error(),
         "box: configuration: channels, interval or lost_limit of the scan: value not allowed: 22");
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
    c.s526_base[1] = 3;
    c.mm32xat_base = 0x2C0;
    c.mm32xat.channels = 0;
    opened(c);
}

TEST_MAIN("box", figures_of_a_tick, five_fingers_take_30_and_14_accesses,
          one_finger_takes_10_and_4_of_one_board, monitors_of_the_last_tick_take_no_wait,
          monitors_in_the_tick_are_that_tick_s, without_monitors_a_board_is_asked_for_its_name,
          every_finger_has_its_counter_monitor_and_output, every_input_pin_has_its_meaning,
          a_board_without_a_finger_has_the_rest, every_output_pin_has_its_meaning,
          codes_are_applied_together, codes_beyond_the_drive_s_range_are_clamped_and_counted,
          a_board_that_dies_is_found_within_a_tick,
          a_conversion_that_is_lost_ends_in_time_and_in_safe_outputs,
          updates_that_do_not_end_are_a_fault, an_enable_that_does_not_go_off_is_a_fault,
          illegal_transitions_are_counted_and_too_many_are_a_fault, opening_anew_ends_a_fault,
          opening_makes_safe_what_was_used_before, what_is_not_certain_can_be_left_out,
          safe_takes_20_accesses_a_board_and_may_be_repeated,
          safe_touches_no_port_where_no_board_was_found, safe_may_come_before_any_access,
          a_scan_in_the_tick_is_that_tick_s, a_scan_of_the_tick_before_takes_no_wait,
          a_scan_that_still_runs_is_not_waited_for, a_scan_that_is_lost_leaves_the_last_frame_older,
          a_glove_that_fails_makes_the_drives_safe, all_cards_that_are_absent_are_named,
          faults_by_example, configurations_are_refused_by_name,
          every_place_of_the_glove_s_jumpers_is_found, what_is_not_used_may_be_anything);
