/* SPDX-License-Identifier: MIT */
/* glove.h, the fit of poses: what it finds, what is refused and by which name. */
#include "exhand/glove.h"

#include "exhand/error.h"
#include "exhand/fix.h"

#include "check.h"

#define ALL    ((1u << EXH_GLOVE_SENSORS) - 1u)
#define DEG(d) EXH_Q(d, 360, 32)

#define POSES 7

struct fixture {
    struct exh_glove_cal cal;
    struct exh_glove_fit fit[EXH_GLOVE_SENSORS];
    struct exh_glove_pose pose[EXH_GLOVE_POSES_MAX];
    unsigned n;
    struct exh_glove_error bad;
};

/* What sensor i reads, q16, when its own angle is so: 0 degrees at 1000 i - 9000, a degree is
 * 50 + 5 i codes, downward for odd sensors. */
static int32_t code_q16(unsigned i, int32_t own_deg)
{
    const int32_t per_deg = (i & 1 ? -1 : 1) * (50 + 5 * (int32_t)i);
    return (1000 * (int32_t)i - 9000 + own_deg * per_deg) * 65536;
}

/* Pose 0 all flat, pose 1 all at 80 degrees, then knuckles 4 and 7 alone and together,
 * sensor 10 alone and with 4. 10 is bent by a quarter of 4 and, backward, by half of 7. */
static void set_up(struct fixture *f)
{
    static const int8_t knuckle[POSES][3] = {{0, 0, 0}, {80, 80, 80}, {80, 0, 0}, {0, 80, 0},
        {0, 0, 40}, {40, 0, 40}, {40, 80, 0}}; /* 4, 7, 10 */
    memset(f, 0, sizeof *f);
    f->cal = (struct exh_glove_cal){7, 3, 20000, 30, ALL, {{0}}};
    for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
        f->cal.sensor[i].of[0] = f->cal.sensor[i].of[1] = EXH_GLOVE_NONE;
    }
    f->cal.sensor[10].of[0] = 4;
    f->cal.sensor[10].of[1] = 7;
    f->n = POSES;
    for (unsigned p = 0; p < POSES; p++) {
        const int32_t a = knuckle[p][0], b = knuckle[p][1], ab = knuckle[p][2];
        f->pose[p].known = p < 2 ? ALL : 1u << 4 | 1u << 7 | 1u << 10;
        for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
            const int32_t deg = i == 4 ? a : i == 7 ? b : i == 10 ? ab : p == 1 ? 80 : 0;
            f->pose[p].angle_turn_q32[i] = DEG(deg);
            f->pose[p].mean_raw_q16[i] = code_q16(i, i == 10 ? ab + a / 4 - b / 2 : deg);
            f->pose[p].noise_raw[i] = 20;
        }
    }
}

static int fit(struct fixture *f)
{
    return exh_glove_cal_fit(&f->cal, f->fit, f->pose, f->n, &exh_glove_fit_default, &f->bad);
}

static int near(int64_t a, int64_t b, int64_t off) { return a - b <= off && b - a <= off; }

