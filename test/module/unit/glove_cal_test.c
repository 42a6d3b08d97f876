/* SPDX-License-Identifier: MIT */
/* glove.h, calibration: what is refused and by which name, the image, the one the library has. */
#include "exhand/glove.h"

#include "exhand/error.h"

#include "check.h"

#define ALL ((1u << EXH_GLOVE_SENSORS) - 1u)

static struct exh_glove_cal sound(void)
{
    struct exh_glove_cal cal = exh_glove_cal_default;
    cal.user_id = 7;
    cal.glove_id = 3;
    cal.day = 20000;
    cal.valid_days = 30;
    cal.sensor[10].of[0] = 4;
    cal.sensor[10].of[1] = 7;
    cal.sensor[10].cross_q30[0] = -12345678;
    cal.sensor[10].cross_q30[1] = 87654321;
    return cal;
}

/* --- values --- */

TEST(valid_names_the_culprit)
{
    static const struct {
        int sensor;
        struct exh_glove_sensor s;
        uint8_t what;
    } row[] = {
        {0, {0, 0, {0, 0}, 0, 1000, {255, 255}}, EXH_GLOVE_GAIN},
        {21, {0, (1 << 17) - 1, {0, 0}, 0, 1000, {255, 255}}, EXH_GLOVE_GAIN},
        {21, {0, -(1 << 17) + 1, {0, 0}, 0, 1000, {255, 255}}, EXH_GLOVE_GAIN},
        {5, {0, INT32_MIN, {0, 0}, 0, 1000, {255, 255}}, EXH_GLOVE_GAIN},
        {5, {0, INT32_MAX, {0, 0}, 0, 1000, {255, 255}}, EXH_GLOVE_ERRORS},
        {5, {0, -INT32_MAX, {0, 0}, 0, 1000, {255, 255}}, EXH_GLOVE_ERRORS},
        {5, {0, 1 << 17, {0, 0}, 0, 1000, {255, 255}}, EXH_GLOVE_ERRORS},
        {6, {1 << 30, 1 << 20, {0, 0}, 0, 1000, {255, 255}}, EXH_GLOVE_ZERO},
        {6, {(1 << 30) - 1, 1 << 20, {0, 0}, 0, 1000, {255, 255}}, EXH_GLOVE_ERRORS},
        {6, {-(1 << 30), 1 << 20, {0, 0}, 0, 1000, {255, 255}}, EXH_GLOVE_ERRORS},
        {6, {-(1 << 30) - 1, 1 << 20, {0, 0}, 0, 1000, {255, 255}}, EXH_GLOVE_ZERO},
        {7, {0, 1 << 20, {0, 0}, 500, 563, {255, 255}}, EXH_GLOVE_SPAN},
        {7, {0, 1 << 20, {0, 0}, 500, 564, {255, 255}}, EXH_GLOVE_ERRORS},
        {7, {0, 1 << 20, {0, 0}, INT16_MIN, INT16_MAX, {255, 255}}, EXH_GLOVE_ERRORS},
        {7, {0, 1 << 20, {0, 0}, INT16_MAX, INT16_MIN, {255, 255}}, EXH_GLOVE_SPAN},
        {3, {0, 1 << 20, {1, 0}, 0, 1000, {22, 255}}, EXH_GLOVE_CROSS},
        {3, {0, 1 << 20, {0, 1}, 0, 1000, {255, 254}}, EXH_GLOVE_CROSS},
        {3, {0, 1 << 20, {1, 0}, 0, 1000, {3, 255}}, EXH_GLOVE_CROSS},   /* itself */
        {3, {0, 1 << 20, {1, 0}, 0, 1000, {10, 255}}, EXH_GLOVE_CROSS},  /* has some itself */
        {3, {0, 1 << 20, {1, 0}, 0, 1000, {255, 255}}, EXH_GLOVE_CROSS}, /* of none */
        {3, {0, 1 << 20, {INT32_MIN, INT32_MAX}, 0, 1000, {0, 21}}, EXH_GLOVE_ERRORS},
    };
    for (size_t i = 0; i < LEN(row); i++) {
        struct exh_glove_cal cal = sound();
        struct exh_glove_error bad = {99, 99};
        int err;
        cal.sensor[row[i].sensor] = row[i].s;
        err = exh_glove_cal_validate(&cal, &bad);
        CHECK(err == (row[i].what == EXH_GLOVE_ERRORS ? 0 : -EXH_E_RANGE), "row %zu: %d", i, err);
        CHECK(err == 0 || (bad.what == row[i].what && bad.at == row[i].sensor), "row %zu: %s of %d",
            i, exh_glove_error_text(bad.what), bad.at);
        CHECK(exh_glove_cal_validate(&cal, NULL) == err, "row %zu", i);
    }
}

