/* SPDX-License-Identifier: MIT */
/* Calibrations of fingers in the scenes that pull. With a good one, two steps of arming pass, and
 * forces follow its points. Set-up refuses by name a damaged one, one of another device or finger,
 * one that is too old, and one made with other scales. It then uses none of it. Without a
 * calibration nothing arms, unless that is waived. */
#include "said.h"

#include "bilateral/bilateral.h"
#include "drop/drop.h"
#include "guarded/guarded.h"

#include "exhand/error.h"
#include "exhand/record.h"

#include <stdio.h>
#include <stdlib.h>

#define DEVICE      7
#define DAY         20000
#define ID_DEVICE   0x8901
#define ID_DAY      0x8902
#define ID_WITHOUT  0x8903
#define ID_FAR      0x8904
#define ID_FINGERS  0x8610
#define ID_DAC_ZERO 0x0507
#define MON_ZERO    -37

static const struct exh_scene_board board = {{1, 2000}, 24};

/* --- images --- */

static struct {
    uint8_t byte[EXH_CALIB_IMAGE_B];
    uint32_t len_B;
} image[EXH_FINGERS + 1];

static struct exh_calib_point point[3] = {
    {EXH_Q(1, 1, EXH_Q_FORCE), EXH_Q(300, 1000, EXH_Q_CUR), EXH_Q(301, 1000, EXH_Q_CUR), 0},
    {EXH_Q(3, 1, EXH_Q_FORCE), EXH_Q(1, 1, EXH_Q_CUR), EXH_Q(1, 1, EXH_Q_CUR), 0},
    {EXH_Q(7, 1, EXH_Q_FORCE), EXH_Q(2, 1, EXH_Q_CUR), EXH_Q(2, 1, EXH_Q_CUR), 0},
};

/* With the scales that a scene begins with. */
static struct exh_calib calib(uint32_t finger)
{
    const struct drop_par *par;
    exh_scene_drop.defaults();
    par = (const void *)exh_scene_drop.params->active;
    return (struct exh_calib){.device_id = DEVICE,
        .finger = finger,
        .day = DAY,
        .valid_days = 90,
        .dac_rawpA_q16 = par->drive.dac_rawpA_q16,
        .dac_zero_raw = par->drive.dac_zero_raw,
        .mon_A_q40 = par->drive.mon_A_q40,
        .mon_zero_raw = MON_ZERO,
        .end_A_q26 = EXH_Q(66, 10, EXH_Q_CUR),
        .point = point,
        .points = LEN(point)};
}

static void save(unsigned i, const struct exh_calib *c)
{
    const int32_t n = exh_calib_save(c, image[i].byte, sizeof image[i].byte, NULL);
    CHECK(n > 0, "%d", (int)n);
    image[i].len_B = (uint32_t)n;
}

/* n images from number `first` on into a scene that begins anew, here and today. */
static void give(const struct exh_scene *sc, unsigned first, unsigned n)
{
    sc->defaults();
    sc->calib->images = (uint8_t)n;
    for (unsigned i = 0; i < n; i++) {
        sc->calib->image[i].byte = image[first + i].byte;
        sc->calib->image[i].len_B = image[first + i].len_B;
    }
    CHECK_EQ_I64(exh_params_stage(sc->params, ID_DEVICE, 0, DEVICE), 0);
    CHECK_EQ_I64(exh_params_stage(sc->params, ID_DAY, 0, DAY + 90), 0);
}

static int set_up(const struct exh_scene *sc)
{
    exh_params_apply(sc->params);
    return sc->setup(board);
}

/* RUN after the first tick, healthy, at rest. */
static void ticks(const struct exh_scene *sc, int n)
{
    struct exh_scene_in in = {.drive.din = UINT32_MAX, .glove.age_ticks = UINT16_MAX};
    struct exh_drive_out out;
    for (unsigned f = 0; f < EXH_FINGERS; f++) { in.drive.mon_raw[f] = MON_ZERO; }
    for (int k = 0; k < n; k++) {
        in.command = k == 1 ? EXH_CMD_RUN : EXH_CMD_NONE;
        sc->tick(&in, &out);
    }
}

