/* SPDX-License-Identifier: MIT */
/* PROVES: calibration of a glove
 * Any bytes of any length as a calibration. An accepted one has its sensors, ends and terms in
 * range; a refused one has no sensor present. Any calibration is judged for any user, glove and
 * day, and written into a buffer of any size.
 *
 * PLANT: lib/src/sense/glove_cal.c: of >= EXH_GLOVE_SENSORS || -> 0 ||
 * PLANT: lib/src/sense/glove_cal.c: const int64_t gain = s->gain_turnpraw_q38; -> const int32_t gain = s->gain_turnpraw_q38;
 * PLANT: lib/src/sense/glove_cal.c: if (err < 0) { cal->present = 0; } -> (void)0;
 * PLANT: lib/src/sense/glove_cal.c: struct head h = {0, 0, 0}; -> struct head h;
 */
#include "num/bytes.c"
#include "num/crc.c"
#include "sense/glove_cal.c"

#include "any.h"

#define IMAGE_B EXH_GLOVE_CAL_IMAGE_B

static struct exh_glove_cal cal;
static struct exh_glove_error bad;
static uint8_t image_B[IMAGE_B + 1], small_B[20];

static void judged(void)
{
    ANY(cal);
    (void)exh_glove_cal_validate(&cal, &bad);
    (void)exh_glove_cal_check(&cal, any_u32(), any_u32(), any_u32(), &bad);
}

static void read(size_t len_B)
{
    int err;
    ANY(image_B);
    err = exh_glove_cal_load(&cal, image_B, len_B, &bad);
    if (err < 0) {
        /*@ assert none_present: cal.present == 0; */
    } else {
        /*@ assert some_present: 1 <= cal.present < 1 << 22; */
    }
}

static void written(uint8_t *buf, size_t cap_B)
{
    ANY(cal);
    (void)exh_glove_cal_save(&cal, buf, cap_B, NULL);
}

int main(void)
{
    judged();
    read(IMAGE_B);
    read(IMAGE_B + 1);
    read(IMAGE_B - 1);
    read(8);
    read(7);
    read(0);
    written(image_B, IMAGE_B);
    written(image_B, IMAGE_B - 1);
    written(small_B, sizeof small_B);
    END();
    return 0;
}
