/* SPDX-License-Identifier: MIT */
/* Calibration of a finger: fit of its points, the tables made from them, and its image. */
#include "exhand/calibrate.h"

#include "exhand/bytes.h"
#include "exhand/error.h"
#include "exhand/frame.h"

#define IMAGE_MAGIC   0x43485845u /* "EXHC" */
#define IMAGE_CRC_B   4u
#define CUR_MAX_A_Q26 EXH_Q(66, 10, EXH_Q_CUR)
#define MON_MAX_A_Q26 EXH_Q(10, 1, EXH_Q_CUR)
#define RATIO_MAX_NPA 2047 /* the minimum is 0.1 */

/* --- mean --- */

void exh_mean_add(struct exh_mean *m, int32_t v)
{
    if (m->n == INT32_MAX) { return; }
    m->sum += v;
    m->n++;
}

int32_t exh_mean_value(const struct exh_mean *m)
{
    /* Adding n 2^31 makes the sum non-negative and the quotient larger by 2^31. */
    const int64_t lift = (int64_t)m->n << 31;
    uint64_t quot, rem;
    if (m->n == 0) { return 0; }
    quot = exh_udiv64((uint64_t)(m->sum + lift), m->n, &rem);
    if (rem >= m->n - rem) { quot++; } /* half up */
    return exh_sat32((int64_t)quot - (INT64_C(1) << 31));
}

/* --- the line through the origin --- */

static int32_t current_of(const struct exh_calib_point *p, enum exh_calib_column which)
{
    return which == EXH_CALIB_MONITOR ? p->mon_A_q26 : p->cur_A_q26;
}

/* Force per current; a force above 0 requires a current above 0. Force q20 per current q26 is 2^-6
 * N/A. */
static int ratio_ok(int64_t force, int64_t cur)
{
    const int64_t force_q26 = force * (1 << (EXH_Q_CUR - EXH_Q_FORCE)); /* < 2^33 */
    return force_q26 * 10 >= cur && force_q26 <= RATIO_MAX_NPA * cur;
}

static int point_ok(const struct exh_calib_point *p, enum exh_calib_column which)
{
    const int32_t cur = current_of(p, which);
    return ratio_ok(p->force_N_q20, cur) && p->force_N_q20 > 0 &&
           p->force_N_q20 <= EXH_FORCE_MAX_N_Q20 &&
           cur <= (which == EXH_CALIB_MONITOR ? MON_MAX_A_Q26 : CUR_MAX_A_Q26) &&
           p->friction_A_q26 >= 0 && p->friction_A_q26 <= CUR_MAX_A_Q26;
}

int exh_calib_fit(struct exh_calib_fit *fit, const struct exh_calib_point *p, unsigned n,
    enum exh_calib_column which)
{
    uint64_t fi = 0, ii = 0; /* terms < 2^57 and < 2^59, 16 of them */
    fit->gain = (struct exh_gain){0, 1};
    fit->kf_NpA_q20 = 0;
    if (n < 1 || n > EXH_CALIB_POINTS_MAX) { return -EXH_E_RANGE; }
    for (unsigned i = 0; i < n; i++) {
        const uint64_t cur = (uint32_t)current_of(&p[i], which);
        if (!point_ok(&p[i], which)) { return -EXH_E_RANGE; }
        fi += cur * (uint32_t)p[i].force_N_q20;
        ii += cur * cur;
    }
    if (exh_gain_set(&fit->gain, fi, ii) < 0) { return -EXH_E_RANGE; }
    fit->kf_NpA_q20 =
        (int32_t)exh_gain_mul(fit->gain, INT32_C(1) << EXH_Q_CUR); /* as each point's, below 2^31 */
    return 0;
}

int32_t exh_calib_residual_N_q20(
    const struct exh_calib_fit *fit, const struct exh_calib_point *p, enum exh_calib_column which)
{
    return exh_sat32(p->force_N_q20 - exh_gain_mul(fit->gain, current_of(p, which)));
}

/* --- names of errors --- */

