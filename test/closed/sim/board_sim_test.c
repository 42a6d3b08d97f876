/* SPDX-License-Identifier: MIT */
/* The POSIX port's virtual time and raw codes: exact where it promises exactness,
 * bounded on both sides where there is chance. */
#include "check.h"

#include "box/run.h"
#include "posix.h"
#include "sim/plant.h"

#include "exhand/board.h"
#include "exhand/error.h"
#include "exhand/exhand.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

static struct exh_period start(const struct posix_config *c, uint32_t rate_Hz)
{
    struct exh_period T = {0, 0};
    posix_configure(c);
    CHECK_EQ_I64(exh_board_init(rate_Hz, &T), 0);
    return T;
}

/* D/A code and enable of finger 0. */
static void write_code(int32_t from_zero, int enable)
{
    struct exh_drive_out out = {{0}, 0, 0};
    out.dac_raw[0] = (uint16_t)(32768 + from_zero);
    out.enable = (uint8_t)enable;
    CHECK_EQ_I64(exh_board_write_drive(&out), 0);
}

static struct exh_drive_in read_codes(void)
{
    struct exh_drive_in in;
    CHECK_EQ_I64(exh_board_read_drive(&in), 0);
    return in;
}

/* ---- Output delay -------------------------------------------------------------- */

/* When the servo took the step, from the current at a later instant: the loop's
 * exponential solved for its start, by bisection. */
static double taken_s(const struct sim_device *d, double ref_A, double at_s, double cur_A)
{
    double lo = 0, hi = 0.01;
    for (int i = 0; i < 100; i++) {
        const double mid = 0.5 * (lo + hi);
        if (ref_A * (1 - sim_exp_neg(6.283185307179586 * d->current_hz * mid)) < cur_A) {
            lo = mid;
        } else {
            hi = mid;
        }
    }
    return at_s - lo;
}

/* a step of the D/A code in a separate run */
struct step {
    uint32_t rate_Hz, tick; /* when it is written */
    double delay_tick, delay_s;
};

/* Writes the step while the mass is held; the servo's sample time that took it. */
static double respond(struct step s)
{
    struct posix_config c = posix_config_default();
    double ref_A, at_s = -1;
    c.device.delay_tick = s.delay_tick;
    c.device.delay_s = s.delay_s;
    start(&c, s.rate_Hz);
    for (uint32_t n = 0; at_s < 0; n++) {
        const struct plant *p = posix_plant();
        CHECK_EQ_I64(exh_board_wait(), 0);
        if (n > s.tick && p->cur_A != 0) { at_s = posix_time_s(); }
        CHECK(n > s.tick || p->cur_A == 0, "current before the step: %.3g A", p->cur_A);
        CHECK(n < s.tick + 1000 && posix_time_s() < 0.1, "no current");
        write_code(n < s.tick ? 0 : 5000, 1);
    }
    ref_A = 5000 / c.device.dac_perA;
    CHECK(posix_plant()->cur_A < ref_A, "more current than asked for");
    return taken_s(&c.device, ref_A, at_s, posix_plant()->cur_A);
}

TEST(a_step_acts_at_the_first_sample_after_its_delay)
{
    static const struct step row[] = {
        {20000, 100, 0, 0},
        {20000, 101, 0, 0},
        {20000, 102, 0, 0},
        {20000, 103, 0, 0},
        {20000, 104, 0, 0},
        {20000, 200, 3, 0},
        {20000, 200, 0, 203e-6},
        {20000, 201, 0.387, 203e-6},
        {20000, 50, 3, 0.01},
        {4000, 20, 0.387, 203e-6},
        {2000, 10, 0.387, 203e-6},
        {2000, 11, 1, 0},
        {1000, 5, 0.5, 50e-6},
        {2000, 0, 0, 0},
        {500, 3, 0.387, 203e-6},
    };
    const struct step first = {20000, 0, 0, 0};
    const double servo_s = 1 / sim_device_default().servo_hz;
    const double grid_s = respond(first); /* same seed: the servo's grid in all runs */
    for (size_t i = 0; i < LEN(row); i++) {
        const double T_s = 1.0 / row[i].rate_Hz;
        const double due_s = row[i].tick * T_s + row[i].delay_tick * T_s + row[i].delay_s;
        double want_s = grid_s;
        double got_s;
        while (want_s < due_s) { want_s += servo_s; }
        got_s = respond(row[i]);
        CHECK(fabs(got_s - want_s) < 1e-9, "row %zu: due %.9f s, taken %.9f, want %.9f", i, due_s,
            got_s, want_s);
    }
}

