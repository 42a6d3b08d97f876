/* SPDX-License-Identifier: MIT */
/* glove.h against exact arithmetic: the angle of any code by any calibration, cross terms,
 * what is believed, and a calibration found back from poses. */
#include "exhand/glove.h"

#include "exhand/error.h"
#include "exhand/fix.h"

#include "check.h"
#include "wide.h"

#define SENSORS EXH_GLOVE_SENSORS

static const struct exh_period kilohertz = {1, 1000};

/* Any calibration that is valid, over the whole card. */
static struct exh_glove_cal any_cal(void)
{
    struct exh_glove_cal cal = {1, 1, 0, 1, (1u << SENSORS) - 1u, {{0}}};
    for (unsigned i = 0; i < SENSORS; i++) {
        struct exh_glove_sensor *s = &cal.sensor[i];
        s->zero_raw_q15 = check_i32_in(-(1 << 30), (1 << 30) - 1);
        s->gain_turnpraw_q38 = check_i32_in(1 << 17, INT32_MAX);
        if (check_u64() & 1) { s->gain_turnpraw_q38 = -s->gain_turnpraw_q38; }
        s->low_raw = -32000;
        s->high_raw = 32000;
        s->of[0] = s->of[1] = EXH_GLOVE_NONE;
    }
    for (unsigned i = 3; i < SENSORS; i += 4) { /* 3, 7, 11, 15, 19 of others than these */
        for (unsigned k = 0; k < 2; k++) {
            const unsigned of = (unsigned)check_i32_in(0, SENSORS - 1);
            if (of % 4 == 3) { continue; }
            cal.sensor[i].of[k] = (uint8_t)of;
            cal.sensor[i].cross_q30[k] = check_i32();
        }
    }
    return cal;
}

/* Without filter and hysteresis, in 16 bits, all codes are exact. */
static struct exh_glove_par exact(void)
{
    const struct exh_signal *r = exh_glove_rows;
    const struct exh_glove_par par = {0, r[1].dflt, 16, 0, INT16_MIN, INT16_MAX, 1, 1, r[8].max};
    return par;
}

TEST(angle_is_within_half_an_lsb)
{
    const struct exh_glove_par par = exact();
    while (check_case(20)) {
        const struct exh_glove_cal cal = any_cal();
        struct exh_glove_cfg cfg;
        struct exh_glove s;
        struct exh_glove_in in = {{0}, 0};
        int32_t angle[SENSORS];
        struct wide own[SENSORS], sum;
        memset(&s, 0, sizeof s);
        CHECK_EQ_I64(exh_glove_setup(&cfg, &par, &cal, kilohertz), 0);
        for (unsigned i = 0; i < SENSORS; i++) {
            in.raw[i] = (int16_t)check_i32_in(INT16_MIN + 1, INT16_MAX - 1);
        }
        CHECK_EQ_I64(exh_glove_step(&s, &cfg, &in, angle), 0);
        for (unsigned i = 0; i < SENSORS; i++) {
            const int64_t off_q15 = (int64_t)in.raw[i] * 32768 - cal.sensor[i].zero_raw_q15;
            own[i] = wide_of(wide_sat32(
                wide_shr_half_up(wide_mul(off_q15, cal.sensor[i].gain_turnpraw_q38), 21)));
        }
        for (unsigned i = 0; i < SENSORS; i++) {
            sum = own[i];
            for (unsigned k = 0; k < 2; k++) {
                const struct exh_glove_sensor *c = &cal.sensor[i];
                if (c->of[k] == EXH_GLOVE_NONE) { continue; }
                sum = wide_add(sum,
                    wide_shr_half_up(wide_mul(wide_sat32(own[c->of[k]]), c->cross_q30[k]), 30));
            }
            CHECK(angle[i] == wide_sat32(sum),
                "sensor %u code %d zero %" PRId32 " gain %" PRId32 ": %" PRId32, i, in.raw[i],
                cal.sensor[i].zero_raw_q15, cal.sensor[i].gain_turnpraw_q38, angle[i]);
        }
    }
}

