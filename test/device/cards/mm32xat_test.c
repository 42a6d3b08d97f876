/* SPDX-License-Identifier: MIT */
/* The driver of the MM-32X-AT against a scripted bus. */
#include "bus.h"
#include "check.h"

#include "cards/mm32xat.h"

#include "exhand/error.h"

static struct exh_mm32xat card;
static struct exh_card_fault fault;
static int16_t frame[32];

static int open_with(struct exh_mm32xat_par par)
{
    bus.s526[0].base = bus.s526[1].base = 0;
    bus_clear();
    fault = (struct exh_card_fault){255, 0, 0, 0, 0, 0};
    return exh_mm32xat_open(&card, 0x300, &par, &fault);
}

static int open_it(void)
{
    const struct exh_mm32xat_par par = EXH_MM32XAT_PAR_DEFAULT;
    return open_with(par);
}

static void opened(void)
{
    bus_reset();
    for (int k = 0; k < 32; k++) { bus.mm.in[k] = (int16_t)(k * 1000 - 11000 + k); }
    CHECK_EQ_I64(open_it(), 0);
    bus_clear();
}

/* A scan, awaited: what reading it gives. */
static int scan(void)
{
    int err;
    exh_mm32xat_start(&card);
    err = exh_mm32xat_wait(&card, &fault);
    return err < 0 ? err : exh_mm32xat_read(&card, frame, &fault);
}

/* ---- detect ------------------------------------------------------------------------ */

/* The writes that Linux' driver was seen to make, and its expectations. */
TEST(detection_by_example)
{
    unsigned i, said = 0;
    static const struct access want[] = {{'o', 0x308, 0x20}, {'o', 0x307, 0}, {'o', 0x309, 0},
        {'o', 0x302, 0x80}, {'o', 0x303, 0xFF}, {'o', 0x30B, 0x0C}};
    opened();
    bus_reset();
    CHECK_EQ_I64(open_it(), 0);
    for (i = 0; i < bus.n && said < 6; i++) {
        if (bus.log[i].op != 'o') { continue; }
        CHECK(bus.log[i].port == want[said].port && bus.log[i].value == want[said].value,
            "write %u: %X to %X", said, (unsigned)bus.log[i].value, (unsigned)bus.log[i].port);
        said++;
    }
    CHECK(bus.time_us > 1100, "%" PRIu32 " us: 1 ms after the reset, 0.1 ms after the settings",
        bus.time_us);
}

TEST(an_empty_port_is_not_written)
{
    bus_reset();
    bus.mm.base = 0;
    CHECK_EQ_I64(open_it(), -EXH_E_ABSENT);
    CHECK(fault.phase == EXH_CARD_DETECT && fault.what == EXH_CARD_EMPTY, "%u", fault.what);
    CHECK(bus_said(0, "i 302 FF, i 303 FF, i 307 FF, i 308 FF, i 309 FF, i 30B FF"), "written");
}

TEST(each_register_that_is_unlike_it_is_named)
{
    bus_reset();
    bus.mm.misc = 0x40; /* some inputs are differential: a jumper */
    CHECK_EQ_I64(open_it(), -EXH_E_ABSENT);
    CHECK(fault.what == EXH_CARD_REGISTER && fault.at == 8 && fault.got == 0x40 && fault.hi == 0x60,
        "%u at %u", fault.what, fault.at);
    bus_reset();
    bus.mm.settle_stuck = 1;
    CHECK_EQ_I64(open_it(), -EXH_E_ABSENT);
    CHECK(fault.what == EXH_CARD_REGISTER && fault.at == 11, "%u at %u", fault.what, fault.at);
}

/* ---- a scan -------------------------------------------------------------------------- */

TEST(the_set_up_of_a_scan_by_example)
{
    unsigned i = 0;
    bus_reset();
    CHECK_EQ_I64(open_it(), 0);
    while (
        i < bus.n && !(bus.log[i].op == 'o' && bus.log[i].port == 0x307 && bus.log[i].value == 2)) {
        i++;
    }
    bus.n = i + 13;
    CHECK(bus_said(i, "o 307 2, o 302 0, o 303 15, o 30B 28, o 307 4, o 309 0, i 30B 88, i 30B 88, "
                      "i 30B 8, i 302 0, i 303 15, i 307 84, o 300 0"),
        "otherwise");
}

