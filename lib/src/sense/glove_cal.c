/* SPDX-License-Identifier: MIT */
/* Calibration of a user's glove: checks, image, and a default. */
#include "exhand/glove.h"

#include "exhand/error.h"

#define IMAGE_MAGIC           0x47485845u        /* "EXHG" */
#define GAIN_MIN_TURNPRAW_Q38 (INT32_C(1) << 17) /* 2^-21 turn per code: 11 degrees in all */
#define ZERO_END_RAW_Q15      (INT32_C(1) << 30)

/* --- the default --- */

/* From normalised end points in thousandths and their angles in degrees. -9 .. 9 V of a +-10 V card
 * are 58982.4 codes. All quotients are exact to one LSB. */
#define CODE(m) ((int16_t)((2 * (m)-1000) * INT64_C(294912) / 10000))
#define ZERO_Q15(m0, m1, d0, d1) \
    ((int32_t)((2 * ((m0)*INT64_C(1) * ((d1) - (d0)) - (d0)*INT64_C(1) * ((m1) - (m0))) - \
                   1000 * INT64_C(1) * ((d1) - (d0))) * \
               (INT64_C(294912) << 15) / (((d1) - (d0)) * INT64_C(10000))))
#define GAIN_Q38(m0, m1, d0, d1) \
    ((int32_t)(((d1) - (d0)) * (INT64_C(1) << 38) * 1000 / (((m1) - (m0)) * INT64_C(21233664))))
#define NO_CROSS \
    { \
        EXH_GLOVE_NONE, EXH_GLOVE_NONE \
    }
#define LINE(m0, m1, d0, d1, low, high) \
    { \
        ZERO_Q15(m0, m1, d0, d1), GAIN_Q38(m0, m1, d0, d1), {0, 0}, CODE(low), CODE(high), \
            NO_CROSS \
    }
#define UP(m0, m1, d0, d1)   LINE(m0, m1, d0, d1, m0, m1)
#define DOWN(m0, m1, d0, d1) LINE(m0, m1, d0, d1, m1, m0)

const struct exh_glove_cal exh_glove_cal_default = {
    .valid_days = UINT32_MAX,
    .present = (UINT32_C(1) << EXH_GLOVE_SENSORS) - 1u,
    .sensor = {UP(335, 697, -60, 60), UP(311, 736, -30, 30), UP(461, 909, 0, 90),
        DOWN(791, 350, 0, 50), UP(429, 654, 0, 90), UP(181, 654, 0, 90), UP(185, 469, 0, 90),
        UP(417, 630, 0, 90), UP(268, 591, 0, 90), UP(0, 323, 0, 90), DOWN(468, 390, 0, 50),
        UP(323, 571, 0, 90), UP(240, 618, 0, 90), UP(177, 390, 0, 90), DOWN(610, 283, 0, 50),
        UP(354, 591, 0, 90), UP(154, 602, 0, 90), UP(319, 579, 0, 90), DOWN(516, 209, 0, 50),
        UP(357, 650, 0, 40), UP(154, 622, -30, 40), DOWN(925, 236, -30, 10)},
};

/* --- names --- */

const char *exh_glove_sensor_text(unsigned sensor)
{
    static const char *const text[EXH_GLOVE_SENSORS] = {
        "ThumbRotate",
        "ThumbMPJ",
        "ThumbIJ",
        "ThumbAb",
        "IndexMPJ",
        "IndexPIJ",
        "IndexDIJ",
        "MiddleMPJ",
        "MiddlePIJ",
        "MiddleDIJ",
        "MiddleIndexAb",
        "RingMPJ",
        "RingPIJ",
        "RingDIJ",
        "RingMiddleAb",
        "PinkieMPJ",
        "PinkiePIJ",
        "PinkieDIJ",
        "PinkieRingAb",
        "PalmArch",
        "WristPitch",
        "WristYaw",
    };
    return sensor < EXH_GLOVE_SENSORS ? text[sensor] : "unknown";
}

const char *exh_glove_error_text(unsigned what)
{
    static const char *const text[EXH_GLOVE_ERRORS] = {
        "image",
        "user",
        "glove",
        "age",
        "sensors present",
        "gain",
        "zero",
        "calibrated span",
        "cross-coupling",
        "poses",
        "movement between poses",
        "noise in a pose",
        "residual",
    };
    return what < EXH_GLOVE_ERRORS ? text[what] : "unknown";
}

static int refuse(struct exh_glove_error *bad, unsigned what, unsigned at, int err)
{
    if (bad != NULL) { *bad = (struct exh_glove_error){(uint8_t)what, (uint8_t)at}; }
    return err;
}

/* --- checks --- */

/* A cross term must refer to a present sensor that has no cross terms. So one pass suffices. */
static int cross_ok(const struct exh_glove_cal *cal, unsigned at)
{
    for (unsigned k = 0; k < 2; k++) {
        const unsigned of = cal->sensor[at].of[k];
        if (of == EXH_GLOVE_NONE) {
            if (cal->sensor[at].cross_q30[k] != 0) { return 0; }
        } else if (of >= EXH_GLOVE_SENSORS || !(cal->present >> of & 1) ||
                   cal->sensor[of].of[0] != EXH_GLOVE_NONE ||
                   cal->sensor[of].of[1] != EXH_GLOVE_NONE) {
            return 0;
        }
    }
    return 1;
}

