/* SPDX-License-Identifier: MIT */
/* glove.h, the tick: codes to angles, what is believed, faults and their end. */
#include "exhand/glove.h"

#include "exhand/error.h"
#include "exhand/fix.h"

#include "check.h"

#define ALL ((1u << EXH_GLOVE_SENSORS) - 1u)

struct fixture {
    struct exh_glove_par par;
    struct exh_glove_cal cal;
    struct exh_glove_cfg cfg;
    struct exh_glove s;
    struct exh_glove_in in;
    int32_t angle[EXH_GLOVE_SENSORS];
};

static struct exh_glove_par defaults(void)
{
    const struct exh_signal *r = exh_glove_rows;
    const struct exh_glove_par par = {r[0].dflt, r[1].dflt, r[2].dflt, r[3].dflt, r[4].dflt,
        r[5].dflt, r[6].dflt, r[7].dflt, r[8].dflt};
    return par;
}

static const struct exh_period kilohertz = {1, 1000};

/* Every sensor: 0 degrees at code 1000, 2^-16 turn a code, calibrated -4000 .. 6000; no
 * filter, 16 bits, no hysteresis: angles are exact. */
static void set_up(struct fixture *f)
{
    memset(f, 0, sizeof *f);
    f->par = defaults();
    f->par.order = 0;
    f->par.bits = 16;
    f->par.hyst_raw_q16 = 0;
    f->cal = (struct exh_glove_cal){.valid_days = 1, .present = ALL};
    for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
        f->cal.sensor[i] = (struct exh_glove_sensor){1000 * 32768, INT32_C(1) << (38 - 16), {0, 0},
            -4000, 6000, {EXH_GLOVE_NONE, EXH_GLOVE_NONE}};
        f->in.raw[i] = 1000;
    }
}

static void ready(struct fixture *f)
{
    CHECK_EQ_I64(exh_glove_setup(&f->cfg, &f->par, &f->cal, kilohertz), 0);
}

static uint32_t frame(struct fixture *f)
{
    return exh_glove_step(&f->s, &f->cfg, &f->in, f->angle);
}

TEST(codes_become_angles)
{
    static const struct {
        int16_t raw;
        int32_t turn_q32;
    } row[] = {{1000, 0}, {1001, 65536}, {999, -65536}, {0, -65536000}, {6000, 327680000},
        {-4000, -327680000}};
    struct fixture f;
    set_up(&f);
    ready(&f);
    for (size_t k = 0; k < LEN(row); k++) {
        for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) { f.in.raw[i] = row[k].raw; }
        CHECK_EQ_I64(frame(&f), 0);
        for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
            CHECK(f.angle[i] == row[k].turn_q32, "sensor %u code %d: %" PRId32, i, row[k].raw,
                f.angle[i]);
        }
    }
}

TEST(a_gain_below_zero_falls)
{
    struct fixture f;
    set_up(&f);
    f.cal.sensor[10].gain_turnpraw_q38 = -(INT32_C(1) << 22);
    ready(&f);
    f.in.raw[10] = f.in.raw[11] = 1100;
    (void)frame(&f);
    CHECK_EQ_I64(f.angle[10], -6553600);
    CHECK_EQ_I64(f.angle[11], 6553600);
}

/* 1/128 turn a code is half a turn within 64 codes; a joint does not wrap. */
TEST(angles_saturate_at_half_a_turn)
{
    struct fixture f;
    set_up(&f);
    for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
        f.cal.sensor[i].gain_turnpraw_q38 = i & 1 ? -INT32_MAX : INT32_MAX;
    }
    ready(&f);
    for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) { f.in.raw[i] = 6000; }
    (void)frame(&f);
    CHECK_EQ_I64(f.angle[0], INT32_MAX);
    CHECK_EQ_I64(f.angle[1], INT32_MIN);
    for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) { f.in.raw[i] = -4000; }
    (void)frame(&f);
    CHECK_EQ_I64(f.angle[0], INT32_MIN);
    CHECK_EQ_I64(f.angle[1], INT32_MAX);
}