/* A nanosecond before the servo's sample is in time for it, one after is not; both parts
 * of the delay count. */
TEST(the_edge_between_two_servo_samples_is_sharp)
{
    static const double rate_Hz[] = {20000, 500};
    const struct step first = {20000, 0, 0, 0};
    const double servo_s = 1 / sim_device_default().servo_hz;
    const double grid_s = respond(first);
    for (int k = 1; k < 40; k++) {
        const double rate = rate_Hz[k % 2], share = k % 3 * 0.5;
        const double due_s = grid_s + k / 2 * servo_s;
        const double late[] = {-1e-9, 1e-9};
        for (int i = 0; i < 2; i++) {
            const double delay_s = due_s + late[i];
            const struct step s = {
                (uint32_t)rate, 0, share * delay_s * rate, (1 - share) * delay_s};
            const double got_s = respond(s), want_s = due_s + i * servo_s;
            CHECK(fabs(got_s - want_s) < 1e-9, "%d: due %.9f s, %s: taken at %.9f", k, due_s,
                i ? "late" : "early", got_s);
        }
    }
}

TEST(a_disabled_drive_gives_no_current)
{
    const struct posix_config c = posix_config_default();
    start(&c, 20000);
    for (int n = 0; n < 1000; n++) {
        CHECK_EQ_I64(exh_board_wait(), 0);
        CHECK(posix_plant()->cur_A == 0, "tick %d: %.3g A", n, posix_plant()->cur_A);
        write_code(12184, 0);
    }
    for (int n = 0; n < 200; n++) {
        CHECK_EQ_I64(exh_board_wait(), 0);
        write_code(12184, 1);
    }
    CHECK(fabs(posix_plant()->cur_A - 6.6) < 1e-3, "enabled: %.6f A", posix_plant()->cur_A);
    exh_board_safe(); /* drops what is on its way, too */
    for (int n = 0; n < 200; n++) { CHECK_EQ_I64(exh_board_wait(), 0); }
    CHECK(posix_plant()->cur_A < 1e-6, "safe: %.3g A", posix_plant()->cur_A);
}

TEST(the_drive_limits_at_its_own_peak)
{
    struct posix_config c = posix_config_default();
    c.device.peak_a = 2;
    for (int sign = -1; sign <= 1; sign += 2) {
        start(&c, 20000);
        for (int n = 0; n < 400; n++) {
            CHECK_EQ_I64(exh_board_wait(), 0);
            write_code(sign * 12184, 1);
        }
        CHECK(fabs(posix_plant()->cur_A - sign * 2) < 1e-6, "%.6f A", posix_plant()->cur_A);
    }
}

/* ---- Monitor --------------------------------------------------------------------- */

TEST(monitor_noise_is_bounded_on_both_sides)
{
    const struct posix_config c = posix_config_default();
    const double lsb_A = c.device.mon_apc;
    double sum = 0;
    int lo = 0, hi = 0;
    start(&c, 2000);
    CHECK_EQ_I64(exh_board_wait(), 0);
    for (int i = 0; i < 100000; i++) {
        const int code = read_codes().mon_raw[0];
        lo = code < lo ? code : lo;
        hi = code > hi ? code : hi;
        sum += code;
    }
    CHECK((hi - lo) * lsb_A <= 0.0472, "%.4f A peak to peak", (hi - lo) * lsb_A);
    CHECK((hi - lo) * lsb_A > 0.6 * 0.0472, "%.4f A peak to peak", (hi - lo) * lsb_A);
    CHECK(hi * lsb_A <= 0.0236 + lsb_A && lo * lsb_A >= -0.0236 - lsb_A, "%d..%d codes", lo, hi);
    /* 13 codes of deviation over 1e5 draws: 5 sigma of the mean is 0.21 codes */
    CHECK(fabs(sum / 100000) < 0.21, "mean %.3f codes", sum / 100000);
}