static void check_refused(const struct exh_scene *sc, int want, const char *what, const char *about)
{
    const int err = set_up(sc);
    const struct exh_scene_calib *k = sc->calib;
    const int32_t zero = exh_signal_find(sc->params->table, 0x050A, 0);
    CHECK(err == want, "%s, %s: %d", sc->name, about, err);
    CHECK(k->refused == want && k->what && strcmp(k->what, what) == 0, "%s, %s: %d, %s", sc->name,
        about, k->refused, k->what ? k->what : "");
    CHECK(sc->params->active[zero] == 0, "%s, %s: its zero was taken", sc->name, about);
}

/* --- one finger --- */

static const struct exh_scene *const one[] = {&exh_scene_drop, &exh_scene_guarded};

TEST(nothing_arms_without_unless_waived)
{
    const struct exh_scene *const all[] = {
        &exh_scene_drop, &exh_scene_guarded, &exh_scene_bilateral};
    for (size_t i = 0; i < LEN(all); i++) {
        for (int32_t waived = 0; waived < 2; waived++) {
            all[i]->defaults();
            all[i]->calib->images = 0;
            CHECK_EQ_I64(exh_params_stage(all[i]->params, ID_WITHOUT, 0, waived), 0);
            CHECK_EQ_I64(set_up(all[i]), 0);
            ticks(all[i], 3);
            CHECK(all[i]->safety->state == (waived ? EXH_STATE_ARM : EXH_STATE_OFF),
                "%s, %d: state %d", all[i]->name, (int)waived, all[i]->safety->state);
            CHECK_EQ_I64(all[i]->safety->refused, waived ? 0 : EXH_ARM_CALIBRATION);
        }
    }
}

TEST(a_good_one_arms_and_forces_go_by_its_points)
{
    struct exh_calib c = calib(0);
    struct drop_cfg *cfg;
    save(0, &c);
    for (size_t i = 0; i < LEN(one); i++) {
        const int32_t zero = exh_signal_find(one[i]->params->table, 0x050A, 0);
        give(one[i], 0, 1);
        CHECK_EQ_I64(set_up(one[i]), 0);
        CHECK_EQ_I64(one[i]->params->active[zero], MON_ZERO);
        ticks(one[i], 1300);
        CHECK(exh_safety_is_running(one[i]->safety), "%s: state %d, refused %d, faults %x",
            one[i]->name, one[i]->safety->state, one[i]->safety->refused,
            (unsigned)one[i]->safety->faults);
    }
    give(&exh_scene_drop, 0, 1);
    CHECK_EQ_I64(set_up(&exh_scene_drop), 0);
    (void)drop_memory(&cfg);
    for (size_t k = 0; k < LEN(point); k++) {
        CHECK_EQ_I64(
            exh_table_at(exh_calib_to_cur(&cfg->calib), point[k].force_N_q20), point[k].cur_A_q26);
        CHECK_EQ_I64(exh_table_at(exh_calib_to_force(&cfg->calib), point[k].mon_A_q26),
            point[k].force_N_q20);
        CHECK_EQ_I64(exh_table_at(exh_calib_to_force(&cfg->calib), -point[k].mon_A_q26),
            -point[k].force_N_q20);
    }
    CHECK(exh_table_at(exh_calib_to_cur(&cfg->calib), INT32_MAX) == EXH_Q(66, 10, EXH_Q_CUR),
        "the table's end");
}

