/* SPDX-License-Identifier: MIT */
/* trace.h: the ticks of a frame, what is held, and that a reader sees each lost frame. And its
 * registers. */
#include "exhand/trace.h"

#include "exhand/error.h"
#include "exhand/regs.h"

#include "check.h"

#define FRAMES  8
#define SIGNALS 6

static struct exh_trace t, shown;
static struct exh_trace_frame frame[EXH_TRACE_FRAMES], shown_frame[EXH_TRACE_FRAMES];
static int32_t signal[SIGNALS];

static void begin(uint32_t frames)
{
    CHECK_EQ_I64(exh_trace_setup(&t, frame, frames, SIGNALS), 0);
    CHECK_EQ_I64(exh_trace_setup(&shown, shown_frame, frames, SIGNALS), 0);
}

/* Signal i is 10 tick + i. */
static void ticks(uint32_t from, uint32_t n)
{
    for (uint32_t k = from; k < from + n; k++) {
        for (unsigned i = 0; i < SIGNALS; i++) { signal[i] = (int32_t)(10 * k + i); }
        exh_trace_step(&t, k, signal);
    }
}

static void trace(struct exh_trace *of, uint32_t every, uint32_t first)
{
    const struct exh_trace_request what = {every, {first, 1, 5, 0}};
    CHECK_EQ_I64(exh_trace_start(of, &what), 0);
}

static void holds(const struct exh_trace *of, uint32_t number, uint32_t tick, int32_t first)
{
    const struct exh_trace_frame *f = &of->frame[number & of->mask];
    const int32_t is = (int32_t)(10 * tick);
    CHECK(f->number == number && f->tick == tick, "frame %lu: %lu of tick %lu",
        (unsigned long)number, (unsigned long)f->number, (unsigned long)f->tick);
    CHECK(f->raw[0] == is + first && f->raw[1] == is + 1 && f->raw[2] == is + 5 && f->raw[3] == is,
        "frame %lu: other values", (unsigned long)number);
}

TEST(what_cannot_be_is_refused)
{
    static const uint32_t bad[] = {0, 1, 3, 127, 129, 256, 0x80000000u};
    struct exh_trace_request what = {1, {0, 0, 0, SIGNALS}};
    for (unsigned i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        CHECK_EQ_I64(exh_trace_setup(&t, frame, bad[i], 1), -EXH_E_RANGE);
    }
    CHECK_EQ_I64(exh_trace_setup(&t, frame, 8, 0), -EXH_E_RANGE);
    begin(FRAMES);
    trace(&t, 3, 2);
    CHECK_EQ_I64(exh_trace_start(&t, &what), -EXH_E_RANGE);
    CHECK(t.run == 1 && t.what.every == 3 && t.what.index[3] == 0, "it was taken");
}

/* A scene that makes signals only for a reader asks before each tick. */
TEST(it_says_before_a_tick_whether_it_reads)
{
    begin(FRAMES);
    CHECK_EQ_I64(exh_trace_reads(&t), 0);
    trace(&t, 3, 2);
    for (uint32_t k = 0; k < 9; k++) {
        const uint32_t head = t.head;
        const int reads = exh_trace_reads(&t);
        ticks(k, 1);
        CHECK_EQ_I64(reads, t.head != head);
    }
    CHECK_EQ_I64(t.head, 3);
}

TEST(every_nth_tick_from_the_next_on)
{
    begin(FRAMES);
    ticks(0, 5);
    CHECK(t.head == 0 && exh_trace_oldest(&t) == 0, "traced without being asked");
    trace(&t, 3, 2);
    ticks(5, 7);
    CHECK_EQ_I64(t.head, 3);
    holds(&t, 0, 5, 2);
    holds(&t, 1, 8, 2);
    holds(&t, 2, 11, 2);
    CHECK_EQ_I64(exh_trace_oldest(&t), 0);
}

TEST(the_newest_are_held)
{
    begin(FRAMES);
    trace(&t, 1, 3);
    ticks(100, FRAMES);
    CHECK_EQ_I64(exh_trace_oldest(&t), 0);
    ticks(100 + FRAMES, 13);
    CHECK_EQ_I64(t.head, FRAMES + 13);
    CHECK_EQ_I64(exh_trace_oldest(&t), 13);
    for (uint32_t k = 13; k < t.head; k++) { holds(&t, k, 100 + k, 3); }
}