TEST(monitor_code_is_the_nearest)
{
    static const double scale_A[] = {305.2e-6 / 0.591, 0.01, 1e-4, 1e-6};
    for (size_t i = 0; i < LEN(scale_A); i++) {
        struct posix_config c = posix_config_default();
        int moved = 0;
        c.device.mon_noise_a = 0;
        c.device.mon_apc = scale_A[i];
        start(&c, 20000);
        for (int n = 0; n < 1900; n++) {
            double codes;
            int code;
            CHECK_EQ_I64(exh_board_wait(), 0);
            code = read_codes().mon_raw[0];
            codes = posix_plant()->mon_A / scale_A[i];
            codes = codes > 32767 ? 32767 : codes < -32768 ? -32768 : codes;
            CHECK(fabs(code - codes) <= 0.5 + 1e-9, "scale %.3g: %d, want %.6f", scale_A[i], code,
                codes);
            moved |= 1 << (code < 0) | 4 << (code > 100);
            write_code((n / 300 % 3 - 1) * 12000, 1);
        }
        CHECK(moved & 2 && moved & 1, "scale %.3g: both signs were seen", scale_A[i]);
    }
}

/* ---- Encoder ----------------------------------------------------------------------- */

#define COUNTS (1 << 24)

/* One fall without motor: position and code of every tick into arrays; how many. */
static int record_fall(
    const struct posix_config *c, uint32_t rate_Hz, double *q_m, uint32_t *raw, int cap)
{
    int n = 0;
    start(c, rate_Hz);
    while (exh_board_wait() >= 0 && n < cap) {
        raw[n] = read_codes().enc_raw[0];
        q_m[n++] = posix_plant()->q_m;
    }
    return n;
}

static struct posix_config short_fall(void)
{
    struct posix_config c = posix_config_default();
    c.device.observe_s = 0.6;
    return c;
}

static double fall_q_m[40000];
static uint32_t fall_raw[4][40000];

/* There must be one phase g in 0..1 with code = floor(q decode/step + g + start), all along. */
TEST(encoder_code_is_the_floor)
{
    static const struct {
        double step_m, decode, start;
    } row[] = {{66.32e-6, 1, 0}, {66.32e-6, 1, 8388608}, {66.32e-6, 4, 5}, {480e-6, 2, 16777215.0},
        {10e-6, 1, 16776000}};
    for (size_t i = 0; i < LEN(row); i++) {
        struct posix_config c = short_fall();
        double lo = 0, hi = 1;
        int n;
        c.device.step_m = row[i].step_m;
        c.device.decode = row[i].decode;
        c.device.enc_start = row[i].start;
        n = record_fall(&c, 20000, fall_q_m, fall_raw[0], 40000);
        CHECK(n > 10000, "%d ticks", n);
        for (int k = 0; k < n; k++) {
            const double u = fall_q_m[k] * row[i].decode / row[i].step_m;
            /* the code without the start, signed, nearest to where it must be */
            double code = fall_raw[0][k] - row[i].start;
            CHECK(fall_raw[0][k] < COUNTS, "more than 24 bits: %#x", (unsigned)fall_raw[0][k]);
            while (code - u > COUNTS / 2) { code -= COUNTS; }
            while (code - u < -COUNTS / 2) { code += COUNTS; }
            lo = code - u > lo ? code - u : lo;
            hi = code + 1 - u < hi ? code + 1 - u : hi;
            CHECK(lo <= hi + 1e-6, "row %zu, tick %d: phase %.6f..%.6f", i, k, lo, hi);
        }
        CHECK(hi - lo < 0.1, "row %zu: too few edges to tell: phase %.6f..%.6f", i, lo, hi);
    }
}

