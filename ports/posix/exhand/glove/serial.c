/* SPDX-License-Identifier: MIT */
/* exhand glove --serial: the sensing scene on a stock glove at a serial line. */
#include "glove/modes.h"

#include "base/until.h"

#include "box/glove_image.h"
#include "glove/poses.h"
#include "glove_tty.h"
#include "base/option.h"
#include "base/outfile.h"
#include "base/outlog.h"
#include "base/param.h"

#include "exhand/run/log.h"
#include "exhand/run/loop.h"

#include "exhand/error.h"

#include <stdio.h>
#include <string.h>

#define SENSORS  EXH_GLOVE_SENSORS
#define SILENT_S 1.0
#define NEVER_S  3.0 /* without a frame since the start: something is wrong */

static struct {
    const struct glove_options *o;
    struct glove_tty tty;
    double rate_Hz;
    uint32_t last_tick;
    uint64_t missed;
    int heard, silent, never;
} run;

/* Options given have priority over it. */
static int stage(const struct glove_options *o)
{
    static struct exh_glove_cal cal;
    int err = o->calibration ? glove_image_read(&cal, "calibration", o->calibration) : 0;
    if (err) { return err; }
    err = glove_serial_stage(
        &exh_scene_glove, o->calibration ? &cal : NULL, run.rate_Hz, run.tty.rate_Hz);
    for (int i = 0; err == 0 && i < o->settings; i++) {
        err = cli_param_set(exh_scene_glove.params, o->setting[i].name, o->setting[i].value);
    }
    return err < 0 ? 2 : 0;
}

/* --- while it runs --- */

static const char *path(void) { return run.tty.path; }

/* No frame since the start: prints the reason, as far as the received bytes show it. */
static void complain_never(void)
{
    const struct cyberglove *g = &run.tty.in;
    if (run.tty.bytes == 0) {
        cli_complain("--serial: %s: silent for %g s: is the glove's unit on, and is this its line "
                     "(115200 baud)?",
            path(), NEVER_S);
    } else if (g->lost[CYBERGLOVE_EIGHTEEN] >
               g->lost[CYBERGLOVE_ZERO] + g->lost[CYBERGLOVE_LENGTH]) {
        cli_complain(
            "--serial: %s: frames of 18 samples: this is the glove of 18 sensors (22 wanted)",
            path());
    } else if (g->lost[CYBERGLOVE_UNPLUGGED] > 0) {
        cli_complain("--serial: %s: its unit says that no glove is plugged into it", path());
    } else {
        cli_complain("--serial: %s: %lu bytes and no whole frame: is it a glove of 22 sensors with "
                     "8-bit samples, without time stamp, at "
                     "115200 baud?",
            path(), (unsigned long)run.tty.bytes);
    }
}

static void watch_silence(double age_s)
{
    const int silent = age_s >= SILENT_S;
    run.heard |= !silent; /* the scene has its first frame a tick after the line */
    if (silent == run.silent || !run.heard) { return; }
    run.silent = silent;
    cli_complain("--serial: %s: %s", path(),
        !silent          ? "frames again"
        : run.tty.fd < 0 ? "was unplugged: waits for it"
                         : "silent: asks again");
}

static void before(uint32_t tick, struct exh_scene_in *in)
{
    run.missed += in->missed;
    if (run.o->record) { exh_log_before(tick, in); }
}

static void after(uint32_t tick, const struct exh_scene_in *in, const struct exh_drive_out *out)
{
    const double t_s = posix_time_s();
    run.last_tick = tick;
    if (run.o->record) { exh_log_after(tick, in, out); }
    if (run.o->pose && in->glove_new) {
        glove_poses_row(stdout, run.o->pose, in->glove.raw);
    } else if (!run.o->record && in->glove_new) {
        glove_line(
            run.o, t_s, (const struct glove_signals *)exh_scene_signals(&exh_scene_glove), NULL);
    }
    watch_silence(in->glove.age_ticks / run.rate_Hz);
    if (run.tty.in.frames == 0 && t_s >= NEVER_S) {
        run.never = 1;
        posix_stop();
    }
}

static void started(const struct exh_scene *sc, struct exh_scene_board board)
{
    if (run.o->record) {
        exh_log_start(sc, board);
    } else if (!run.o->pose) {
        glove_header(run.o, 0);
    }
}

static void summary(FILE *to)
{
    const struct cyberglove *g = &run.tty.in;
    fprintf(to, "%s: %lu frames at %.6g Hz, discarded:", path(), (unsigned long)g->frames,
        run.tty.rate_Hz);
    for (unsigned i = 0; i < CYBERGLOVE_CAUSES; i++) {
        fprintf(to, " %s %lu,", cyberglove_cause_text(i), (unsigned long)g->lost[i]);
    }
    fprintf(to,
        " stray bytes %lu, refused commands %lu, told to stream %lu times, gone %lu times; "
        "missed ticks %llu\n",
        (unsigned long)g->strays, (unsigned long)g->errors, (unsigned long)run.tty.told,
        (unsigned long)run.tty.gone, (unsigned long long)run.missed);
}

/* --- the whole --- */

static int go(const struct glove_options *o, FILE *log)
{
    static const struct exh_loop_hooks hooks = {started, before, after};
    struct posix_config c = posix_config_default();
    int err;
    c.glove = c.bench = c.pace = 1;
    c.glove_tty = &run.tty;
    c.T = glove_period(run.rate_Hz);
    c.log = log;
    c.max_ticks = o->seconds > 0 ? (uint32_t)(o->seconds * run.rate_Hz + 1) : 0;
    posix_configure(&c);
    setvbuf(stdout, NULL, _IOLBF, BUFSIZ); /* a reader gets each row immediately */
    until_catch(UNTIL_RESTARTS);
    err = exh_loop(&exh_scene_glove, 0, &hooks);
    if (err < 0) {
        cli_complain("%.6g Hz, the glove at %.6g Hz: %s: see --rate, --glove-rate and --set",
            run.rate_Hz, run.tty.rate_Hz, exh_error_text(err));
        return 2;
    }
    if (log && exh_log_end(run.last_tick + 1) != 0) { err = 1; }
    return err;
}

int glove_serial(const struct glove_options *o)
{
    FILE *log = NULL;
    int err;
    memset(&run, 0, sizeof run);
    run.o = o;
    run.rate_Hz = o->rate_Hz;
    if (o->pose && glove_pose_find(o->pose) < 0) {
        cli_complain(
            "--pose: %s: no such pose: `exhand calibrate --glove --list` lists them", o->pose);
        return 2;
    }
    err = glove_serial_open(&run.tty, "serial", o->serial, o->glove_Hz);
    if (err) { return err; }
    err = stage(o);
    if (err == 0 && o->record && (log = outfile_open("record", o->record)) == NULL) { err = 2; }
    if (err == 0) { err = go(o, log); }
    glove_tty_close(&run.tty);
    if (err == 2) {
        outfile_abandon(log);
    } else if (log && outlog_close(log) != 0) {
        err = 1;
    }
    if (err == 0 && run.never) {
        complain_never();
        err = 3;
    }
    if (run.last_tick > 0) { summary(o->record ? stdout : stderr); }
    return err ? err : posix_interrupted() ? 130 : 0;
}