TEST(abductions_lose_what_knuckles_add)
{
    struct fixture f;
    set_up(&f);
    f.cal.sensor[10].of[0] = 4;
    f.cal.sensor[10].of[1] = 7;
    f.cal.sensor[10].cross_q30[0] = -(INT32_C(1) << 28); /* -1/4 */
    f.cal.sensor[10].cross_q30[1] = INT32_C(1) << 29;    /* 1/2 */
    f.cal.sensor[18].of[1] = 15;
    f.cal.sensor[18].cross_q30[1] = INT32_MIN; /* -2 */
    ready(&f);
    f.in.raw[4] = 1000 + 80;
    f.in.raw[7] = 1000 - 30;
    f.in.raw[10] = 1000 + 7;
    f.in.raw[15] = 6000;
    f.in.raw[18] = 6000;
    (void)frame(&f);
    CHECK_EQ_I64(f.angle[10], (7 - 80 / 4 - 30 / 2) * 65536);
    CHECK_EQ_I64(f.angle[4], 80 * 65536);
    CHECK_EQ_I64(f.angle[7], -30 * 65536);
    CHECK_EQ_I64(f.angle[18], -5000 * 65536);
}

/* No code makes a sensor faulty that the glove does not have. Cross terms may compute its angle:
 * the last joint of a finger from the middle one. */
TEST(absent_sensors_have_no_faults)
{
    static const int16_t raw[] = {INT16_MIN, INT16_MAX, 0};
    struct fixture f;
    set_up(&f);
    f.cal.present &= ~(1u << 6);
    f.cal.sensor[6] =
        (struct exh_glove_sensor){0, 0, {INT32_C(1) << 29, 0}, 0, 0, {5, EXH_GLOVE_NONE}};
    ready(&f);
    f.in.raw[5] = 3000;
    for (size_t k = 0; k < LEN(raw); k++) {
        f.in.raw[6] = raw[k];
        CHECK_EQ_I64(frame(&f), 0);
        CHECK_EQ_I64(f.angle[6], 1000 * 65536);
    }
}

/* --- faults --- */

/* Margin 1/2 of the span of 10000: -9000 .. 11000 is believed. */
TEST(causes_are_told_apart)
{
    static const struct {
        int16_t raw;
        int open_high;
        uint8_t cause;
    } row[] = {
        {-9000, 1, EXH_GLOVE_GOOD},
        {-9001, 1, EXH_GLOVE_OUTSIDE},
        {11000, 1, EXH_GLOVE_GOOD},
        {11001, 1, EXH_GLOVE_OUTSIDE},
        {-31999, 1, EXH_GLOVE_OUTSIDE},
        {31999, 1, EXH_GLOVE_OUTSIDE},
        {-32000, 1, EXH_GLOVE_SHORT},
        {32000, 1, EXH_GLOVE_OPEN},
        {INT16_MIN, 1, EXH_GLOVE_SHORT},
        {INT16_MAX, 1, EXH_GLOVE_OPEN},
        {-32000, 0, EXH_GLOVE_OPEN},
        {32000, 0, EXH_GLOVE_SHORT},
    };
    for (size_t k = 0; k < LEN(row); k++) {
        struct fixture f;
        set_up(&f);
        f.par.open_high = row[k].open_high;
        ready(&f);
        (void)frame(&f);
        f.in.raw[3] = row[k].raw;
        for (int n = 0; n < 3; n++) { (void)frame(&f); }
        CHECK(f.s.cause[3] == row[k].cause, "code %d: %s", row[k].raw,
            exh_glove_cause_text(f.s.cause[3]));
        CHECK_EQ_I64(frame(&f), row[k].cause == EXH_GLOVE_GOOD ? 0 : 1 << 3);
        CHECK_EQ_I64(f.s.faults[3], row[k].cause != EXH_GLOVE_GOOD);
    }
}