/* One channel among others, any codes in any order, judged again by the words of the header. */
TEST(faults_as_the_header_tells)
{
    const int32_t scale = 65536;
    while (check_case(200)) {
        struct exh_glove_par par = exact();
        struct exh_glove_cal cal = any_cal();
        struct exh_glove_cfg cfg;
        struct exh_glove s;
        struct exh_glove_in in = {{0}, 0};
        int32_t angle[SENSORS], held = 0;
        const unsigned at = (unsigned)check_i32_in(0, SENSORS - 1);
        const int n = check_i32_in(1, 5);
        int bads = 0, goods = 0, faulty = 0, faults = 0;
        memset(&s, 0, sizeof s);
        par.debounce_frames = n;
        par.low_raw = -30000;
        par.high_raw = 30000;
        par.margin_q16 = 65536 / 4;
        for (unsigned i = 0; i < SENSORS; i++) {
            cal.sensor[i] = (struct exh_glove_sensor){
                0, 1 << 22, {0, 0}, -10000, 10000, {EXH_GLOVE_NONE, EXH_GLOVE_NONE}};
        }
        CHECK_EQ_I64(exh_glove_setup(&cfg, &par, &cal, kilohertz), 0);
        for (int k = 0; k < 60; k++) {
            const int16_t raw = (int16_t)(check_u64() % 2 ? check_i32_in(-15000, 15000)
                                                          : check_i32_in(INT16_MIN, INT16_MAX));
            const int bad = raw < -15000 || raw > 15000;
            uint32_t told;
            in.raw[at] = raw;
            told = exh_glove_step(&s, &cfg, &in, angle);
            bads = bad ? bads + 1 : 0;
            goods = bad ? 0 : goods + 1;
            if (!faulty && (bads >= n || (k == 0 && bad))) {
                faulty = 1;
                faults++;
            } else if (faulty && goods >= n) {
                faulty = 0;
            }
            if (!bad && !faulty) { held = raw * scale; }
            CHECK(angle[at] == held, "frame %d: %" PRId32 ", %" PRId32, k, angle[at], held);
            CHECK(told == (uint32_t)faulty << at, "frame %d: %" PRIx32, k, told);
            CHECK(s.faults[at] == faults, "frame %d: %d faults", k, s.faults[at]);
            CHECK(!bad || !faulty ||
                      s.cause[at] == (raw <= -30000     ? EXH_GLOVE_SHORT
                                         : raw >= 30000 ? EXH_GLOVE_OPEN
                                                        : EXH_GLOVE_OUTSIDE),
                "frame %d code %d: %s", k, raw, exh_glove_cause_text(s.cause[at]));
        }
    }
}

/* --- the fit finds back what codes were made of --- */

struct truth {
    int64_t zero_q16;     /* code */
    int32_t deg_raw_q16;  /* codes per degree */
    int32_t cross_q16[2]; /* of 4 and 7, on 10 */
};

static int32_t read_q16(const struct truth *t, int32_t own_mdeg)
{
    return exh_sat32(t->zero_q16 + (int64_t)t->deg_raw_q16 * own_mdeg / 1000);
}

#define MDEG(d) ((int32_t)((int64_t)(d) * (INT64_C(1) << 32) / 360000))

/* Eight poses of 4 and 7 at corners and inside, sensor 10 both ways in each: nothing but the
 * rounding of the codes is left. */
TEST(the_fit_finds_the_truth)
{
    static const unsigned id[3] = {4, 7, 10};
    while (check_case(500)) {
        struct exh_glove_cal cal = {1, 1, 0, 1, 1u << 4 | 1u << 7 | 1u << 10, {{0}}};
        struct exh_glove_fit fit[SENSORS];
        struct exh_glove_pose pose[8];
        struct exh_glove_error bad = {99, 99};
        struct truth t[3];
        memset(pose, 0, sizeof pose);
        for (unsigned k = 0; k < 3; k++) {
            t[k].zero_q16 = check_i32_in(-8000 * 65536, 8000 * 65536);
            t[k].deg_raw_q16 = check_i32_in(20 * 65536, 120 * 65536) * (check_u64() & 1 ? 1 : -1);
            t[k].cross_q16[0] = check_i32_in(-65536 / 2, 65536 / 2);
            t[k].cross_q16[1] = check_i32_in(-65536 / 2, 65536 / 2);
        }
        for (unsigned i = 0; i < SENSORS; i++) {
            cal.sensor[i].of[0] = cal.sensor[i].of[1] = EXH_GLOVE_NONE;
        }
        cal.sensor[10].of[0] = 4;
        cal.sensor[10].of[1] = 7;
        for (unsigned p = 0; p < 8; p++) {
            const int32_t mdeg[3] = {(p & 1 ? 60000 : 0) + check_i32_in(0, 20000),
                (p & 2 ? 60000 : 0) + check_i32_in(0, 20000),
                (p & 4 ? 25000 : 0) + check_i32_in(0, 10000)};
            pose[p].known = cal.present;
            for (unsigned k = 0; k < 3; k++) {
                int64_t own = mdeg[k];
                if (k == 2) {
                    own -= ((int64_t)t[k].cross_q16[0] * mdeg[0] +
                               (int64_t)t[k].cross_q16[1] * mdeg[1]) /
                           65536;
                }
                pose[p].angle_turn_q32[id[k]] = MDEG(mdeg[k]);
                pose[p].mean_raw_q16[id[k]] = read_q16(&t[k], (int32_t)own);
            }
        }
        CHECK(exh_glove_cal_fit(&cal, fit, pose, 8, &exh_glove_fit_default, &bad) == 0, "%s of %s",
            exh_glove_error_text(bad.what), exh_glove_sensor_text(bad.at));
        for (unsigned k = 0; k < 3; k++) {
            const struct exh_glove_sensor *s = &cal.sensor[id[k]];
            const int64_t gain = (INT64_C(1) << 54) / ((int64_t)360 * t[k].deg_raw_q16);
            const int64_t off = s->gain_turnpraw_q38 - gain, size = gain < 0 ? -gain : gain;
            const int64_t zero = s->zero_raw_q15 * INT64_C(2) - t[k].zero_q16;
            const int32_t left = fit[id[k]].residual_turn_q32;
            CHECK((off < 0 ? -off : off) <= size / 8192, "%u: gain %" PRId32 ", %" PRId64, id[k],
                s->gain_turnpraw_q38, gain);
            CHECK(zero < 3 * 65536 && zero > -3 * 65536, "%u: zero off by %" PRId64, id[k], zero);
            CHECK(left < MDEG(5) && left > -MDEG(5), "%u: residual %" PRId32, id[k], left);
        }
        for (unsigned k = 0; k < 2; k++) {
            const int64_t off = cal.sensor[10].cross_q30[k] - (int64_t)t[2].cross_q16[k] * 16384;
            CHECK(off < 1 << 18 && off > -(1 << 18), "cross %u: off by %" PRId64, k, off);
        }
    }
}