const char *exh_calib_error_text(unsigned what)
{
    static const char *const text[EXH_CALIB_ERRORS] = {
        "image",
        "device",
        "finger",
        "age",
        "scale or zero of D/A or monitor",
        "zero, F0, end or number of points",
        "force-to-current table",
        "monitor-to-force table",
        "validity, above 366 days",
        "force over current",
        "force over monitored current",
        "force over current beside the other fingers",
    };
    return what < EXH_CALIB_ERRORS ? text[what] : "unknown";
}

static int refuse(struct exh_calib_error *bad, enum exh_calib_error_kind what, unsigned at, int err)
{
    if (bad != NULL) { *bad = (struct exh_calib_error){(uint8_t)what, (uint8_t)at}; }
    return err;
}

static int values_ok(const struct exh_calib *c)
{
    return c->points >= 1 && c->points <= EXH_CALIB_POINTS_MAX && c->finger < EXH_FINGERS &&
           c->dac_rawpA_q16 > 0 && exh_inside(c->dac_zero_raw, 0, UINT16_MAX) && c->mon_A_q40 > 0 &&
           c->mon_zero_raw >= INT16_MIN && c->mon_zero_raw <= INT16_MAX && c->f0_A_q26 >= 0 &&
           c->f0_A_q26 <= CUR_MAX_A_Q26 && c->end_A_q26 >= 0 && c->end_A_q26 <= CUR_MAX_A_Q26;
}

/* --- tables --- */

/* Checks that all points are in range and rise. Typical errors on the bench: a mass hung on twice
 * or in another order, or a monitor that is not connected. */
static int rises(const struct exh_calib *c, enum exh_calib_column which,
    enum exh_calib_error_kind what, struct exh_calib_error *bad)
{
    int32_t force = 0, cur = 0;
    if (!values_ok(c)) { return refuse(bad, EXH_CALIB_VALUE, 0, -EXH_E_RANGE); }
    for (unsigned i = 0; i < c->points; i++) {
        const struct exh_calib_point *p = &c->point[i];
        if (p->force_N_q20 <= force || current_of(p, which) <= cur) {
            return refuse(bad, what, i, -EXH_E_MONOTONE);
        }
        if (!point_ok(p, which)) { return refuse(bad, what, i, -EXH_E_RANGE); }
        force = p->force_N_q20;
        cur = current_of(p, which);
    }
    return 0;
}

/* Computes the end of a table beyond its last point; 0 if the table ends at that point. Refuses a
 * slope below the resolution of monitor or table. */
static int straight_on(
    const struct exh_calib *c, enum exh_calib_column which, struct exh_knot *knot)
{
    const struct exh_calib_point *last = &c->point[c->points - 1];
    const int64_t more = (int64_t)c->end_A_q26 - last->cur_A_q26;
    struct exh_calib_fit fit;
    int64_t force;
    if (more <= 0) { return 0; }
    if (exh_calib_fit(&fit, c->point, c->points, which) < 0) { return -EXH_E_RANGE; }
    force = last->force_N_q20 + exh_gain_mul(fit.gain, (int32_t)more);
    if (force <= last->force_N_q20 || force > INT32_MAX) { return -EXH_E_RANGE; }
    knot->x = (int32_t)force;
    knot->y = (int32_t)(current_of(last, which) + more); /* <= 10 + 6.6 A */
    return 1;
}

int exh_calib_force_table(
    const struct exh_calib *c, struct exh_knot *knot, unsigned cap, struct exh_calib_error *bad)
{
    const unsigned last = c->points;
    int err = rises(c, EXH_CALIB_CURRENT, EXH_CALIB_FORCE_TABLE, bad);
    if (err < 0) { return err; }
    if (cap < last + 2u) { return refuse(bad, EXH_CALIB_FORCE_TABLE, last, -EXH_E_SHORT); }
    knot[0].x = knot[0].y = 0;
    for (unsigned i = 0; i < last; i++) {
        knot[i + 1].x = c->point[i].force_N_q20;
        knot[i + 1].y = c->point[i].cur_A_q26;
    }
    err = straight_on(c, EXH_CALIB_CURRENT, &knot[last + 1]);
    if (err >= 0) {
        const unsigned n = last + 1u + (unsigned)err;
        err = exh_table_setup(knot, n);
        if (err == 0) { return (int)n; }
    }
    return refuse(bad, EXH_CALIB_FORCE_TABLE, last - 1u, err);
}

