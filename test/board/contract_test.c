/* The contract of a port, against exhand/board.h alone: link it to any port and run it
 * there. Where a drive is connected, finger 0 is told 0.5 A for 50 ms and the samples
 * behind them three times, the last time with its drive not enabled.
 *
 * A board is set up once a run, so the rate is one a build: -DCONTRACT_RATE_HZ. */
#include "check.h"

#include "exhand/board.h"
#include "exhand/error.h"

#ifndef CONTRACT_RATE_HZ
#define CONTRACT_RATE_HZ 1000
#endif

#define DAC_ZERO    32768 /* raw codes are the Sensoray's on every port                 */
#define DAC_HALF_A  923 /* 3249 codes/V over 1.76 A/V                                 */
#define MON_HALF_A  968 /* 305.2 uV a code at 0.591 V/A                               */
#define PULSE_TICKS (CONTRACT_RATE_HZ / 20)
#define SAMPLES     16 /* averaged against the monitor's noise, 47 mA peak to peak         */

static struct exh_period period;
static uint8_t alive;

/* The board, set up once by whichever test comes first. */
static void ready(void)
{
    static int done;
    if (done) { return; }
    CHECK_EQ_I64(exh_board_init(CONTRACT_RATE_HZ, &period), 0);
    done = 1;
}

static struct exh_drive_in read_frame(void)
{
    struct exh_drive_in in;
    CHECK_EQ_I64(exh_board_read_drive(&in), 0);
    return in;
}

static void write_frame(int32_t from_zero, unsigned enable)
{
    struct exh_drive_out out = {{0}, 0, 0};
    for (unsigned i = 0; i < EXH_FINGERS; i++) { out.dac_raw[i] = DAC_ZERO; }
    out.dac_raw[0] = (uint16_t)(DAC_ZERO + from_zero);
    out.enable = (uint8_t)enable;
    out.alive = ++alive;
    CHECK_EQ_I64(exh_board_write_drive(&out), 0);
}

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
    CHECK(b->enc_bits == 16 || b->enc_bits == 24 || b->enc_bits == 32, "%u bits", b->enc_bits);
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
    CHECK(period.num >= 1 && period.den >= 1, "%" PRIu32 "/%" PRIu32, period.num, period.den);
    got = (uint64_t)period.num * CONTRACT_RATE_HZ; /* num/den * rate = 1 +- 1000 ppm */
    want = period.den;
    off = got > want ? got - want : want - got;
    CHECK(off <= want / 1000, "%" PRIu32 "/%" PRIu32 " s for %d Hz", period.num, period.den,
          CONTRACT_RATE_HZ);
}

/* ---- Frames ---------------------------------------------------------------------- */

TEST(frames_work_before_the_first_tick)
{
    ready();
    (void)read_frame();
    write_frame(0, 0);
    (void)read_frame();
}

TEST(waiting_in_time_misses_nothing)
{
    ready();
    for (int n = 0; n < 32; n++) { (void)tick(0, 0); }
}

TEST(inputs_of_an_idle_box_are_healthy)
{
    const uint32_t drives = ((1u << exh_board_info.fingers) - 1u) * EXH_DIN_DRIVE0;
    const uint32_t want = EXH_DIN_ESTOP | EXH_DIN_DEADMAN | drives;
    ready();
    for (int n = 0; n < 16; n++) {
        const struct exh_drive_in in = tick(0, 0);
        CHECK((in.din & want) == want, "digital inputs %#" PRIx32 ", want %#" PRIx32, in.din, want);
        for (unsigned i = 0; i < exh_board_info.fingers && exh_board_info.enc_bits < 32; i++) {
            CHECK(in.enc_raw[i] >> exh_board_info.enc_bits == 0, "finger %u: count %#" PRIx32, i,
                  in.enc_raw[i]);
        }
    }
}