TEST(a_fault_begins_and_ends_with_the_third_frame)
{
    struct fixture f;
    set_up(&f);
    ready(&f);
    f.in.raw[0] = f.in.raw[21] = 1500;
    (void)frame(&f);
    f.in.raw[21] = INT16_MAX;
    for (int n = 1; n <= 5; n++) {
        CHECK(frame(&f) == (n >= 3 ? 1u << 21 : 0), "bad frame %d", n);
        CHECK_EQ_I64(f.angle[21], 500 * 65536); /* what it was, from the first on */
        f.in.raw[0]++;
        CHECK_EQ_I64(f.angle[0], (500 + n - 1) * 65536); /* the others go on */
    }
    f.in.raw[21] = 2000;
    for (int n = 1; n <= 4; n++) {
        CHECK(frame(&f) == (n < 3 ? 1u << 21 : 0), "good frame %d", n);
        CHECK_EQ_I64(f.angle[21], n < 3 ? 500 * 65536 : 1000 * 65536);
    }
    CHECK_EQ_I64(f.s.faults[21], 1);
    CHECK_EQ_I64(f.s.cause[21], EXH_GLOVE_GOOD);
}

/* Good and bad in turn: neither is believed for long enough to change anything. */
TEST(a_loose_contact_keeps_its_state)
{
    struct fixture f;
    set_up(&f);
    ready(&f);
    (void)frame(&f);
    for (int n = 0; n < 20; n++) { /* two bad of three: still good */
        f.in.raw[8] = n % 3 ? INT16_MIN : 1000;
        CHECK_EQ_I64(frame(&f), 0);
    }
    f.in.raw[8] = INT16_MIN;
    for (int n = 0; n < 3; n++) { (void)frame(&f); }
    for (int n = 0; n < 20; n++) { /* two good of three: still faulty */
        f.in.raw[8] = n % 3 ? 1300 : INT16_MIN;
        CHECK_EQ_I64(frame(&f), 1 << 8);
        CHECK_EQ_I64(f.angle[8], 0);
    }
    CHECK_EQ_I64(f.s.faults[8], 1);
}

TEST(the_latest_cause_stands)
{
    struct fixture f;
    set_up(&f);
    ready(&f);
    (void)frame(&f);
    f.in.raw[2] = INT16_MIN;
    for (int n = 0; n < 3; n++) { (void)frame(&f); }
    CHECK_EQ_I64(f.s.cause[2], EXH_GLOVE_SHORT);
    f.in.raw[2] = 20000;
    (void)frame(&f);
    CHECK_EQ_I64(f.s.cause[2], EXH_GLOVE_OUTSIDE);
    CHECK_EQ_I64(f.s.faults[2], 1); /* the same fault */
}

TEST(faults_are_counted_up_to_65535)
{
    struct fixture f;
    set_up(&f);
    f.par.debounce_frames = 1;
    ready(&f);
    (void)frame(&f);
    for (int32_t n = 1; n <= 65540; n++) {
        f.in.raw[0] = INT16_MIN;
        CHECK(frame(&f) == 1, "fault %" PRId32, n);
        CHECK(f.s.faults[0] == (n < 65535 ? n : 65535), "fault %" PRId32, n);
        f.in.raw[0] = 1000;
        CHECK(frame(&f) == 0, "fault %" PRId32, n);
    }
}

/* No frame was good before the first one, so a fault counts immediately. The code is that of angle
 * 0, or the end of the span next to it. */
TEST(a_channel_may_start_faulty)
{
    struct fixture f;
    set_up(&f);
    f.cal.sensor[1].zero_raw_q15 = 9000 * 32768;
    f.cal.sensor[2].zero_raw_q15 = -9000 * 32768;
    ready(&f);
    f.in.raw[0] = f.in.raw[1] = f.in.raw[2] = INT16_MAX;
    CHECK_EQ_I64(frame(&f), 7);
    CHECK_EQ_I64(f.angle[0], 0);
    CHECK_EQ_I64(f.angle[1], -3000 * 65536);
    CHECK_EQ_I64(f.angle[2], 5000 * 65536);
    CHECK_EQ_I64(f.s.cause[0], EXH_GLOVE_OPEN);
    CHECK_EQ_I64(f.s.faults[0], 1);
    f.in.raw[0] = 1200;
    CHECK_EQ_I64(frame(&f), 7);
    CHECK_EQ_I64(frame(&f), 7);
    CHECK_EQ_I64(frame(&f), 6);
    CHECK_EQ_I64(f.angle[0], 200 * 65536);
}