unsigned exh_glove_sensor_validate(const struct exh_glove_cal *cal, unsigned at)
{
    const struct exh_glove_sensor *s = &cal->sensor[at];
    const int present = (int)(cal->present >> at & 1);
    const int64_t gain = s->gain_turnpraw_q38; /* 64 bits: -2^31 has a magnitude here */
    const int64_t size = gain < 0 ? -gain : gain;
    if (present ? size < GAIN_MIN_TURNPRAW_Q38 || size > INT32_MAX : size != 0) {
        return EXH_GLOVE_GAIN;
    }
    if (s->zero_raw_q15 < -ZERO_END_RAW_Q15 || s->zero_raw_q15 >= ZERO_END_RAW_Q15) {
        return EXH_GLOVE_ZERO;
    }
    if (present && (int32_t)s->high_raw - s->low_raw < EXH_GLOVE_SPAN_MIN_RAW) {
        return EXH_GLOVE_SPAN;
    }
    return cross_ok(cal, at) ? EXH_GLOVE_ERRORS : EXH_GLOVE_CROSS;
}

int exh_glove_cal_validate(const struct exh_glove_cal *cal, struct exh_glove_error *bad)
{
    if (cal->present == 0 || cal->present >= UINT32_C(1) << EXH_GLOVE_SENSORS) {
        return refuse(bad, EXH_GLOVE_PRESENT, 0, -EXH_E_RANGE);
    }
    for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
        const unsigned what = exh_glove_sensor_validate(cal, i);
        if (what != EXH_GLOVE_ERRORS) { return refuse(bad, what, i, -EXH_E_RANGE); }
    }
    return 0;
}

int exh_glove_cal_check(const struct exh_glove_cal *cal, uint32_t user_id, uint32_t glove_id,
    uint32_t day, struct exh_glove_error *bad)
{
    if (cal->present == 0) { return refuse(bad, EXH_GLOVE_PRESENT, 0, -EXH_E_RANGE); }
    if (cal->user_id != user_id) { return refuse(bad, EXH_GLOVE_USER, 0, -EXH_E_VERSION); }
    if (cal->glove_id != glove_id) { return refuse(bad, EXH_GLOVE_GLOVE, 0, -EXH_E_VERSION); }
    if (day < cal->day || day - cal->day > cal->valid_days) {
        return refuse(bad, EXH_GLOVE_AGE, 0, -EXH_E_STALE);
    }
    return 0;
}

/* --- image --- */

struct head {
    uint32_t magic;
    uint16_t version, sensors;
};

static void head_bytes(struct exh_bytes *b, struct head *h)
{
    exh_bytes_u32(b, &h->magic);
    exh_bytes_u16(b, &h->version);
    exh_bytes_u16(b, &h->sensors);
}

/* All fields after the head except the CRC. */
static void body_bytes(struct exh_bytes *b, struct exh_glove_cal *cal)
{
    exh_bytes_u32(b, &cal->user_id);
    exh_bytes_u32(b, &cal->glove_id);
    exh_bytes_u32(b, &cal->day);
    exh_bytes_u32(b, &cal->valid_days);
    exh_bytes_u32(b, &cal->present);
    for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
        struct exh_glove_sensor *s = &cal->sensor[i];
        exh_bytes_i32(b, &s->zero_raw_q15);
        exh_bytes_i32(b, &s->gain_turnpraw_q38);
        exh_bytes_i32(b, &s->cross_q30[0]);
        exh_bytes_i32(b, &s->cross_q30[1]);
        exh_bytes_i16(b, &s->low_raw);
        exh_bytes_i16(b, &s->high_raw);
        exh_bytes_u8(b, &s->of[0]);
        exh_bytes_u8(b, &s->of[1]);
    }
}

int32_t exh_glove_cal_save(
    const struct exh_glove_cal *cal, void *buf, size_t cap_B, struct exh_glove_error *bad)
{
    struct head h = {IMAGE_MAGIC, EXH_GLOVE_CAL_VERSION, EXH_GLOVE_SENSORS};
    struct exh_bytes b = exh_bytes_writer(buf, cap_B);
    struct exh_glove_cal copy = *cal; /* the cursor's functions also read */
    uint32_t crc;
    const int err = exh_glove_cal_validate(cal, bad);
    if (err < 0) { return err; }
    head_bytes(&b, &h);
    body_bytes(&b, &copy);
    crc = exh_bytes_ok(&b) ? exh_crc32(0, buf, b.at) : 0;
    exh_bytes_u32(&b, &crc);
    return exh_bytes_ok(&b) ? (int32_t)b.at : refuse(bad, EXH_GLOVE_IMAGE, 0, -EXH_E_SHORT);
}

static int load(struct exh_glove_cal *cal, const void *buf, size_t len_B)
{
    struct exh_bytes b = exh_bytes_reader(buf, len_B);
    struct head h = {0, 0, 0};
    uint32_t at, crc = 0;
    head_bytes(&b, &h);
    if (!exh_bytes_ok(&b)) { return -EXH_E_SHORT; }
    if (h.magic != IMAGE_MAGIC || h.version != EXH_GLOVE_CAL_VERSION ||
        h.sensors != EXH_GLOVE_SENSORS) {
        return -EXH_E_VERSION;
    }
    body_bytes(&b, cal);
    at = b.at;
    exh_bytes_u32(&b, &crc);
    if (!exh_bytes_ok(&b)) { return -EXH_E_SHORT; }
    return crc == exh_crc32(0, buf, at) ? 0 : -EXH_E_CRC;
}

int exh_glove_cal_load(
    struct exh_glove_cal *cal, const void *buf, size_t len_B, struct exh_glove_error *bad)
{
    int err = load(cal, buf, len_B);
    if (err < 0) {
        (void)refuse(bad, EXH_GLOVE_IMAGE, 0, err);
    } else {
        err = exh_glove_cal_validate(cal, bad);
    }
    if (err < 0) { cal->present = 0; }
    return err;
}
