/* SPDX-License-Identifier: MIT */
#include "box/glove_image.h"

#include "base/option.h"
#include "base/outfile.h"

#include "exhand/error.h"

#define IMAGE_B (EXH_GLOVE_CAL_IMAGE_B + 1)

int glove_image_read(struct exh_glove_cal *cal, const char *option, const char *path)
{
    struct exh_glove_error bad = {0, 0};
    uint8_t image[IMAGE_B];
    const long len = outfile_read(option, path, IMAGE_WANTED, image, sizeof image);
    int err;
    if (len < 0) { return (int)-len; }
    err = exh_glove_cal_load(cal, image, (size_t)len, &bad);
    if (err == -EXH_E_RANGE) {
        cli_complain("--%s: %s: %s of %s: outside its range: calibrate again", option, path,
            exh_glove_error_text(bad.what), exh_glove_sensor_text(bad.at));
    } else if (err < 0) {
        cli_complain("--%s: %s: %s: give the " IMAGE_WANTED, option, path, exh_error_text(err));
    }
    return err < 0 ? 2 : 0;
}
