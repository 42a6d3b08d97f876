/* SPDX-License-Identifier: MIT */
/* calibrate: mean, fit, the two tables made of the points, the image. */
#include "modules.h"

#include "exhand/calibrate.h"

#define POINTS 5

static int32_t any_mean(struct golden_rng *r)
{
    struct exh_mean m = {0, 0};
    const int64_t n = golden_draw(r, 0, 9);
    for (int64_t i = 0; i < n; i++) {
        const int64_t v = golden_draw(r, INT32_MIN, INT32_MAX);
        exh_mean_add(&m, (int32_t)(v >> golden_draw(r, 0, 31)));
    }
    return exh_mean_value(&m);
}

/* Rising points of one device: 1 to 20 N/A, each a little off. */
static uint8_t any_points(struct golden_rng *r, struct exh_calib_point *p)
{
    const int64_t kf = golden_draw(r, 1, 20);
    const int64_t n = golden_draw(r, 1, POINTS);
    int64_t f = 0;
    int64_t i = 0;
    int64_t m = 0;
    for (int64_t k = 0; k < n; k++) {
        const int64_t df = golden_draw(r, INT32_C(1) << 18, INT32_C(1) << 20);
        f += df;
        i += df * 64 / kf * golden_draw(r, 90, 110) / 100;
        m += df * 64 / kf * golden_draw(r, 80, 120) / 100;
        p[k].force_N_q20 = (int32_t)f;
        p[k].cur_A_q26 = (int32_t)i;
        p[k].mon_A_q26 = (int32_t)m;
        p[k].friction_A_q26 = (int32_t)golden_draw(r, 0, INT32_C(1) << 24);
    }
    return (uint8_t)n;
}

static void any_values(struct golden_rng *r, struct exh_calib *c)
{
    c->device_id = (uint32_t)(golden_u64(r) & UINT32_MAX);
    c->finger = (uint32_t)golden_draw(r, 0, 4);
    c->day = (uint32_t)golden_draw(r, 1, 30000);
    c->valid_days = (uint32_t)golden_draw(r, 0, 366);
    c->dac_rawpA_q16 = (int32_t)golden_draw(r, 65536, INT32_MAX);
    c->dac_zero_raw = (int32_t)golden_draw(r, 0, 65535);
    c->mon_A_q40 = (int32_t)golden_draw(r, 1, INT32_MAX);
    c->mon_zero_raw = (int32_t)golden_draw(r, -32768, 32767);
    c->f0_A_q26 = (int32_t)golden_draw(r, 0, 442918502);
    c->end_A_q26 = (int32_t)golden_draw(r, 0, 442918502);
}

static void put_fits(struct golden *g, struct golden_rng *r, const struct exh_calib *c)
{
    struct exh_calib_fit fit[2];
    int64_t at;
    int64_t which;
    golden_put(g, c->points);
    for (which = 0; which < 2; which++) {
        CHECK_EQ_I64(exh_calib_fit(&fit[which], c->point, c->points,
                         which == 0 ? EXH_CALIB_CURRENT : EXH_CALIB_MONITOR),
            0);
        golden_put(g, fit[which].kf_NpA_q20);
        golden_put(g, fit[which].gain.mant);
        golden_put(g, fit[which].gain.shift);
    }
    at = golden_draw(r, 0, c->points - 1);
    which = golden_draw(r, 0, 1);
    golden_put(g, exh_calib_residual_N_q20(&fit[which], &c->point[at],
                      which == 0 ? EXH_CALIB_CURRENT : EXH_CALIB_MONITOR));
}

/* Saves, spoils now and then, loads. */
static void put_image(struct golden *g, struct golden_rng *r, const struct exh_calib *c)
{
    uint8_t buf[EXH_CALIB_IMAGE_B];
    struct exh_calib_point point[POINTS];
    struct exh_calib again = {.point = point, .cap = POINTS};
    const int32_t size = exh_calib_save(c, buf, sizeof buf, NULL);
    CHECK(size > 0, "image: %" PRId32, size);
    golden_put(g, size);
    golden_put(g, exh_crc32(0, buf, (size_t)size - 1)); /* over all, the CRC is constant */
    const int spoilt = golden_draw(r, 0, 3) == 0;
    const int64_t where = golden_draw(r, 64, 8 * (int64_t)size - 1);
    if (spoilt) { buf[where >> 3] ^= (uint8_t)(UINT32_C(1) << (where & 7)); }
    golden_put(g, exh_calib_load(&again, buf, (size_t)size, NULL));
}

