/* SPDX-License-Identifier: MIT */
/* Calibration images of a scene at set-up: check, selection and defaults. */
#include "exhand/run/calib_set.h"

#include "exhand/error.h"
#include "exhand/exhand.h"

#define MON_ZERO_ID 0x050A

const struct exh_signal exh_calib_set_rows[EXH_CALIB_SET_ROWS] = {
    {0x8901, 0, EXH_WHEN_PERSON, 0, INT32_MAX, 0, "device_id", "",
        "of this box: calibrations are made for one"},
    {0x8902, 0, EXH_WHEN_PERSON, 0, INT32_MAX, 0, "day", "",
        "today, days since 1970; 0: not known, no calibration of a day holds"},
    {0x8903, 0, EXH_WHEN_PERSON, 0, 1, 0, "uncalibrated", "",
        "1: a finger without a calibration arms without, by kf, polarity on trust"},
    {0x8904, 0, EXH_WHEN_PERSON, 0, 1, 0, "far_calibration", "",
        "1: a calibration beyond half or 3/2 of kf, or of the fingers' median, is believed"},
};

/* An image with room for the maximum number of points. */
struct loaded {
    struct exh_calib c;
    struct exh_calib_point point[EXH_CALIB_POINTS_MAX];
};

static int refuse(struct exh_scene_calib *k, unsigned i, struct exh_calib_error bad, int err)
{
    k->refused = err;
    k->image_at = (uint8_t)i;
    k->point_at = bad.at;
    k->what = exh_calib_error_text(bad.what);
    return err;
}

static int load(struct loaded *to, struct exh_scene_calib *k, unsigned i)
{
    struct exh_calib_error bad = {0, 0};
    int err;
    to->c.point = to->point;
    to->c.cap = EXH_CALIB_POINTS_MAX;
    err = exh_calib_load(&to->c, k->image[i].byte, k->image[i].len_B, &bad);
    /* In a log's header, extra bytes would look like the next image. */
    if (err == 0 && k->image[i].len_B !=
                        EXH_CALIB_IMAGE_B - 16u * (EXH_CALIB_POINTS_MAX - (uint32_t)to->c.points)) {
        err = -EXH_E_RANGE;
    }
    return err < 0 ? refuse(k, i, bad, err) : 0;
}

/* Is the ratio of force and current of an image within half of the expected one? */
static int near(
    struct exh_scene_calib *k, unsigned i, const struct loaded *now, int32_t kf_NpA_q20, int others)
{
    struct exh_calib_error bad = {0, 0};
    const int err = exh_calib_near(&now->c, kf_NpA_q20, &bad);
    if (err == 0) { return 0; }
    k->finger = (uint8_t)now->c.finger;
    k->ratio_NpA_q20 = exh_calib_ratio_NpA_q20(&now->point[bad.at],
        bad.what == EXH_CALIB_FAR_MONITOR ? EXH_CALIB_MONITOR : EXH_CALIB_CURRENT);
    k->expected_NpA_q20 = kf_NpA_q20;
    if (others) { bad.what = EXH_CALIB_FAR_FINGERS; }
    return refuse(k, i, bad, err);
}

/* Median of the ratios of all images; of an even number the lower one. All images are valid. */
static int32_t median(struct exh_scene_calib *k)
{
    int32_t sorted[EXH_FINGERS] = {0};
    struct loaded now;
    struct exh_calib_fit fit;
    for (unsigned i = 0; i < k->images; i++) {
        unsigned at = i;
        (void)load(&now, k, i);
        (void)exh_calib_fit(&fit, now.point, now.c.points, EXH_CALIB_CURRENT);
        for (; at > 0 && sorted[at - 1] > fit.kf_NpA_q20; at--) { sorted[at] = sorted[at - 1]; }
        sorted[at] = fit.kf_NpA_q20;
    }
    return sorted[(k->images - 1) / 2];
}

/* With two images, it is unknown which one is wrong: compare with kf only. */
static int alike(struct exh_scene_calib *k)
{
    struct loaded now;
    int32_t middle;
    int err = 0;
    if (k->images < 3) { return 0; }
    middle = median(k);
    for (unsigned i = 0; err == 0 && i < k->images; i++) {
        (void)load(&now, k, i);
        err = near(k, i, &now, middle, 1);
    }
    return err;
}

/* With the scales of the image itself if drive is NULL. */
static struct exh_calib_target here(const struct exh_calib *c, const struct exh_calib_set_par *par,
    const struct exh_drive_par *drive)
{
    struct exh_calib_target h = {(uint32_t)par->device_id, c->finger, (uint32_t)par->day,
        c->dac_rawpA_q16, c->dac_zero_raw, c->mon_A_q40, c->mon_zero_raw};
    if (drive) {
        h.dac_rawpA_q16 = drive->dac_rawpA_q16;
        h.dac_zero_raw = drive->dac_zero_raw;
        h.mon_A_q40 = drive->mon_A_q40;
        h.mon_zero_raw = drive->mon_zero_raw;
    }
    return h;
}