TEST(poses_give_gain_zero_and_cross_terms)
{
    struct fixture f;
    set_up(&f);
    CHECK(fit(&f) == 0, "%s of %s", exh_glove_error_text(f.bad.what),
        exh_glove_sensor_text(f.bad.at));
    for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
        const struct exh_glove_sensor *s = &f.cal.sensor[i];
        const int64_t per_deg = (i & 1 ? -1 : 1) * (50 + 5 * (int64_t)i);
        const int64_t gain = (INT64_C(1) << 38) / (360 * per_deg);
        const int32_t end = code_q16(i, 80) >> 16, flat = code_q16(i, 0) >> 16;
        CHECK(near(s->gain_turnpraw_q38, gain, 40), "%u: gain %" PRId32 ", %" PRId64, i,
            s->gain_turnpraw_q38, gain);
        CHECK(near(s->zero_raw_q15, (1000 * (int64_t)i - 9000) * 32768, 300), "%u: zero %" PRId32,
            i, s->zero_raw_q15);
        CHECK(i == 10 || (s->low_raw == (flat < end ? flat : end) &&
                             s->high_raw == (flat < end ? end : flat)),
            "%u: %d .. %d", i, s->low_raw, s->high_raw);
        CHECK(f.fit[i].what == EXH_GLOVE_ERRORS &&
                  f.fit[i].poses == (i == 4 || i == 7 || i == 10 ? 7 : 2) &&
                  near(f.fit[i].residual_turn_q32, 0, 4096),
            "%u: %d poses, %" PRId32, i, f.fit[i].poses, f.fit[i].residual_turn_q32);
    }
    CHECK(near(f.cal.sensor[10].cross_q30[0], -(1 << 28), 2000), "%" PRId32,
        f.cal.sensor[10].cross_q30[0]);
    CHECK(near(f.cal.sensor[10].cross_q30[1], 1 << 29, 2000), "%" PRId32,
        f.cal.sensor[10].cross_q30[1]);
    CHECK_EQ_I64(f.cal.sensor[10].low_raw, (1000 - 40 * 100));
    CHECK_EQ_I64(f.cal.sensor[10].high_raw, (1000 + 60 * 100));
}

/* One pose 3 degrees off, of three on the line: least squares leave two thirds or less. */
TEST(residual_is_the_worst_pose)
{
    struct fixture f;
    set_up(&f);
    f.pose[2].known |= 1u << 5;
    f.pose[2].angle_turn_q32[5] = DEG(40);
    f.pose[2].mean_raw_q16[5] = code_q16(5, 37);
    CHECK_EQ_I64(fit(&f), 0);
    CHECK_EQ_I64(f.fit[5].poses, 3);
    CHECK_EQ_I64(f.fit[5].pose, 2);
    CHECK(near(f.fit[5].residual_turn_q32, DEG(2), DEG(1) / 50), "%" PRId32,
        f.fit[5].residual_turn_q32);
    f.pose[2].mean_raw_q16[5] = code_q16(5, 28);
    CHECK_EQ_I64(fit(&f), -EXH_E_RANGE);
}

/* Where the poses may just be: noise at its limit, a pose number behind poses that know nothing. */
TEST(limits_of_poses_are_allowed)
{
    struct fixture f;
    set_up(&f);
    f.pose[1].noise_raw[5] = 128;
    f.pose[0].known &= ~(1u << 6);
    for (unsigned p = 2; p < 4; p++) {
        f.pose[p].known |= 1u << 6;
        f.pose[p].angle_turn_q32[6] = DEG(p == 2 ? 40 : 0);
        f.pose[p].mean_raw_q16[6] = code_q16(6, p == 2 ? 37 : 0);
    }
    CHECK(fit(&f) == 0, "%s of %s", exh_glove_error_text(f.bad.what),
        exh_glove_sensor_text(f.bad.at));
    CHECK_EQ_I64(f.fit[6].pose, 2);
}

/* One pose of the knuckles 4 and 7 and of what lies between them. */
static void knuckles(struct fixture *f, unsigned p, int32_t a_deg, int32_t b_deg, int32_t ab_deg)
{
    f->pose[p].angle_turn_q32[4] = (int32_t)(a_deg * (INT64_C(1) << 32) / 360);
    f->pose[p].angle_turn_q32[7] = (int32_t)(b_deg * (INT64_C(1) << 32) / 360);
    f->pose[p].angle_turn_q32[10] = (int32_t)(ab_deg * (INT64_C(1) << 32) / 360);
    f->pose[p].mean_raw_q16[4] = code_q16(4, a_deg);
    f->pose[p].mean_raw_q16[7] = code_q16(7, b_deg);
    f->pose[p].mean_raw_q16[10] = code_q16(10, ab_deg);
}

