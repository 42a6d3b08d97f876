/* SPDX-License-Identifier: MIT */
/* exhand glove --record: the sensing scene on the simulated glove, logged. */
#include "glove/modes.h"

#include "base/until.h"

#include "base/option.h"
#include "base/outfile.h"
#include "base/outlog.h"
#include "base/param.h"
#include "box/hand_options.h"

#include "exhand/run/log.h"
#include "exhand/run/loop.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static uint32_t last_tick;
static long frames;

static void after(uint32_t tick, const struct exh_scene_in *in, const struct exh_drive_out *out)
{
    exh_log_after(tick, in, out);
    last_tick = tick;
    frames += in->glove_new;
}

static int find_motion(const struct glove_options *o, struct sim_operator_par *hand)
{
    static const char *const does[] = {"rest", "poses", "grasp", "wave"};
    *hand = sim_operator_default();
    hand->pose = o->pose ? sim_pose_find(o->pose) : 0;
    for (int i = 0; i < 4; i++) {
        if (o->does == NULL || strcmp(o->does, does[i]) == 0) {
            hand->does = (enum sim_operator_does)i;
            if (hand->pose >= 0) { return 0; }
        }
    }
    if (hand->pose < 0) { return hand_bad_pose(o->pose); }
    cli_complain("--does: %.60s: a hand can rest, poses, grasp or wave", o->does);
    return 2;
}

static int complain_loop(const struct glove_options *o, int err)
{
    if (err < 0) { cli_setup_complain(exh_scene_glove.params, o->rate_Hz, err); }
    return err < 0 ? 2 : 0;
}

/* One tick without a log: what is refused has touched no log that was there. */
static int try_once(const struct glove_options *o, struct posix_config c)
{
    c.max_ticks = 1;
    posix_configure(&c);
    return complain_loop(o, exh_loop(&exh_scene_glove, 0, NULL));
}

static int run_logged(const struct glove_options *o, const struct posix_config *c)
{
    static const struct exh_loop_hooks hooks = {exh_log_start, exh_log_before, after};
    const long every = *exh_scene_glove.glove_every;
    int err;
    posix_configure(c);
    last_tick = 0;
    frames = 0;
    err = exh_loop(&exh_scene_glove, 0, &hooks);
    if (err < 0) { return complain_loop(o, err); }
    /* As set up, the filter has another cut-off. */
    if (!posix_interrupted() && frames * (int64_t)every <= (int64_t)last_tick - last_tick / 4) {
        cli_complain(
            "%ld frames in %lu ticks: a scan takes longer than %ld: --set every=... says more",
            frames, last_tick + 1ul, every);
    }
    return exh_log_end(last_tick + 1) == 0 ? 0 : 1;
}

/* As long as was said, or as what is played; one tick at least, since none were no end. */
static uint32_t ticks_of(const struct glove_options *o, const struct posix_config *c)
{
    const double every = *exh_scene_glove.glove_every;
    const double plays = c->frames > 0      ? (double)c->frames * every / o->rate_Hz
                         : c->hand.rows > 0 ? (double)c->hand.rows / c->hand.row_hz
                                            : 10;
    const double seconds = o->seconds > 0 ? o->seconds : plays;
    const double ticks = seconds * o->rate_Hz + 0.5;
    return ticks < 1 ? 1 : ticks > UINT32_MAX ? UINT32_MAX : (uint32_t)ticks;
}

/* The rows of --play: codes as frames, a scan each; angles through the analog chain. */
static int play(const struct glove_options *o, struct posix_config *c, struct glove_frames *f,
    struct recording *r)
{
    const struct recording_ask ask = glove_asked(o);
    int err = recording_read(r, o->play, &ask);
    if (err) { return err; }
    if (r->codes && r->t_s != NULL) {
        cli_complain("--play: codes come a row a scan: leave their time out of --columns");
        return 2;
    }
    if (r->codes) {
        err = glove_frames_from(f, o, r, o->play);
        c->frame = (const int16_t(*)[SIM_GLOVE_SENSORS])f->raw;
        c->frames = f->n;
    } else {
        recording_hold(r);
        c->hand.does = SIM_RECORD;
        c->hand.row_rad = (const double(*)[SIM_GLOVE_SENSORS])r->row;
        c->hand.rows = r->rows;
        c->hand.row_hz = r->t_s != NULL && r->rows > 1 ? recording_row_hz(r) : o->rate_Hz;
    }
    return err;
}

int glove_record(const struct glove_options *o)
{
    struct posix_config c = posix_config_default();
    struct glove_frames f = {NULL, 0, {0, 0}, NULL, NULL};
    struct recording r = {NULL, NULL, NULL, 0, 0};
    int err = find_motion(o, &c.hand);
    if (err == 0 && o->play) { err = play(o, &c, &f, &r); }
    c.device = o->device;
    c.glove_par = o->chain;
    c.seed = (uint64_t)o->seed;
    c.cards.how = o->cards ? POSIX_CARDS_INSTANT : POSIX_CARDS_NONE;
    c.bench = c.glove = 1;
    c.T = glove_period(o->rate_Hz);
    if (err == 0) { err = try_once(o, c); }
    c.max_ticks = ticks_of(o, &c);
    if (err == 0 && (c.log = outfile_open("record", o->record)) == NULL) { err = 2; }
    if (err == 0) {
        until_catch(UNTIL_RESTARTS);
        err = run_logged(o, &c);
        if (err == 2) {
            outfile_abandon(c.log);
        } else if (outlog_close(c.log) != 0) {
            err = 1;
        }
    }
    glove_frames_free(&f);
    recording_free(&r);
    return err ? err : posix_interrupted() ? 130 : 0;
}