/* Whatever it is, with `uncalibrated` too: who brings an image means it. */
TEST(what_does_not_hold_is_refused_by_name)
{
    static const struct {
        const char *what, *about;
        int err, id, finger, day, waived;
        int32_t zero_raw;
    } row[] = {
        {"device", "another device", -EXH_E_VERSION, DEVICE + 1, 0, 0, 0, 0},
        {"device", "another device, waived", -EXH_E_VERSION, DEVICE + 1, 0, 0, 1, 0},
        {"finger", "another finger", -EXH_E_VERSION, DEVICE, 1, 0, 0, 0},
        {"age", "from the future", -EXH_E_STALE, DEVICE, 0, DAY + 91, 0, 0},
        {"age", "too old", -EXH_E_STALE, DEVICE, 0, DAY - 1, 0, 0},
        {"scale or zero of D/A or monitor", "another zero", -EXH_E_STALE, DEVICE, 0, DAY, 0, 32700},
    };
    for (size_t i = 0; i < LEN(row); i++) {
        struct exh_calib c = calib((uint32_t)row[i].finger);
        c.device_id = (uint32_t)row[i].id;
        if (row[i].day) { c.day = (uint32_t)row[i].day; }
        save(0, &c);
        for (size_t s = 0; s < LEN(one); s++) {
            const int32_t zero_raw = row[i].zero_raw;
            give(one[s], 0, 1);
            CHECK_EQ_I64(exh_params_stage(one[s]->params, ID_WITHOUT, 0, row[i].waived), 0);
            if (zero_raw) {
                CHECK_EQ_I64(exh_params_stage(one[s]->params, ID_DAC_ZERO, 0, zero_raw), 0);
            }
            if (zero_raw) {
                CHECK_EQ_I64(set_up(one[s]), row[i].err);
                CHECK(strcmp(one[s]->calib->what, row[i].what) == 0, "%s", one[s]->calib->what);
            } else {
                check_refused(one[s], row[i].err, row[i].what, row[i].about);
            }
        }
    }
    /* A day that is not known makes every image of a day one from the future. */
    struct exh_calib c = calib(0);
    save(0, &c);
    give(&exh_scene_drop, 0, 1);
    CHECK_EQ_I64(exh_params_stage(exh_scene_drop.params, ID_DAY, 0, 0), 0);
    check_refused(&exh_scene_drop, -EXH_E_STALE, "age", "no day");
    exh_scene_drop.calib->images = 0;
    CHECK_EQ_I64(set_up(&exh_scene_drop), 0);
    CHECK_EQ_I64(exh_scene_drop.calib->refused, 0);
}

TEST(every_damaged_bit_and_every_end_is_refused)
{
    struct exh_calib c = calib(0);
    save(0, &c);
    for (uint32_t bit = 0; bit < 8 * image[0].len_B; bit++) {
        give(&exh_scene_drop, 0, 1);
        image[0].byte[bit / 8] ^= (uint8_t)(1u << bit % 8);
        CHECK(set_up(&exh_scene_drop) < 0 && exh_scene_drop.calib->refused < 0, "bit %u",
            (unsigned)bit);
        CHECK(strcmp(exh_scene_drop.calib->what, "image") == 0, "bit %u: %s", (unsigned)bit,
            exh_scene_drop.calib->what);
        image[0].byte[bit / 8] ^= (uint8_t)(1u << bit % 8);
    }
    for (uint32_t len_B = 0; len_B < image[0].len_B; len_B++) {
        give(&exh_scene_drop, 0, 1);
        exh_scene_drop.calib->image[0].len_B = len_B;
        check_refused(&exh_scene_drop, -EXH_E_SHORT, "image", "cut off");
    }
    give(&exh_scene_drop, 0, 1);
    exh_scene_drop.calib->image[0].len_B++;
    check_refused(&exh_scene_drop, -EXH_E_RANGE, "image", "a byte behind it");
    give(&exh_scene_drop, 0, 1);
    CHECK_EQ_I64(set_up(&exh_scene_drop), 0);
}

/* --- five --- */

static void save_hand(void)
{
    for (unsigned f = 0; f < EXH_FINGERS; f++) {
        struct exh_calib c = calib(EXH_FINGERS - 1 - f); /* any order */
        c.mon_zero_raw = MON_ZERO + (int32_t)c.finger;
        point[2].cur_A_q26 = EXH_Q(2, 1, EXH_Q_CUR) + (int32_t)c.finger;
        save(f, &c);
    }
}

TEST(the_full_box_needs_one_for_every_finger_in_use)
{
    const struct exh_scene *sc = &exh_scene_bilateral;
    struct bilateral_cfg *cfg;
    (void)bilateral_memory(&cfg);
    save_hand();
    for (int32_t fingers = 1; fingers < 1 << EXH_FINGERS; fingers++) {
        for (unsigned n = 0; n <= EXH_FINGERS; n++) {
            const uint32_t have = ((1u << n) - 1)
                                  << (EXH_FINGERS - n); /* the last n, little first */
            const int all = ((uint32_t)fingers & ~have) == 0;
            give(sc, 0, n);
            CHECK_EQ_I64(exh_params_stage(sc->params, ID_FINGERS, 0, fingers), 0);
            CHECK_EQ_I64(set_up(sc), 0);
            ticks(sc, 3);
            CHECK(sc->safety->state == (all ? EXH_STATE_ARM : EXH_STATE_OFF),
                "fingers %d, %u images: state %d", (int)fingers, n, sc->safety->state);
            CHECK_EQ_I64(sc->safety->refused, all ? 0 : EXH_ARM_CALIBRATION);
        }
    }
    for (unsigned f = 0; f < EXH_FINGERS; f++) {
        const struct exh_calib_tables *t = &cfg->finger[f].calib;
        const int32_t zero = exh_signal_find(sc->params->table, 0x050A, (uint16_t)f);
        CHECK_EQ_I64(exh_table_at(exh_calib_to_cur(t), point[2].force_N_q20),
            EXH_Q(2, 1, EXH_Q_CUR) + (int32_t)f);
        CHECK_EQ_I64(sc->params->active[zero], MON_ZERO + (int32_t)f);
    }
}

