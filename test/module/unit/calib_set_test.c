/* SPDX-License-Identifier: MIT */
/* calib_set.h: which images of a hand set-up accepts, what confirms a finger, and the name by which
 * each other image is refused. In the scenes: sim/calib. */
#include "exhand/run/calib_set.h"

#include "exhand/bytes.h"
#include "exhand/drive.h"
#include "exhand/error.h"
#include "exhand/table.h"

#include "check.h"

#include <string.h>

/* Compiled here, as images of scenes have it and the library has not. */
#include "../../../lib/src/run/calib_set.c"

#define N(f) EXH_Q(f, 1000, EXH_Q_FORCE) /* mN */
#define A(i) EXH_Q(i, 1000, EXH_Q_CUR)   /* mA */
#define DAY  20000
#define ALL  31u
#define KF   3000 /* mN/A */

static const struct exh_signal_group group = {exh_drive_rows, EXH_DRIVE_ROWS, EXH_FINGERS};
static const struct exh_signal_table table = {&group, 1};

static struct {
    uint8_t byte[EXH_FINGERS][EXH_CALIB_IMAGE_B];
    struct exh_scene_calib k;
    struct exh_params p;
    int32_t active[EXH_DRIVE_ROWS * EXH_FINGERS], wanted[EXH_DRIVE_ROWS * EXH_FINGERS];
    struct exh_drive_par drive;
    struct exh_calib_set_par par;
} g;

/* Image i, of finger f: 3 A and 6 A, at so many mN/A; monitored are mon_mA, and twice that. */
static void give_with(unsigned i, unsigned f, int32_t ratio, int32_t mon_mA)
{
    struct exh_calib_point p[2] = {
        {3 * N(ratio), A(3000), A(mon_mA), 0}, {6 * N(ratio), A(6000), 2 * A(mon_mA), 0}};
    const struct exh_calib c = {.device_id = 7,
        .finger = f,
        .day = DAY,
        .valid_days = 90,
        .dac_rawpA_q16 = g.drive.dac_rawpA_q16,
        .dac_zero_raw = g.drive.dac_zero_raw,
        .mon_A_q40 = g.drive.mon_A_q40,
        .mon_zero_raw = -37 - (int32_t)f,
        .end_A_q26 = A(6600),
        .point = p,
        .points = 2};
    const int32_t n = exh_calib_save(&c, g.byte[i], sizeof g.byte[i], NULL);
    CHECK(n > 0, "image %u: %d", i, (int)n);
    g.k.image[i].byte = g.byte[i];
    g.k.image[i].len_B = (uint32_t)n;
    if (g.k.images <= i) { g.k.images = (uint8_t)(i + 1); }
}

static void give(unsigned i, unsigned f, int32_t ratio) { give_with(i, f, ratio, 3000); }

/* A hand of n fingers at kf. */
static void begin(unsigned n)
{
    int32_t *field = &g.drive.f_max_N_q20; /* all int32_t, in the order of the rows */
    memset(&g, 0, sizeof g);
    exh_params_setup(&g.p, &table, g.active, g.wanted);
    for (size_t r = 0; r < EXH_DRIVE_ROWS; r++) { field[r] = exh_drive_rows[r].dflt; }
    g.par = (struct exh_calib_set_par){7, DAY + 90, 0, 0};
    for (unsigned f = 0; f < n; f++) { give(f, f, KF); }
}

static int32_t zero_of(unsigned f)
{
    return g.active[exh_signal_find(&table, MON_ZERO_ID, (uint16_t)f)];
}

static void check_refused(int got, int want, unsigned image, const char *what)
{
    CHECK(got == want && g.k.refused == want && g.k.image_at == image && g.k.what &&
              check_same_text(g.k.what, what),
        "%d, image %u: %s; want %s", got, g.k.image_at, g.k.what ? g.k.what : "", what);
}

/* The tables of finger f. */
static int tables(struct exh_calib_tables *t, unsigned f)
{
    const struct exh_calib_finger of = {f, &g.drive, N(KF)};
    memset(t, 0, sizeof *t);
    g.drive.mon_zero_raw = zero_of(f);
    return exh_calib_set_tables(t, &g.k, &g.par, &of);
}

