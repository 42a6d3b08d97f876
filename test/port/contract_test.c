/* SPDX-License-Identifier: MIT */
/* The contract of a port, against exhand/board.h alone. Link it to any port and run it there. Where
 * drives are connected, finger 0 is commanded 0.5 A for 50 ms, sometimes with its drive not
 * enabled, and the samples after it are read.
 *
 * A board is set up once a run, at contract_rate_Hz. -DCONTRACT_REAL_TIME means that time goes on
 * while a tick computes. Missed ticks and the counter of cycles are then compared, also with
 * -DCONTRACT_CYCLES_HZ if the port knows it. Some rules cannot be tested through board.h: that wait
 * returns stop, and the outputs after halt. The person who runs this tests them: README.md. */
#include "contract.h"

#include "check.h"

#include "exhand/board.h"
#include "exhand/error.h"
#include "exhand/fix.h"

#define DAC_ZERO   32768 /* raw codes are the Sensoray's on every port */
#define DAC_HALF_A 923   /* 3249 codes/V over 1.76 A/V */
#define MON_HALF_A 968   /* 305.2 uV a code at 0.591 V/A */
#define SAMPLES    16    /* averaged against the monitor's noise, 47 mA peak to peak */

#define SETUP_WORK 400000u /* turns of a loop: several ticks of any port */

static struct exh_period period;
static uint8_t alive;

static int pulse_ticks(void) { return (int)(contract_rate_Hz / 20); }

/* The board, set up once by whichever test comes first. */
static void ready(void)
{
    static int done;
    if (done) { return; }
    CHECK_EQ_I64(exh_board_init(contract_rate_Hz, &period), 0);
    done = 1;
}

/* What was printed since the last tick may have taken several. */
static void begin(void)
{
    ready();
    (void)exh_board_wait();
}

static struct exh_drive_in read_frame(void)
{
    struct exh_drive_in in;
    memset(&in, 0xA5, sizeof in);
    CHECK_EQ_I64(exh_board_read_drive(&in), 0);
    return in;
}

/* Finger 0 gets a code, from zero, the others another, of which no drive is ever enabled. */
static void write_codes(int32_t from_zero, int32_t others, unsigned enable)
{
    struct exh_drive_out out = {{0}, 0, 0};
    for (unsigned i = 0; i < EXH_FINGERS; i++) { out.dac_raw[i] = (uint16_t)(DAC_ZERO + others); }
    out.dac_raw[0] = (uint16_t)(DAC_ZERO + from_zero);
    out.enable = (uint8_t)enable;
    out.alive = ++alive;
    CHECK_EQ_I64(exh_board_write_drive(&out), 0);
}

static void write_frame(int32_t from_zero, unsigned enable) { write_codes(from_zero, 0, enable); }

/* One tick of a loop that does what it should. */
static struct exh_drive_in tick(int32_t from_zero, unsigned enable)
{
    struct exh_drive_in in;
    CHECK_EQ_I64(exh_board_wait(), 0);
    in = read_frame();
    write_frame(from_zero, enable);
    return in;
}

/* ---- Set-up ---------------------------------------------------------------------- */

TEST(info_is_sane)
{
    const struct exh_board_info *b = &exh_board_info;
    unsigned n = 0;
    CHECK(b->name != NULL, "no name");
    while (n < 16 && b->name[n] != '\0') {
        CHECK(b->name[n] > ' ' && b->name[n] <= '~', "character %u of its name: %d", n, b->name[n]);
        n++;
    }
    CHECK(n >= 1 && n <= 15, "a name of %u characters", n);
    CHECK_EQ_I64(b->version, EXH_BOARD_VERSION);
    CHECK(b->fingers >= 1 && b->fingers <= EXH_FINGERS, "%u fingers", b->fingers);
    CHECK(b->enc_bits >= 16 && b->enc_bits <= 32, "%u bits", b->enc_bits);
    CHECK(b->rate_max_Hz >= 1 && b->rate_max_Hz <= 20000, "%" PRIu32 " Hz", b->rate_max_Hz);
}