TEST(present_and_absent)
{
    struct exh_glove_cal cal = sound();
    struct exh_glove_error bad = {99, 99};
    cal.present = 0;
    CHECK_EQ_I64(exh_glove_cal_validate(&cal, &bad), -EXH_E_RANGE);
    CHECK_EQ_I64(bad.what, EXH_GLOVE_PRESENT);
    cal.present = ALL | 1u << 22;
    CHECK_EQ_I64(exh_glove_cal_validate(&cal, &bad), -EXH_E_RANGE);
    CHECK_EQ_I64(bad.what, EXH_GLOVE_PRESENT);
    cal = (struct exh_glove_cal){
        7, 3, 20000, 30, 1u << 22, {{0}}}; /* that bit alone, of no sensor that is */
    for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
        cal.sensor[i].of[0] = cal.sensor[i].of[1] = EXH_GLOVE_NONE;
    }
    CHECK_EQ_I64(exh_glove_cal_validate(&cal, &bad), -EXH_E_RANGE);
    CHECK_EQ_I64(bad.what, EXH_GLOVE_PRESENT);
    cal = sound();
    cal.present = ALL & ~(1u << 6);
    CHECK_EQ_I64(exh_glove_cal_validate(&cal, &bad), -EXH_E_RANGE); /* absent with a gain */
    CHECK(bad.what == EXH_GLOVE_GAIN && bad.at == 6, "%d of %d", bad.what, bad.at);
    cal.sensor[6] = (struct exh_glove_sensor){0, 0, {1 << 29, 0}, 0, 0, {5, 255}};
    CHECK_EQ_I64(exh_glove_cal_validate(&cal, &bad), 0);
    for (unsigned k = 0; k < 2; k++) { /* of one that has a cross term itself */
        cal.sensor[9].of[k] = 0;
        cal.sensor[6].of[0] = 9;
        CHECK_EQ_I64(exh_glove_cal_validate(&cal, &bad), -EXH_E_RANGE);
        CHECK(bad.what == EXH_GLOVE_CROSS && bad.at == 6, "%d of %d", bad.what, bad.at);
        cal.sensor[9].of[k] = EXH_GLOVE_NONE;
    }
    CHECK_EQ_I64(exh_glove_cal_validate(&cal, &bad), 0);
    cal.present &= ~(1u << 9);
    cal.sensor[9] = (struct exh_glove_sensor){0, 0, {0, 0}, 0, 0, {255, 255}};
    CHECK_EQ_I64(exh_glove_cal_validate(&cal, &bad), -EXH_E_RANGE); /* of one that is not there */
    CHECK(bad.what == EXH_GLOVE_CROSS && bad.at == 6, "%d of %d", bad.what, bad.at);
}

TEST(check_tells_whose_and_when)
{
    static const struct {
        uint32_t user, glove, day;
        int err, what;
    } row[] = {
        {7, 3, 20000, 0, 0},
        {7, 3, 20030, 0, 0},
        {7, 3, 20031, -EXH_E_STALE, EXH_GLOVE_AGE},
        {7, 3, 19999, -EXH_E_STALE, EXH_GLOVE_AGE},
        {7, 3, UINT32_MAX, -EXH_E_STALE, EXH_GLOVE_AGE},
        {8, 3, 20000, -EXH_E_VERSION, EXH_GLOVE_USER},
        {7, 4, 20000, -EXH_E_VERSION, EXH_GLOVE_GLOVE},
        {8, 4, 0, -EXH_E_VERSION, EXH_GLOVE_USER},
    };
    struct exh_glove_cal cal = sound();
    struct exh_glove_error bad = {99, 99};
    for (size_t i = 0; i < LEN(row); i++) {
        const int err = exh_glove_cal_check(&cal, row[i].user, row[i].glove, row[i].day, &bad);
        CHECK(err == row[i].err && (err == 0 || (bad.what == row[i].what && bad.at == 0)),
            "row %zu: %d, %s", i, err, exh_glove_error_text(bad.what));
    }
    cal.valid_days = UINT32_MAX; /* for ever, but not before */
    CHECK_EQ_I64(exh_glove_cal_check(&cal, 7, 3, UINT32_MAX, &bad), 0);
    CHECK_EQ_I64(exh_glove_cal_check(&cal, 7, 3, 19999, &bad), -EXH_E_STALE);
    cal.present = 0;
    CHECK_EQ_I64(exh_glove_cal_check(&cal, 7, 3, 20000, &bad), -EXH_E_RANGE);
    CHECK_EQ_I64(bad.what, EXH_GLOVE_PRESENT);
}