/* The rails stay what they are however far the margin reaches. */
TEST(no_margin_reaches_a_rail)
{
    static const struct {
        int16_t raw;
        uint8_t cause;
    } row[] = {{-32000, EXH_GLOVE_SHORT}, {-31999, EXH_GLOVE_GOOD}, {32000, EXH_GLOVE_OPEN},
        {31999, EXH_GLOVE_GOOD}};
    for (size_t k = 0; k < LEN(row); k++) {
        struct fixture f;
        set_up(&f);
        f.par.margin_q16 = 8 * 65536;
        ready(&f);
        f.in.raw[3] = row[k].raw;
        (void)frame(&f);
        CHECK(f.s.cause[3] == row[k].cause, "code %d: %s", row[k].raw,
            exh_glove_cause_text(f.s.cause[3]));
    }
}

/* --- with the filter --- */

/* Low-pass, quantizer and line by hand, at both orders and without. */
TEST(the_chain_is_filter_quantizer_line)
{
    for (int order = 0; order <= 2; order++) {
        struct fixture f;
        struct exh_filter_cfg low;
        struct exh_quantizer_cfg codes;
        struct exh_filter state;
        struct exh_quantizer kept;
        set_up(&f);
        f.par = defaults();
        f.par.order = order;
        ready(&f);
        memset(&state, 0, sizeof state);
        memset(&kept, 0, sizeof kept);
        CHECK_EQ_I64(exh_quantizer_setup(&codes, &(struct exh_quantizer_par){11, 20 * 65536}), 0);
        if (order > 0) {
            const struct exh_filter_par par = {order, 30 * 65536};
            CHECK_EQ_I64(exh_filter_setup(&low, &par, kilohertz), 0);
        }
        for (int n = 0; n < 500; n++) {
            int32_t x = check_i32_in(-9000, 11000) * 65536;
            f.in.raw[12] = (int16_t)(x / 65536);
            CHECK_EQ_I64(frame(&f), 0);
            if (order > 0 && n == 0) { exh_filter_reset(&state, &x, 1); }
            if (order > 0) { exh_filter_step(&state, &low, &x, &x, 1); }
            x = exh_quantizer_step(&kept, &codes, x);
            CHECK(f.angle[12] == x - 1000 * 65536, "order %d frame %d", order, n);
        }
    }
}

TEST(the_first_frame_settles)
{
    struct fixture f;
    set_up(&f);
    f.par = defaults();
    ready(&f);
    for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
        f.in.raw[i] = (int16_t)(320 * (int)i - 3200);
    }
    for (int n = 0; n < 5; n++) {
        (void)frame(&f);
        for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) { /* multiples of Q = 32 codes */
            CHECK(f.angle[i] == (f.in.raw[i] - 1000) * 65536, "sensor %u frame %d", i, n);
        }
    }
}

/* The same movement with and without a spike of two frames in another code. No bit differs before
 * the spike. None differs once the hand was at rest for as long. */
TEST(a_spike_leaves_no_trace)
{
    struct fixture f, g;
    set_up(&f);
    f.par = defaults();
    f.par.bits = 24;
    f.par.hyst_raw_q16 = 0;
    ready(&f);
    g = f;
    g.cfg.cal = &g.cal;
    for (int n = 0; n < 400; n++) {
        const int at = n < 100 ? n * 20 : n < 110 ? 2000 : 2000 - (n - 110) * 15;
        f.in.raw[5] = g.in.raw[5] = (int16_t)at;
        if (n == 104 || n == 105) { g.in.raw[5] = n == 104 ? INT16_MAX : INT16_MIN; }
        CHECK_EQ_I64(frame(&f), 0);
        CHECK_EQ_I64(frame(&g), 0);
        CHECK(memcmp(f.angle, g.angle, sizeof f.angle) == 0, "frame %d", n);
    }
}

