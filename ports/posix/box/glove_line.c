/* SPDX-License-Identifier: MIT */
/* A stock glove on a serial line: opened, and what a scene is set to for it. */
#include "box/glove_line.h"

#include "base/option.h"
#include "base/param.h"
#include "box/run.h"
#include "glove_tty.h"

#include "bilateral/bilateral.h"
#include "glove/glove.h"

#include <errno.h>
#include <string.h>

/* The range of this hand is unknown. */
static void nobody(struct exh_glove_cal *cal)
{
    *cal = exh_glove_cal_default;
    for (int i = 0; i < EXH_GLOVE_SENSORS; i++) {
        cal->sensor[i].low_raw = cyberglove_raw(1);
        cal->sensor[i].high_raw = cyberglove_raw(255);
    }
}

int glove_serial_stage(
    const struct exh_scene *sc, const struct exh_glove_cal *cal, double rate_Hz, double glove_Hz)
{
    const double every = (double)(long)(rate_Hz / glove_Hz);
    const struct run_setting own[] = {
        {"every", every < 1      ? 1
                  : every > 1000 ? 1000
                                 : every},
        {"glove_fc", glove_Hz > 66 ? 30 : glove_Hz / 4},
    };
    static struct exh_glove_cal none;
    int err;
    nobody(&none);
    if (cal == NULL) { cal = &none; }
    err = sc == &exh_scene_glove ? glove_stage_cal(cal, NULL) : bilateral_stage_cal(cal, NULL);
    for (size_t i = 0; err == 0 && i < sizeof own / sizeof own[0]; i++) {
        err = cli_param_set(sc->params, own[i].name, own[i].value);
    }
    return err;
}

int glove_serial_open(struct glove_tty *t, const char *option, const char *path, double glove_Hz)
{
    const int err = glove_tty_open(t, path, glove_Hz) < 0 ? errno : 0;
    const char *what = err == ENOENT || err == ENXIO || err == ENODEV
                           ? "is it plugged in? `ls /dev/tty*` lists what there is"
                       : err == EACCES ? "join the group that owns it (`ls -l` says which)"
                       : err == ENOTTY ? "give a serial line, e.g. /dev/ttyUSB0"
                       : err == EBUSY  ? "another program has it"
                                       : "give a serial line that can be opened";
    if (err == 0) { return 0; }
    cli_complain("--%s: %s: %s: %s", option, path,
        err == ENOTTY ? "is no serial line" : strerror(err), what);
    return 3;
}