/* Before anything else: a port may be made safe, and a rate it cannot have is refused. */
TEST(safe_needs_no_init)
{
    exh_board_safe();
    exh_board_safe();
}

TEST(impossible_rates_are_refused)
{
    const uint32_t rate_Hz[] = {0, exh_board_info.rate_max_Hz + 1, 1000000, UINT32_MAX};
    for (unsigned i = 0; i < sizeof rate_Hz / sizeof rate_Hz[0]; i++) {
        struct exh_period T = {0, 0};
        const int err = exh_board_init(rate_Hz[i], &T);
        CHECK(err == -EXH_E_RATE, "%" PRIu32 " Hz: %d", rate_Hz[i], err);
    }
}

TEST(achieved_period_is_near_the_asked)
{
    uint64_t got, want, off;
    ready();
    CHECK(exh_period_ok(period), "%" PRIu32 "/%" PRIu32 " s", period.num, period.den);
    got = (uint64_t)period.num * contract_rate_Hz; /* num/den * rate = 1 +- 1000 ppm */
    want = period.den;
    off = got > want ? got - want : want - got;
    CHECK(off * 1000 <= want, "%" PRIu32 "/%" PRIu32 " s for %" PRIu32 " Hz", period.num,
        period.den, contract_rate_Hz);
}

/* ---- Frames ---------------------------------------------------------------------- */

TEST(frames_work_before_the_first_tick)
{
    ready();
    (void)read_frame();
    write_frame(0, 0);
    (void)read_frame();
}

/* The first wait starts the clock, however long ago that was set up. */
TEST(set_up_is_no_missed_tick)
{
    volatile uint32_t work = 0;
    ready();
    while (work < SETUP_WORK) { work = work + 1; }
    CHECK_EQ_I64(exh_board_wait(), 0);
    (void)read_frame();
    write_frame(0, 0);
}

TEST(waiting_in_time_misses_nothing)
{
    begin();
    for (int n = 0; n < 32; n++) { (void)tick(0, 0); }
}

TEST(inputs_of_an_idle_box_are_healthy)
{
    const uint32_t drives = ((1u << exh_board_info.fingers) - 1u) * EXH_DIN_DRIVE0;
    const uint32_t want = EXH_DIN_ESTOP | EXH_DIN_WATCHDOG | EXH_DIN_CARDS | drives,
                   may = want | EXH_DIN_DEADMAN;
    begin();
    for (int n = 0; n < 16; n++) {
        const struct exh_drive_in in = tick(0, 0);
        CHECK((in.din & want) == want, "digital inputs %#" PRIx32 ", want %#" PRIx32, in.din, want);
        CHECK(
            (in.din & ~may) == 0, "digital inputs %#" PRIx32 ": there are %#" PRIx32, in.din, may);
        for (unsigned i = 0; i < exh_board_info.fingers && exh_board_info.enc_bits < 32; i++) {
            CHECK(in.enc_raw[i] >> exh_board_info.enc_bits == 0, "finger %u: count %#" PRIx32, i,
                in.enc_raw[i]);
        }
    }
}

/* With a command of no current nothing moves the box: a held string by a few counts. */
TEST(counts_of_an_idle_box_stand_still)
{
    uint32_t first;
    begin();
    first = tick(0, 0).enc_raw[0];
    for (int n = 0; n < 8; n++) {
        const uint32_t moved = tick(0, 0).enc_raw[0] - first + 4;
        CHECK((moved & 0xFFFF) <= 8, "moved by %" PRId32, (int32_t)moved - 4);
    }
}

/* Reading again within a tick, or not at all, breaks nothing. */
TEST(a_tick_may_read_twice_or_never)
{
    begin();
    CHECK_EQ_I64(exh_board_wait(), 0);
    (void)read_frame();
    (void)read_frame();
    write_frame(0, 0);
    write_frame(0, 0);
    CHECK_EQ_I64(exh_board_wait(), 0);
    (void)tick(0, 0);
}

