/* SPDX-License-Identifier: MIT */
#include "box/images.h"

#include "base/option.h"
#include "base/outfile.h"
#include "base/param.h"

#include "exhand/calibrate.h"
#include "exhand/error.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

#define DAY_S    86400
#define EXPECTED "calibration.bin that `exhand calibrate --out` wrote"

static int add(struct images *im, const char *path)
{
    long len;
    if (im->n == EXH_FINGERS || strlen(path) >= sizeof im->at[0].path) {
        cli_complain("--calibration: %s: %s", path,
            im->n == EXH_FINGERS ? "more than one a finger (5): leave some out"
                                 : "too long a name");
        return 2;
    }
    len = outfile_read("calibration", path, EXPECTED, im->at[im->n].byte, sizeof im->at[0].byte);
    if (len < 0) { return (int)-len; }
    strcpy(im->at[im->n].path, path);
    im->at[im->n++].len_B = (uint32_t)len;
    return 0;
}

static int is_image(const struct dirent *e)
{
    const size_t n = strlen(e->d_name);
    return n > 4 && strcmp(e->d_name + n - 4, ".bin") == 0;
}

/* In the order of their names, so that a log's bytes don't depend on the file system. */
static int add_all(struct images *im, const char *dir)
{
    struct dirent **name;
    const int n = scandir(dir, &name, is_image, alphasort);
    int err = 0;
    for (int i = 0; i < n; i++) {
        char path[sizeof im->at[0].path];
        if (err == 0 &&
            snprintf(path, sizeof path, "%s/%s", dir, name[i]->d_name) < (int)sizeof path) {
            err = add(im, path);
        }
        free(name[i]);
    }
    if (n >= 0) { free(name); }
    if (n <= 0) {
        cli_complain("--calibration: %s: no *.bin in it: give the " EXPECTED, dir);
        return 2;
    }
    return err;
}

int images_take(void *ctx, const char *text)
{
    struct images *im = ctx;
    struct stat is;
    im->n = 0;
    if (stat(text, &is) == 0 && S_ISDIR(is.st_mode)) { return add_all(im, text); }
    for (const char *at = text;;) {
        char path[sizeof im->at[0].path];
        const size_t n = strcspn(at, ",");
        int err;
        snprintf(path, sizeof path, "%.*s", (int)n, at);
        err = add(im, path);
        if (err || at[n] == '\0') { return err; }
        at += n + 1;
    }
}

int images_give(const struct images *im, const struct exh_scene *sc)
{
    struct exh_scene_calib *k = sc->calib;
    int err;
    if (k == NULL) { return 0; }
    k->images = im ? (uint8_t)im->n : 0;
    if (k->images == 0) { return cli_param_set(sc->params, "uncalibrated", 1); }
    for (int i = 0; i < im->n; i++) {
        k->image[i].byte = im->at[i].byte;
        k->image[i].len_B = im->at[i].len_B;
    }
    err = cli_param_set(sc->params, "device_id", 1);
    if (err == 0) { err = cli_param_set(sc->params, "uncalibrated", 0); }
    if (err == 0) { err = cli_param_set(sc->params, "far_calibration", 0); }
    return err < 0 ? err : cli_param_set(sc->params, "day", (double)(time(NULL) / DAY_S));
}

/* What the image says of itself, if it can be read at all. */
static void say_whose(const struct images *im, const struct exh_scene *sc, int i)
{
    struct exh_calib_point point[EXH_CALIB_POINTS_MAX];
    struct exh_calib c = {.point = point, .cap = EXH_CALIB_POINTS_MAX};
    uint32_t id = 0, day = 0;
    (void)cli_signal_find(sc->params->table, "device_id", &id);
    (void)cli_signal_find(sc->params->table, "day", &day);
    if (exh_calib_load(&c, im->at[i].byte, im->at[i].len_B, NULL) < 0) { return; }
    cli_complain("%s: made for device %lu, finger %lu, on day %lu, good for %lu days; here is "
                 "device_id %ld, day %ld",
        im->at[i].path, (unsigned long)c.device_id, (unsigned long)c.finger, (unsigned long)c.day,
        (unsigned long)c.valid_days, (long)sc->params->active[id], (long)sc->params->active[day]);
}

/* Reports an implausible ratio of force and current. */
static void say_far(const struct images *im, const struct exh_scene_calib *k)
{
    const double scale = 1 << EXH_Q_FORCE;
    const double expected = k->expected_NpA_q20 / scale;
    cli_complain(
        "--calibration: %s: finger %u, %s, point %u: %.4g N/A (allowed %.4g..%.4g, half to "
        "3/2 of %.4g): calibrate again, or correct kf; --set far_calibration=1 believes it",
        im->at[k->image_at].path, (unsigned)k->finger, k->what, k->point_at + 1u,
        k->ratio_NpA_q20 / scale, expected / 2, 1.5 * expected, expected);
}

int images_complain(const struct images *im, const struct exh_scene *sc)
{
    const struct exh_scene_calib *k = sc->calib;
    char point[24] = "";
    if (im == NULL || k == NULL || k->refused == 0 || k->image_at >= im->n) { return 0; }
    if (k->expected_NpA_q20) {
        say_far(im, k);
        return 1;
    }
    if (k->point_at) { snprintf(point, sizeof point, ", point %d", k->point_at + 1); }
    cli_complain("--calibration: %s: %s%s: %s: nothing was started", im->at[k->image_at].path,
        k->what, point, exh_error_text(k->refused));
    say_whose(im, sc, k->image_at);
    return 1;
}