TEST(numbers_go_on_and_wrap)
{
    begin(FRAMES);
    trace(&t, 1, 3);
    ticks(0, 3);
    trace(&t, 2, 4);
    CHECK(t.head == 3 && exh_trace_oldest(&t) == 3 && t.run == 2, "what was before is still held");
    ticks(3, 1);
    holds(&t, 3, 3, 4);
    t.head = t.first = UINT32_MAX - 2;
    t.left = 0;
    ticks(40, 2 * 20);
    CHECK_EQ_I64(t.head, 17);
    CHECK_EQ_I64(exh_trace_oldest(&t), 9);
    holds(&t, 16, 40 + 2 * 19, 4);
    t.head = 3;
    t.first = UINT32_MAX - 1;
    CHECK_EQ_I64(exh_trace_oldest(&t), UINT32_MAX - 1);
}

TEST(a_frame_that_never_was_has_another_number)
{
    begin(FRAMES);
    for (uint32_t i = 0; i < FRAMES; i++) {
        CHECK((frame[i].number & t.mask) != i, "%lu", (unsigned long)i);
    }
}

/* The copy has what the loop's has, whenever it is made. */
TEST(passed_on_whole)
{
    begin(FRAMES);
    trace(&shown, 2, 2);
    exh_trace_copy(&t, &shown);
    ticks(0, 5);
    CHECK(shown.head == 0, "shown before it was passed");
    exh_trace_copy(&t, &shown);
    CHECK_EQ_I64(shown.head, 3);
    for (uint32_t k = 0; k < 3; k++) { holds(&shown, k, 2 * k, 2); }
    ticks(5, 100); /* the reader is late for long */
    exh_trace_copy(&t, &shown);
    CHECK_EQ_I64(shown.head, 53);
    CHECK_EQ_I64(exh_trace_oldest(&shown), 53 - FRAMES);
    for (uint32_t k = 53 - FRAMES; k < 53; k++) { holds(&shown, k, 2 * k, 2); }
    exh_trace_copy(&t, &shown);
    CHECK_EQ_I64(shown.head, 53);
    ticks(105, 4);
    trace(&shown, 1, 4); /* two frames were not passed on */
    exh_trace_copy(&t, &shown);
    CHECK(
        shown.head == 53 && exh_trace_oldest(&shown) == 53 && t.head == 53, "of the trace before");
    ticks(200, 2);
    exh_trace_copy(&t, &shown);
    CHECK_EQ_I64(shown.head, 55);
    holds(&shown, 53, 200, 4);
    holds(&shown, 54, 201, 4);
}

/* --- as registers --- */

static const struct exh_signal row[SIGNALS] = {
    {0x7201, 30, EXH_WHEN_OUTPUT, INT32_MIN, INT32_MAX, 0, "a", "", ""},
    {0x7202, 30, EXH_WHEN_OUTPUT, INT32_MIN, INT32_MAX, 0, "b", "", ""},
    {0x7203, 30, EXH_WHEN_OUTPUT, INT32_MIN, INT32_MAX, 0, "c", "", ""},
    {0x7204, 30, EXH_WHEN_OUTPUT, INT32_MIN, INT32_MAX, 0, "d", "", ""},
    {0x7205, 30, EXH_WHEN_OUTPUT, INT32_MIN, INT32_MAX, 0, "e", "", ""},
    {0x7206, 30, EXH_WHEN_OUTPUT, INT32_MIN, INT32_MAX, 0, "f", "", ""}};
static const struct exh_signal_group group = {row, SIGNALS, 1};
static const struct exh_signal_table table = {&group, 1};

static struct exh_regs box(void)
{
    struct exh_regs r = {.signals = &table, .signal = signal};
    CHECK_EQ_I64(exh_regs_setup(&r), 0);
    r.trace = &t;
    return r;
}

static uint32_t input(const struct exh_regs *r, uint32_t at)
{
    uint8_t b[4];
    CHECK_EQ_I64(exh_regs_read(r, EXH_REGS_INPUT, (uint16_t)at, 2, b), 0);
    return (uint32_t)b[0] << 24 | (uint32_t)b[1] << 16 | (uint32_t)b[2] << 8 | b[3];
}

static int writes(struct exh_regs *r, uint32_t at, uint16_t n, const uint8_t *from)
{
    return exh_regs_write(r, (uint16_t)at, n, from);
}