TEST(every_word_is_there)
{
    for (unsigned i = 0; i <= EXH_GLOVE_ERRORS; i++) {
        CHECK(check_same_text(exh_glove_error_text(i), "unknown") == (i == EXH_GLOVE_ERRORS), "%u",
            i);
    }
    for (unsigned i = 0; i <= EXH_GLOVE_SENSORS; i++) {
        CHECK(check_same_text(exh_glove_sensor_text(i), "unknown") == (i == EXH_GLOVE_SENSORS),
            "%u", i);
    }
    CHECK(check_same_text(exh_glove_sensor_text(EXH_GLOVE_LITTLE_RING_AB), "PinkieRingAb"), "18");
}

/* --- image --- */

TEST(image_round_trip)
{
    struct exh_glove_cal cal = sound(), back;
    uint8_t a[EXH_GLOVE_CAL_IMAGE_B + 1], b[EXH_GLOVE_CAL_IMAGE_B];
    struct exh_glove_error bad = {99, 99};
    memset(&back, 0xA5, sizeof back);
    CHECK_EQ_I64(exh_glove_cal_save(&cal, a, sizeof a, &bad), EXH_GLOVE_CAL_IMAGE_B);
    CHECK(memcmp(a, "EXHG\x01\0\x16\0\x07\0\0\0\x03", 13) == 0, "head");
    CHECK_EQ_I64(exh_glove_cal_load(&back, a, sizeof a, &bad), 0);
    CHECK_EQ_I64(exh_glove_cal_save(&back, b, sizeof b, &bad), EXH_GLOVE_CAL_IMAGE_B);
    CHECK(memcmp(a, b, sizeof b) == 0, "written again it differs");
    CHECK(back.valid_days == 30 && back.sensor[10].cross_q30[1] == 87654321 &&
              back.sensor[21].low_raw == cal.sensor[21].low_raw &&
              back.sensor[20].gain_turnpraw_q38 == cal.sensor[20].gain_turnpraw_q38,
        "values");
}

TEST(every_flipped_bit_is_seen)
{
    struct exh_glove_cal cal = sound();
    uint8_t image[EXH_GLOVE_CAL_IMAGE_B];
    struct exh_glove_error bad;
    CHECK(exh_glove_cal_save(&cal, image, sizeof image, &bad) > 0, "save");
    for (size_t bit = 0; bit < 8 * sizeof image; bit++) {
        int err;
        image[bit / 8] ^= (uint8_t)(1u << bit % 8);
        bad.what = 99;
        err = exh_glove_cal_load(&cal, image, sizeof image, &bad);
        CHECK(err == (bit < 64 ? -EXH_E_VERSION : -EXH_E_CRC), "bit %zu: %d", bit, err);
        CHECK(bad.what == EXH_GLOVE_IMAGE && cal.present == 0, "bit %zu", bit);
        image[bit / 8] ^= (uint8_t)(1u << bit % 8);
    }
    CHECK_EQ_I64(exh_glove_cal_load(&cal, image, sizeof image, &bad), 0);
}

TEST(every_cut_is_seen)
{
    struct exh_glove_cal cal = sound();
    uint8_t image[EXH_GLOVE_CAL_IMAGE_B];
    struct exh_glove_error bad;
    CHECK(exh_glove_cal_save(&cal, image, sizeof image, &bad) > 0, "save");
    for (size_t len = 0; len < sizeof image; len++) {
        CHECK(exh_glove_cal_load(&cal, image, len, &bad) == -EXH_E_SHORT && cal.present == 0,
            "%zu bytes", len);
        CHECK_EQ_I64(bad.what, EXH_GLOVE_IMAGE);
    }
    cal = sound();
    for (size_t cap = 0; cap < sizeof image; cap++) {
        CHECK(exh_glove_cal_save(&cal, image, cap, &bad) == -EXH_E_SHORT, "room for %zu", cap);
    }
}

/* Sound bytes of an unsound calibration: refused for what it says. */
TEST(an_image_of_nonsense_is_refused)
{
    struct exh_glove_cal cal = sound();
    uint8_t image[EXH_GLOVE_CAL_IMAGE_B];
    struct exh_glove_error bad = {99, 99};
    struct exh_bytes b;
    uint32_t crc;
    int32_t zero = 0;
    cal.sensor[4].gain_turnpraw_q38 = 0;
    CHECK_EQ_I64(exh_glove_cal_save(&cal, image, sizeof image, &bad), -EXH_E_RANGE);
    CHECK(bad.what == EXH_GLOVE_GAIN && bad.at == 4, "saved");
    cal = sound();
    CHECK(exh_glove_cal_save(&cal, image, sizeof image, &bad) > 0, "save");
    b = exh_bytes_writer(image + 28 + 4 * 22 + 4, 4);
    exh_bytes_i32(&b, &zero);
    crc = exh_crc32(0, image, sizeof image - 4);
    b = exh_bytes_writer(image + sizeof image - 4, 4);
    exh_bytes_u32(&b, &crc);
    CHECK_EQ_I64(exh_glove_cal_load(&cal, image, sizeof image, &bad), -EXH_E_RANGE);
    CHECK(bad.what == EXH_GLOVE_GAIN && bad.at == 4 && cal.present == 0, "%s",
        exh_glove_error_text(bad.what));
}