/* Held in a fault, it comes back as the filter's answer to a step: no faster than the filter
 * lets any movement through, and no farther beyond than its overshoot. */
TEST(after_a_fault_the_angle_glides)
{
    struct fixture f;
    int32_t before, most = 0, last;
    set_up(&f);
    f.par = defaults();
    f.par.bits = 20;
    f.par.hyst_raw_q16 = 0;
    ready(&f);
    for (int n = 0; n < 50; n++) { (void)frame(&f); }
    before = f.angle[9];
    f.in.raw[9] = INT16_MAX;
    for (int n = 0; n < 500; n++) {
        (void)frame(&f);
        CHECK(f.angle[9] == before, "held, frame %d", n);
    }
    f.in.raw[9] = 5000;
    last = before;
    for (int n = 0; n < 500; n++) {
        const uint32_t bad = frame(&f);
        const int32_t moved = exh_wrap_diff(f.angle[9], last);
        CHECK((bad != 0) == (n < 2), "frame %d", n);
        CHECK(moved < 4000 * 65536 / 8, "a jump at frame %d: %" PRId32, n, moved);
        most = f.angle[9] > most ? f.angle[9] : most;
        last = f.angle[9];
    }
    CHECK_EQ_I64(last, 4000 * 65536);
    CHECK(most < 4000 * 65536 / 100 * 105, "overshoot: %" PRId32, most);
}

/* The paper's noise, 6.1 mV = 20 codes peak to peak, is no more than the default hysteresis. So at
 * any level an angle moves at most once, to its final value. */
TEST(noise_within_the_hysteresis_moves_no_angle_twice)
{
    for (int order = 0; order <= 2; order++) {
        struct fixture f;
        int32_t last[EXH_GLOVE_SENSORS];
        int moves[EXH_GLOVE_SENSORS] = {0};
        set_up(&f);
        f.par = defaults();
        f.par.order = order;
        ready(&f);
        for (int n = 0; n < 3000; n++) {
            for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
                f.in.raw[i] = (int16_t)(1000 + 3 * (int)i + check_i32_in(-10, 10));
            }
            CHECK_EQ_I64(frame(&f), 0);
            for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
                moves[i] += n > 0 && f.angle[i] != last[i];
                CHECK(moves[i] <= 1, "order %d sensor %u frame %d", order, i, n);
            }
            memcpy(last, f.angle, sizeof last);
        }
    }
}

/* --- set-up --- */

TEST(default_calibration_runs_at_the_default)
{
    static const struct exh_period T[] = {
        {1, 90}, {1, 100}, {1, 200}, {1, 500}, {1, 1000}, {1, 2000}, {1, 20000}};
    const struct exh_glove_par par = defaults();
    struct exh_glove_cfg cfg;
    for (size_t k = 0; k < LEN(T); k++) {
        CHECK(exh_glove_setup(&cfg, &par, &exh_glove_cal_default, T[k]) == 0, "row %zu", k);
    }
}

/* End points of the published file: their codes give their angles, to the code that the
 * ends are rounded to. */
TEST(default_calibration_gives_its_end_points)
{
    static const struct {
        unsigned sensor;
        int32_t milli, deg;
    } row[] = {{0, 335, -60}, {0, 697, 60}, {3, 791, 0}, {3, 350, 50}, {4, 429, 0}, {4, 654, 90},
        {9, 0, 0}, {9, 323, 90}, {10, 468, 0}, {10, 390, 50}, {20, 154, -30}, {20, 622, 40},
        {21, 925, -30}, {21, 236, 10}};
    struct exh_glove_par par = defaults();
    par.order = 0;
    par.bits = 16;
    par.hyst_raw_q16 = 0;
    for (size_t k = 0; k < LEN(row); k++) {
        const struct exh_glove_sensor *cal = &exh_glove_cal_default.sensor[row[k].sensor];
        const int32_t code = (int32_t)((2 * row[k].milli - 1000) * INT64_C(294912) / 10000);
        struct exh_glove_cfg cfg;
        struct exh_glove s;
        struct exh_glove_in in = {{0}, 0};
        int32_t angle[EXH_GLOVE_SENSORS], off;
        const int32_t step =
            (int32_t)((cal->gain_turnpraw_q38 < 0 ? -(int64_t)cal->gain_turnpraw_q38
                                                  : cal->gain_turnpraw_q38) >>
                      6);
        memset(&s, 0, sizeof s);
        in.raw[row[k].sensor] = (int16_t)code;
        CHECK_EQ_I64(exh_glove_setup(&cfg, &par, &exh_glove_cal_default, kilohertz), 0);
        (void)exh_glove_step(&s, &cfg, &in, angle);
        off = exh_wrap_diff(angle[row[k].sensor], (int32_t)(row[k].deg * (INT64_C(1) << 32) / 360));
        CHECK(off <= step && off >= -step,
            "%s at %" PRId32 " deg: %" PRId32 " off, a code is %" PRId32,
            exh_glove_sensor_text(row[k].sensor), row[k].deg, off, step);
    }
}