TEST(set_and_read_by_registers)
{
    static const uint8_t set[20] = {0, 0, 0, 2, 0, 0, 0, 3, 0, 0, 0, 1, 0, 0, 0, 5, 0, 0, 0, 0};
    struct exh_regs r;
    begin(EXH_TRACE_FRAMES);
    r = box();
    CHECK_EQ_I64(writes(&r, EXH_REGS_TRACE_AT, 10, set), 0);
    CHECK(
        t.run == 1 && t.what.every == 2 && t.what.index[0] == 3 && t.what.index[2] == 5, "not set");
    ticks(0, 300);
    CHECK_EQ_I64(input(&r, EXH_REGS_TRACE_AT + 2 * EXH_TRACE_HEAD_FRAMES), 128);
    CHECK_EQ_I64(input(&r, EXH_REGS_TRACE_AT + 2 * EXH_TRACE_HEAD_NEXT), 150);
    CHECK_EQ_I64(input(&r, EXH_REGS_TRACE_AT + 2 * EXH_TRACE_HEAD_OLDEST), 22);
    CHECK_EQ_I64(input(&r, EXH_REGS_TRACE_AT + 2 * EXH_TRACE_HEAD_SIGNAL_2), 5);
    for (uint32_t k = 22; k < 150; k++) {
        const uint32_t at = EXH_REGS_FRAMES_AT + 2 * EXH_REGS_FRAME_VALUES * (k & 127u);
        CHECK_EQ_I64(input(&r, at), k);
        CHECK_EQ_I64(input(&r, at + 2), 2 * k);
        CHECK_EQ_I64(input(&r, at + 4), 20 * k + 3);
        CHECK_EQ_I64(input(&r, at + 8), 20 * k + 5);
        CHECK_EQ_I64(input(&r, at + 10), 20 * k);
    }
}

TEST(halves_and_edges_of_its_registers)
{
    static const uint8_t many[4] = {0, SIGNALS, 0, 0}, one[2] = {0, 4}, high[2] = {0x12, 0x34};
    uint8_t b[2 * 125];
    struct exh_regs r;
    begin(FRAMES);
    r = box();
    trace(&t, 0x10007, 2);
    CHECK_EQ_I64(writes(&r, EXH_REGS_TRACE_AT + 1, 1, one), 0); /* the low half alone */
    CHECK_EQ_I64(t.what.every, 0x10004);
    CHECK_EQ_I64(writes(&r, EXH_REGS_TRACE_AT, 1, high), 0);
    CHECK_EQ_I64(t.what.every, 0x12340004);
    CHECK_EQ_I64(t.run, 3);
    CHECK_EQ_I64(writes(&r, EXH_REGS_TRACE_AT + 9, 1, one), 0);
    CHECK_EQ_I64(t.what.index[3], 4);
    CHECK_EQ_I64(
        writes(&r, EXH_REGS_TRACE_AT + 3, 2, many), EXH_MODBUS_VALUE); /* a signal that is none */
    CHECK_EQ_I64(writes(&r, EXH_REGS_TRACE_AT + 9, 2, many), EXH_MODBUS_ADDRESS);
    CHECK(t.run == 4 && t.what.index[0] == 2, "a refused write did something");
    CHECK_EQ_I64(exh_regs_read(&r, EXH_REGS_HOLDING, EXH_REGS_TRACE_AT, 10, b), 0);
    CHECK(b[0] == 0x12 && b[3] == 4 && b[19] == 4, "what is set is not read back");
    CHECK_EQ_I64(exh_regs_read(&r, EXH_REGS_INPUT, EXH_REGS_TRACE_AT, 2 * EXH_TRACE_HEADS, b), 0);
    CHECK_EQ_I64(exh_regs_read(&r, EXH_REGS_INPUT, EXH_REGS_TRACE_AT, 2 * EXH_TRACE_HEADS + 1, b),
        EXH_MODBUS_ADDRESS);
    CHECK_EQ_I64(
        exh_regs_read(&r, EXH_REGS_INPUT, EXH_REGS_FRAMES_AT - 1, 2, b), EXH_MODBUS_ADDRESS);
    CHECK_EQ_I64(exh_regs_read(&r, EXH_REGS_INPUT, EXH_REGS_FRAMES_AT, 12 * FRAMES, b), 0);
    CHECK_EQ_I64(exh_regs_read(&r, EXH_REGS_INPUT, EXH_REGS_FRAMES_AT, 12 * FRAMES + 1, b),
        EXH_MODBUS_ADDRESS);
    r.trace = NULL;
    CHECK_EQ_I64(exh_regs_read(&r, EXH_REGS_INPUT, EXH_REGS_TRACE_AT, 2, b), EXH_MODBUS_ADDRESS);
    CHECK_EQ_I64(exh_regs_read(&r, EXH_REGS_INPUT, EXH_REGS_FRAMES_AT, 2, b), EXH_MODBUS_ADDRESS);
    CHECK_EQ_I64(writes(&r, EXH_REGS_TRACE_AT, 1, high), EXH_MODBUS_ADDRESS);
}

