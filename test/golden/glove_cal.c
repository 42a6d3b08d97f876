/* SPDX-License-Identifier: MIT */
/* glove_cal: a glove's calibration as an image, what is refused of it and when. */
#include "modules.h"

#include "exhand/glove.h"

/* Saves, spoils now and then, loads. */
static void put_image(struct golden *g, struct golden_rng *r, const struct exh_glove_cal *cal)
{
    uint8_t buf[EXH_GLOVE_CAL_IMAGE_B];
    static struct exh_glove_cal again;
    const int32_t size = exh_glove_cal_save(cal, buf, sizeof buf, NULL);
    int spoilt;
    int64_t where;
    CHECK(size == (int32_t)sizeof buf, "image: %" PRId32, size);
    golden_put(g, size);
    golden_put(g, exh_crc32(0, buf, sizeof buf - 1)); /* over all, the CRC is constant */
    spoilt = golden_draw(r, 0, 3) == 0;
    where = golden_draw(r, 64, 8 * (int64_t)sizeof buf - 1);
    if (spoilt) { buf[where >> 3] ^= (uint8_t)(UINT32_C(1) << (where & 7)); }
    golden_put(g, exh_glove_cal_load(&again, buf, sizeof buf, NULL));
}

/* The same user, glove and day, but for one of them. */
static void put_check(struct golden *g, struct golden_rng *r, const struct exh_glove_cal *cal)
{
    const int64_t other = golden_draw(r, 0, 4);
    const uint32_t by = (uint32_t)golden_draw(r, 1, 500);
    struct exh_glove_error bad = {0, 0};
    uint32_t day = cal->day;
    int err;
    if (other == 2) { day += by; }
    if (other == 3) { day -= by < day ? by : day; }
    err = exh_glove_cal_check(cal, other == 0 ? cal->user_id ^ by : cal->user_id,
        other == 1 ? cal->glove_id + by : cal->glove_id, day, &bad);
    golden_put(g, err);
    golden_put(g, err == 0 ? 0 : bad.what);
}

/* One thing that is not as it should be. */
static void spoil(struct golden_rng *r, struct exh_glove_cal *cal)
{
    static const uint8_t crossed[] = {3, 10, 14, 18};
    const int64_t what = golden_draw(r, 0, 6);
    const uint32_t at = (uint32_t)golden_draw(r, 0, EXH_GLOVE_SENSORS - 1);
    const int32_t little = (int32_t)golden_draw(r, -131071, 131071);
    const int present = cal->present >> at & 1;
    struct exh_glove_sensor *s = &cal->sensor[at];
    switch (what) {
    case 0: cal->present = at & 1 ? 0 : cal->present | UINT32_C(1) << EXH_GLOVE_SENSORS; break;
    case 1: s->gain_turnpraw_q38 = little; break;
    case 2:
        if (present) { s->zero_raw_q15 = little < 0 ? -(INT32_C(1) << 30) - 1 : INT32_C(1) << 30; }
        break;
    case 3: s->high_raw = (int16_t)(s->low_raw + EXH_GLOVE_SPAN_MIN_RAW - 1); break;
    case 4: cal->sensor[crossed[at & 3]].of[0] = crossed[at >> 2 & 3]; break;
    case 5: cal->sensor[crossed[at & 3]].of[1] = EXH_GLOVE_SENSORS; break;
    default: break;
    }
}

void golden_glove_cal(struct golden *g, uint32_t rate_Hz)
{
    static struct exh_glove_cal whole;
    static struct exh_glove_cal cal;
    struct golden_rng r = golden_rng("glove_cal", rate_Hz, 0);
    while (g->tick < GOLDEN_TICKS) {
        struct exh_glove_error bad = {0, 0};
        int err;
        if (g->tick % 8 == 0) { golden_glove_sensors(&whole, &r); }
        whole.user_id = (uint32_t)(golden_u64(&r) & UINT32_MAX);
        whole.glove_id = (uint32_t)(golden_u64(&r) & UINT32_MAX);
        whole.day = (uint32_t)golden_draw(&r, 1, 30000);
        whole.valid_days = (uint32_t)golden_draw(&r, 0, 400);
        if (g->tick % 4 == 0) {
            put_image(g, &r, &whole);
        } else {
            for (int i = 0; i < 3; i++) { golden_put(g, 0); }
        }
        put_check(g, &r, &whole);
        cal = whole;
        spoil(&r, &cal);
        err = exh_glove_cal_validate(&cal, &bad);
        golden_put(g, err);
        golden_put(g, err == 0 ? 0 : bad.what);
        golden_put(g, err == 0 ? 0 : bad.at);
        golden_tick(g);
    }
}