/* The same place and day, but for one thing. */
static void put_check(struct golden *g, struct golden_rng *r, const struct exh_calib *c)
{
    const int64_t other = golden_draw(r, 0, 9);
    const uint32_t by = (uint32_t)golden_draw(r, 1, 500);
    struct exh_calib_error bad = {0, 0};
    struct exh_calib_target h = {c->device_id, c->finger, c->day, c->dac_rawpA_q16, c->dac_zero_raw,
        c->mon_A_q40, c->mon_zero_raw};
    int err;
    if (other == 0) { h.device_id ^= by; }
    if (other == 1) { h.finger += by; }
    if (other == 2) { h.day += by; }
    if (other == 3) { h.day -= by < h.day ? by : h.day; }
    if (other == 4) { h.dac_rawpA_q16 ^= 1; }
    if (other == 5) { h.dac_zero_raw ^= 1; }
    if (other == 6) { h.mon_A_q40 ^= 1; }
    if (other == 7) { h.mon_zero_raw ^= 1; }
    err = exh_calib_check(c, &h, &bad);
    golden_put(g, err);
    golden_put(g, err == 0 ? 0 : bad.what);
}

static void knots(struct exh_bytes *c, struct exh_knot *knot, int n)
{
    for (int i = 0; i < n; i++) {
        struct exh_gain slope = i < n - 1 ? knot[i].slope : (struct exh_gain){0, 0};
        exh_bytes_i32(c, &knot[i].x);
        exh_bytes_i32(c, &knot[i].y);
        exh_bytes_i32(c, &slope.mant);
        exh_bytes_u8(c, &slope.shift);
    }
}

static void put_tables(struct golden *g, const struct exh_calib *c)
{
    struct exh_knot knot[2 * POINTS + 3];
    struct exh_bytes b = golden_state(g);
    int n = exh_calib_force_table(c, knot, 2 * POINTS + 3, NULL);
    CHECK(n > 0, "force table: %d", n);
    knots(&b, knot, n);
    n = exh_calib_monitor_table(c, knot, 2 * POINTS + 3, NULL);
    CHECK(n > 0, "monitor table: %d", n);
    knots(&b, knot, n);
    golden_state_end(g, &b);
}

/* One point that is not above the one before. */
static void put_spoilt(struct golden *g, struct golden_rng *r, const struct exh_calib *c)
{
    const int64_t at = golden_draw(r, 0, c->points - 1);
    const int64_t which = golden_draw(r, 0, 1);
    struct exh_calib_error bad = {0, 0};
    int err;
    if (at > 0) {
        int32_t *v = which == 0 ? &c->point[at].cur_A_q26 : &c->point[at].mon_A_q26;
        *v = which == 0 ? c->point[at - 1].cur_A_q26 : c->point[at - 1].mon_A_q26;
        *v -= (int32_t)golden_draw(r, 0, 1);
    }
    err = exh_calib_validate(c, &bad);
    golden_put(g, err);
    golden_put(g, err == 0 ? 0 : bad.what);
    golden_put(g, err == 0 ? 0 : bad.at);
}

void golden_calibrate(struct golden *g, uint32_t rate_Hz)
{
    struct golden_rng r = golden_rng("calibrate", rate_Hz, 0);
    while (g->tick < GOLDEN_TICKS) {
        struct exh_calib_point point[POINTS];
        struct exh_calib c = {.point = point, .cap = POINTS};
        golden_put(g, any_mean(&r));
        c.points = any_points(&r, point);
        any_values(&r, &c);
        put_fits(g, &r, &c);
        if (g->tick % 4 == 0) {
            put_image(g, &r, &c);
        } else {
            for (int i = 0; i < 3; i++) { golden_put(g, 0); }
        }
        put_check(g, &r, &c);
        put_tables(g, &c);
        put_spoilt(g, &r, &c);
        golden_tick(g);
    }
}
