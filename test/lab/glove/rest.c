/* SPDX-License-Identifier: MIT */
/* Where exhand-lab glove --selftest gets hand and motor at rest from. */
#include "lab/glove/glove.h"

#include "base/logfile.h"

#include "base/until.h"
#include "base/option.h"
#include "base/param.h"

#include "exhand/run/log.h"
#include "exhand/run/loop.h"

#include "exhand/board.h"
#include "exhand/error.h"

#include <stdlib.h>
#include <string.h>

/* Of normal noise that ends at 3 deviations, a hundred show 5 of the 6 between its ends. */
#define FRAMES_MIN 100

static struct glove_rest *taking; /* of the loop's hook */

static void start(const struct exh_scene *sc, struct exh_scene_board board)
{
    (void)sc;
    taking->frames.T = board.T;
}

/* What the frames' rate turned out to be: the scene may ask every so many ticks only, and a scan
 * may be longer than that. */
static int settle_rate(struct glove_rest *r)
{
    const long n = r->frames.n;
    if (n < FRAMES_MIN) {
        cli_complain(
            "%ld frames: too few to measure noise by (%d): give more --seconds", n, FRAMES_MIN);
        return 2;
    }
    r->frames.T.num *= (uint32_t)((r->ticks + n / 2) / n);
    return 0;
}

static void after(uint32_t tick, const struct exh_scene_in *in, const struct exh_drive_out *out)
{
    struct glove_rest *r = taking;
    (void)tick;
    (void)out;
    if (r->ticks == r->cap) {
        posix_stop();
        return;
    }
    r->enc[r->ticks] = in->drive.enc_raw[0];
    r->mon[r->ticks++] = in->drive.mon_raw[0];
    if (in->glove_new) {
        memcpy(r->frames.raw[r->frames.n++], in->glove.raw, sizeof in->glove.raw);
    }
}

static int make_room(struct glove_rest *r, long n)
{
    r->cap = n;
    r->frames.raw = malloc((size_t)n * sizeof *r->frames.raw);
    r->enc = malloc((size_t)n * sizeof *r->enc);
    r->mon = malloc((size_t)n * sizeof *r->mon);
    if (r->frames.raw && r->enc && r->mon) { return 0; }
    cli_complain("out of memory: fewer --seconds");
    return 1;
}

/* What the board gives, hand and motor at rest. */
int glove_rest_board(struct glove_rest *r, const struct glove_options *o)
{
    static const struct exh_loop_hooks hooks = {start, NULL, after};
    const double rate_Hz = o->rate_Hz > 0 ? o->rate_Hz : exh_scene_glove.rate_Hz;
    struct posix_config c = posix_config_default();
    const double seconds = o->seconds > 0 ? o->seconds : 10;
    int err = make_room(r, (long)(seconds * rate_Hz) + 1);
    if (err) { return err; }
    c.device = o->device;
    c.glove_par = o->chain;
    c.seed = (uint64_t)o->seed;
    c.cards.how = o->cards ? POSIX_CARDS_INSTANT : POSIX_CARDS_NONE;
    c.bench = c.glove = 1;
    c.enc_jitter_cnt = 1;
    c.T = glove_period(rate_Hz);
    c.max_ticks = r->cap > 1 ? (uint32_t)r->cap - 1 : 1; /* 0 were no end */
    posix_configure(&c);
    taking = r;
    until_catch(UNTIL_RESTARTS);
    err = exh_loop(&exh_scene_glove, 0, &hooks);
    if (err < 0) {
        cli_setup_complain(exh_scene_glove.params, rate_Hz, err);
        return err == -EXH_E_ABSENT ? 3 : 2;
    }
    return posix_interrupted() ? 130 : settle_rate(r);
}

/* A tick with a new glove frame; 0 at the end. */
static int next_glove(struct logfile *l, struct exh_scene_in *in)
{
    struct exh_record rec;
    struct exh_drive_out out;
    while (logfile_next(l, &rec)) {
        struct exh_bytes c = exh_bytes_reader(rec.payload, rec.len_B);
        if (rec.type != EXH_RECORD_FRAME) { continue; }
        memset(in, 0, sizeof *in);
        exh_log_frame_serialize(&c, l->scene, in, &out, l->scene->values);
        if (exh_bytes_ok(&c) && c.at == rec.len_B && in->glove_new) { return 1; }
    }
    return 0;
}

/* The glove frames of a log. */
int glove_rest_log(struct glove_rest *r, const char *path)
{
    struct logfile l;
    struct exh_scene_in in;
    int err = logfile_open(&l, path);
    if (err == 0 && l.scene->read_glove == NULL) {
        cli_complain("%s: made by scene %s, which reads no glove", path, l.scene->name);
        err = 2;
    }
    r->frames.T = l.header.T;
    if (err == 0) {
        while (next_glove(&l, &in)) { r->cap++; }
        logfile_rewind(&l);
        r->frames.raw = malloc((size_t)(r->cap + 1) * sizeof *r->frames.raw);
        err = r->frames.raw == NULL;
    }
    while (err == 0 && next_glove(&l, &in)) {
        memcpy(r->frames.raw[r->frames.n++], in.glove.raw, sizeof in.glove.raw);
    }
    if (err == 0) { err = logfile_complain(&l); }
    logfile_close(&l);
    return err;
}

int glove_rest_csv(struct glove_rest *r, const struct glove_options *o)
{
    return glove_frames_of(&r->frames, o, o->csv);
}

/* --from and --to of a recording. */
int glove_rest_cut(struct glove_frames *f, const struct rest_options *o)
{
    const double T_s = (double)f->T.num / f->T.den;
    const long from = (long)(o->from_s / T_s + 0.5);
    long to = o->to_s > 0 ? (long)(o->to_s / T_s + 0.5) : f->n;
    if (to > f->n) { to = f->n; }
    if (from >= to) {
        cli_complain("--from, --to: %.6g..%.6g s: nothing is recorded there: it ends at %.6g s",
            o->from_s, o->to_s, (double)f->n * T_s);
        return 2;
    }
    f->n = to - from;
    memmove(f->raw, f->raw + from, (size_t)f->n * sizeof *f->raw);
    return 0;
}