TEST(decoding_multiplies_the_counts)
{
    static const int multiplier[] = {1, 2, 4};
    int n = 0;
    for (size_t i = 0; i < 3; i++) {
        struct posix_config c = short_fall();
        c.device.decode = multiplier[i];
        c.device.enc_start = 4000000;
        n = record_fall(&c, 2000, fall_q_m, fall_raw[i], 4000);
    }
    CHECK(n > 1000, "%d ticks", n);
    for (size_t i = 0; i < 3; i++) {
        const int m = multiplier[i];
        for (int k = 0; k < n; k++) {
            const int one = (int)(fall_raw[0][k] - fall_raw[0][0]);
            const int many = (int)(fall_raw[i][k] - fall_raw[i][0]);
            CHECK(many > m * (one - 1) && many < m * (one + 1), "x%d, tick %d: %d counts, x1 %d", m,
                k, many, one);
        }
    }
    CHECK(fall_raw[0][n - 1] - fall_raw[0][0] > 1000, "hardly moved");
}

/* ---- Ticks ----------------------------------------------------------------------------- */

/* n num/den rounded once; checked without dividing. */
TEST(every_tick_lands_on_its_instant)
{
    static const struct exh_period T[] = {{597, 1193182}, {1, 1}, {1, 7}, {1, 90}, {1, 2000},
        {1, 20000}, {13258, 1193182}, {60, 1193182}, {999999999, 2000000000}};
    for (size_t i = 0; i < LEN(T); i++) {
        struct posix_config c = posix_config_default();
        uint64_t n = 0;
        c.T = T[i];
        c.falls = 3;
        start(&c, 1);
        for (; exh_board_wait() >= 0; n++) {
            const long double exact = (long double)n * T[i].num;
            const long double off = (long double)posix_time_s() * (long double)T[i].den - exact;
            CHECK((off < 0 ? -off : off) <= exact * 0x1p-53L, "%lu/%lu, tick %lu: off by %.3g s",
                (unsigned long)T[i].num, (unsigned long)T[i].den, (unsigned long)n,
                (double)(off / T[i].den));
        }
        CHECK(n > 15 * (uint64_t)T[i].den / T[i].num, "only %lu ticks", (unsigned long)n);
    }
}

TEST(the_run_ends_where_it_was_told)
{
    struct posix_config c = posix_config_default();
    c.max_ticks = 321;
    start(&c, 2000);
    for (int n = 0; n < 321; n++) { CHECK_EQ_I64(exh_board_wait(), 0); }
    CHECK(exh_board_wait() < 0, "goes on beyond max_ticks");
    c.max_ticks = 0;
    start(&c, 2000);
    for (int n = 0; n < 321; n++) { CHECK_EQ_I64(exh_board_wait(), 0); }
    posix_stop();
    CHECK(exh_board_wait() < 0, "goes on after posix_stop()");
}

/* Compared without a division, which would let 10/200009 s pass for 20000 Hz. */
TEST(periods_outside_the_range_are_refused)
{
    static const struct {
        struct exh_period T;
        int ok;
    } row[] = {{{1, 1}, 1}, {{1, 20000}, 1}, {{597, 1193182}, 1}, {{10, 200000}, 1},
        {{214749, 4294967295u}, 1}, {{10, 200001}, 0}, {{10, 200009}, 0}, {{1, 20001}, 0},
        {{214748, 4294967295u}, 0}, {{1, 4294967295u}, 0}, {{2, 1}, 0},
        {{4294967295u, 4294967294u}, 0}};
    for (size_t i = 0; i < LEN(row); i++) {
        struct posix_config c = posix_config_default();
        struct exh_period T;
        c.T = row[i].T;
        posix_configure(&c);
        CHECK(exh_board_init(1000, &T) == (row[i].ok ? 0 : -EXH_E_RATE), "%lu/%lu",
            (unsigned long)c.T.num, (unsigned long)c.T.den);
    }
}

