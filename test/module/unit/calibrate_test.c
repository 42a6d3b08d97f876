/* SPDX-License-Identifier: MIT */
/* calibrate.h: means, tables out of points, what is refused and by which name, the image. */
#include "exhand/calibrate.h"

#include "exhand/bytes.h"
#include "exhand/error.h"
#include "exhand/frame.h"

#include "check.h"

#define N(f)   EXH_Q(f, 1000, EXH_Q_FORCE) /* mN */
#define A(i)   EXH_Q(i, 1000, EXH_Q_CUR)   /* mA */
#define POINTS 4

struct fixture {
    struct exh_calib c;
    struct exh_calib_point point[EXH_CALIB_POINTS_MAX];
};

/* 3.3 N/A, bent a little at the top; the monitor reads 1 % more. */
static void set_up(struct fixture *f)
{
    static const struct exh_calib_point p[POINTS] = {
        {N(990), A(300), A(303), A(30)},
        {N(1980), A(600), A(606), A(60)},
        {N(4950), A(1500), A(1515), A(150)},
        {N(6500), A(2000), A(2020), A(200)},
    };
    memset(f, 0, sizeof *f);
    memcpy(f->point, p, sizeof p);
    f->c = (struct exh_calib){.device_id = 7,
        .finger = 1,
        .day = 20000,
        .valid_days = 30,
        .dac_rawpA_q16 = EXH_Q(324900, 176, EXH_Q_DAC),
        .dac_zero_raw = 32768,
        .mon_A_q40 = EXH_Q(5164, 10000000, EXH_Q_MON),
        .mon_zero_raw = -3,
        .f0_A_q26 = A(40),
        .end_A_q26 = A(6600),
        .point = f->point,
        .points = POINTS,
        .cap = EXH_CALIB_POINTS_MAX};
}

TEST(mean_rounds_half_up_once)
{
    static const struct {
        int32_t v[4];
        unsigned n;
        int32_t want;
    } row[] = {{{0}, 0, 0}, {{5}, 1, 5}, {{1, 2}, 2, 2}, {{-1, -2}, 2, -1}, {{1, 1, 2}, 3, 1},
        {{-1, -1, -2}, 3, -1}, {{INT32_MAX, INT32_MAX, INT32_MAX, INT32_MAX}, 4, INT32_MAX},
        {{INT32_MIN, INT32_MIN, INT32_MIN, INT32_MIN}, 4, INT32_MIN},
        {{INT32_MIN, INT32_MAX}, 2, 0}};
    for (size_t i = 0; i < LEN(row); i++) {
        struct exh_mean m = {0, 0};
        for (unsigned k = 0; k < row[i].n; k++) { exh_mean_add(&m, row[i].v[k]); }
        CHECK(exh_mean_value(&m) == row[i].want, "row %zu: %" PRId32, i, exh_mean_value(&m));
    }
}

TEST(mean_stops_before_it_overflows)
{
    struct exh_mean m = {(int64_t)INT32_MIN * (INT32_MAX - 1), INT32_MAX - 1};
    exh_mean_add(&m, INT32_MIN);
    CHECK_EQ_I64(exh_mean_value(&m), INT32_MIN);
    exh_mean_add(&m, INT32_MIN);
    CHECK_EQ_I64(m.n, INT32_MAX);
    m = (struct exh_mean){(int64_t)INT32_MAX * INT32_MAX, INT32_MAX};
    CHECK_EQ_I64(exh_mean_value(&m), INT32_MAX);
}

TEST(tables_meet_every_point_and_go_straight_on)
{
    struct exh_knot k[2 * EXH_CALIB_POINTS_MAX + 3];
    struct fixture f;
    struct exh_table t = {k, 0};
    set_up(&f);
    t.n = (uint8_t)exh_calib_force_table(&f.c, k, LEN(k), NULL);
    CHECK_EQ_I64(t.n, POINTS + 2);
    CHECK_EQ_I64(exh_table_at(t, 0), 0);
    for (unsigned i = 0; i < POINTS; i++) {
        CHECK_EQ_I64(exh_table_at(t, f.point[i].force_N_q20), f.point[i].cur_A_q26);
    }
    CHECK_EQ_I64(k[POINTS + 1].y, A(6600));
    t.n = (uint8_t)exh_calib_monitor_table(&f.c, k, LEN(k), NULL);
    CHECK_EQ_I64(t.n, 2 * POINTS + 3);
    CHECK_EQ_I64(exh_table_at(t, 0), 0);
    for (unsigned i = 0; i < POINTS; i++) { /* odd: the monitor's noise has both signs */
        CHECK_EQ_I64(exh_table_at(t, f.point[i].mon_A_q26), f.point[i].force_N_q20);
        CHECK_EQ_I64(exh_table_at(t, -f.point[i].mon_A_q26), -f.point[i].force_N_q20);
    }
    CHECK_EQ_I64(k[2 * POINTS + 2].x, A(2020) + A(6600) - A(2000));
    f.c.end_A_q26 = f.point[POINTS - 1].cur_A_q26; /* not beyond what was measured */
    CHECK_EQ_I64(exh_calib_force_table(&f.c, k, LEN(k), NULL), POINTS + 1);
    CHECK_EQ_I64(exh_calib_monitor_table(&f.c, k, LEN(k), NULL), 2 * POINTS + 1);
}