/* ---- Time -------------------------------------------------------------------------- */

/* From the beginning of a tick to that of another. */
static uint32_t cycles_of_ticks(int ticks)
{
    uint32_t from;
    CHECK_EQ_I64(exh_board_wait(), 0);
    from = exh_board_cycles();
    while (ticks-- > 0) { CHECK_EQ_I64(exh_board_wait(), 0); }
    return exh_board_cycles() - from;
}

static void spend_cycles(uint32_t cycles)
{
    const uint32_t from = exh_board_cycles();
    while (exh_board_cycles() - from < cycles) {}
}

#ifdef CONTRACT_REAL_TIME
/* Three ticks and a half too long: they are counted, and once. Ticks and cycles agree. */
TEST(missed_ticks_are_counted_once)
{
    uint32_t one, from, cycles, ticks = 0;
    int missed;
    begin();
    (void)tick(0, 0);
    one = cycles_of_ticks(8) / 8;
    from = exh_board_cycles();
    spend_cycles(3 * one + one / 2);
    missed = exh_board_wait();
    CHECK(missed == 2 || missed == 3, "%d of three ticks missed", missed);
    ticks += 1 + (uint32_t)missed;
    for (int n = 0; n < 4; n++) {
        missed = exh_board_wait();
        CHECK(missed == 0, "%d missed again", missed);
        ticks += 1 + (uint32_t)missed;
    }
    cycles = exh_board_cycles() - from;
    CHECK(cycles + one / 4 - ticks * one <= one / 2,
        "%" PRIu32 " ticks of %" PRIu32 " cycles took %" PRIu32, ticks, one, cycles);
}

TEST(cycles_run_while_it_waits)
{
    uint32_t least = UINT32_MAX, most = 0;
    begin();
    (void)tick(0, 0);
    for (int n = 0; n < 16; n++) {
        const uint32_t c = cycles_of_ticks(4);
        least = c < least ? c : least;
        most = c > most ? c : most;
    }
    CHECK(least > 0 && most - least <= most / 10,
        "four ticks took %" PRIu32 " .. %" PRIu32 " cycles", least, most);
#ifdef CONTRACT_CYCLES_HZ /* known: the period is the set one, within 1 % */
    {
        const uint64_t want = 4 * (uint64_t)period.num * CONTRACT_CYCLES_HZ;
        const uint64_t got = (uint64_t)most * period.den,
                       off = got > want ? got - want : want - got;
        CHECK(off <= want / 100,
            "four ticks took %" PRIu32 " cycles, period %" PRIu32 "/%" PRIu32 " s", most,
            period.num, period.den);
    }
#endif
}
#else
TEST(missed_ticks_are_counted_once)
{
    begin();
    spend_cycles(cycles_of_ticks(8) / 2);
    CHECK_EQ_I64(exh_board_wait(), 0);
    check_note("time stands still while a tick computes: nothing can be missed here");
}

TEST(cycles_run_while_it_waits)
{
    begin();
    (void)cycles_of_ticks(4);
}
#endif

/* ---- Zero current ------------------------------------------------------------------ */

static int is_zero(int32_t code) { return code > -MON_HALF_A / 10 && code < MON_HALF_A / 10; }

/* Mean monitor code of finger 0 over the last ticks of 50 ms of one frame. No other finger has
 * current. */
static int32_t monitor_after(int32_t from_zero, int32_t others, unsigned enable)
{
    int32_t sum[EXH_FINGERS] = {0};
    for (int n = 0; n < pulse_ticks() + SAMPLES; n++) {
        CHECK_EQ_I64(exh_board_wait(), 0);
        if (n >= pulse_ticks()) {
            const struct exh_drive_in in = read_frame();
            for (unsigned i = 0; i < exh_board_info.fingers; i++) { sum[i] += in.mon_raw[i]; }
        }
        write_codes(from_zero, others, enable);
    }
    for (unsigned i = 1; i < exh_board_info.fingers; i++) {
        CHECK(is_zero(sum[i] / SAMPLES), "finger %u: monitor %" PRId32, i, sum[i] / SAMPLES);
    }
    return sum[0] / SAMPLES;
}