/* A bad finger is named by its place in the list. If one is damaged, none is used. */
TEST(one_of_five_that_is_refused_refuses_all)
{
    const struct exh_scene *sc = &exh_scene_bilateral;
    save_hand();
    for (unsigned bad = 0; bad < EXH_FINGERS; bad++) {
        give(sc, 0, EXH_FINGERS);
        image[bad].byte[20] ^= 1;
        check_refused(sc, -EXH_E_CRC, "image", "one of five");
        CHECK_EQ_I64(sc->calib->image_at, bad);
        image[bad].byte[20] ^= 1;
    }
    image[1] = image[0];
    give(sc, 0, EXH_FINGERS);
    check_refused(sc, -EXH_E_VERSION, "finger", "the little finger's twice");
    CHECK_EQ_I64(sc->calib->image_at, 1);
}

/* --- far from what is expected --- */

#define FORGED_DAYS 36500

/* An impossible calibration: 0.1 N/A of a motor with 3.3, valid for a hundred years, CRC right. */
static void forge(unsigned i, struct exh_calib c, uint32_t valid_days)
{
    static struct exh_calib_point weak[2] = {
        {EXH_Q(1001, 10000, EXH_Q_FORCE), EXH_Q(1, 1, EXH_Q_CUR), EXH_Q(1, 1, EXH_Q_CUR), 0},
        {EXH_Q(5005, 10000, EXH_Q_FORCE), EXH_Q(5, 1, EXH_Q_CUR), EXH_Q(5, 1, EXH_Q_CUR), 0},
    };
    struct exh_bytes b;
    uint32_t crc;
    c.point = weak;
    c.points = LEN(weak);
    save(i, &c);
    b = exh_bytes_writer(image[i].byte + 20, 4);
    exh_bytes_u32(&b, &valid_days);
    crc = exh_crc32(0, image[i].byte, image[i].len_B - 4);
    b = exh_bytes_writer(image[i].byte + image[i].len_B - 4, 4);
    exh_bytes_u32(&b, &crc);
}

TEST(a_forged_one_is_refused)
{
    const struct exh_scene *const all[] = {
        &exh_scene_drop, &exh_scene_guarded, &exh_scene_bilateral};
    for (size_t i = 0; i < LEN(all); i++) {
        const struct exh_scene_calib *k = all[i]->calib;
        forge(0, calib(0), 90);
        give(all[i], 0, 1);
        if (i == 2) { CHECK_EQ_I64(exh_params_stage(all[i]->params, ID_FINGERS, 0, 1), 0); }
        CHECK_EQ_I64(exh_params_stage(all[i]->params, ID_WITHOUT, 0, 1), 0);
        CHECK_EQ_I64(set_up(all[i]), -EXH_E_RANGE);
        CHECK(strcmp(k->what, "force over current") == 0 && k->image_at == 0 && k->point_at == 0 &&
                  k->finger == 0,
            "%s", k->what);
        CHECK(abs(k->ratio_NpA_q20 - EXH_Q(1001, 10000, EXH_Q_FORCE)) < 4 &&
                  k->expected_NpA_q20 == EXH_Q(3339, 1000, EXH_Q_FORCE),
            "%d of %d", (int)k->ratio_NpA_q20, (int)k->expected_NpA_q20);
        CHECK_EQ_I64(exh_params_stage(all[i]->params, ID_FAR, 0, 1), 0);
        CHECK_EQ_I64(set_up(all[i]), 0);
        CHECK_EQ_I64(k->expected_NpA_q20, 0);
        forge(0, calib(0), FORGED_DAYS); /* which nothing waives */
        give(all[i], 0, 1);
        CHECK_EQ_I64(exh_params_stage(all[i]->params, ID_FAR, 0, 1), 0);
        check_refused(all[i], -EXH_E_RANGE, "validity, above 366 days", "a hundred years");
    }
}