TEST(tables_need_room)
{
    struct exh_knot k[2 * EXH_CALIB_POINTS_MAX + 3];
    struct fixture f;
    struct exh_calib_error bad = {99, 99};
    set_up(&f);
    CHECK_EQ_I64(exh_calib_force_table(&f.c, k, POINTS + 1, &bad), -EXH_E_SHORT);
    CHECK_EQ_I64(bad.what, EXH_CALIB_FORCE_TABLE);
    CHECK_EQ_I64(exh_calib_monitor_table(&f.c, k, 2 * POINTS + 2, &bad), -EXH_E_SHORT);
    CHECK_EQ_I64(bad.what, EXH_CALIB_MONITOR_TABLE);
}

/* 9 N of a motor with 3 N/A: 2 A and 6 A are 3/2 and half of kf, and near. A bit beyond is not, and
 * point and column are named. */
TEST(near_is_within_half_of_kf)
{
    static const struct {
        int32_t cur_A_q26, mon_A_q26;
        unsigned what; /* 0: near */
    } row[] = {
        {A(3000), A(3000), 0},
        {A(2000), A(6000), 0},
        {A(6000), A(2000), 0},
        {A(2000) - 1, A(3000), EXH_CALIB_FAR_CURRENT},
        {A(6000) + 1, A(3000), EXH_CALIB_FAR_CURRENT},
        {A(3000), A(2000) - 1, EXH_CALIB_FAR_MONITOR},
        {A(3000), A(6000) + 1, EXH_CALIB_FAR_MONITOR},
    };
    for (uint8_t at = 0; at < 2; at++) {
        for (size_t i = 0; i < LEN(row); i++) {
            struct exh_calib_point p[2] = {
                {N(9000), A(3000), A(3000), 0}, {N(9000), A(3000), A(3000), 0}};
            const struct exh_calib c = {.point = p, .points = 2, .cap = 2};
            struct exh_calib_error bad = {0, 99};
            p[at].cur_A_q26 = row[i].cur_A_q26;
            p[at].mon_A_q26 = row[i].mon_A_q26;
            CHECK_EQ_I64(exh_calib_near(&c, N(3000), &bad), row[i].what ? -EXH_E_RANGE : 0);
            CHECK(bad.what == row[i].what && bad.at == (row[i].what ? at : 99), "row %zu: %u, %u",
                i, bad.what, bad.at);
        }
    }
}

TEST(a_ratio_saturates)
{
    static const struct exh_calib_point p[] = {
        {N(9000), A(3000), A(2000), 0}, {N(1), 0, -5, 0}, {N(100000), 1, 2, 0}, {-1, 1, 2, 0}};
    CHECK_EQ_I64(exh_calib_ratio_NpA_q20(&p[0], EXH_CALIB_CURRENT), N(3000));
    CHECK_EQ_I64(exh_calib_ratio_NpA_q20(&p[0], EXH_CALIB_MONITOR), N(4500));
    CHECK_EQ_I64(exh_calib_ratio_NpA_q20(&p[1], EXH_CALIB_CURRENT), 0);
    CHECK_EQ_I64(exh_calib_ratio_NpA_q20(&p[1], EXH_CALIB_MONITOR), 0);
    CHECK_EQ_I64(exh_calib_ratio_NpA_q20(&p[2], EXH_CALIB_MONITOR), INT32_MAX);
    CHECK_EQ_I64(exh_calib_ratio_NpA_q20(&p[3], EXH_CALIB_MONITOR), 0);
}