TEST(a_hand_that_holds_is_taken)
{
    struct exh_calib_tables t;
    begin(EXH_FINGERS);
    CHECK_EQ_I64(exh_calib_set_load(&g.k, &g.p, &g.par, ALL), 0);
    CHECK(g.k.refused == 0 && g.k.what == NULL, "%d", g.k.refused);
    for (unsigned f = 0; f < EXH_FINGERS; f++) {
        CHECK_EQ_I64(zero_of(f), -37 - (int32_t)f);
        CHECK_EQ_I64(tables(&t, f), 0);
        CHECK_EQ_I64(t.vouches, EXH_ARM_CALIBRATION | EXH_ARM_POLARITY);
        CHECK_EQ_I64(exh_table_at(exh_calib_to_cur(&t), 3 * N(KF)), A(3000));
        CHECK_EQ_I64(exh_table_at(exh_calib_to_force(&t), A(6000)), 6 * N(KF));
    }
}

/* Without an image only the person can waive the calibration of a finger. */
TEST(without_an_image_nothing_vouches)
{
    struct exh_calib_tables t;
    begin(1);
    CHECK_EQ_I64(exh_calib_set_load(&g.k, &g.p, &g.par, ALL), 0);
    CHECK_EQ_I64(tables(&t, 1), 0);
    CHECK_EQ_I64(t.vouches, 0);
    CHECK_EQ_I64((exh_table_at(exh_calib_to_cur(&t), 2 * N(KF)) + 4) / 8, (A(2000) + 4) / 8);
    g.par.uncalibrated = 1;
    CHECK_EQ_I64(tables(&t, 1), 0);
    CHECK_EQ_I64(t.vouches, EXH_UNCALIBRATED | EXH_UNPOLARISED);
    CHECK_EQ_I64(tables(&t, 0), 0); /* the waiver is not for an image */
    CHECK_EQ_I64(t.vouches, EXH_ARM_CALIBRATION | EXH_ARM_POLARITY);
    CHECK_EQ_I64(exh_calib_set_tables(&t, NULL, &g.par, &(struct exh_calib_finger){0, &g.drive, 0}),
        -EXH_E_MONOTONE); /* no kf is no line */
}

/* The lower median of three to five: half and 3/2 of it, and a bit beyond. */
TEST(a_finger_far_from_the_others_is_refused)
{
    static const char what[] = "force over current beside the other fingers";
    static const int32_t far[] = {1499, 4501}, near[] = {1501, 4499};
    for (unsigned n = 1; n <= EXH_FINGERS; n++) {
        for (unsigned odd = 0; odd < n; odd++) {
            for (size_t k = 0; k < LEN(far); k++) {
                begin(n);
                give(odd, odd, far[k]);
                if (n > 2) { /* two cannot show which one is wrong */
                    check_refused(
                        exh_calib_set_load(&g.k, &g.p, &g.par, ALL), -EXH_E_RANGE, odd, what);
                    CHECK(g.k.finger == odd && g.k.expected_NpA_q20 / 8 == N(KF) / 8, "%d",
                        (int)g.k.expected_NpA_q20);
                    CHECK(zero_of(0) == 0, "something of it was taken");
                    g.par.far_allowed = 1;
                }
                CHECK_EQ_I64(exh_calib_set_load(&g.k, &g.p, &g.par, ALL), 0);
                g.par.far_allowed = 0;
                give(odd, odd, near[k]);
                CHECK_EQ_I64(exh_calib_set_load(&g.k, &g.p, &g.par, ALL), 0);
            }
        }
    }
}