/* Each point is held against kf, the monitor's current as the one that is coded. */
TEST(one_point_far_from_kf_is_named)
{
    const struct exh_calib_point was = point[1];
    for (int far = 0; far < 4; far++) {
        struct exh_calib c = calib(0);
        point[1].cur_A_q26 = far == 0 ? EXH_Q(59, 100, EXH_Q_CUR) : was.cur_A_q26;
        point[1].mon_A_q26 = far == 1   ? EXH_Q(59, 100, EXH_Q_CUR)
                             : far == 2 ? EXH_Q(18, 10, EXH_Q_CUR)
                                        : was.mon_A_q26;
        save(0, &c);
        give(&exh_scene_drop, 0, 1);
        CHECK(set_up(&exh_scene_drop) == (far < 3 ? -EXH_E_RANGE : 0), "row %d", far);
        if (far < 3) {
            CHECK(strcmp(exh_scene_drop.calib->what,
                      far ? "force over monitored current" : "force over current") == 0 &&
                      exh_scene_drop.calib->point_at == 1,
                "row %d: %s", far, exh_scene_drop.calib->what);
        }
    }
    point[1] = was;
}

/* All are within half of kf, one is not within half of the median. Two fingers cannot show which is
 * wrong. */
TEST(one_finger_far_from_the_others_is_named)
{
    const struct exh_scene *sc = &exh_scene_bilateral;
    const struct exh_calib_point was[3] = {point[0], point[1], point[2]};
    for (unsigned odd = 0; odd < EXH_FINGERS; odd++) {
        for (unsigned f = 0; f < EXH_FINGERS; f++) {
            struct exh_calib c = calib(f);
            for (unsigned i = 0; i < LEN(point); i++) { /* 4.67 and 2.67 N/A */
                const int32_t A_q26 =
                    (int32_t)(was[i].force_N_q20 * 64.0 / (f == odd ? 4.67 : 2.67));
                point[i] = (struct exh_calib_point){was[i].force_N_q20, A_q26, A_q26, 0};
            }
            save(f, &c);
        }
        for (unsigned n = 1; n <= EXH_FINGERS; n++) {
            const int told = n >= 3 && odd < n;
            give(sc, 0, n);
            CHECK(set_up(sc) == (told ? -EXH_E_RANGE : 0), "%u of %u", odd, n);
            if (!told) { continue; }
            CHECK(sc->calib->finger == odd && sc->calib->image_at == odd &&
                      strcmp(sc->calib->what, "force over current beside the other fingers") == 0,
                "%u of %u: %s", odd, n, sc->calib->what);
            CHECK_EQ_I64(exh_params_stage(sc->params, ID_FAR, 0, 1), 0);
            CHECK(set_up(sc) == 0, "%u of %u, waived", odd, n);
        }
    }
    memcpy(point, was, sizeof was);
}

/* --- people --- */

static uint32_t slurp(const char *path, uint8_t *to, size_t cap_B)
{
    FILE *f = fopen(path, "rb");
    size_t n;
    CHECK(f != NULL, "%s", path);
    n = fread(to, 1, cap_B, f);
    fclose(f);
    return (uint32_t)n;
}