/* A year is believed, a day more is neither written nor read. */
TEST(validity_has_a_ceiling)
{
    struct exh_calib_error bad = {99, 99};
    struct exh_calib_point point[POINTS];
    struct exh_calib back = {.point = point, .cap = POINTS};
    struct fixture f;
    uint8_t buf[EXH_CALIB_IMAGE_B];
    int32_t n;
    set_up(&f);
    f.c.valid_days = EXH_CALIB_VALID_MAX_DAYS;
    n = exh_calib_save(&f.c, buf, sizeof buf, &bad);
    CHECK(n > 0, "%d", (int)n);
    CHECK_EQ_I64(exh_calib_load(&back, buf, (size_t)n, &bad), 0);
    f.c.valid_days++;
    CHECK_EQ_I64(exh_calib_save(&f.c, buf, sizeof buf, &bad), -EXH_E_RANGE);
    CHECK_EQ_I64(bad.what, EXH_CALIB_VALIDITY);
    buf[20]++; /* 366 is 0x16E: no carry */
    {
        struct exh_bytes b = exh_bytes_writer(buf + n - 4, 4);
        uint32_t crc = exh_crc32(0, buf, (size_t)n - 4);
        exh_bytes_u32(&b, &crc);
    }
    bad = (struct exh_calib_error){99, 99};
    CHECK_EQ_I64(exh_calib_load(&back, buf, (size_t)n, &bad), -EXH_E_RANGE);
    CHECK(bad.what == EXH_CALIB_VALIDITY && back.points == 0, "%u", bad.what);
}

/* Each spoiled value is refused with the table and the point that it spoils. */
TEST(refusals_name_table_and_point)
{
    static const struct {
        unsigned at, field; /* point; force, current, monitor, friction */
        int32_t v;
        int err;
        unsigned what;
    } row[] = {
        {0, 0, 0, -EXH_E_MONOTONE, EXH_CALIB_FORCE_TABLE},
        {0, 0, -5, -EXH_E_MONOTONE, EXH_CALIB_FORCE_TABLE},
        {2, 0, N(1980), -EXH_E_MONOTONE, EXH_CALIB_FORCE_TABLE},
        {1, 1, A(300), -EXH_E_MONOTONE, EXH_CALIB_FORCE_TABLE},
        {3, 1, A(1499), -EXH_E_MONOTONE, EXH_CALIB_FORCE_TABLE},
        {0, 1, INT32_MIN, -EXH_E_MONOTONE, EXH_CALIB_FORCE_TABLE},
        {3, 1, A(6601), -EXH_E_RANGE, EXH_CALIB_FORCE_TABLE},
        {3, 0, N(100001), -EXH_E_RANGE, EXH_CALIB_FORCE_TABLE},
        {1, 3, -1, -EXH_E_RANGE, EXH_CALIB_FORCE_TABLE},
        {0, 2, 0, -EXH_E_MONOTONE, EXH_CALIB_MONITOR_TABLE},
        {2, 2, A(606), -EXH_E_MONOTONE, EXH_CALIB_MONITOR_TABLE},
        {3, 2, A(1), -EXH_E_MONOTONE, EXH_CALIB_MONITOR_TABLE},
        {3, 2, A(10001), -EXH_E_RANGE, EXH_CALIB_MONITOR_TABLE},
        {0, 0, N(30) - 100, -EXH_E_RANGE, EXH_CALIB_FORCE_TABLE}, /* 0.1 N/A of 300 mA */
        {0, 1, EXH_Q(990, 2047000, EXH_Q_CUR) - 2, -EXH_E_RANGE, EXH_CALIB_FORCE_TABLE},
        {0, 2, EXH_Q(990, 2047000, EXH_Q_CUR) - 2, -EXH_E_RANGE, EXH_CALIB_MONITOR_TABLE},
    };
    for (size_t i = 0; i < LEN(row); i++) {
        struct exh_calib_error bad = {99, 99};
        struct fixture f;
        uint8_t buf[EXH_CALIB_IMAGE_B];
        int32_t *field[4];
        int err;
        set_up(&f);
        field[0] = &f.point[row[i].at].force_N_q20;
        field[1] = &f.point[row[i].at].cur_A_q26;
        field[2] = &f.point[row[i].at].mon_A_q26;
        field[3] = &f.point[row[i].at].friction_A_q26;
        *field[row[i].field] = row[i].v;
        err = exh_calib_validate(&f.c, &bad);
        CHECK(err == row[i].err, "row %zu: %d", i, err);
        CHECK(bad.what == row[i].what && bad.at == row[i].at, "row %zu: %s, point %d", i,
            exh_calib_error_text(bad.what), bad.at);
        CHECK_EQ_I64(exh_calib_validate(&f.c, NULL), row[i].err);
        CHECK_EQ_I64(exh_calib_save(&f.c, buf, sizeof buf, &bad), row[i].err);
    }
}

