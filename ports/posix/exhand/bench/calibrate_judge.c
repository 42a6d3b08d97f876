/* SPDX-License-Identifier: MIT */
/* exhand calibrate: is what was weighed a calibration? */
#include "bench/calibrate.h"

#include "base/option.h"

#include "exhand/error.h"

#include <math.h>
#include <string.h>

static double si(int32_t raw) { return (double)raw / (1 << EXH_Q_FORCE); }

int calibrate_complain(const char *what, int err, const struct exh_calib_error *bad)
{
    char point[24] = "";
    if (bad->what == EXH_CALIB_FORCE_TABLE || bad->what == EXH_CALIB_MONITOR_TABLE) {
        snprintf(point, sizeof point, ", point %d", bad->at + 1);
    }
    cli_complain("%s: %s%s: %s: calibrate again", what, exh_calib_error_text(bad->what), point,
        exh_error_text(err));
    return 1;
}

int calibrate_far(const char *what, const struct exh_calib *c, double kf_NpA, const char *whose,
    const char *advice)
{
    struct exh_calib_error bad = {0, 0};
    const int err = exh_calib_near(c, (int32_t)(kf_NpA * (1 << EXH_Q_FORCE) + 0.5), &bad);
    if (err == 0) { return 0; }
    cli_complain(
        "%s: finger %lu, %s, point %d: %.4g N/A (allowed %.4g..%.4g, half to 3/2 of %s): %s", what,
        (unsigned long)c->finger, exh_calib_error_text(bad.what), bad.at + 1,
        si(exh_calib_ratio_NpA_q20(&c->point[bad.at],
            bad.what == EXH_CALIB_FAR_MONITOR ? EXH_CALIB_MONITOR : EXH_CALIB_CURRENT)),
        kf_NpA / 2, 1.5 * kf_NpA, whose, advice);
    return 1;
}

/* --- masses against each other --- */

/* What is left without point `out`: the worst residual of either line, and what the line of
 * currents makes of that point, N. 0 or -EXH_E…. */
static int without(const struct exh_calib *c, int out, double *worst_N, double *seems_N)
{
    struct exh_calib_point point[EXH_CALIB_POINTS_MAX], odd = c->point[out];
    struct exh_calib rest = *c;
    struct calibration_lines l;
    int err;
    rest.point = point;
    rest.points = 0;
    for (int i = 0; i < c->points; i++) {
        if (i != out) { point[rest.points++] = c->point[i]; }
    }
    err = calibration_lines(&rest, &l);
    if (err < 0) { return err; }
    *worst_N = fmax(l.cur_worst_N, l.mon_worst_N);
    *seems_N = si(odd.force_N_q20) - si(exh_calib_residual_N_q20(&l.cur, &odd, EXH_CALIB_CURRENT));
    return 0;
}

/* If masses do not lie on one line, finds the one without which the others fit. With two masses
 * this is impossible. */
static void say_odd(const struct calibrate_options *o, const struct calibration *r, double off_N)
{
    double least_N = off_N, seems_N = 0;
    int odd = -1;
    for (int i = 0; r->c.points > 2 && i < r->c.points; i++) {
        double worst_N, force_N;
        if (without(&r->c, i, &worst_N, &force_N) < 0 || worst_N >= least_N) { continue; }
        odd = i;
        least_N = worst_N;
        seems_N = force_N;
    }
    if (odd < 0 || least_N > o->residual_N) {
        cli_complain("residual: %.4g N (allowed 0..%.4g), and no one mass is the cause: weigh all "
                     "again, or --residual",
            off_N, o->residual_N);
        return;
    }
    cli_complain("mass %.4g kg: residual: %.4g N from the line of the others (allowed 0..%.4g): it "
                 "hangs as %.3g kg would: correct --mass, weigh it again, or --residual",
        o->mass_kg[odd], fabs(si(r->c.point[odd].force_N_q20) - seems_N), o->residual_N,
        o->mass_kg[odd] * seems_N / si(r->c.point[odd].force_N_q20));
}

/* --- against what is known --- */

/* The image that --out would replace, where it is this finger's: a motor's constant does not
 * change by half. Any other file there says nothing. */
static int far_from_last(const struct calibrate_options *o, const struct exh_calib *c)
{
    struct exh_calib_point point[EXH_CALIB_POINTS_MAX];
    struct exh_calib last = {.point = point, .cap = EXH_CALIB_POINTS_MAX};
    struct calibration_lines l;
    uint8_t image[EXH_CALIB_IMAGE_B];
    char path[4096], whose[64];
    size_t n;
    FILE *f;
    if (o->out == NULL ||
        snprintf(path, sizeof path, "%s/calibration.bin", o->out) >= (int)sizeof path) {
        return 0;
    }
    f = fopen(path, "rb");
    if (f == NULL) { return 0; }
    n = fread(image, 1, sizeof image, f);
    fclose(f);
    if (exh_calib_load(&last, image, n, NULL) < 0 || last.device_id != c->device_id ||
        last.finger != c->finger || calibration_lines(&last, &l) < 0) {
        return 0;
    }
    snprintf(whose, sizeof whose, "%.4g, the last one's, of day %lu", si(l.cur.kf_NpA_q20),
        (unsigned long)last.day);
    return calibrate_far(path, c, si(l.cur.kf_NpA_q20), whose,
        "nothing was saved: weigh again, or move that file away if the motor is another one");
}

static int judge_table(const struct calibrate_options *o, const struct calibration *r)
{
    struct exh_calib_error bad;
    int err;
    if (r->c.points != o->masses) {
        cli_complain("%d of %d masses were weighed: calibrate again", r->c.points, o->masses);
        return 1;
    }
    err = exh_calib_validate(&r->c, &bad);
    return err < 0 ? calibrate_complain("calibrate", err, &bad) : 0;
}

int calibrate_judge(
    const struct calibrate_options *o, const struct calibration *r, struct calibration_lines *l)
{
    char whose[32];
    double off_N;
    if (judge_table(o, r) != 0) { return 1; }
    if (calibration_lines(&r->c, l) < 0) {
        cli_complain("no line through these points: calibrate again");
        return 1;
    }
    calibration_print(stdout, &r->c, l);
    fflush(stdout);
    off_N = fmax(l->cur_worst_N, l->mon_worst_N);
    if (off_N > o->residual_N) {
        say_odd(o, r, off_N);
        return 1;
    }
    snprintf(whose, sizeof whose, "kf %.4g", o->device.kf_npa);
    return calibrate_far("calibrate", &r->c, o->device.kf_npa, whose,
               "are --mass in kg? Else weigh again, or give --device kf=") ||
           far_from_last(o, &r->c);
}