/* The file that gave 22 N for a limit of 0.67 N. */
TEST(a_forged_file_is_refused_by_every_command)
{
    static const struct {
        uint32_t days;
        const char *drop, *check;
    } row[] = {
        {90,
            "finger 0, force over current, point 1: 0.1001 N/A (allowed 1.669..5.008, half to 3/2 "
            "of 3.339): calibrate again",
            "finger 0, force over current, point 1: 0.1001 N/A (allowed 1.669..5.008, half to 3/2 "
            "of kf 3.339): calibrate again"},
        {FORGED_DAYS, "validity, above 366 days: ", "validity, above 366 days: "},
    };
    static struct said s;
    const char *dir = said_dir();
    const char *path = said_path(dir, "calibration.bin");
    struct exh_calib_point own[EXH_CALIB_POINTS_MAX];
    struct exh_calib c = {.point = own, .cap = EXH_CALIB_POINTS_MAX};
    uint8_t genuine[EXH_CALIB_IMAGE_B];
    said(&s, dir, cli_calibrate, WORDS("calibrate", "--day", "20000", "--out", dir));
    CHECK_EQ_I64(exh_calib_load(&c, genuine, slurp(path, genuine, sizeof genuine), NULL), 0);
    for (size_t i = 0; i < LEN(row); i++) {
        FILE *f = fopen(path, "wb");
        forge(0, c, row[i].days);
        CHECK(f && fwrite(image[0].byte, 1, image[0].len_B, f) == image[0].len_B && fclose(f) == 0,
            "%s", path);
        said(&s, dir, cli_drop,
            WORDS("drop", "--rate", "500", "--falls", "1", "--set", "f_max=0.66", "--calibration",
                path, "--set", "day=20000"));
        CHECK(s.status == 2 && strstr(s.err, row[i].drop), "%d: %s", s.status, s.err);
        said(&s, dir, cli_calibrate, WORDS("calibrate", "--check", path, "--day", "20000"));
        CHECK(s.status == 1 && strstr(s.err, row[i].check), "%d: %s", s.status, s.err);
    }
    said_clean(dir);
}

/* The header has the image's bytes, so that a replay elsewhere, years later, is the same. */
TEST(a_log_has_them_and_replays)
{
    static uint8_t log[4u << 20], file[EXH_CALIB_IMAGE_B];
    static struct said s;
    const char *dir = said_dir();
    char path[512], out[512];
    uint32_t log_B, file_B, at = 0;
    said(&s, dir, cli_calibrate, WORDS("calibrate", "--day", "20000", "--out", dir));
    CHECK(s.status == 0, "%d: %s", s.status, s.err);
    snprintf(path, sizeof path, "%s/calibration.bin", dir);
    said(&s, dir, cli_drop,
        WORDS("drop", "--rate", "500", "--falls", "1", "--out", dir, "--calibration", path, "--set",
            "day=20010"));
    CHECK(s.status == 0, "%d: %s", s.status, s.err);
    snprintf(out, sizeof out, "%s/drop_500Hz.exh", dir);
    said(&s, dir, cli_replay, WORDS("replay", out));
    CHECK(s.status == 0 && strstr(s.out, "identical"), "%d: %s%s", s.status, s.out, s.err);
    file_B = slurp(path, file, sizeof file);
    log_B = slurp(out, log, sizeof log);
    while (at + file_B < 4096 && memcmp(log + at, file, file_B) != 0) { at++; }
    CHECK(at + file_B < 4096 && log_B > 4096, "its header has no image");
    /* Then without: the log of the run before is not taken for one of it. */
    said(&s, dir, cli_drop, WORDS("drop", "--rate", "500", "--falls", "1", "--out", dir));
    CHECK(s.status == 0, "%d: %s", s.status, s.err);
    said(&s, dir, cli_replay, WORDS("replay", out));
    CHECK(s.status == 0 && strstr(s.out, "identical"), "%d: %s%s", s.status, s.out, s.err);
    said_clean(dir);
}

TEST(a_dump_of_the_black_box_has_them)
{
    static struct said s;
    const char *dir = said_dir();
    char path[512], box[512];
    said(&s, dir, cli_calibrate, WORDS("calibrate", "--finger", "1", "--out", dir));
    CHECK(s.status == 0, "%d: %s", s.status, s.err);
    snprintf(path, sizeof path, "%s/calibration.bin", dir);
    snprintf(box, sizeof box, "%s/box.exh", dir);
    said(&s, dir, cli_bilateral,
        WORDS("bilateral", "--rate", "500", "--speed", "fast", "--approaches", "1", "--let-go",
            "1.2", "--blackbox", box, "--calibration", dir));
    CHECK(s.status == 1 && strstr(s.err, "deadman"), "%d: %s", s.status, s.err);
    said(&s, dir, cli_replay, WORDS("replay", box));
    CHECK(s.status == 0 && strstr(s.out, "fault deadman at tick"), "%d: %s%s", s.status, s.out,
        s.err);
    said_clean(dir);
}