TEST(setup_rejections)
{
    struct fixture f;
    struct exh_glove_par good;
    int32_t *field[EXH_GLOVE_ROWS];
    set_up(&f);
    f.par = good = defaults();
    field[0] = &f.par.order;
    field[1] = &f.par.fc_Hz_q16;
    field[2] = &f.par.bits;
    field[3] = &f.par.hyst_raw_q16;
    field[4] = &f.par.low_raw;
    field[5] = &f.par.high_raw;
    field[6] = &f.par.open_high;
    field[7] = &f.par.debounce_frames;
    field[8] = &f.par.margin_q16;
    ready(&f);
    for (size_t i = 0; i < EXH_GLOVE_ROWS; i++) {
        f.par = good;
        *field[i] = exh_glove_rows[i].min - 1;
        CHECK(exh_glove_setup(&f.cfg, &f.par, &f.cal, kilohertz) == -EXH_E_RANGE, "%s too low",
            exh_glove_rows[i].name);
        *field[i] = exh_glove_rows[i].max + 1;
        CHECK(exh_glove_setup(&f.cfg, &f.par, &f.cal, kilohertz) == -EXH_E_RANGE, "%s too high",
            exh_glove_rows[i].name);
    }
    f.par = good;
    f.par.low_raw = f.par.high_raw;
    CHECK(exh_glove_setup(&f.cfg, &f.par, &f.cal, kilohertz) == -EXH_E_RANGE, "rails exchanged");
    f.par = good;
    f.par.high_raw = 6000; /* a calibrated code would be a fault */
    CHECK(exh_glove_setup(&f.cfg, &f.par, &f.cal, kilohertz) == -EXH_E_RANGE, "a rail in the span");
    f.par.high_raw = 6001;
    CHECK_EQ_I64(exh_glove_setup(&f.cfg, &f.par, &f.cal, kilohertz), 0);
    f.par.low_raw = -4000;
    CHECK(exh_glove_setup(&f.cfg, &f.par, &f.cal, kilohertz) == -EXH_E_RANGE, "a rail in the span");
    f.par = good;
    CHECK(exh_glove_setup(&f.cfg, &f.par, &f.cal, (struct exh_period){1, 60}) == -EXH_E_CUTOFF,
        "30 Hz at 60 Hz");
    CHECK_EQ_I64(exh_glove_setup(&f.cfg, &f.par, &f.cal, (struct exh_period){1, 61}), 0);
    f.par.order = 0; /* no filter: any rate */
    CHECK_EQ_I64(exh_glove_setup(&f.cfg, &f.par, &f.cal, (struct exh_period){1, 10}), 0);
    f.cal.present = 0;
    CHECK(exh_glove_setup(&f.cfg, &f.par, &f.cal, kilohertz) == -EXH_E_RANGE, "nothing loaded");
}

/* --- state --- */