TEST(poses_are_refused_by_name)
{
    for (int k = 0; k < 22; k++) {
        struct exh_glove_fit_par fit_par = exh_glove_fit_default;
        struct fixture f;
        int what, at = 5;
        set_up(&f);
        switch (k) {
        case 0:
            f.pose[1].mean_raw_q16[5] = f.pose[0].mean_raw_q16[5] + 255 * 65536;
            what = EXH_GLOVE_MOVE;
            break;
        case 1:
            f.pose[1].noise_raw[5] = 129;
            what = EXH_GLOVE_NOISE;
            break;
        case 2:
            f.pose[1].known &= ~(1u << 5);
            what = EXH_GLOVE_POSES;
            break;
        case 3:
            f.pose[1].angle_turn_q32[5] = DEG(4);
            what = EXH_GLOVE_POSES;
            break;
        case 4:
            f.pose[2].known |= 1u << 5;
            f.pose[2].angle_turn_q32[5] = DEG(40);
            f.pose[2].mean_raw_q16[5] = code_q16(5, 29);
            what = EXH_GLOVE_RESIDUAL;
            break;
        case 5: /* 80 degrees over the whole card: its zero is beyond */
            f.pose[0].angle_turn_q32[5] = DEG(100);
            f.pose[1].angle_turn_q32[5] = DEG(120);
            f.pose[0].mean_raw_q16[5] = -30000 * 65536;
            f.pose[1].mean_raw_q16[5] = 30000 * 65536;
            what = EXH_GLOVE_ZERO;
            break;
        case 6:
            f.cal.sensor[5].of[0] = 22;
            what = EXH_GLOVE_CROSS;
            break;
        case 7:
            f.cal.sensor[5].of[1] = 10;
            what = EXH_GLOVE_CROSS;
            break;
        case 8: /* both knuckles always together */
            for (unsigned p = 2; p < POSES; p++) {
                f.pose[p].mean_raw_q16[7] = code_q16(7, f.pose[p].angle_turn_q32[4] / DEG(1));
            }
            for (unsigned p = 2; p < POSES; p++) {
                f.pose[p].angle_turn_q32[7] = f.pose[p].angle_turn_q32[4];
            }
            what = EXH_GLOVE_POSES;
            at = 10;
            break;
        case 9:
            f.pose[1].noise_raw[4] = 500;
            what = EXH_GLOVE_NOISE;
            at = 4;
            break; /* and 10 with it */
        case 10:
            f.n = 1;
            what = EXH_GLOVE_POSES;
            at = 0;
            break;
        case 12: /* knuckles that are never 4 degrees apart: as good as together */
            for (unsigned p = 0; p < POSES; p++) {
                knuckles(&f, p, (int32_t)(p % 3) * 40, (int32_t)(p % 3) * 40 + (p & 1 ? 3 : 0),
                    p & 4 ? 30 : 0);
            }
            what = EXH_GLOVE_POSES;
            at = 10;
            break;
        case 13: /* of the poses that know sensor 10, 7 moves in one, by 1 degree */
            f.pose[1].known &= ~(1u << 10);
            for (unsigned p = 2; p < POSES; p++) {
                knuckles(&f, p, p & 1 ? 80 : 0, p == 3, p & 4 ? 40 : 0);
            }
            what = EXH_GLOVE_POSES;
            at = 10;
            break;
        case 14: /* three times as far as the knuckle itself, either way */
        case 16:
            for (unsigned p = 0; p < POSES; p++) {
                const int32_t a = f.pose[p].angle_turn_q32[4] / DEG(1),
                              ab = f.pose[p].angle_turn_q32[10] / DEG(1);
                f.pose[p].mean_raw_q16[10] =
                    code_q16(10, k == 14 ? ab + 3 * a - 100 : ab - 3 * a + 100);
            }
            what = EXH_GLOVE_CROSS;
            at = 10;
            break;
        case 15: /* one and a half of both, against each other: the first leaves 240 degrees */
        case 17:
            for (unsigned p = 0; p < POSES; p++) {
                const int32_t a = p % 3 == 0 ? 0 : 160, b = p % 3 == 0 ? 0 : p & 1 ? 110 : 160;
                knuckles(&f, p, a, b, p & 4 ? 30 : 0);
                f.pose[p].mean_raw_q16[10] =
                    code_q16(10, (p & 4 ? 30 : 0) + (k == 15 ? a - b : b - a) * 3 / 2);
            }
            what = EXH_GLOVE_CROSS;
            at = 10;
            break;
        case 18: /* its zero is beyond the other end */
            f.pose[0].angle_turn_q32[5] = DEG(-120);
            f.pose[1].angle_turn_q32[5] = DEG(-100);
            f.pose[0].mean_raw_q16[5] = -30000 * 65536;
            f.pose[1].mean_raw_q16[5] = 30000 * 65536;
            what = EXH_GLOVE_ZERO;
            break;
        case 19: /* half a turn in 64 codes, up and down */
        case 20:
            fit_par.move_min_raw = 64;
            f.pose[0].angle_turn_q32[5] = INT32_MIN;
            f.pose[1].angle_turn_q32[5] = INT32_MAX;
            f.pose[0].mean_raw_q16[5] = k == 19 ? -32 * 65536 : 32 * 65536;
            f.pose[1].mean_raw_q16[5] = k == 19 ? 32 * 65536 : -32 * 65536;
            what = EXH_GLOVE_GAIN;
            break;
        case 21: /* up and down again: the line through it is level */
            f.pose[2].known |= 1u << 5;
            for (unsigned p = 0; p < 3; p++) {
                f.pose[p].angle_turn_q32[5] = DEG(p == 1 ? 60 : 0);
                f.pose[p].mean_raw_q16[5] = (int32_t)p * 1000 * 65536;
            }
            what = EXH_GLOVE_GAIN;
            break;
        default:
            f.n = EXH_GLOVE_POSES_MAX + 1;
            what = EXH_GLOVE_POSES;
            at = 0;
            break;
        }
        CHECK(exh_glove_cal_fit(&f.cal, f.fit, f.pose, f.n, &fit_par, &f.bad) == -EXH_E_RANGE,
            "case %d", k);
        CHECK(f.bad.what == what && f.bad.at == at, "case %d: %s of %s", k,
            exh_glove_error_text(f.bad.what), exh_glove_sensor_text(f.bad.at));
        CHECK(f.cal.present == 0, "case %d", k);
        CHECK(k == 10 || k == 11 || (f.fit[at].what == what && f.fit[20].what == EXH_GLOVE_ERRORS),
            "case %d", k);
        CHECK(k != 9 || f.fit[10].what == EXH_GLOVE_CROSS, "case %d", k);
        CHECK(k != 1 || f.fit[5].pose == 1, "case %d", k);
    }
}