TEST(values_out_of_range_are_refused)
{
    for (unsigned i = 0; i < 14; i++) {
        struct exh_calib_error bad = {99, 99};
        struct fixture f;
        set_up(&f);
        if (i == 0) { f.c.points = 0; }
        if (i == 1) { f.c.points = EXH_CALIB_POINTS_MAX + 1; }
        if (i == 2) { f.c.finger = EXH_FINGERS; }
        if (i == 3) { f.c.dac_rawpA_q16 = 0; }
        if (i == 4) { f.c.mon_A_q40 = -1; }
        if (i == 5) { f.c.mon_zero_raw = 32768; }
        if (i == 6) { f.c.mon_zero_raw = -32769; }
        if (i == 7) { f.c.f0_A_q26 = -1; }
        if (i == 8) { f.c.f0_A_q26 = A(6601); }
        if (i == 9) { f.c.end_A_q26 = -1; }
        if (i == 10) { f.c.end_A_q26 = A(6601); }
        if (i == 11) { f.c.dac_zero_raw = -1; }
        if (i == 12) { f.c.dac_zero_raw = 65536; }
        CHECK(exh_calib_validate(&f.c, &bad) == (i < 13 ? -EXH_E_RANGE : 0), "value %u", i);
        CHECK(bad.what == (i < 13 ? EXH_CALIB_VALUE : 99), "value %u: %d", i, bad.what);
    }
}

TEST(another_device_and_stale_ones_are_refused)
{
    static const struct {
        struct exh_calib_target here; /* scales: difference from the fixture's */
        int err;
        unsigned what;
    } row[] = {
        {{7, 1, 20000, 0, 0, 0, 0}, 0, 99}, {{7, 1, 20030, 0, 0, 0, 0}, 0, 99},
        {{7, 1, 20031, 0, 0, 0, 0}, -EXH_E_STALE, EXH_CALIB_AGE},
        {{7, 1, 19999, 0, 0, 0, 0}, -EXH_E_STALE, EXH_CALIB_AGE}, /* a clock that was set back */
        {{7, 1, UINT32_MAX, 0, 0, 0, 0}, -EXH_E_STALE, EXH_CALIB_AGE},
        {{7, 1, 0, 0, 0, 0, 0}, -EXH_E_STALE, EXH_CALIB_AGE},
        {{8, 1, 20000, 0, 0, 0, 0}, -EXH_E_VERSION, EXH_CALIB_DEVICE},
        {{7, 0, 20000, 0, 0, 0, 0}, -EXH_E_VERSION, EXH_CALIB_FINGER},
        {{7, 1, 20000, 1, 0, 0, 0}, -EXH_E_STALE, EXH_CALIB_SCALE},
        {{7, 1, 20000, 0, 0, -1, 0}, -EXH_E_STALE, EXH_CALIB_SCALE},
        {{7, 1, 20000, 0, 1, 0, 0}, -EXH_E_STALE, EXH_CALIB_SCALE}, /* D/A moved by a code */
        {{7, 1, 20000, 0, 0, 0, 3}, -EXH_E_STALE, EXH_CALIB_SCALE}, /* monitor's zero not copied */
    };
    struct exh_calib_error bad;
    struct exh_calib_target here;
    struct fixture f;
    set_up(&f);
    for (size_t i = 0; i < LEN(row); i++) {
        here = row[i].here;
        bad.what = bad.at = 99;
        here.dac_rawpA_q16 += f.c.dac_rawpA_q16;
        here.mon_A_q40 += f.c.mon_A_q40;
        here.dac_zero_raw += f.c.dac_zero_raw;
        here.mon_zero_raw += f.c.mon_zero_raw;
        CHECK(exh_calib_check(&f.c, &here, &bad) == row[i].err, "row %zu", i);
        CHECK(bad.what == row[i].what && bad.at == (row[i].err == 0 ? 99 : 0), "row %zu: %s of %d",
            i, exh_calib_error_text(bad.what), bad.at);
        CHECK_EQ_I64(exh_calib_check(&f.c, &here, NULL), row[i].err);
    }
    f.c.valid_days = UINT32_MAX; /* for ever, but not before it was made */
    here = (struct exh_calib_target){
        7, 1, UINT32_MAX, f.c.dac_rawpA_q16, f.c.dac_zero_raw, f.c.mon_A_q40, f.c.mon_zero_raw};
    CHECK_EQ_I64(exh_calib_check(&f.c, &here, NULL), 0);
    here.day = 19999;
    CHECK_EQ_I64(exh_calib_check(&f.c, &here, NULL), -EXH_E_STALE);
    here.day = 20000;
    f.c.points = 0; /* no points are loaded, so none is judged */
    bad.what = bad.at = 99;
    CHECK_EQ_I64(exh_calib_check(&f.c, &here, &bad), -EXH_E_RANGE);
    CHECK(bad.what == EXH_CALIB_VALUE && bad.at == 0, "%d of %d", bad.what, bad.at);
}

/* --- image --- */

static int32_t save(struct fixture *f, uint8_t *buf)
{
    const int32_t len = exh_calib_save(&f->c, buf, EXH_CALIB_IMAGE_B, NULL);
    CHECK_EQ_I64(len, 8 + 40 + 16 * f->c.points + 4);
    return len;
}