int exh_calib_monitor_table(
    const struct exh_calib *c, struct exh_knot *knot, unsigned cap, struct exh_calib_error *bad)
{
    const unsigned last = c->points;
    struct exh_knot end = {0, 0, {0, 1}};
    int err = rises(c, EXH_CALIB_MONITOR, EXH_CALIB_MONITOR_TABLE, bad);
    unsigned half;
    if (err < 0) { return err; }
    if (cap < 2u * last + 3u) { return refuse(bad, EXH_CALIB_MONITOR_TABLE, last, -EXH_E_SHORT); }
    err = straight_on(c, EXH_CALIB_MONITOR, &end);
    if (err < 0) { return refuse(bad, EXH_CALIB_MONITOR_TABLE, last - 1u, err); }
    half = last + (unsigned)err;
    knot[half].x = knot[half].y = 0;
    for (unsigned i = 0; i < half; i++) {
        const int32_t x = i < last ? c->point[i].mon_A_q26 : end.y;
        const int32_t y = i < last ? c->point[i].force_N_q20 : end.x;
        knot[half + 1 + i].x = x;
        knot[half + 1 + i].y = y;
        knot[half - 1 - i].x = -x;
        knot[half - 1 - i].y = -y;
    }
    err = exh_table_setup(knot, 2 * half + 1);
    return err < 0 ? refuse(bad, EXH_CALIB_MONITOR_TABLE, last - 1u, err) : (int)(2 * half + 1);
}

int exh_calib_validate(const struct exh_calib *c, struct exh_calib_error *bad)
{
    struct exh_knot knot[2 * EXH_CALIB_POINTS_MAX + 3];
    const unsigned cap = sizeof knot / sizeof knot[0];
    int n;
    if (c->valid_days > EXH_CALIB_VALID_MAX_DAYS) {
        return refuse(bad, EXH_CALIB_VALIDITY, 0, -EXH_E_RANGE);
    }
    n = exh_calib_force_table(c, knot, cap, bad);
    if (n >= 0) { n = exh_calib_monitor_table(c, knot, cap, bad); }
    return n < 0 ? n : 0;
}

int32_t exh_calib_ratio_NpA_q20(const struct exh_calib_point *p, enum exh_calib_column which)
{
    const int32_t cur = current_of(p, which);
    uint64_t ratio;
    if (cur <= 0 || p->force_N_q20 < 0) { return 0; }
    ratio = exh_udiv64((uint64_t)p->force_N_q20 << EXH_Q_CUR, (uint32_t)cur, NULL);
    return ratio < INT32_MAX ? (int32_t)ratio : INT32_MAX;
}

/* Points are in range and kf is at most 512 N/A = 2^29, so wanted < 2^59. */
static int is_near(int64_t force, int64_t cur, int64_t kf)
{
    const int64_t twice = force * (2 << EXH_Q_CUR), wanted = kf * cur;
    return twice >= wanted && twice <= 3 * wanted;
}

int exh_calib_near(const struct exh_calib *c, int32_t kf_NpA_q20, struct exh_calib_error *bad)
{
    for (unsigned i = 0; i < c->points; i++) {
        const struct exh_calib_point *p = &c->point[i];
        if (!is_near(p->force_N_q20, p->cur_A_q26, kf_NpA_q20)) {
            return refuse(bad, EXH_CALIB_FAR_CURRENT, i, -EXH_E_RANGE);
        }
        if (!is_near(p->force_N_q20, p->mon_A_q26, kf_NpA_q20)) {
            return refuse(bad, EXH_CALIB_FAR_MONITOR, i, -EXH_E_RANGE);
        }
    }
    return 0;
}