/* 22 samples: 1 start, 1 poll, 44 bytes, 3 looks at the FIFO. */
TEST(a_scan_by_example)
{
    opened();
    bus.mm.busy_for = 0;
    CHECK_EQ_I64(scan(), 1);
    for (int k = 0; k < 22; k++) { CHECK_EQ_I64(frame[k], k * 1000 - 11000 + k); }
    CHECK_EQ_I64(bus.n, 49);
    CHECK(bus_said(43, "i 300 3C, i 301 23, i 307 4, i 300 25, i 301 27, i 307 84"), "otherwise");
    bus.n = 5;
    CHECK(bus_said(0, "o 300 0, i 308 60, i 307 44, i 300 8, i 301 D5"), "otherwise"); /* -11000 */
}

TEST(words_take_half)
{
    struct exh_mm32xat_par par = EXH_MM32XAT_PAR_DEFAULT;
    opened();
    par.words = 1;
    CHECK_EQ_I64(open_with(par), 0);
    bus.mm.busy_for = 0;
    bus_clear();
    CHECK_EQ_I64(scan(), 1);
    CHECK_EQ_I64(bus.n, 27);
    for (int k = 0; k < 22; k++) { CHECK_EQ_I64(frame[k], k * 1000 - 11000 + k); }
}

TEST(every_number_of_channels)
{
    struct exh_mm32xat_par par = EXH_MM32XAT_PAR_DEFAULT;
    for (par.channels = 1; par.channels <= 31; par.channels++) {
        opened();
        CHECK_EQ_I64(open_with(par), 0);
        memset(frame, 0, sizeof frame);
        CHECK_EQ_I64(scan(), 1);
        for (int k = 0; k < 32; k++) {
            CHECK_EQ_I64(frame[k], k < par.channels ? k * 1000 - 11000 + k : 0);
        }
    }
}

/* ---- scans that are lost ---------------------------------------------------------------- */

static void lost(unsigned drop, unsigned more, uint8_t overflow)
{
    opened();
    CHECK_EQ_I64(scan(), 1);
    for (int k = 0; k < 22; k++) { bus.mm.in[k] = 77; }
    bus.mm.drop = drop;
    bus.mm.more = more;
    exh_mm32xat_start(&card);
    bus.mm.overflow = overflow;
    CHECK_EQ_I64(exh_mm32xat_wait(&card, &fault), 0);
    CHECK_EQ_I64(exh_mm32xat_read(&card, frame, &fault), 0);
    for (int k = 0; k < 22; k++) { CHECK_EQ_I64(frame[k], k * 1000 - 11000 + k); } /* as it was */
    bus.mm.drop = bus.mm.more = 0;
    CHECK_EQ_I64(scan(), 1);
    for (int k = 0; k < 22; k++) { CHECK_EQ_I64(frame[k], 77); } /* in step again */
    CHECK_EQ_I64(card.lost, 0);
}

TEST(samples_missing_or_too_many_are_dropped_and_counted)
{
    for (unsigned n = 1; n <= 22; n++) {
        lost(n, 0, 0);
        CHECK(card.shorts == 1 && card.longs == 0 && card.overflows == 0, "%u missing", n);
        lost(0, n, 0);
        CHECK(card.shorts == 0 && card.longs == 1 && card.overflows == 0, "%u more", n);
    }
    lost(0, 600, 1);
    CHECK(card.shorts == 0 && card.longs == 0 && card.overflows == 1, "overflow");
}

TEST(three_lost_in_a_row_are_a_fault)
{
    opened();
    bus.mm.drop = 1;
    CHECK_EQ_I64(scan(), 0);
    CHECK_EQ_I64(scan(), 0);
    CHECK_EQ_I64(scan(), -EXH_E_IO);
    CHECK(fault.phase == EXH_CARD_SCAN && fault.what == EXH_CARD_SCAN_LOST, "%u", fault.what);
    opened();
    for (int n = 0; n < 10; n++) { /* not in a row */
        bus.mm.drop = (unsigned)n & 1u;
        CHECK_EQ_I64(scan(), !(n & 1));
    }
    CHECK_EQ_I64(card.shorts, 5);
}