TEST(state_there_and_back_and_brought_into_range)
{
    uint8_t b[36 + 24 * FRAMES], hostile[sizeof b];
    struct exh_bytes c = exh_bytes_writer(b, sizeof b);
    begin(FRAMES);
    t.head = UINT32_MAX - 2;
    trace(&t, 3, 2);
    ticks(7, 20);
    exh_trace_serialize(&c, &t);
    CHECK(exh_bytes_ok(&c) && c.at == sizeof b, "%lu B", (unsigned long)c.at);
    c = exh_bytes_reader(b, sizeof b);
    exh_trace_serialize(&c, &shown);
    CHECK(memcmp(frame, shown_frame, FRAMES * sizeof frame[0]) == 0 && shown.head == t.head &&
              shown.first == t.first && shown.left == t.left && shown.run == t.run &&
              memcmp(&shown.what, &t.what, sizeof t.what) == 0,
        "not what was written");
    memset(hostile, 0xFF, sizeof hostile);
    c = exh_bytes_reader(hostile, sizeof hostile);
    exh_trace_serialize(&c, &t);
    CHECK(t.mask == FRAMES - 1 && t.signals == SIGNALS && t.frame == frame,
        "what is set up is no state");
    for (unsigned i = 0; i < EXH_TRACE_SIGNALS; i++) { CHECK_EQ_I64(t.what.index[i], 0); }
    CHECK_EQ_I64(t.left, UINT32_MAX - 1);
    memset(hostile, 0, 4); /* none is traced */
    c = exh_bytes_reader(hostile, sizeof hostile);
    exh_trace_serialize(&c, &t);
    CHECK_EQ_I64(t.left, 0);
}

/* Two frames are enough; and of every tick, left is 0 when it comes back. */
TEST(the_least_ring)
{
    begin(2);
    trace(&t, 1, 0);
    ticks(0, 5);
    CHECK(t.head == 5 && exh_trace_oldest(&t) <= 4 && exh_trace_oldest(&t) >= 3, "oldest %lu",
        (unsigned long)exh_trace_oldest(&t));
    holds(&t, 4, 4, 0);
}

/* A frame that was passed on is not written again: a reader may be reading it. */
TEST(a_frame_is_passed_on_once)
{
    begin(FRAMES);
    trace(&shown, 1, 0);
    exh_trace_copy(&t, &shown); /* takes what is asked */
    ticks(0, 3);
    exh_trace_copy(&t, &shown);
    CHECK_EQ_I64(shown.head, 3);
    for (uint32_t n = 0; n < 3; n++) { shown_frame[n].tick = 1000 + n; }
    ticks(3, 2);
    exh_trace_copy(&t, &shown);
    CHECK_EQ_I64(shown.head, 5);
    for (uint32_t n = 0; n < 3; n++) {
        CHECK(shown_frame[n].tick == 1000 + n, "frame %lu again", (unsigned long)n);
    }
    holds(&shown, 3, 3, 0);
    holds(&shown, 4, 4, 0);
}

/* The number behind the last signal is none, wherever it comes from. */
TEST(the_signal_behind_the_last)
{
    static const struct exh_trace_request end = {1, {SIGNALS - 1, 0, 0, 0}},
                                          behind = {1, {SIGNALS, 0, 0, 0}};
    uint8_t bytes[36 + 24 * 2];
    struct exh_bytes c = exh_bytes_writer(bytes, sizeof bytes);
    begin(2);
    CHECK_EQ_I64(exh_trace_start(&t, &end), 0);
    CHECK_EQ_I64(exh_trace_start(&t, &behind), -EXH_E_RANGE);
    t.signals++;
    CHECK_EQ_I64(exh_trace_start(&t, &behind), 0);
    exh_trace_serialize(&c, &t);
    CHECK(exh_bytes_ok(&c), "written");
    t.signals--;
    c = exh_bytes_reader(bytes, c.at);
    exh_trace_serialize(&c, &t);
    CHECK(exh_bytes_ok(&c) && t.what.index[0] == 0, "%" PRIu32, t.what.index[0]);
}

TEST_MAIN("trace", what_cannot_be_is_refused, it_says_before_a_tick_whether_it_reads,
    every_nth_tick_from_the_next_on, the_newest_are_held, numbers_go_on_and_wrap,
    a_frame_that_never_was_has_another_number, passed_on_whole,
    state_there_and_back_and_brought_into_range, set_and_read_by_registers,
    halves_and_edges_of_its_registers, the_least_ring, a_frame_is_passed_on_once,
    the_signal_behind_the_last);