TEST(absent_sensors_need_no_pose)
{
    struct fixture f;
    set_up(&f);
    f.cal.present &= ~(1u << 6);
    f.cal.sensor[6].of[0] = 5;
    f.cal.sensor[6].cross_q30[0] = 1 << 29;
    for (unsigned p = 0; p < POSES; p++) { f.pose[p].known &= ~(1u << 6); }
    CHECK_EQ_I64(fit(&f), 0);
    CHECK_EQ_I64(f.cal.sensor[6].cross_q30[0], 1 << 29);
    CHECK_EQ_I64(f.cal.sensor[6].gain_turnpraw_q38, 0);
}

/* All but level: one LSB of angle is left over, by which no zero can be found. */
TEST(a_line_as_good_as_level_is_refused)
{
    const int32_t x =
        1 << 22; /* codes q12: 0, x, 2 x + 1 at angles 0, 3 x + 1, 1 of q28: the sum is 1 */
    struct fixture f;
    set_up(&f);
    f.pose[2].known |= 1u << 5;
    for (unsigned p = 0; p < 3; p++) {
        f.pose[p].mean_raw_q16[5] = (p == 0 ? 0 : p == 1 ? x : 2 * x + 1) * 16;
        f.pose[p].angle_turn_q32[5] = (p == 0 ? 0 : p == 1 ? 3 * x + 1 : 1) * 16;
    }
    CHECK_EQ_I64(fit(&f), -EXH_E_RANGE);
    CHECK(f.bad.what == EXH_GLOVE_GAIN && f.bad.at == 5, "%s of %d",
        exh_glove_error_text(f.bad.what), f.bad.at);
}