int exh_calib_check(
    const struct exh_calib *c, const struct exh_calib_target *here, struct exh_calib_error *bad)
{
    if (c->points == 0) { return refuse(bad, EXH_CALIB_VALUE, 0, -EXH_E_RANGE); }
    if (c->device_id != here->device_id) {
        return refuse(bad, EXH_CALIB_DEVICE, 0, -EXH_E_VERSION);
    }
    if (c->finger != here->finger) { return refuse(bad, EXH_CALIB_FINGER, 0, -EXH_E_VERSION); }
    if (here->day < c->day || here->day - c->day > c->valid_days) {
        return refuse(bad, EXH_CALIB_AGE, 0, -EXH_E_STALE);
    }
    if (c->dac_rawpA_q16 != here->dac_rawpA_q16 || c->dac_zero_raw != here->dac_zero_raw ||
        c->mon_A_q40 != here->mon_A_q40 || c->mon_zero_raw != here->mon_zero_raw) {
        return refuse(bad, EXH_CALIB_SCALE, 0, -EXH_E_STALE);
    }
    return 0;
}

/* --- image --- */

struct head {
    uint32_t magic;
    uint16_t version, points;
};

static void head_bytes(struct exh_bytes *b, struct head *h)
{
    exh_bytes_u32(b, &h->magic);
    exh_bytes_u16(b, &h->version);
    exh_bytes_u16(b, &h->points);
}

/* All fields after the head except the CRC. */
static void body_bytes(struct exh_bytes *b, struct exh_calib *c)
{
    uint32_t *const id[] = {&c->device_id, &c->finger, &c->day, &c->valid_days};
    int32_t *const value[] = {&c->dac_rawpA_q16, &c->dac_zero_raw, &c->mon_A_q40, &c->mon_zero_raw,
        &c->f0_A_q26, &c->end_A_q26};
    for (unsigned i = 0; i < sizeof id / sizeof id[0]; i++) { exh_bytes_u32(b, id[i]); }
    for (unsigned i = 0; i < sizeof value / sizeof value[0]; i++) { exh_bytes_i32(b, value[i]); }
    for (unsigned i = 0; i < c->points; i++) {
        exh_bytes_i32(b, &c->point[i].force_N_q20);
        exh_bytes_i32(b, &c->point[i].cur_A_q26);
        exh_bytes_i32(b, &c->point[i].mon_A_q26);
        exh_bytes_i32(b, &c->point[i].friction_A_q26);
    }
}

int32_t exh_calib_save(
    const struct exh_calib *c, void *buf, size_t cap_B, struct exh_calib_error *bad)
{
    struct head h = {IMAGE_MAGIC, EXH_CALIB_VERSION, c->points};
    struct exh_bytes b = exh_bytes_writer(buf, cap_B);
    struct exh_calib copy = *c; /* the cursor's functions also read */
    uint32_t crc;
    const int err = exh_calib_validate(c, bad);
    if (err < 0) { return err; }
    head_bytes(&b, &h);
    body_bytes(&b, &copy);
    crc = exh_bytes_ok(&b) ? exh_crc32(0, buf, b.at) : 0;
    exh_bytes_u32(&b, &crc);
    return exh_bytes_ok(&b) ? (int32_t)b.at : refuse(bad, EXH_CALIB_IMAGE, 0, -EXH_E_SHORT);
}

static int load(struct exh_calib *c, const void *buf, size_t len_B)
{
    struct exh_bytes b = exh_bytes_reader(buf, len_B);
    struct head h = {0, 0, 0};
    uint32_t at, crc = 0;
    head_bytes(&b, &h);
    if (!exh_bytes_ok(&b)) { return -EXH_E_SHORT; }
    if (h.magic != IMAGE_MAGIC || h.version != EXH_CALIB_VERSION) { return -EXH_E_VERSION; }
    if (h.points > c->cap) { return -EXH_E_SHORT; }
    c->points = (uint8_t)h.points;
    body_bytes(&b, c);
    at = b.at;
    exh_bytes_u32(&b, &crc);
    if (!exh_bytes_ok(&b)) { return -EXH_E_SHORT; }
    return crc == exh_crc32(0, buf, at) ? 0 : -EXH_E_CRC;
}

int exh_calib_load(struct exh_calib *c, const void *buf, size_t len_B, struct exh_calib_error *bad)
{
    int err;
    c->points = 0;
    err = load(c, buf, len_B);
    if (err < 0) {
        (void)refuse(bad, EXH_CALIB_IMAGE, 0, err);
    } else {
        err = exh_calib_validate(c, bad);
    }
    if (err < 0) { c->points = 0; }
    return err;
}