TEST(image_round_trip)
{
    struct fixture a, b;
    struct exh_calib_error bad = {99, 99};
    uint8_t buf[EXH_CALIB_IMAGE_B], again[EXH_CALIB_IMAGE_B];
    int32_t len;
    set_up(&a);
    memset(&b, 0, sizeof b);
    b.c.point = b.point;
    b.c.cap = EXH_CALIB_POINTS_MAX;
    len = save(&a, buf);
    CHECK(memcmp(buf, "EXHC\2\0\4\0\7\0\0\0\1\0\0\0", 16) == 0, "head");
    CHECK_EQ_I64(exh_calib_load(&b.c, buf, (size_t)len, NULL), 0);
    CHECK_EQ_I64(save(&b, again), len);
    CHECK(memcmp(buf, again, (size_t)len) == 0, "what is loaded is what was saved");
    CHECK(memcmp(a.point, b.point, sizeof a.point) == 0, "points");
    CHECK(exh_calib_save(&a.c, again, (size_t)len - 1, &bad) == -EXH_E_SHORT, "short buffer");
    CHECK(bad.what == EXH_CALIB_IMAGE && bad.at == 0, "short buffer: %d of %d", bad.what, bad.at);
    b.c.cap = POINTS - 1;
    CHECK_EQ_I64(exh_calib_load(&b.c, buf, (size_t)len, NULL), -EXH_E_SHORT);
    CHECK_EQ_I64(b.c.points, 0);
}

TEST(any_bit_flipped_any_byte_missing_is_refused)
{
    struct fixture a, b;
    struct exh_calib_error bad;
    uint8_t buf[EXH_CALIB_IMAGE_B], crc[4];
    int32_t len;
    set_up(&a);
    set_up(&b);
    len = save(&a, buf);
    for (int32_t i = 0; i < 8 * len; i++) {
        int err;
        bad.what = bad.at = 99;
        buf[i / 8] ^= (uint8_t)(1u << i % 8);
        err = exh_calib_load(&b.c, buf, (size_t)len, &bad);
        buf[i / 8] ^= (uint8_t)(1u << i % 8);
        CHECK(err == (i < 48       ? -EXH_E_VERSION
                         : i >= 64 ? -EXH_E_CRC
                                   : err) &&
                  err < 0,
            "bit %" PRId32 ": %d", i, err);
        CHECK(bad.what == EXH_CALIB_IMAGE && bad.at == 0 && b.c.points == 0, "bit %" PRId32, i);
    }
    for (int k = 0; k < 4 && len >= 4; k++) { /* no CRC is none that fits */
        crc[k] = buf[len - 4 + k];
        buf[len - 4 + k] = 0;
    }
    CHECK_EQ_I64(exh_calib_load(&b.c, buf, (size_t)len, &bad), -EXH_E_CRC);
    for (int k = 0; k < 4 && len >= 4; k++) { buf[len - 4 + k] = crc[k]; }
    for (int32_t i = 0; i < len; i++) {
        CHECK_EQ_I64(exh_calib_load(&b.c, buf, (size_t)i, &bad), -EXH_E_SHORT);
        CHECK(bad.what == EXH_CALIB_IMAGE && b.c.points == 0, "%" PRId32 " bytes", i);
    }
    CHECK_EQ_I64(exh_calib_load(&b.c, buf, (size_t)len, &bad), 0);
}

/* Whole bytes around a table that does not rise: only another program writes that. */
TEST(a_sound_image_of_a_bad_table_is_refused)
{
    struct fixture a, b;
    struct exh_calib_error bad = {99, 99};
    uint8_t buf[EXH_CALIB_IMAGE_B];
    const int32_t equal = A(600);
    int32_t len;
    struct exh_bytes c;
    uint32_t crc;
    set_up(&a);
    set_up(&b);
    len = save(&a, buf);
    c = exh_bytes_writer(buf + 48 + 2 * 16 + 4, 4); /* current of the third point */
    exh_bytes_i32(&c, &(int32_t){equal});
    crc = exh_crc32(0, buf, (size_t)len - 4);
    c = exh_bytes_writer(buf + len - 4, 4);
    exh_bytes_u32(&c, &crc);
    CHECK_EQ_I64(exh_calib_load(&b.c, buf, (size_t)len, &bad), -EXH_E_MONOTONE);
    CHECK(bad.what == EXH_CALIB_FORCE_TABLE && bad.at == 2, "%s, point %d",
        exh_calib_error_text(bad.what), bad.at);
    CHECK_EQ_I64(b.c.points, 0);
}

TEST(every_name_has_its_text)
{
    for (unsigned i = 0; i <= EXH_CALIB_ERRORS; i++) {
        CHECK(exh_calib_error_text(i)[0] != '\0', "%u", i);
        for (unsigned k = 0; k < i; k++) {
            CHECK(
                !check_same_text(exh_calib_error_text(i), exh_calib_error_text(k)), "%u %u", i, k);
        }
    }
}