TEST(the_command_names_file_and_field)
{
    static const struct {
        const char *set, *want;
    } row[] = {
        {"device_id=2", "device: "},
        {"day=19999", "age: "},
        {"dac_zero=32700", "scale or zero"},
        {"uncalibrated=1", NULL},
    };
    static struct said s;
    const char *dir = said_dir();
    char path[512];
    said(&s, dir, cli_calibrate, WORDS("calibrate", "--day", "20000", "--out", dir));
    snprintf(path, sizeof path, "%s/calibration.bin", dir);
    for (size_t i = 0; i < LEN(row); i++) {
        said(&s, dir, cli_drop,
            WORDS("drop", "--rate", "500", "--falls", "1", "--calibration", path, "--set",
                "day=20000", "--set", row[i].set));
        CHECK(s.status == (row[i].want ? 2 : 0), "%s: %d: %s", row[i].set, s.status, s.err);
        CHECK(!row[i].want || (strstr(s.err, "calibration.bin: ") && strstr(s.err, row[i].want)),
            "%s: %s", row[i].set, s.err);
    }
    said(&s, dir, cli_drop,
        WORDS("drop", "--rate", "500", "--falls", "1", "--set", "uncalibrated=0"));
    CHECK(s.status == 1 && strstr(s.err, "refused at calibration"), "%d: %s", s.status, s.err);
    said(&s, dir, cli_drop, WORDS("drop", "--rate", "500", "--calibration", "no/such/file"));
    CHECK(s.status == 3 && strstr(s.err, "no/such/file"), "%d: %s", s.status, s.err);
    said_clean(dir);
}

/* An image of parameters has the day on which it was saved, the device, and what was waived: it is
 * not asked whether a calibration holds today. */
TEST(loaded_parameters_do_not_vouch)
{
    static struct said s;
    const char *dir = said_dir();
    char path[512], par[512];
    snprintf(path, sizeof path, "%s/calibration.bin", dir);
    snprintf(par, sizeof par, "%s/p.exhp", dir);
    said(&s, dir, cli_calibrate, WORDS("calibrate", "--day", "10000", "--out", dir)); /* 1997 */
    said(&s, dir, cli_drop,
        WORDS("drop", "--rate", "500", "--falls", "1", "--calibration", path, "--set", "day=10000",
            "--save-params", par));
    CHECK(s.status == 0, "%d: %s", s.status, s.err);
    said(&s, dir, cli_drop,
        WORDS(
            "drop", "--rate", "500", "--falls", "1", "--calibration", path, "--load-params", par));
    CHECK(s.status == 2 && strstr(s.err, "age: "), "%d: %s", s.status, s.err);
    said_clean(dir);
}

/* A log of another record version is named as that. */
TEST(an_old_log_is_named)
{
    static struct said s;
    const char *dir = said_dir();
    static uint8_t b[64];
    struct exh_bytes c = exh_bytes_writer(b, sizeof b);
    char path[512];
    uint32_t n, crc;
    FILE *f;
    exh_record_begin(&c, EXH_RECORD_HEADER, 0, 0);
    n = exh_record_end(&c);
    b[3] = 1;
    crc = exh_crc32(0, b, n - 4);
    c = exh_bytes_writer(b + n - 4, 4);
    exh_bytes_u32(&c, &crc);
    snprintf(path, sizeof path, "%s/old.exh", dir);
    f = fopen(path, "wb");
    CHECK(f != NULL && fwrite(b, 1, n, f) == n && fclose(f) == 0, "%s", path);
    said(&s, dir, cli_replay, WORDS("replay", path));
    CHECK(s.status == 2 && strstr(s.err, "record version 1"), "%d: %s", s.status, s.err);
    said_clean(dir);
}

TEST_MAIN("calib", nothing_arms_without_unless_waived, a_good_one_arms_and_forces_go_by_its_points,
    what_does_not_hold_is_refused_by_name, every_damaged_bit_and_every_end_is_refused,
    the_full_box_needs_one_for_every_finger_in_use, one_of_five_that_is_refused_refuses_all,
    a_forged_one_is_refused, one_point_far_from_kf_is_named,
    one_finger_far_from_the_others_is_named, a_forged_file_is_refused_by_every_command,
    a_log_has_them_and_replays, a_dump_of_the_black_box_has_them, the_command_names_file_and_field,
    loaded_parameters_do_not_vouch, an_old_log_is_named);