/* Nothing of an old calibration gets into a new one. */
TEST(a_fit_begins_anew)
{
    struct fixture clean, old;
    set_up(&clean);
    set_up(&old);
    for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
        struct exh_glove_sensor *s = &old.cal.sensor[i];
        s->gain_turnpraw_q38 = s->zero_raw_q15 = 77777;
        if (i != 9) {
            s->cross_q30[0] = s->cross_q30[1] = 77777;
        } /* of one that is not there they are not looked at */
        s->low_raw = s->high_raw = 777;
    }
    clean.cal.present = old.cal.present = ALL & ~(1u << 9);
    CHECK_EQ_I64(fit(&clean), 0);
    CHECK_EQ_I64(fit(&old), 0);
    for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
        const struct exh_glove_sensor *a = &clean.cal.sensor[i], *b = &old.cal.sensor[i];
        CHECK(a->gain_turnpraw_q38 == b->gain_turnpraw_q38 && a->zero_raw_q15 == b->zero_raw_q15,
            "line %u", i);
        CHECK(a->low_raw == b->low_raw && a->high_raw == b->high_raw, "span %u", i);
        CHECK(a->cross_q30[0] == b->cross_q30[0] && a->cross_q30[1] == b->cross_q30[1], "cross %u",
            i);
    }
}

/* Two poses will do where nothing couples, 5 degrees apart and no less; what was there stays there.
 */
TEST(two_poses_five_degrees_apart)
{
    for (int32_t less = 0; less < 2; less++) {
        struct fixture f;
        set_up(&f);
        f.cal.sensor[10].of[0] = f.cal.sensor[10].of[1] = EXH_GLOVE_NONE;
        f.n = 2;
        f.pose[1].angle_turn_q32[5] = EXH_Q(5, 360, 32) - less;
        CHECK(fit(&f) == (less ? -EXH_E_RANGE : 0), "%d: %s of %d", (int)less,
            exh_glove_error_text(f.bad.what), f.bad.at);
        CHECK(f.cal.present == (less ? 0u : ALL), "%d", (int)less);
        CHECK(!less || (f.bad.what == EXH_GLOVE_POSES && f.bad.at == 5), "%s of %d",
            exh_glove_error_text(f.bad.what), f.bad.at);
        f.n = 1;
        CHECK_EQ_I64(fit(&f), -EXH_E_RANGE);
    }
}

/* The worst pose counts on either side of the line. */
TEST(residual_has_two_sides)
{
    for (int32_t side = -1; side <= 1; side += 2) {
        struct fixture f;
        set_up(&f);
        f.pose[2].known |= 1u << 5;
        f.pose[2].angle_turn_q32[5] = DEG(40);
        f.pose[2].mean_raw_q16[5] = code_q16(5, 40 + 3 * side);
        CHECK_EQ_I64(fit(&f), 0);
        CHECK_EQ_I64(f.fit[5].pose, 2);
        CHECK(near(f.fit[5].residual_turn_q32, -2 * side * (int64_t)DEG(1), DEG(1) / 50),
            "%d: %" PRId32, (int)side, f.fit[5].residual_turn_q32);
        f.pose[2].mean_raw_q16[5] = code_q16(5, 40 + 12 * side);
        CHECK(fit(&f) == -EXH_E_RANGE && f.bad.what == EXH_GLOVE_RESIDUAL && f.bad.at == 5, "%d",
            (int)side);
    }
}