/* Of two fingers the others say nothing: each is held against kf alone. */
TEST(a_finger_far_from_kf_is_refused)
{
    struct exh_calib_tables t;
    begin(2);
    give(1, 1, 4501);
    CHECK_EQ_I64(exh_calib_set_load(&g.k, &g.p, &g.par, ALL), 0);
    CHECK_EQ_I64(tables(&t, 0), 0);
    check_refused(tables(&t, 1), -EXH_E_RANGE, 1, "force over current");
    CHECK(g.k.finger == 1 && g.k.point_at == 0 && g.k.expected_NpA_q20 == N(KF), "%u", g.k.finger);
    CHECK_EQ_I64(t.vouches, 0);
    g.par.far_allowed = 1;
    CHECK_EQ_I64(tables(&t, 1), 0);
    CHECK_EQ_I64(t.vouches, EXH_ARM_CALIBRATION | EXH_ARM_POLARITY);
}

/* The monitor's column alone is off. */
TEST(a_monitor_far_from_kf_is_refused)
{
    struct exh_calib_tables t;
    begin(1);
    give_with(0, 0, KF, 1999);
    CHECK_EQ_I64(exh_calib_set_load(&g.k, &g.p, &g.par, ALL), 0);
    check_refused(tables(&t, 0), -EXH_E_RANGE, 0, "force over monitored current");
    CHECK(g.k.ratio_NpA_q20 > N(4500) && g.k.ratio_NpA_q20 < N(4503), "%d", (int)g.k.ratio_NpA_q20);
}

/* By name, by number, and nothing of any is taken. */
TEST(what_does_not_hold_is_refused)
{
    static const struct {
        const char *what;
        int err;
        uint32_t fingers;
        int32_t device, day;
        int32_t more_B; /* of the second image */
        unsigned at;
    } row[] = {
        {"image", -EXH_E_SHORT, ALL, 7, DAY, -1, 1},
        {"image", -EXH_E_RANGE, ALL, 7, DAY, 1, 1},
        {"finger", -EXH_E_VERSION, 0x1D, 7, DAY, 0, 1},
        {"device", -EXH_E_VERSION, ALL, 8, DAY, 0, 0},
        {"age", -EXH_E_STALE, ALL, 7, DAY + 91, 0, 0},
        {"age", -EXH_E_STALE, ALL, 7, DAY - 1, 0, 0},
        {"age", -EXH_E_STALE, ALL, 7, 0, 0, 0},
    };
    for (size_t i = 0; i < LEN(row); i++) {
        begin(2);
        g.par.device_id = row[i].device;
        g.par.day = row[i].day;
        g.k.image[1].len_B += (uint32_t)(row[i].more_B);
        check_refused(exh_calib_set_load(&g.k, &g.p, &g.par, row[i].fingers), row[i].err, row[i].at,
            row[i].what);
        CHECK(zero_of(0) == 0 && g.p.pending == 0, "row %zu: something of it was taken", i);
    }
    begin(2);
    give(1, 0, KF);
    check_refused(exh_calib_set_load(&g.k, &g.p, &g.par, ALL), -EXH_E_VERSION, 1, "finger");
}

/* Once the loop has begun no zero is taken any more; a scale that changed since, and an image that
 * is damaged since, end with it. */
TEST(what_changed_since_is_refused)
{
    struct exh_calib_tables t;
    begin(1);
    g.p.locked = 1;
    check_refused(exh_calib_set_load(&g.k, &g.p, &g.par, ALL), -EXH_E_STATE, 0,
        "scale or zero of D/A or monitor");
    begin(1);
    CHECK_EQ_I64(exh_calib_set_load(&g.k, &g.p, &g.par, ALL), 0);
    g.drive.dac_zero_raw++;
    check_refused(tables(&t, 0), -EXH_E_STALE, 0, "scale or zero of D/A or monitor");
    CHECK_EQ_I64(t.vouches, 0);
    g.byte[0][20] ^= 1;
    check_refused(tables(&t, 0), -EXH_E_CRC, 0, "image");
}

TEST_MAIN("unit/calib_set", a_hand_that_holds_is_taken, without_an_image_nothing_vouches,
    a_finger_far_from_the_others_is_refused, a_finger_far_from_kf_is_refused,
    a_monitor_far_from_kf_is_refused, what_does_not_hold_is_refused, what_changed_since_is_refused);