TEST(a_card_that_always_loses_samples_does_not_open)
{
    bus_reset();
    bus.mm.drop = 1;
    CHECK_EQ_I64(open_it(), -EXH_E_IO);
    CHECK(fault.phase == EXH_CARD_SELFTEST && fault.what == EXH_CARD_SCAN_LOST, "%u: %u",
        fault.phase, fault.what);
}

/* ---- waits ---------------------------------------------------------------------------------- */

TEST(a_scan_that_never_ends_is_a_fault_by_time_or_by_polls)
{
    for (unsigned stopped = 0; stopped < 2; stopped++) {
        opened();
        bus.stopped = (uint8_t)stopped;
        bus.mm.stuck = 1;
        bus.time_us = 0;
        CHECK_EQ_I64(scan(), -EXH_E_IO);
        CHECK_EQ_I64(fault.what, EXH_CARD_SCAN_TIMEOUT);
        CHECK(stopped ? bus.n > 32000 && bus.n < 32010 : bus.time_us > 2000 && bus.time_us < 2020,
            "%u accesses, %" PRIu32 " us", bus.n, bus.time_us);
    }
}

TEST(also_where_it_is_only_asked_for)
{
    for (unsigned stopped = 0; stopped < 2; stopped++) {
        int done = 0;
        unsigned n = 0;
        opened();
        exh_mm32xat_start(&card);
        bus.stopped = (uint8_t)stopped;
        bus.mm.stuck = 1;
        for (; n < 2000 && done == 0; n++) {
            done = exh_mm32xat_done(&card, &fault);
            if (!stopped) { bus.time_us += 500; }
        }
        CHECK_EQ_I64(done, -EXH_E_IO);
        CHECK_EQ_I64(fault.what, EXH_CARD_SCAN_TIMEOUT);
        CHECK_EQ_I64(n, stopped ? 1000 : 5);
    }
}

TEST(an_input_that_never_settles_is_a_fault)
{
    opened();
    bus.mm.drop = 1;
    bus.mm.settle_stuck = 1;
    CHECK_EQ_I64(scan(), -EXH_E_IO);
    CHECK(fault.phase == EXH_CARD_SCAN && fault.what == EXH_CARD_WAIT_TIMEOUT, "%u", fault.what);
}

/* From whichever access on, while opened or in a scan: found dead, never a frame. */
TEST(a_card_that_dies_is_found_dead)
{
    unsigned all;
    bus_reset();
    CHECK_EQ_I64(open_it(), 0);
    all = bus.n;
    for (unsigned from = 0; from < all; from++) {
        bus_reset();
        bus.dead_card = 2;
        bus.dead_from = from;
        CHECK(open_it() < 0, "from access %u", from);
        CHECK(fault.what == EXH_CARD_EMPTY, "from %u: %u", from, fault.what);
    }
    for (unsigned from = 0; from < 49; from++) {
        opened();
        bus.mm.busy_for = 0;
        bus.dead_card = 2;
        bus.dead_from = from;
        CHECK_EQ_I64(scan(), -EXH_E_IO);
        CHECK_EQ_I64(fault.what, EXH_CARD_EMPTY);
    }
}

TEST(a_card_that_dies_in_a_scan_is_found_dead_when_asked)
{
    opened();
    exh_mm32xat_start(&card);
    bus.mm.base = 0;
    CHECK_EQ_I64(exh_mm32xat_done(&card, &fault), -EXH_E_IO);
    CHECK(fault.phase == EXH_CARD_SCAN && fault.what == EXH_CARD_EMPTY, "%u", fault.what);
}

TEST_MAIN("mm32xat", detection_by_example, an_empty_port_is_not_written,
    each_register_that_is_unlike_it_is_named, the_set_up_of_a_scan_by_example, a_scan_by_example,
    words_take_half, every_number_of_channels, samples_missing_or_too_many_are_dropped_and_counted,
    three_lost_in_a_row_are_a_fault, a_card_that_always_loses_samples_does_not_open,
    a_scan_that_never_ends_is_a_fault_by_time_or_by_polls, also_where_it_is_only_asked_for,
    an_input_that_never_settles_is_a_fault, a_card_that_dies_is_found_dead,
    a_card_that_dies_in_a_scan_is_found_dead_when_asked);