/* As monitor_after(), but nothing is written: what safe left is what the drive has. */
static int32_t monitor_alone(void)
{
    int32_t sum = 0;
    for (int n = 0; n < pulse_ticks(); n++) { CHECK_EQ_I64(exh_board_wait(), 0); }
    for (int n = 0; n < SAMPLES; n++) {
        CHECK_EQ_I64(exh_board_wait(), 0);
        sum += read_frame().mon_raw[0];
    }
    return sum / SAMPLES;
}

TEST(init_leaves_no_current)
{
    int32_t code;
    begin();
    code = monitor_alone();
    CHECK(is_zero(code), "monitor %d before any was asked for", (int)code);
}

TEST(safe_takes_the_current_away_and_repeats)
{
    int32_t code;
    begin();
    code = monitor_after(DAC_HALF_A, 0, 1);
    if (is_zero(code)) {
        check_note("monitor %d at 0.5 A: zero current can't be seen here", (int)code);
    }
    exh_board_safe();
    code = monitor_alone();
    CHECK(is_zero(code), "monitor %d after safe", (int)code);
    exh_board_safe();
    exh_board_safe();
    code = monitor_alone();
    CHECK(is_zero(code), "monitor %d after safe again", (int)code);
    write_frame(0, 0); /* frames may still be written, nothing else fails */
    (void)read_frame();
}

/* Between any two of the other calls. */
TEST(safe_fits_anywhere_in_a_tick)
{
    int32_t code;
    begin();
    (void)monitor_after(DAC_HALF_A, 0, 1);
    CHECK_EQ_I64(exh_board_wait(), 0);
    exh_board_safe();
    (void)read_frame();
    exh_board_safe();
    code = monitor_alone();
    CHECK(is_zero(code), "monitor %d after safe amid a tick", (int)code);
    code = monitor_after(DAC_HALF_A, 0, 1); /* safe is no halt */
    exh_board_safe();
    if (is_zero(code)) { check_note("monitor %d at 0.5 A after safe", (int)code); }
}

/* More than this a board may take for a fault: a drive that is off rests near zero. */
TEST(a_disabled_drive_gives_no_current)
{
    static const int32_t code[] = {DAC_HALF_A, -DAC_HALF_A};
    begin();
    (void)monitor_after(DAC_HALF_A, 0, 1);
    for (unsigned k = 0; k < sizeof code / sizeof code[0]; k++) {
        const int32_t mon = monitor_after(code[k], code[k], 0);
        CHECK(is_zero(mon), "monitor %d at code %d and not enabled", (int)mon, (int)code[k]);
    }
    (void)monitor_after(DAC_HALF_A, DAC_HALF_A, 1); /* the others stay disabled beside it */
    exh_board_safe();
}

/* Commanded 0.5 A while disabled, then zero in the frame that enables it. No current of the earlier
 * code flows. */
TEST(codes_and_enables_act_together)
{
    int32_t code;
    begin();
    (void)monitor_after(DAC_HALF_A, 0, 0);
    code = monitor_after(0, 0, 1);
    exh_board_safe();
    CHECK(is_zero(code), "monitor %d at zero", (int)code);
}

/* ---- Log, link, glove, counter -------------------------------------------------------- */

TEST(log_takes_a_record_whole_or_not_at_all)
{
    static uint8_t rec[5120]; /* the largest of a log (log.h) */
    static const size_t len_B[] = {1, 18, 19, 64, 5119, 5120};
    begin();
    (void)tick(0, 0);
    for (unsigned i = 0; i < sizeof len_B / sizeof len_B[0]; i++) {
        const int took = exh_board_log(rec, len_B[i]);
        CHECK(took == 0 || (size_t)took == len_B[i], "%d of %u bytes", took, (unsigned)len_B[i]);
        CHECK_EQ_I64(exh_board_wait(), 0); /* it blocks nothing */
    }
}