TEST(fit_by_hand)
{
    struct exh_calib_fit fit;
    struct fixture f;
    set_up(&f);
    CHECK_EQ_I64(exh_calib_fit(&fit, f.point, 3, EXH_CALIB_CURRENT), 0);
    CHECK(fit.kf_NpA_q20 - EXH_Q(33, 10, EXH_Q_FORCE) <= 1 &&
              fit.kf_NpA_q20 - EXH_Q(33, 10, EXH_Q_FORCE) >= -1,
        "%" PRId32, fit.kf_NpA_q20);
    /* the bent point lies 100 mN below that line */
    CHECK((exh_calib_residual_N_q20(&fit, &f.point[3], EXH_CALIB_CURRENT) + N(100)) / 4 == 0,
        "%" PRId32, exh_calib_residual_N_q20(&fit, &f.point[3], EXH_CALIB_CURRENT));
    CHECK_EQ_I64(exh_calib_fit(&fit, f.point, 3, EXH_CALIB_MONITOR), 0);
    CHECK((fit.kf_NpA_q20 - EXH_Q(330, 101, EXH_Q_FORCE)) / 2 == 0, "%" PRId32, fit.kf_NpA_q20);
    CHECK_EQ_I64(exh_calib_fit(&fit, f.point, 0, EXH_CALIB_CURRENT), -EXH_E_RANGE);
    CHECK_EQ_I64(
        exh_calib_fit(&fit, f.point, EXH_CALIB_POINTS_MAX + 1, EXH_CALIB_CURRENT), -EXH_E_RANGE);
    f.point[0].cur_A_q26 = 0;
    CHECK_EQ_I64(exh_calib_fit(&fit, f.point, 3, EXH_CALIB_CURRENT), -EXH_E_RANGE);
    f.point[0] = (struct exh_calib_point){N(100000), 1, 1, 0}; /* 10^9 N/A and more */
    CHECK_EQ_I64(exh_calib_fit(&fit, f.point, 1, EXH_CALIB_CURRENT), -EXH_E_RANGE);
}

/* The line that continues the last point must rise and must not overflow. A monitor's table
 * continues both ways. */
TEST(tables_that_cannot_go_on_are_refused)
{
    static const struct {
        struct exh_calib_point point;
        int32_t end_A_q26;
        uint8_t what;
    } row[] = {
        {{N(1000), A(5000), A(5000), 0}, A(5000) + 1,
            EXH_CALIB_FORCE_TABLE},                                     /* by less than an LSB */
        {{N(100000), A(50), A(50), 0}, A(6600), EXH_CALIB_FORCE_TABLE}, /* to 13 kN */
        {{N(10000), A(1000), A(5), 0}, A(3000),
            EXH_CALIB_MONITOR_TABLE}, /* to 4 kN by the monitor */
        {{N(10000), A(1000), A(10), 0}, A(3000), EXH_CALIB_MONITOR_TABLE}, /* from -2 kN to 2 kN */
        {{N(10000), A(1000), A(10000), 0}, A(6600), EXH_CALIB_ERRORS}, /* from -15.6 A to 15.6 A */
        {{N(10000), A(100), A(10000), 0}, A(6600),
            EXH_CALIB_MONITOR_TABLE}, /* from -16.5 A to 16.5 A */
    };
    for (size_t i = 0; i < LEN(row); i++) {
        struct exh_calib_error bad = {99, 99};
        struct fixture f;
        int err;
        set_up(&f);
        f.point[0] = row[i].point;
        f.c.points = 1;
        f.c.end_A_q26 = row[i].end_A_q26;
        err = exh_calib_validate(&f.c, &bad);
        if (row[i].what == EXH_CALIB_ERRORS) {
            CHECK(err == 0, "row %zu: %d", i, err);
        } else {
            CHECK(err == -EXH_E_RANGE && bad.what == row[i].what && bad.at == 0, "row %zu: %d, %s",
                i, err, exh_calib_error_text(bad.what));
        }
    }
}

TEST(points_that_are_none_are_not_fitted)
{
    static const struct exh_calib_point point[] = {
        {0, 0, 0, 0}, /* any ratio */
        {N(990), A(300), A(303), A(6600) + 1},
        {N(990), A(300), A(303), -1},
        {-N(990), -A(300), -A(303), 0},
    };
    struct exh_calib_fit fit;
    for (size_t i = 0; i < LEN(point); i++) {
        CHECK(exh_calib_fit(&fit, &point[i], 1, EXH_CALIB_CURRENT) == -EXH_E_RANGE, "point %zu", i);
    }
}

