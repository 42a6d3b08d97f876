/* SPDX-License-Identifier: MIT */
/* A user's calibration of the glove: the table, and its files. */
#include "glove/result.h"

#include "base/option.h"
#include "base/outfile.h"
#include "box/glove_image.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

/* --- the table --- */

static double zero_code(const struct exh_glove_sensor *s) { return s->zero_raw_q15 / 32768.0; }

static const char *verdict(unsigned what)
{
    return what == EXH_GLOVE_ERRORS ? "ok" : exh_glove_error_text(what);
}

static int32_t noise_of(const struct glove_result *r, unsigned sensor)
{
    int32_t most = 0;
    for (unsigned p = 0; p < r->poses; p++) {
        if (r->pose[p].noise_raw[sensor] > most) { most = r->pose[p].noise_raw[sensor]; }
    }
    return most;
}

static void print_sensor(unsigned i, const struct exh_glove_sensor *s)
{
    printf("%-13s %10.2f %11.6f %7d %7d", exh_glove_sensor_text(i), zero_code(s),
        s->gain_turnpraw_q38 * DEG_OF_GAIN_Q38, s->low_raw, s->high_raw);
}

static void print_cross(const struct exh_glove_cal *cal, uint32_t present)
{
    for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
        const struct exh_glove_sensor *s = &cal->sensor[i];
        for (unsigned k = 0; k < 2; k++) {
            if (s->of[k] == EXH_GLOVE_NONE) { continue; }
            printf("%-13s %+10.4f of %s%s\n", exh_glove_sensor_text(i),
                s->cross_q30[k] / 1073741824.0, exh_glove_sensor_text(s->of[k]),
                present >> i & 1 ? "" : " (not measured)");
        }
    }
}

void glove_cal_print(const struct exh_glove_cal *cal)
{
    printf("\n%-13s %10s %11s %15s\n", "sensor", "zero_code", "deg/code", "span_codes");
    for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
        if (!(cal->present >> i & 1)) { continue; }
        print_sensor(i, &cal->sensor[i]);
        putchar('\n');
    }
    printf("\ncross-coupling, of the other sensor's own angle:\n");
    print_cross(cal, cal->present);
}

void glove_result_print(const struct glove_result *r)
{
    printf("\n%-13s %10s %11s %15s %5s %5s %12s %-9s %s\n", "sensor", "zero_code", "deg/code",
        "span_codes", "noise", "poses", "residual_deg", "in_pose", "verdict");
    for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
        const struct exh_glove_fit *f = &r->fit[i];
        if (!(r->present >> i & 1)) { continue; }
        print_sensor(i, &r->cal.sensor[i]);
        printf(" %5" PRId32 " %5d %12.3f %-9s %s\n", noise_of(r, i), f->poses,
            f->residual_turn_q32 * DEG_OF_TURN_Q32, glove_pose_name(r->which[f->pose]),
            verdict(f->what));
    }
    printf("\ncross-coupling, of the other sensor's own angle:\n");
    print_cross(&r->cal, r->present);
}

/* --- files --- */

static void write_image(FILE *f, const void *ctx)
{
    const struct glove_result *r = ctx;
    (void)fwrite(r->image, 1, sizeof r->image, f);
}

static void write_sensors(FILE *f, const void *ctx)
{
    const struct glove_result *r = ctx;
    fprintf(f, "sensor,present,zero_code,gain_deg_per_code,low_code,high_code,cross_0_of,cross_0,"
               "cross_1_of,"
               "cross_1,noise_codes,poses,residual_deg,residual_pose\n");
    for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
        const struct exh_glove_sensor *s = &r->cal.sensor[i];
        fprintf(f, "%s,%d,%.5f,%.9g,%d,%d", exh_glove_sensor_text(i), (int)(r->present >> i & 1),
            zero_code(s), s->gain_turnpraw_q38 * DEG_OF_GAIN_Q38, s->low_raw, s->high_raw);
        for (unsigned k = 0; k < 2; k++) {
            fprintf(f, ",%s,%.9g",
                s->of[k] == EXH_GLOVE_NONE ? "" : exh_glove_sensor_text(s->of[k]),
                s->cross_q30[k] / 1073741824.0);
        }
        fprintf(f, ",%" PRId32 ",%d,%.6f,%s\n", noise_of(r, i), r->fit[i].poses,
            r->fit[i].residual_turn_q32 * DEG_OF_TURN_Q32,
            glove_pose_name(r->which[r->fit[i].pose]));
    }
}

static void write_poses(FILE *f, const void *ctx)
{
    const struct glove_result *r = ctx;
    glove_poses_csv(f, &r->taken);
}

/* All of them or the first that fails. 0, or 1 after a line on stderr. */
int glove_result_write(const char *dir, struct glove_result *r)
{
    struct exh_glove_error bad;
    if (exh_glove_cal_save(&r->cal, r->image, sizeof r->image, &bad) < 0) {
        cli_complain("%s of %s: nothing was saved: calibrate again", exh_glove_error_text(bad.what),
            exh_glove_sensor_text(bad.at));
        return 1;
    }
    return outfile_write(dir, IMAGE_NAME, write_image, r) ||
           outfile_write(dir, "glove.csv", write_sensors, r) ||
           outfile_write(dir, "poses.csv", write_poses, r);
}