/* A packet in the buffer's first bytes and nothing behind it. */
static void receive(size_t cap_B)
{
    uint8_t buf[64];
    int n;
    memset(buf, 0xA5, sizeof buf);
    n = exh_board_link_recv(buf, cap_B);
    CHECK(n >= 0 ? (size_t)n <= cap_B : n == -EXH_E_IO, "%d of at most %u", n, (unsigned)cap_B);
    for (size_t i = n > 0 ? (size_t)n : 0; i < sizeof buf; i++) {
        CHECK(buf[i] == 0xA5, "byte %u behind %d was written", (unsigned)i, n);
    }
}

TEST(link_is_whole_packets_and_empty_at_first)
{
    uint8_t buf[64] = {0};
    begin();
    (void)tick(0, 0);
    CHECK_EQ_I64(exh_board_link_recv(buf, sizeof buf), 0);
    CHECK_EQ_I64(exh_board_link_recv(buf, 0), 0);
    for (unsigned i = 0; i < 8; i++) {
        const int n = exh_board_link_send(buf, sizeof buf);
        CHECK(n == 0 || n == (int)sizeof buf || n == -EXH_E_IO, "sent %d of %u", n,
            (unsigned)sizeof buf);
        receive(i < 4 ? sizeof buf : 8);
        CHECK_EQ_I64(exh_board_wait(), 0); /* neither blocks */
    }
}

/* Either newer than the last, or the same and a tick older. */
TEST(glove_is_read_with_its_age_or_absent)
{
    struct exh_glove_in last, in;
    int err;
    begin();
    (void)tick(0, 0);
    memset(&last, 0xA5, sizeof last);
    err = exh_board_read_glove(&last);
    if (err < 0) {
        CHECK(err == -EXH_E_ABSENT, "%d", err);
        check_note("no glove");
        return;
    }
    for (int n = 0; n < 16; n++) {
        (void)tick(0, 0);
        memset(&in, 0xA5, sizeof in);
        CHECK_EQ_I64(exh_board_read_glove(&in), 0);
        CHECK(in.age_ticks <= last.age_ticks || in.age_ticks == last.age_ticks + 1u,
            "age %u after %u", in.age_ticks, last.age_ticks);
        /* The first may have been converted twice in its tick: on request, and for the next. */
        CHECK(n == 0 || in.age_ticks <= last.age_ticks ||
                  memcmp(in.raw, last.raw, sizeof in.raw) == 0,
            "an older frame of other codes, age %u", in.age_ticks);
        last = in;
    }
    CHECK(last.age_ticks < UINT16_MAX, "no frame in %d ticks", 16);
}

TEST(cycles_run_freely)
{
    uint32_t last;
    begin();
    last = exh_board_cycles();
    for (int n = 0; n < 16; n++) {
        const uint32_t before = last;
        volatile uint32_t work = 0;
        while (work < 1000) { work = work + 1; }
        last = exh_board_cycles();
        CHECK(last != before, "stands at %" PRIu32, last);
    }
}

/* info and what needs no set-up first; then in the order of a box's life. */
#define main contract_main /* who runs it has the other */
TEST_MAIN("contract", info_is_sane, safe_needs_no_init, impossible_rates_are_refused,
    achieved_period_is_near_the_asked, frames_work_before_the_first_tick, set_up_is_no_missed_tick,
    counts_of_an_idle_box_stand_still, init_leaves_no_current, waiting_in_time_misses_nothing,
    inputs_of_an_idle_box_are_healthy, a_tick_may_read_twice_or_never,
    missed_ticks_are_counted_once, cycles_run_while_it_waits,
    safe_takes_the_current_away_and_repeats, safe_fits_anywhere_in_a_tick,
    a_disabled_drive_gives_no_current, codes_and_enables_act_together,
    log_takes_a_record_whole_or_not_at_all, link_is_whole_packets_and_empty_at_first,
    glove_is_read_with_its_age_or_absent, cycles_run_freely);