/* Saved in the middle of everything, restored into another: both go on alike. */
TEST(state_round_trip)
{
    struct fixture f;
    struct exh_glove back;
    uint8_t buf[2048];
    struct exh_bytes c = exh_bytes_writer(buf, sizeof buf);
    set_up(&f);
    f.par = defaults();
    ready(&f);
    for (int n = 0; n < 60; n++) {
        for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
            f.in.raw[i] = (int16_t)check_i32_in(-12000, 12000);
        }
        (void)frame(&f);
    }
    exh_glove_serialize(&c, &f.s);
    CHECK(exh_bytes_ok(&c), "%" PRIu32 " bytes", c.at);
    memset(&back, 0, sizeof back);
    c = exh_bytes_reader(buf, c.at);
    exh_glove_serialize(&c, &back);
    CHECK(exh_bytes_ok(&c), "reader");
    for (int n = 0; n < 60; n++) {
        int32_t angle[EXH_GLOVE_SENSORS];
        for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
            f.in.raw[i] = (int16_t)check_i32_in(-12000, 12000);
        }
        CHECK_EQ_I64(frame(&f), exh_glove_step(&back, &f.cfg, &f.in, angle));
        CHECK(memcmp(angle, f.angle, sizeof angle) == 0, "frame %d", n);
        CHECK(memcmp(back.cause, f.s.cause, sizeof back.cause) == 0 &&
                  memcmp(back.run, f.s.run, sizeof back.run) == 0 &&
                  memcmp(back.faults, f.s.faults, sizeof back.faults) == 0,
            "frame %d", n);
    }
}

TEST(damaged_state_finds_back)
{
    struct fixture f;
    uint8_t buf[2048];
    set_up(&f);
    ready(&f);
    for (int k = 0; k < 4; k++) {
        struct exh_bytes c = exh_bytes_reader(buf, sizeof buf);
        for (size_t i = 0; i < sizeof buf; i++) {
            buf[i] = k == 0 ? 0xFF : k == 1 ? 0x80 : (uint8_t)check_u64();
        }
        exh_glove_serialize(&c, &f.s);
        for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
            CHECK(f.s.cause[i] < EXH_GLOVE_CAUSES, "cause %d", f.s.cause[i]);
        }
        for (int n = 0; n < 4; n++) { (void)frame(&f); }
        for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) { CHECK_EQ_I64(f.angle[i], 0); }
        CHECK_EQ_I64(frame(&f), 0);
    }
}

/* Nothing of a state that says it has not begun is taken on. */
TEST(a_state_that_has_not_begun_is_empty)
{
    struct fixture f;
    set_up(&f);
    ready(&f);
    f.in.raw[0] = INT16_MAX;
    (void)frame(&f);
    memset(f.s.run, 2, sizeof f.s.run);
    f.s.started = 0;
    f.in.raw[0] = 1500;
    CHECK_EQ_I64(frame(&f), 0);
    CHECK_EQ_I64(f.s.faults[0], 0);
    for (int n = 0; n < 2; n++) {
        f.in.raw[1] = INT16_MAX;
        CHECK_EQ_I64(frame(&f), 0);
    }
    CHECK_EQ_I64(frame(&f), 2);
}

TEST(every_cause_has_a_word)
{
    for (unsigned i = 0; i <= EXH_GLOVE_CAUSES; i++) {
        CHECK(check_same_text(exh_glove_cause_text(i), "unknown") == (i == EXH_GLOVE_CAUSES), "%u",
            i);
    }
}

/* Any sensor may lose what another adds, the first and the last as well. */
TEST(the_first_and_the_last_have_cross_terms)
{
    struct fixture f;
    set_up(&f);
    f.cal.sensor[0].of[0] = 1;
    f.cal.sensor[0].cross_q30[0] = INT32_C(1) << 29;
    f.cal.sensor[EXH_GLOVE_SENSORS - 1].of[1] = 1;
    f.cal.sensor[EXH_GLOVE_SENSORS - 1].cross_q30[1] = -(INT32_C(1) << 29);
    ready(&f);
    f.in.raw[1] = 1000 + 80;
    (void)frame(&f);
    CHECK_EQ_I64(f.angle[0], 40 * 65536);
    CHECK_EQ_I64(f.angle[EXH_GLOVE_SENSORS - 1], -40 * 65536);
}

