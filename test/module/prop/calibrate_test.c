/* SPDX-License-Identifier: MIT */
/* calibrate.h against known tables: what was put in comes out, within the bound that
 * the measurement allows. The D/A code is 36355 LSB of current, the monitor's 34655. */
#include "exhand/calibrate.h"

#include "exhand/error.h"

#include "check.h"
#include "wide.h"

#define DAC_LSB (INT64_C(36355))
#define MON_LSB (INT64_C(34655))

/* F = kf I, straight; 0.5 .. 50 N/A */
struct known {
    int64_t kf_q20;
    struct exh_calib c;
    struct exh_calib_point point[EXH_CALIB_POINTS_MAX];
    struct exh_knot to_cur[EXH_CALIB_POINTS_MAX + 2], to_force[2 * EXH_CALIB_POINTS_MAX + 3];
    struct exh_table cur, force;
};

static int64_t nearest(int64_t num, int64_t den)
{
    return (2 * num + den) / (2 * den); /* num >= 0 */
}

static int64_t quantised(int64_t v, int64_t lsb) { return nearest(v, lsb) * lsb; }

/* n points on the line at least 50 mA apart, seen through codes of that many LSB. 0:
 * too many of them for the drive. */
static int measure(struct known *k, int64_t dac_lsb, int64_t mon_lsb)
{
    const int64_t apart = EXH_Q(5, 100, EXH_Q_CUR);
    const unsigned n = (unsigned)check_i32_in(1, EXH_CALIB_POINTS_MAX);
    int64_t force = 0;
    int err;
    memset(k, 0, sizeof *k);
    k->kf_q20 = check_i32_in(EXH_Q(1, 2, EXH_Q_FORCE), EXH_Q(50, 1, EXH_Q_FORCE));
    k->c = (struct exh_calib){.dac_rawpA_q16 = 1,
        .mon_A_q40 = 1,
        .point = k->point,
        .points = (uint8_t)n,
        .cap = EXH_CALIB_POINTS_MAX};
    for (unsigned i = 0; i < n; i++) {
        int64_t cur;
        force += ((apart * k->kf_q20) >> EXH_Q_CUR) + 1 + check_i32_in(0, 3 << EXH_Q_FORCE);
        cur = nearest(force << EXH_Q_CUR, k->kf_q20);
        if (force > EXH_Q(100, 1, EXH_Q_FORCE) || cur > EXH_Q(65, 10, EXH_Q_CUR)) { return 0; }
        k->point[i] = (struct exh_calib_point){
            (int32_t)force, (int32_t)quantised(cur, dac_lsb), (int32_t)quantised(cur, mon_lsb), 0};
    }
    if (check_u64() % 2) { k->c.end_A_q26 = EXH_Q(66, 10, EXH_Q_CUR); }
    err = exh_calib_force_table(&k->c, k->to_cur, EXH_CALIB_POINTS_MAX + 2, NULL);
    CHECK(err == (int)n + 1 + (k->c.end_A_q26 > 0), "force table: %d", err);
    k->cur = (struct exh_table){k->to_cur, (uint8_t)err};
    err = exh_calib_monitor_table(&k->c, k->to_force, 2 * EXH_CALIB_POINTS_MAX + 3, NULL);
    CHECK(err == 2 * ((int)n + (k->c.end_A_q26 > 0)) + 1, "monitor table: %d", err);
    k->force = (struct exh_table){k->to_force, (uint8_t)err};
    return 1;
}

/* Both tables at random places between the points against the line; cur_lsb and mon_lsb
 * are what a current may be off. */
static void compare(const struct known *k, int64_t cur_lsb, int64_t mon_lsb)
{
    const int last = k->c.points - 1;
    const int32_t f = check_i32_in(0, k->point[last].force_N_q20);
    const int32_t m = check_i32_in(-k->point[last].mon_A_q26, k->point[last].mon_A_q26);
    const int64_t i_off = exh_table_at(k->cur, f) * k->kf_q20 - ((int64_t)f << EXH_Q_CUR);
    const int64_t f_off =
        ((int64_t)exh_table_at(k->force, m) * (1 << EXH_Q_CUR)) - (int64_t)m * k->kf_q20;
    CHECK(i_off <= cur_lsb * k->kf_q20 && i_off >= -cur_lsb * k->kf_q20,
        "kf %" PRId64 ": %" PRId32 " N q20 gives a current off by %" PRId64, k->kf_q20, f,
        i_off / k->kf_q20);
    CHECK(f_off <= mon_lsb * k->kf_q20 + (INT64_C(3) << (EXH_Q_CUR - 1)) &&
              f_off >= -mon_lsb * k->kf_q20 - (INT64_C(3) << (EXH_Q_CUR - 1)),
        "kf %" PRId64 ": monitor %" PRId32 " gives a force off by %" PRId64, k->kf_q20, m,
        f_off >> EXH_Q_CUR);
}