/* Nothing moves a box that is told to give no current: a held string by a few counts. */
TEST(counts_of_an_idle_box_stand_still)
{
    uint32_t first;
    ready();
    first = tick(0, 0).enc_raw[0];
    for (int n = 0; n < 8; n++) {
        const uint32_t moved = tick(0, 0).enc_raw[0] - first + 4;
        CHECK((moved & 0xFFFF) <= 8, "moved by %" PRId32, (int32_t)moved - 4);
    }
}

/* ---- Zero current ------------------------------------------------------------------ */

/* Mean monitor code of finger 0 over the last ticks of 50 ms of one frame. */
static int32_t monitor_after(int32_t from_zero, unsigned enable)
{
    int32_t sum = 0;
    for (int n = 0; n < PULSE_TICKS; n++) { (void)tick(from_zero, enable); }
    for (int n = 0; n < SAMPLES; n++) { sum += tick(from_zero, enable).mon_raw[0]; }
    return sum / SAMPLES;
}

static int is_zero(int32_t code)
{
    return code > -MON_HALF_A / 10 && code < MON_HALF_A / 10;
}

/* As monitor_after(), but nothing is written: what safe left is what the drive has. */
static int32_t monitor_alone(void)
{
    int32_t sum = 0;
    for (int n = 0; n < PULSE_TICKS; n++) { CHECK_EQ_I64(exh_board_wait(), 0); }
    for (int n = 0; n < SAMPLES; n++) {
        CHECK_EQ_I64(exh_board_wait(), 0);
        sum += read_frame().mon_raw[0];
    }
    return sum / SAMPLES;
}

TEST(safe_takes_the_current_away_and_repeats)
{
    int32_t code;
    ready();
    code = monitor_after(DAC_HALF_A, 1);
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

TEST(a_disabled_drive_gives_no_current)
{
    int32_t code;
    ready();
    (void)monitor_after(DAC_HALF_A, 1);
    code = monitor_after(DAC_HALF_A, 0);
    exh_board_safe();
    CHECK(is_zero(code), "monitor %d at 0.5 A and not enabled", (int)code);
}

/* ---- Log, link, glove, counter -------------------------------------------------------- */

TEST(log_takes_a_record_whole_or_not_at_all)
{
    static uint8_t rec[4096];
    static const size_t len_B[] = {1, 18, 19, 64, 4095, 4096};
    ready();
    for (unsigned i = 0; i < sizeof len_B / sizeof len_B[0]; i++) {
        const int took = exh_board_log(rec, len_B[i]);
        CHECK(took == 0 || (size_t)took == len_B[i], "%d of %u bytes", took, (unsigned)len_B[i]);
    }
}

TEST(link_is_whole_packets_and_empty_at_first)
{
    uint8_t buf[64] = {0};
    int n;
    ready();
    CHECK_EQ_I64(exh_board_link_recv(buf, sizeof buf), 0);
    CHECK_EQ_I64(exh_board_link_recv(buf, 0), 0);
    n = exh_board_link_send(buf, sizeof buf);
    CHECK(n == 0 || n == (int)sizeof buf || n == -EXH_E_IO, "sent %d of %u", n,
          (unsigned)sizeof buf);
}

TEST(glove_is_read_or_absent)
{
    struct exh_glove_in in;
    int err;
    ready();
    err = exh_board_read_glove(&in);
    CHECK(err == 0 || err == -EXH_E_ABSENT, "%d", err);
}

TEST(cycles_run_freely)
{
    uint32_t last;
    ready();
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
TEST_MAIN("contract", info_is_sane, safe_needs_no_init, impossible_rates_are_refused,
          achieved_period_is_near_the_asked, frames_work_before_the_first_tick,
          counts_of_an_idle_box_stand_still, waiting_in_time_misses_nothing,
          inputs_of_an_idle_box_are_healthy, safe_takes_the_current_away_and_repeats,
          a_disabled_drive_gives_no_current, log_takes_a_record_whole_or_not_at_all,
          link_is_whole_packets_and_empty_at_first, glove_is_read_or_absent, cycles_run_freely);