/* A cross term in the second place counts alone. A sensor without terms is not computed. */
TEST(a_second_cross_term_alone)
{
    struct fixture f;
    int32_t angle[64] = {0};
    set_up(&f);
    ready(&f);
    CHECK_EQ_I64(f.cfg.crosses, 0);
    f.cal.sensor[5].of[1] = 2;
    f.cal.sensor[5].cross_q30[1] = INT32_C(1) << 29;
    ready(&f);
    CHECK(f.cfg.crosses == 1 && f.cfg.crossed[0] == 5, "%u of %u", (unsigned)f.cfg.crossed[0],
        (unsigned)f.cfg.crosses);
    f.in.raw[2] = 1100;
    (void)frame(&f);
    CHECK(f.angle[5] == 3276800 && f.angle[2] == 6553600, "%" PRId32, f.angle[5]);
    f.cal.sensor[5].of[0] = 40; /* damaged memory: no sensor has this number */
    f.cal.sensor[5].cross_q30[0] = INT32_C(1) << 29;
    angle[40] = INT32_C(1) << 28;
    (void)exh_glove_step(&f.s, &f.cfg, &f.in, angle);
    CHECK_EQ_I64(angle[5], 3276800);
}

/* Spread over any parts, a frame has the same angles, faults and state. */
TEST(a_frame_in_parts_is_the_same)
{
    struct fixture whole, parts;
    uint8_t bytes[2][2048];
    set_up(&whole);
    whole.par = defaults();
    whole.cal.sensor[3] =
        (struct exh_glove_sensor){0, 1 << 22, {1 << 29, -(1 << 28)}, -4000, 6000, {2, 4}};
    ready(&whole);
    parts = whole;
    for (int n = 0; n < 300; n++) {
        const unsigned first = (unsigned)check_i32_in(0, EXH_GLOVE_SENSORS);
        for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
            whole.in.raw[i] = (int16_t)check_i32_in(-12000, 14000);
        }
        CHECK_EQ_I64(
            exh_glove_believe(&parts.s, &whole.cfg, &whole.in, parts.angle), frame(&whole));
        exh_glove_angles(&parts.s, &whole.cfg, first, EXH_GLOVE_SENSORS, parts.angle);
        exh_glove_angles(&parts.s, &whole.cfg, 0, first, parts.angle);
        exh_glove_cross(&whole.cfg, parts.angle);
        CHECK(memcmp(parts.angle, whole.angle, sizeof whole.angle) == 0, "frame %d", n);
        for (int k = 0; k < 2; k++) {
            struct exh_bytes c = exh_bytes_writer(bytes[k], sizeof bytes[k]);
            memset(bytes[k], 0, sizeof bytes[k]);
            exh_glove_serialize(&c, k == 0 ? &whole.s : &parts.s);
            CHECK(exh_bytes_ok(&c), "no room");
        }
        CHECK(memcmp(bytes[0], bytes[1], sizeof bytes[0]) == 0, "frame %d: state", n);
    }
}

TEST_MAIN("unit/glove", codes_become_angles, a_gain_below_zero_falls,
    angles_saturate_at_half_a_turn, abductions_lose_what_knuckles_add,
    absent_sensors_have_no_faults, causes_are_told_apart,
    a_fault_begins_and_ends_with_the_third_frame, a_loose_contact_keeps_its_state,
    the_latest_cause_stands, faults_are_counted_up_to_65535, a_channel_may_start_faulty,
    no_margin_reaches_a_rail, the_chain_is_filter_quantizer_line, the_first_frame_settles,
    a_spike_leaves_no_trace, after_a_fault_the_angle_glides,
    noise_within_the_hysteresis_moves_no_angle_twice, default_calibration_runs_at_the_default,
    default_calibration_gives_its_end_points, setup_rejections, state_round_trip,
    damaged_state_finds_back, a_state_that_has_not_begun_is_empty, every_cause_has_a_word,
    the_first_and_the_last_have_cross_terms, a_second_cross_term_alone,
    a_frame_in_parts_is_the_same);