TEST(an_image_needs_room)
{
    struct fixture f;
    struct exh_calib_error bad = {99, 99};
    uint8_t image[1024];
    int32_t len;
    set_up(&f);
    len = exh_calib_save(&f.c, image, sizeof image, &bad);
    CHECK(len > 0, "%" PRId32, len);
    for (int32_t cap = 0; cap < len; cap++) {
        bad.what = 99;
        CHECK(exh_calib_save(&f.c, image, (size_t)cap, &bad) == -EXH_E_SHORT &&
                  bad.what == EXH_CALIB_IMAGE,
            "%" PRId32 " bytes", cap);
    }
    CHECK_EQ_I64(exh_calib_save(&f.c, NULL, 0, NULL), -EXH_E_SHORT); /* not looked at */
}

/* Each value at the ends of its range, and one beyond. */
TEST(values_at_the_ends_of_their_ranges)
{
    static const struct {
        int32_t lo, hi;
    } row[] = {
        {1, INT32_MAX}, {0, 65535}, {1, INT32_MAX}, {-32768, 32767}, {0, A(6600)}, {0, A(6600)}};
    for (unsigned i = 0; i < LEN(row); i++) {
        for (unsigned end = 0; end < 4; end++) {
            struct exh_calib_error bad = {99, 99};
            struct fixture f;
            int32_t *const of[] = {&f.c.dac_rawpA_q16, &f.c.dac_zero_raw, &f.c.mon_A_q40,
                &f.c.mon_zero_raw, &f.c.f0_A_q26, &f.c.end_A_q26};
            const int beyond = end >= 2;
            set_up(&f);
            if (end == 3 && row[i].hi == INT32_MAX) { continue; }
            *of[i] = end == 0   ? row[i].lo
                     : end == 1 ? row[i].hi
                     : end == 2 ? row[i].lo - 1
                                : row[i].hi + 1;
            CHECK(exh_calib_validate(&f.c, &bad) == (beyond ? -EXH_E_RANGE : 0), "value %u, %u", i,
                end);
            CHECK(!beyond || (bad.what == EXH_CALIB_VALUE && bad.at == 0), "value %u, %u: %d of %d",
                i, end, bad.what, bad.at);
        }
    }
}

/* The least numbers there are: nothing is added to the sums. */
TEST(the_least_point_is_fitted)
{
    struct exh_calib_point p = {1, 2, 4, 0};
    struct exh_calib_fit fit;
    CHECK_EQ_I64(exh_calib_fit(&fit, &p, 1, EXH_CALIB_CURRENT), 0);
    CHECK_EQ_I64(fit.kf_NpA_q20, INT32_C(1) << 25); /* 1/2 q20 over q26 */
    CHECK_EQ_I64(exh_calib_fit(&fit, &p, 1, EXH_CALIB_MONITOR), 0);
    CHECK_EQ_I64(fit.kf_NpA_q20, INT32_C(1) << 24);
    p.force_N_q20 = 0;
    CHECK_EQ_I64(exh_calib_fit(&fit, &p, 1, EXH_CALIB_CURRENT), -EXH_E_RANGE);
}

/* 0.1 and 2047 N/A to the bit; and what is refused fits nothing: no force at any current. */
TEST(the_ends_of_a_ratio)
{
    static const struct {
        int32_t force, cur, friction;
        int err;
    } row[] = {{1, 640, 0, 0}, {1, 641, 0, -EXH_E_RANGE}, {2047, 64, 0, 0},
        {2048, 64, 0, -EXH_E_RANGE}, {0, 0, 0, -EXH_E_RANGE},
        {EXH_Q(100, 1, EXH_Q_FORCE), A(1000), A(6600), 0},
        {EXH_Q(100, 1, EXH_Q_FORCE) + 1, A(1000), 0, -EXH_E_RANGE}, {N(1000), A(6600), 0, 0},
        {N(1000), A(6600) + 1, 0, -EXH_E_RANGE}};
    for (size_t i = 0; i < LEN(row); i++) {
        const struct exh_calib_point p[2] = {
            {row[i].force, row[i].cur, 1, row[i].friction}, {N(10000), A(1000), A(1000), 0}};
        struct exh_calib_fit fit = {{12345, 1}, 6789};
        CHECK(exh_calib_fit(&fit, p, 2, EXH_CALIB_CURRENT) == row[i].err, "row %zu", i);
        if (row[i].err == 0) { continue; }
        CHECK_EQ_I64(fit.kf_NpA_q20, 0);
        CHECK_EQ_I64(exh_calib_residual_N_q20(&fit, &p[1], EXH_CALIB_CURRENT), N(10000));
    }
}