/* Whatever the poses hold, the fit ends, and what it calls sound can be used. */
TEST(any_poses_end_in_a_word)
{
    while (check_case(500)) {
        struct exh_glove_cal cal = any_cal();
        struct exh_glove_fit fit[SENSORS];
        static struct exh_glove_pose pose[EXH_GLOVE_POSES_MAX];
        struct exh_glove_error bad = {99, 99};
        const struct exh_glove_fit_par par = {check_i32(), check_i32(), check_i32()};
        const unsigned n = (unsigned)check_i32_in(0, EXH_GLOVE_POSES_MAX);
        int err;
        cal.present = (uint32_t)check_u64() >> 10;
        for (unsigned p = 0; p < n; p++) {
            pose[p].known = (uint32_t)check_u64();
            for (unsigned i = 0; i < SENSORS; i++) {
                pose[p].angle_turn_q32[i] = check_i32();
                pose[p].mean_raw_q16[i] = check_i32();
                pose[p].noise_raw[i] = check_i32();
            }
        }
        err = exh_glove_cal_fit(&cal, fit, pose, n, &par, &bad);
        CHECK(err == 0 || err == -EXH_E_RANGE, "%d", err);
        CHECK(err == 0 ? exh_glove_cal_validate(&cal, NULL) == 0
                       : cal.present == 0 && bad.what < EXH_GLOVE_ERRORS,
            "%d", bad.what);
    }
}

/* An abduction whose code follows a knuckle's but for some noise. Too little noise once left a
 * divisor of rounding errors alone, and the sums overflowed. */
TEST(what_moves_together_is_refused)
{
    static struct exh_glove_pose pose[EXH_GLOVE_POSES_MAX];
    const struct exh_glove_fit_par par = {0, 0, INT32_MAX};
    while (check_case(1)) {
        struct exh_glove_cal cal = {1, 1, 0, 1, 1u | 2u | 1u << 10, {{0}}};
        struct exh_glove_fit fit[SENSORS];
        const int32_t noise = 1 << check_i32_in(0, 20);
        for (unsigned i = 0; i < SENSORS; i++) {
            cal.sensor[i].of[0] = cal.sensor[i].of[1] = EXH_GLOVE_NONE;
        }
        cal.sensor[10].of[0] = 0;
        cal.sensor[10].of[1] = 1;
        memset(pose, 0, sizeof pose);
        for (unsigned p = 0; p < EXH_GLOVE_POSES_MAX; p++) {
            const int32_t far = p & 1 ? 2000000000 : -2000000000;
            struct exh_glove_pose *const at = &pose[p];
            at->known = cal.present;
            at->mean_raw_q16[0] = check_i32_in(-2000000000, 2000000000);
            at->mean_raw_q16[1] = p < 2 ? far : check_i32_in(-2000000000, 2000000000);
            at->mean_raw_q16[10] = at->mean_raw_q16[0] + check_i32_in(-noise, noise);
            at->angle_turn_q32[0] = at->mean_raw_q16[0];
            at->angle_turn_q32[1] = at->mean_raw_q16[1];
            at->angle_turn_q32[10] = check_i32();
        }
        CHECK_EQ_I64(
            exh_glove_cal_fit(&cal, fit, pose, EXH_GLOVE_POSES_MAX, &par, NULL), -EXH_E_RANGE);
        CHECK(fit[0].what == EXH_GLOVE_ERRORS && fit[1].what == EXH_GLOVE_ERRORS &&
                  fit[10].what == EXH_GLOVE_POSES,
            "%s, %s, %s", exh_glove_error_text(fit[0].what), exh_glove_error_text(fit[1].what),
            exh_glove_error_text(fit[10].what));
    }
}

TEST_MAIN("prop/glove", angle_is_within_half_an_lsb, faults_as_the_header_tells,
    the_fit_finds_the_truth, any_poses_end_in_a_word, what_moves_together_is_refused);