/* Checks all images. *fingers: mask of the fingers without one so far. */
static int check(struct exh_scene_calib *k, const struct exh_calib_set_par *par, uint32_t fingers)
{
    static const struct exh_calib_error wrong_finger = {EXH_CALIB_FINGER, 0};
    struct loaded now;
    for (unsigned i = 0; i < k->images; i++) {
        struct exh_calib_target h;
        struct exh_calib_error bad = {0, 0};
        int err = load(&now, k, i);
        if (err < 0) { return err; }
        if (!(fingers >> now.c.finger & 1u)) { return refuse(k, i, wrong_finger, -EXH_E_VERSION); }
        fingers &= ~(UINT32_C(1) << now.c.finger); /* refuse a second image */
        h = here(&now.c, par, NULL);
        err = exh_calib_check(&now.c, &h, &bad);
        if (err < 0) { return refuse(k, i, bad, err); }
    }
    return 0;
}

int exh_calib_set_load(struct exh_scene_calib *k, struct exh_params *params,
    const struct exh_calib_set_par *par, uint32_t fingers)
{
    static const struct exh_calib_error scale = {EXH_CALIB_SCALE, 0};
    struct loaded now;
    int err;
    k->refused = 0;
    k->what = NULL;
    k->expected_NpA_q20 = 0;
    err = check(k, par, fingers);
    if (err == 0 && !par->far_allowed) { err = alike(k); }
    for (unsigned i = 0; err == 0 && i < k->images; i++) {
        (void)load(&now, k, i);
        err = exh_params_stage(params, MON_ZERO_ID, (uint16_t)now.c.finger, now.c.mon_zero_raw);
        if (err < 0) { (void)refuse(k, i, scale, err); }
    }
    if (err == 0) { exh_params_apply(params); }
    return err;
}

/* --- tables --- */

/* Straight lines; the monitor's also for negative currents. */
static int lines(struct exh_calib_tables *t, const struct exh_calib_finger *of)
{
    const int32_t peak_A_q26 = of->drive->i_peak_A_q26;
    const int32_t peak_N_q20 = exh_sat32(exh_mul_shr(of->kf_NpA_q20, peak_A_q26, EXH_Q_CUR));
    int err;
    t->to_cur_n = t->to_force_n = 2;
    t->force_to_cur[0] = (struct exh_knot){0, 0, {0, 0}};
    t->force_to_cur[1] = (struct exh_knot){peak_N_q20, peak_A_q26, {0, 0}};
    t->cur_to_force[0] = (struct exh_knot){-peak_A_q26, -peak_N_q20, {0, 0}};
    t->cur_to_force[1] = (struct exh_knot){peak_A_q26, peak_N_q20, {0, 0}};
    err = exh_table_setup(t->force_to_cur, 2);
    return err == 0 ? exh_table_setup(t->cur_to_force, 2) : err;
}

static int measured(
    struct exh_calib_tables *t, struct exh_scene_calib *k, unsigned i, const struct loaded *now)
{
    struct exh_calib_error bad = {0, 0};
    int m, n = exh_calib_force_table(&now->c, t->force_to_cur, EXH_CALIB_POINTS_MAX + 2, &bad);
    if (n < 0) { return refuse(k, i, bad, n); }
    m = exh_calib_monitor_table(&now->c, t->cur_to_force, 2 * EXH_CALIB_POINTS_MAX + 3, &bad);
    if (m < 0) { return refuse(k, i, bad, m); }
    t->to_cur_n = (uint8_t)n;
    t->to_force_n = (uint8_t)m;
    t->vouches = EXH_ARM_CALIBRATION | EXH_ARM_POLARITY;
    return 0;
}

int exh_calib_set_tables(struct exh_calib_tables *t, struct exh_scene_calib *k,
    const struct exh_calib_set_par *par, const struct exh_calib_finger *of)
{
    struct loaded now;
    t->vouches = par->uncalibrated ? EXH_UNCALIBRATED | EXH_UNPOLARISED : 0;
    for (unsigned i = 0; k && i < k->images; i++) {
        struct exh_calib_target h;
        struct exh_calib_error bad = {0, 0};
        int err = load(&now, k, i);
        if (err < 0) { return err; }
        if (now.c.finger != of->f) { continue; }
        h = here(&now.c, par, of->drive);
        err = exh_calib_check(&now.c, &h, &bad);
        if (err < 0) { return refuse(k, i, bad, err); }
        err = par->far_allowed ? 0 : near(k, i, &now, of->kf_NpA_q20, 0);
        return err < 0 ? err : measured(t, k, i, &now);
    }
    return lines(t, of);
}
