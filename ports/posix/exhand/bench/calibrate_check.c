/* SPDX-License-Identifier: MIT */
/* exhand calibrate --check: whether an image may be used on this device today. */
#include "bench/calibrate.h"

#include "base/option.h"
#include "base/outfile.h"
#include "base/param.h"

#include "calibrate/calibrate.h"

#include "exhand/error.h"

#include <inttypes.h>
#include <string.h>

/* what is written into the files */
/* The device, the day, and the scales as they are now. The user of an image copies the monitor's
 * zero from it, so here it is the image's. */
static struct exh_calib_target here_and_now(
    const struct calibrate_options *o, const struct exh_calib *c)
{
    struct exh_calib_target here = {
        (uint32_t)o->id, (uint32_t)o->finger, (uint32_t)o->day, 0, 0, 0, c->mon_zero_raw};
    struct exh_params *p = exh_scene_calibrate.params;
    uint32_t at;
    exh_scene_calibrate.defaults();
    (void)cli_param_set(p, "dac_scale", o->device.dac_perA);
    (void)cli_param_set(p, "dac_zero", o->device.dac_zero);
    (void)cli_param_set(p, "mon_scale", o->device.mon_apc);
    if (cli_signal_find(p->table, "dac_scale", &at)) { here.dac_rawpA_q16 = p->staged[at]; }
    if (cli_signal_find(p->table, "dac_zero", &at)) { here.dac_zero_raw = p->staged[at]; }
    if (cli_signal_find(p->table, "mon_scale", &at)) { here.mon_A_q40 = p->staged[at]; }
    return here;
}

/* A sound image that may not be used: what it was made for, and what is here. */
static int not_here(const struct calibrate_options *o, const struct exh_calib *c, int err,
    const struct exh_calib_error *bad)
{
    if (bad->what == EXH_CALIB_DEVICE) {
        cli_complain("%s: made for device %lu, this is %" PRId64
                     ": give its --id, or calibrate this one",
            o->check, (unsigned long)c->device_id, o->id);
    } else if (bad->what == EXH_CALIB_FINGER) {
        cli_complain("%s: made for finger %lu, this is %" PRId64
                     ": give its --finger, or calibrate this one",
            o->check, (unsigned long)c->finger, o->finger);
    } else if (bad->what == EXH_CALIB_AGE && (uint32_t)o->day < c->day) {
        cli_complain("%s: from the future: made on day %lu, today is day %" PRId64
                     ": set the clock right, or "
                     "give --day",
            o->check, (unsigned long)c->day, o->day);
    } else if (bad->what == EXH_CALIB_AGE) {
        cli_complain("%s: stale: made on day %lu, good for %lu days, today is day %" PRId64
                     ": calibrate again",
            o->check, (unsigned long)c->day, (unsigned long)c->valid_days, o->day);
    } else {
        return calibrate_complain(o->check, err, bad);
    }
    return 1;
}

int calibrate_check(const struct calibrate_options *o)
{
    struct exh_calib_point point[EXH_CALIB_POINTS_MAX];
    struct exh_calib c = {.point = point, .cap = EXH_CALIB_POINTS_MAX};
    struct exh_calib_target here;
    struct calibration_lines l;
    struct exh_calib_error bad = {0, 0};
    char whose[32];
    uint8_t image[EXH_CALIB_IMAGE_B];
    const long len = outfile_read("check", o->check,
        "calibration.bin that `exhand calibrate --out` wrote", image, sizeof image);
    int err;
    if (len < 0) { return (int)-len; }
    err = exh_calib_load(&c, image, (size_t)len, &bad);
    if (err < 0) { return calibrate_complain(o->check, err, &bad); }
    printf("%s: device %lu, finger %lu, made on day %lu, good for %lu days; today is day %" PRId64
           "\n",
        o->check, (unsigned long)c.device_id, (unsigned long)c.finger, (unsigned long)c.day,
        (unsigned long)c.valid_days, o->day);
    fflush(stdout);
    here = here_and_now(o, &c);
    err = exh_calib_check(&c, &here, &bad);
    if (err < 0) { return not_here(o, &c, err, &bad); }
    if (calibration_lines(&c, &l) < 0) {
        cli_complain("%s: no line through its points: calibrate again", o->check);
        return 1;
    }
    calibration_print(stdout, &c, &l);
    fflush(stdout);
    snprintf(whose, sizeof whose, "kf %.4g", o->device.kf_npa);
    return calibrate_far(o->check, &c, o->device.kf_npa, whose,
        "calibrate again, or give --device kf= of this motor");
}