/* --- the default glove of the library --- */

/* Ends of each channel in thousandths of the converter's -9 .. 9 V of +-10 V, and the joint's
 * angles there. */
TEST(the_default_goes_through_its_ends)
{
    static const int16_t of[EXH_GLOVE_SENSORS][4] = {{335, 697, -60, 60}, {311, 736, -30, 30},
        {461, 909, 0, 90}, {791, 350, 0, 50}, {429, 654, 0, 90}, {181, 654, 0, 90},
        {185, 469, 0, 90}, {417, 630, 0, 90}, {268, 591, 0, 90}, {0, 323, 0, 90}, {468, 390, 0, 50},
        {323, 571, 0, 90}, {240, 618, 0, 90}, {177, 390, 0, 90}, {610, 283, 0, 50},
        {354, 591, 0, 90}, {154, 602, 0, 90}, {319, 579, 0, 90}, {516, 209, 0, 50},
        {357, 650, 0, 40}, {154, 622, -30, 40}, {925, 236, -30, 10}};
    for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
        const struct exh_glove_sensor *s = &exh_glove_cal_default.sensor[i];
        int16_t end[2];
        for (unsigned e = 0; e < 2; e++) {
            const int64_t code_q15 = (2 * of[i][e] - 1000) * (INT64_C(294912) << 15) / 10000;
            const int64_t turn_q32 =
                (code_q15 - s->zero_raw_q15) * s->gain_turnpraw_q38 / (1 << 21);
            const int64_t off_q32 = turn_q32 - of[i][2 + e] * (INT64_C(1) << 32) / 360;
            CHECK(off_q32 <= 1 << 15 && -off_q32 <= 1 << 15, "sensor %u, end %u", i, e);
            end[e] = (int16_t)((2 * of[i][e] - 1000) * INT64_C(294912) / 10000);
        }
        { /* 58982.4 codes times 360 degrees; the last gain below */
            const int64_t n = (of[i][3] - of[i][2]) * (INT64_C(1) << 38) * 1000;
            const int64_t d = (of[i][1] > of[i][0] ? of[i][1] - of[i][0] : of[i][0] - of[i][1]) *
                              INT64_C(21233664);
            const int64_t g = of[i][1] > of[i][0] ? s->gain_turnpraw_q38 : -s->gain_turnpraw_q38;
            CHECK(g * d <= n && (g + 1) * d > n, "sensor %u: gain", i);
        }
        CHECK(s->low_raw == (end[0] < end[1] ? end[0] : end[1]), "sensor %u: low", i);
        CHECK(s->high_raw == (end[0] < end[1] ? end[1] : end[0]), "sensor %u: high", i);
        CHECK(s->cross_q30[0] == 0 && s->cross_q30[1] == 0 && s->of[0] == EXH_GLOVE_NONE &&
                  s->of[1] == EXH_GLOVE_NONE,
            "sensor %u: cross", i);
    }
    CHECK(exh_glove_cal_default.user_id == 0 && exh_glove_cal_default.glove_id == 0 &&
              exh_glove_cal_default.day == 0,
        "somebody's");
    CHECK(exh_glove_cal_default.valid_days == UINT32_MAX && exh_glove_cal_default.present == ALL,
        "for ever, and all");
}

/* A bit beyond the last sensor does not make it one. */
TEST(no_cross_term_of_what_is_no_sensor)
{
    struct {
        struct exh_glove_cal cal;
        struct exh_glove_sensor beyond; /* as one would be that is there and has no cross terms */
    } of;
    of.cal = sound();
    of.beyond = of.cal.sensor[0];
    of.cal.present = UINT32_MAX;
    of.cal.sensor[6].of[0] = EXH_GLOVE_SENSORS;
    of.cal.sensor[6].cross_q30[0] = 1;
    CHECK_EQ_I64(exh_glove_sensor_validate(&of.cal, 6), EXH_GLOVE_CROSS);
}

TEST_MAIN("unit/glove_cal", valid_names_the_culprit, present_and_absent, check_tells_whose_and_when,
    every_word_is_there, image_round_trip, every_flipped_bit_is_seen, every_cut_is_seen,
    an_image_of_nonsense_is_refused, the_default_goes_through_its_ends,
    no_cross_term_of_what_is_no_sensor);