/* Without noise the current is within 2 LSB of its format (30 nA): half an LSB of the point, 1.5 of
 * the table. kf is within 1 LSB, plus the effect of half an LSB in the least current. */
TEST(a_straight_table_is_recovered_to_the_lsb)
{
    unsigned cases = 0, measured = 0;
    while (check_case(4)) {
        struct known k;
        struct exh_calib_fit fit;
        int64_t off;
        cases++;
        if (!measure(&k, 1, 1)) { continue; }
        measured++;
        compare(&k, 2, 2);
        CHECK_EQ_I64(exh_calib_fit(&fit, k.point, k.c.points, EXH_CALIB_CURRENT), 0);
        off = fit.kf_NpA_q20 - k.kf_q20;
        off = off < 0 ? -off : off;
        CHECK(2 * k.point[0].cur_A_q26 * (off - 1) <= k.kf_q20 + fit.kf_NpA_q20 / 1024,
            "kf %" PRId64 " found as %" PRId32, k.kf_q20, fit.kf_NpA_q20);
        for (unsigned i = 0; i < k.c.points; i++) { /* on the line: no residual */
            const int64_t r = exh_calib_residual_N_q20(&fit, &k.point[i], EXH_CALIB_CURRENT);
            const int64_t most = 2 + (k.kf_q20 >> EXH_Q_CUR) +
                                 nearest((off + 1) * k.point[i].cur_A_q26, 1 << EXH_Q_CUR);
            CHECK(r <= most && r >= -most, "residual %" PRId64 " of %" PRId64, r, most);
        }
    }
    CHECK(cases < 100 || measured > cases / 20, "%u of %u", measured, cases);
}

/* Through codes: within one code of either, half a code's error at the worst point. */
TEST(a_quantised_table_is_recovered_to_the_code)
{
    unsigned cases = 0, measured = 0;
    while (check_case(4)) {
        struct known k;
        cases++;
        if (!measure(&k, DAC_LSB, MON_LSB)) { continue; }
        measured++;
        compare(&k, DAC_LSB / 2 + 3, MON_LSB / 2 + 3);
    }
    CHECK(cases < 100 || measured > cases / 20, "%u of %u", measured, cases);
}

/* A bent table: points at all its knots and any between them give it back. */
TEST(a_bent_table_is_recovered_to_the_lsb)
{
    unsigned cases = 0, accepted = 0;
    while (check_case(4)) {
        struct exh_knot known[5], found[EXH_CALIB_POINTS_MAX + 2];
        struct exh_calib_point p[8];
        struct exh_calib c = {.dac_rawpA_q16 = 1, .mon_A_q40 = 1, .point = p, .points = 8};
        const struct exh_table t = {known, 5};
        struct exh_table got = {found, 10};
        int32_t x = 0, y = 0;
        int flat = 0, steep = 0, n;
        for (unsigned i = 0; i < 5; i++) {
            known[i].x = x;
            known[i].y = y;
            x += check_i32_in(1 << 16, 20 << EXH_Q_FORCE);
            y += check_i32_in(1 << 16, EXH_Q(16, 10, EXH_Q_CUR));
        }
        CHECK_EQ_I64(exh_table_setup(known, 5), 0);
        for (unsigned i = 0; i < 8; i++) { /* knots, and a place before each */
            const int32_t to = known[i / 2 + 1].x, from = known[i / 2].x;
            const int32_t f = i % 2 ? to : from + check_i32_in(1 << 12, to - from - (1 << 12));
            p[i] = (struct exh_calib_point){f, exh_table_at(t, f), 1 + (int32_t)i, 0};
            flat |= p[i].cur_A_q26 <= (i > 0 ? p[i - 1].cur_A_q26 : 0);
            steep |= INT64_C(640) * f < p[i].cur_A_q26 ||
                     INT64_C(64) * f > INT64_C(2047) * p[i].cur_A_q26;
        }
        n = exh_calib_force_table(&c, found, 10, NULL);
        cases++;
        if (n < 0) { /* only a table that is flat to rounding, or no motor's */
            CHECK((n == -EXH_E_MONOTONE && flat) || (n == -EXH_E_RANGE && steep), "refused: %d", n);
            continue;
        }
        CHECK(n == 9 && !flat && !steep, "%d knots", n);
        accepted++;
        got.n = 9;
        x = check_i32_in(0, known[4].x);
        y = exh_table_at(got, x) - exh_table_at(t, x);
        CHECK(y <= 4 && y >= -4, "at %" PRId32 " off by %" PRId32, x, y);
        for (unsigned i = 0; i < 5; i++) {
            CHECK_EQ_I64(exh_table_at(got, known[i].x), known[i].y);
        }
    }
    CHECK(cases < 16 || accepted > 0, "none of %u tables was accepted", cases);
}