/* Zero at the very ends of its format, and an LSB beyond: 90 degrees over 4096 codes, exactly. */
TEST(a_zero_at_the_end)
{
    const struct exh_glove_fit_par *const usual = &exh_glove_fit_default;
    static const struct {
        int32_t code_q16, angle_turn_q32, zero_q15;
    } row[] = {{INT32_MAX - (1 << 28), -(1 << 30), INT32_MAX / 2},
        {INT32_MAX - (1 << 28), -(1 << 30) - 4, 0}, {INT32_MIN, 0, -(1 << 30)}, {INT32_MIN, 4, 0}};
    CHECK(usual->move_min_raw == 256 && usual->noise_max_raw == 128 &&
              usual->residual_max_turn_q32 == 71582788,
        "usual");
    for (size_t i = 0; i < sizeof row / sizeof row[0]; i++) {
        struct fixture f;
        int err;
        set_up(&f);
        for (unsigned p = 0; p < POSES; p++) {
            f.pose[p].mean_raw_q16[5] = row[i].code_q16 + (p == 1 ? 1 << 28 : 0);
            f.pose[p].angle_turn_q32[5] = row[i].angle_turn_q32 + (p == 1 ? 1 << 30 : 0);
        }
        err = fit(&f);
        if (row[i].zero_q15 != 0) {
            CHECK(err == 0 && f.cal.sensor[5].zero_raw_q15 == row[i].zero_q15,
                "row %zu: %d, %" PRId32, i, err, f.cal.sensor[5].zero_raw_q15);
        } else {
            CHECK(err == -EXH_E_RANGE && f.bad.what == EXH_GLOVE_ZERO && f.bad.at == 5,
                "row %zu: %d of %d", i, f.bad.what, f.bad.at);
        }
    }
}

/* A knuckle that moves in one pose of five, by 2^-8 turn to the bit: four times the square of that
 * is the least that counts. */
TEST(a_knuckle_that_just_moved_enough)
{
    static const int8_t deg[5] = {
        -20, 20, -20, 20, 0}; /* its own way has nothing of the knuckle's */
    struct fixture f;
    struct exh_glove_sensor s;
    int32_t raw_q16 = code_q16(4, 0), flat, moved;
    for (unsigned run = 0; run < 3; run++) {
        set_up(&f);
        f.cal.sensor[10].of[1] = EXH_GLOVE_NONE;
        for (unsigned p = 0; p < POSES; p++) {
            f.pose[p].known =
                (p < 2 ? ALL & ~(1u << 4 | 1u << 10) : 1u << 7) | (p < 5 ? 1u << 10 : 1u << 4);
            f.pose[p].angle_turn_q32[10] = DEG(p < 5 ? deg[p] : 0);
            f.pose[p].mean_raw_q16[10] = code_q16(10, p < 5 ? deg[p] : 0);
            f.pose[p].angle_turn_q32[4] = DEG(p == 6 ? 80 : 0);
            f.pose[p].mean_raw_q16[4] = p == 4 ? raw_q16 : code_q16(4, p == 6 ? 80 : 0);
        }
        if (run == 0) { /* for the knuckle alone: of its line comes the code where it is so far */
            (void)fit(&f);
            s = f.cal.sensor[4];
            flat =
                (int32_t)(exh_mul_shr((raw_q16 >> 1) - s.zero_raw_q15, s.gain_turnpraw_q38, 21) >>
                          4);
            raw_q16 += 98 * 65536;
            do {
                raw_q16++;
                moved = (int32_t)(exh_mul_shr(
                                      (raw_q16 >> 1) - s.zero_raw_q15, s.gain_turnpraw_q38, 21) >>
                                  4) -
                        flat;
            } while (moved < 1 << 20);
            CHECK_EQ_I64(moved, 1 << 20);
        } else if (run == 1) {
            CHECK(fit(&f) == 0, "%s of %d", exh_glove_error_text(f.bad.what), f.bad.at);
            raw_q16--;
        } else {
            CHECK_EQ_I64(fit(&f), -EXH_E_RANGE);
            CHECK(f.bad.what == EXH_GLOVE_POSES && f.bad.at == 10, "%s of %d",
                exh_glove_error_text(f.bad.what), f.bad.at);
        }
    }
}

TEST_MAIN("unit/glove_fit", poses_give_gain_zero_and_cross_terms, residual_is_the_worst_pose,
    limits_of_poses_are_allowed, poses_are_refused_by_name, absent_sensors_need_no_pose,
    a_line_as_good_as_level_is_refused, a_fit_begins_anew, two_poses_five_degrees_apart,
    residual_has_two_sides, a_zero_at_the_end, a_knuckle_that_just_moved_enough);