TEST(more_points_than_there_may_be)
{
    struct exh_calib_point p[EXH_CALIB_POINTS_MAX + 1];
    struct exh_calib_fit fit;
    for (int32_t i = 0; i <= EXH_CALIB_POINTS_MAX; i++) {
        p[i] = (struct exh_calib_point){N(100) * (i + 1), A(30) * (i + 1), A(31) * (i + 1), 0};
    }
    CHECK_EQ_I64(exh_calib_fit(&fit, p, EXH_CALIB_POINTS_MAX, EXH_CALIB_CURRENT), 0);
    CHECK_EQ_I64(exh_calib_fit(&fit, p, EXH_CALIB_POINTS_MAX + 1, EXH_CALIB_CURRENT), -EXH_E_RANGE);
}

/* As many points as there may be, and straight on behind them; one point of an LSB of all. */
TEST(most_and_least_points)
{
    struct exh_calib_point p[EXH_CALIB_POINTS_MAX];
    struct fixture f;
    for (int32_t i = 0; i < EXH_CALIB_POINTS_MAX; i++) {
        p[i] = (struct exh_calib_point){N(100) * (i + 1), A(30) * (i + 1), A(31) * (i + 1), 0};
    }
    set_up(&f);
    f.c.point = p;
    f.c.points = EXH_CALIB_POINTS_MAX;
    CHECK_EQ_I64(exh_calib_validate(&f.c, NULL), 0);
    p[0] = (struct exh_calib_point){1, 1, 1, 0};
    f.c.points = 1;
    f.c.end_A_q26 = 1;
    CHECK_EQ_I64(exh_calib_validate(&f.c, NULL), 0);
}

/* Of two points that cannot go on there is no shorter table either; up to the last force that fits
 * there is one. */
TEST(no_table_ends_early)
{
    static const struct {
        struct exh_calib_point point[2];
        int32_t end_A_q26;
        int err;
        uint8_t what;
    } row[] = {
        {{{N(500), A(2500), A(2500), 0}, {N(1000), A(5000), A(5000), 0}}, A(5000) + 1, -EXH_E_RANGE,
            EXH_CALIB_FORCE_TABLE},
        {{{N(5000), A(500), A(3), 0}, {N(10000), A(1000), A(5), 0}}, A(3000), -EXH_E_RANGE,
            EXH_CALIB_MONITOR_TABLE},
        {{{94988559, 13330173, 39990519, 0}, {0, 0, 0, 0}}, 301366068, 0, 99}, /* to 2^31 - 1 */
        {{{94988559, 13330173, 39990519, 0}, {0, 0, 0, 0}}, 301366069, -EXH_E_RANGE,
            EXH_CALIB_FORCE_TABLE},
    };
    for (size_t i = 0; i < LEN(row); i++) {
        struct exh_calib_error bad = {99, 99};
        struct fixture f;
        set_up(&f);
        f.point[0] = row[i].point[0];
        f.point[1] = row[i].point[1];
        f.c.points = row[i].point[1].force_N_q20 > 0 ? 2 : 1;
        f.c.end_A_q26 = row[i].end_A_q26;
        CHECK(exh_calib_validate(&f.c, &bad) == row[i].err && bad.what == row[i].what,
            "row %zu: %d", i, bad.what);
        CHECK(row[i].err == 0 || bad.at == f.c.points - 1, "row %zu: point %d", i, bad.at);
    }
}

/* One LSB of force more is enough to go on to, and half of one, rounded up, is one. */
TEST(the_least_way_on)
{
    static const struct {
        int32_t more;
        int err;
    } row[] = {{159, -EXH_E_RANGE}, {161, 0}, {320, 0}, {481, 0}};
    for (size_t i = 0; i < LEN(row); i++) { /* 1 N at 5 A: 320 to 1 */
        struct exh_calib_point p = {EXH_Q(1, 1, EXH_Q_FORCE), A(5000), A(5000), 0};
        struct fixture f;
        set_up(&f);
        f.c.point = &p;
        f.c.points = 1;
        f.c.end_A_q26 = p.cur_A_q26 + row[i].more;
        CHECK(exh_calib_validate(&f.c, NULL) == row[i].err, "row %zu: %d", i,
            exh_calib_validate(&f.c, NULL));
    }
}

TEST_MAIN("unit/calibrate", mean_rounds_half_up_once, mean_stops_before_it_overflows,
    tables_meet_every_point_and_go_straight_on, tables_need_room, near_is_within_half_of_kf,
    a_ratio_saturates, validity_has_a_ceiling, refusals_name_table_and_point,
    values_out_of_range_are_refused, another_device_and_stale_ones_are_refused, image_round_trip,
    any_bit_flipped_any_byte_missing_is_refused, a_sound_image_of_a_bad_table_is_refused,
    every_name_has_its_text, fit_by_hand, tables_that_cannot_go_on_are_refused,
    points_that_are_none_are_not_fitted, an_image_needs_room, values_at_the_ends_of_their_ranges,
    the_least_point_is_fitted, the_ends_of_a_ratio, more_points_than_there_may_be,
    most_and_least_points, no_table_ends_early, the_least_way_on);