/* Whatever the rate: the controller sees the whole observation, and a tick between. */
TEST(every_fall_is_watched_to_its_end)
{
    static const struct exh_period T[] = {{1, 1}, {3, 4}, {2, 3}, {1, 2}, {1, 3}, {2, 7}, {1, 5},
        {1, 7}, {1, 9}, {1, 10}, {1, 90}, {1, 2000}};
    for (size_t i = 0; i < LEN(T); i++) {
        struct run_cfg c = {.rate_Hz = 1, .k_Npm = 1500};
        struct fall_contacts contacts;
        struct fall_rest rest[8];
        struct run r;
        c.board = posix_config_default();
        c.board.falls = 8;
        c.board.T = T[i];
        CHECK_EQ_I64(run_drop(&c, &r), 0);
        CHECK(r.log.falls == 8, "%zu falls", r.log.falls);
        CHECK(fall_dissect(&r.log, 1, &contacts) == FALL_OK, "row %zu", i);
        CHECK(fall_rest(&r.log, &contacts, &fall_rest_opt_default, rest) == FALL_OK, "row %zu", i);
        for (size_t f = 0; f < 8; f++) {
            const double gap_s =
                f ? r.log.sample[r.log.start[f]].t_s - r.log.sample[r.log.start[f] - 1].t_s : 9;
            CHECK(rest[f].rest != FALL_INCOMPLETE, "row %zu, fall %zu", i, f);
            CHECK(gap_s * T[i].den > 1.5 * T[i].num, "row %zu, fall %zu: no tick before it", i, f);
        }
        fall_contacts_free(&contacts);
        run_free(&r);
    }
}

/* In a separate process, since there is no way back. */
TEST(an_interruption_outlasts_a_new_run)
{
    const pid_t pid = fork();
    int status = 1;
    CHECK(pid >= 0, "no process");
    if (pid == 0) {
        const struct posix_config c = posix_config_default();
        struct exh_period T;
        int bad = 0;
        posix_configure(&c);
        bad |= exh_board_init(2000, &T) != 0 || exh_board_wait() != 0;
        posix_stop(); /* this run alone */
        bad |= exh_board_wait() >= 0;
        bad |= exh_board_init(2000, &T) != 0 || exh_board_wait() != 0 || posix_interrupted();
        posix_interrupt();
        bad |= exh_board_wait() >= 0;
        bad |= exh_board_init(2000, &T) != 0 || exh_board_wait() >= 0 || !posix_interrupted();
        _exit(bad);
    }
    CHECK(waitpid(pid, &status, 0) == pid && status == 0, "status %#x", (unsigned)status);
}

/* 24 V through 1:4, and 0.1 V less for each ampere; a dead supply is 0. */
TEST(the_supply_falls_with_the_current)
{
    struct posix_config c = posix_config_default();
    int16_t idle, loaded;
    (void)start(&c, 1000);
    CHECK_EQ_I64(exh_board_wait(), 0);
    idle = read_codes().supply_raw;
    CHECK_EQ_I64(idle, 19661);
    for (int n = 0; n < 5; n++) { /* 2 A */
        write_code(3692, 1);
        CHECK_EQ_I64(exh_board_wait(), 0);
    }
    loaded = read_codes().supply_raw;
    CHECK(idle - loaded >= 163 && idle - loaded <= 165, "%d codes less", idle - loaded);
    c.device.rail_v = 0;
    (void)start(&c, 1000);
    CHECK_EQ_I64(exh_board_wait(), 0);
    CHECK_EQ_I64(read_codes().supply_raw, 0);
}

TEST_MAIN("board_sim", a_step_acts_at_the_first_sample_after_its_delay,
    the_edge_between_two_servo_samples_is_sharp, a_disabled_drive_gives_no_current,
    the_drive_limits_at_its_own_peak, monitor_noise_is_bounded_on_both_sides,
    monitor_code_is_the_nearest, encoder_code_is_the_floor, decoding_multiplies_the_counts,
    every_tick_lands_on_its_instant, the_run_ends_where_it_was_told,
    periods_outside_the_range_are_refused, the_supply_falls_with_the_current,
    every_fall_is_watched_to_its_end, an_interruption_outlasts_a_new_run);