TEST(mean_is_the_nearest)
{
    while (check_case(4)) {
        struct exh_mean m = {0, 0};
        const int32_t n = check_i32_in(1, 20);
        int64_t sum = 0, off;
        for (int32_t i = 0; i < n; i++) {
            const int32_t v = check_i32();
            sum += v;
            exh_mean_add(&m, v);
        }
        off = 2 * ((int64_t)exh_mean_value(&m) * n - sum);
        CHECK(off <= n && off > -n, "sum %" PRId64 " of %" PRId32 ": %" PRId32, sum, n,
            exh_mean_value(&m));
    }
}

/* Any values: what is saved can be loaded and is the same; what is refused says why. */
TEST(anything_is_saved_and_loaded_or_refused)
{
    unsigned cases = 0, saved = 0;
    while (check_case(8)) {
        struct exh_calib_point p[EXH_CALIB_POINTS_MAX], q[EXH_CALIB_POINTS_MAX];
        struct exh_calib c = {.point = p, .points = (uint8_t)check_i32_in(0, 16), .cap = 16};
        struct exh_calib back = {.point = q, .cap = 16};
        struct exh_calib_error bad = {99, 99};
        uint8_t buf[EXH_CALIB_IMAGE_B], again[EXH_CALIB_IMAGE_B];
        int32_t len;
        c.device_id = (uint32_t)check_u64();
        c.finger = (uint32_t)check_u64() % 6;
        c.dac_rawpA_q16 = check_i32_in(-1, INT32_MAX);
        c.dac_zero_raw = check_i32_in(-1, 65536);
        c.mon_A_q40 = check_i32_in(-1, INT32_MAX);
        c.mon_zero_raw = check_i32_in(-32769, 32768);
        c.f0_A_q26 = check_i32_in(-1, EXH_Q(66, 10, EXH_Q_CUR));
        c.end_A_q26 = check_i32_in(-1, EXH_Q(66, 10, EXH_Q_CUR));
        for (int32_t i = 0; i < c.points; i++) {
            p[i].force_N_q20 = (i + 1) << 20 | check_i32_in(0, (1 << 20) - 1);
            p[i].cur_A_q26 = (i + 1) << 24 | check_i32_in(0, (1 << 24) - 1);
            p[i].mon_A_q26 = check_u64() % 64 ? p[i].cur_A_q26 : check_i32();
            p[i].friction_A_q26 = check_i32_in(-1, 1 << 20);
        }
        len = exh_calib_save(&c, buf, sizeof buf, &bad);
        CHECK((len < 0) == (exh_calib_validate(&c, NULL) < 0), "saved %" PRId32, len);
        CHECK(len > 0 || bad.what < EXH_CALIB_ERRORS, "refused without a name");
        cases++;
        if (len < 0) {
            CHECK(len == -EXH_E_RANGE ||
                      (len == -EXH_E_MONOTONE && bad.what == EXH_CALIB_MONITOR_TABLE),
                "refused: %" PRId32, len);
            continue;
        }
        saved++;
        CHECK_EQ_I64(exh_calib_load(&back, buf, (size_t)len, &bad), 0);
        CHECK_EQ_I64(exh_calib_save(&back, again, sizeof again, NULL), len);
        CHECK(memcmp(buf, again, (size_t)len) == 0, "another image");
        buf[check_u64() % (uint32_t)len] ^= (uint8_t)(1 + check_u64() % 255);
        CHECK(exh_calib_load(&back, buf, (size_t)len, &bad) < 0, "a damaged byte passes");
    }
    CHECK(cases < 1000 || saved > 0, "none of %u was saved", cases);
}

TEST_MAIN("prop/calibrate", a_straight_table_is_recovered_to_the_lsb,
    a_quantised_table_is_recovered_to_the_code, a_bent_table_is_recovered_to_the_lsb,
    mean_is_the_nearest, anything_is_saved_and_loaded_or_refused);
