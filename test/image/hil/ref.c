/* SPDX-License-Identifier: MIT */
#include "ref.h"

#include "base/param.h"
#include "exhand/run/deadman.h"
#include "exhand/run/loop.h"

#include "exhand/board.h"

#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

struct ref {
    const struct ref_cfg *cfg;
    FILE *from;
    pid_t child;
};

static struct {
    const struct ref_cfg *cfg;
    FILE *to;
    struct ref_tick frame;
    unsigned signals;
} run; /* in the child */

int ref_held(const struct ref_cfg *c, uint64_t tick)
{
    const struct exh_period T = c->board.T;
    return (double)tick * (double)T.num / (double)T.den >= c->held_s;
}

/* --- parameters --- */

int ref_parameters(const struct ref_cfg *c)
{
    int err = 0;
    c->scene->defaults();
    if (c->prepare) { err = c->prepare(); }
    for (int i = 0; err == 0 && i < c->settings; i++) {
        err = cli_param_set(c->scene->params, c->setting[i].name, c->setting[i].value);
    }
    return err;
}

void ref_options(const struct ref_cfg *c, char *text, size_t cap_B)
{
    size_t n = strlen(text);
    if (ref_parameters(c) < 0) { return; }
    for (int i = 0; i < c->settings && n < cap_B; i++) {
        uint32_t index;
        const struct exh_signal *row =
            cli_signal_find(c->scene->params->table, c->setting[i].name, &index);
        const double value = cli_signal_value(row, c->scene->params->staged[index]);
        n += (size_t)snprintf(text + n, cap_B - n, " %s=%.15g", c->setting[i].name, value);
    }
}

/* --- in the child --- */

static void start(const struct exh_scene *sc, struct exh_scene_board board)
{
    exh_deadman_start(sc, board);
    run.signals = sc->signals ? exh_signal_count(sc->signals) : 0;
}

/* The cards convert while a tick computes, and hand over what the tick before began; the first
 * what the opening began, when nothing was at the monitors yet. */
static void delay_monitor(struct exh_drive_in *in)
{
    static struct exh_drive_in last;
    const struct exh_drive_in now = *in;
    memcpy(in->mon_raw, last.mon_raw, sizeof in->mon_raw);
    in->supply_raw = last.supply_raw;
    last = now;
}

/* In each tick every board begins one channel, in turn, which the next tick reads. Board A converts
 * monitors 0..3, or monitor 0 and the supply in a box for one finger. Board B converts monitor 4
 * and the supply. The first tick reads the values of the opening: nothing. */
static void take_turns(uint32_t tick, struct exh_drive_in *in)
{
    static struct exh_drive_in held, last;
    const struct exh_drive_in now = *in;
    const int one = run.cfg->scene->fingers == 1, turn = (int)(tick - 1) & 3;
    if (tick > 0) {
        if (!one) { held.mon_raw[turn] = last.mon_raw[turn]; }
        if (turn % 2 == 0) { held.mon_raw[one ? 0 : 4] = last.mon_raw[one ? 0 : 4]; }
        if (turn % 2 == 1) { held.supply_raw = last.supply_raw; }
    }
    memcpy(in->mon_raw, held.mon_raw, sizeof in->mon_raw);
    in->supply_raw = held.supply_raw;
    last = now;
}

/* A scan is begun when the one before is handed over. */
static void delay_glove(uint32_t tick, struct exh_scene_in *in)
{
    static struct exh_glove_in last;
    static uint32_t last_tick;
    const struct exh_glove_in now = in->glove;
    if (tick > 0) {
        in->glove = last;
        in->glove.age_ticks = (uint16_t)(tick - last_tick);
    } else {
        memset(&in->glove, 0, sizeof in->glove);
        in->glove.age_ticks = UINT16_MAX;
        in->glove_new = 0;
    }
    last = now;
    last_tick = tick;
}

static void before(uint32_t tick, struct exh_scene_in *in)
{
    if (!ref_held(run.cfg, tick)) { in->drive.din &= ~(uint32_t)EXH_DIN_DEADMAN; }
    if (run.cfg->turns) { take_turns(tick, &in->drive); }
    if (run.cfg->monitor_age) { delay_monitor(&in->drive); }
    if (in->glove_new) {
        in->glove.age_ticks = (uint16_t)(in->glove.age_ticks + run.cfg->glove_age);
    }
    if (run.cfg->glove_last && in->glove_new) { delay_glove(tick, in); }
    exh_deadman_before(tick, in);
}

static int put(const void *p, size_t n) { return n == 0 || fwrite(p, n, 1, run.to) == 1; }

static void after(uint32_t tick, const struct exh_scene_in *in, const struct exh_drive_out *out)
{
    const struct exh_scene *sc = run.cfg->scene;
    struct ref_tick *f = &run.frame;
    (void)tick;
    f->in = in->drive;
    f->out = *out;
    f->missed = in->missed;
    f->command = in->command;
    f->glove_new = in->glove_new;
    f->glove = in->glove;
    if (!put(f, sizeof *f) || !put(exh_scene_signals(sc), run.signals * sizeof(int32_t)) ||
        (sc->link && (!put(sc->link->in, sizeof *sc->link->in) ||
                         !put(sc->link->out, sizeof *sc->link->out)))) {
        posix_stop();
    }
}

static void be_child(const struct ref_cfg *c, int to)
{
    static const struct exh_loop_hooks hooks = {start, before, after};
    int err;
    run.cfg = c;
    run.to = fdopen(to, "wb");
    err = run.to == NULL || ref_parameters(c) < 0;
    if (!err) {
        posix_configure(&c->board);
        err = exh_loop(c->scene, 1, &hooks) < 0;
    }
    if (run.to) { fclose(run.to); }
    _exit(err != 0);
}

/* --- outside --- */

struct ref *ref_start(const struct ref_cfg *c)
{
    struct ref *r = calloc(1, sizeof *r);
    int way[2];
    if (r == NULL || pipe(way) < 0) {
        free(r);
        return NULL;
    }
    r->cfg = c;
    fflush(NULL);
    r->child = fork();
    if (r->child == 0) {
        close(way[0]);
        be_child(c, way[1]);
    }
    close(way[1]);
    r->from = fdopen(way[0], "rb");
    return r;
}

static int get(struct ref *r, void *p, size_t n)
{
    return n == 0 || (r->from && fread(p, n, 1, r->from) == 1);
}

int ref_next(struct ref *r, struct ref_frame *f)
{
    const struct exh_scene *sc = r->cfg->scene;
    const uint32_t signals = sc->signals ? exh_signal_count(sc->signals) : 0;
    if (signals > REF_SIGNALS || !get(r, &f->tick, sizeof f->tick) ||
        !get(r, f->signal, signals * sizeof f->signal[0])) {
        return 0;
    }
    return sc->link == NULL ||
           (get(r, &f->mail_in, sizeof f->mail_in) && get(r, &f->mail_out, sizeof f->mail_out));
}

void ref_stop(struct ref *r)
{
    if (r == NULL) { return; }
    if (r->from) { fclose(r->from); }
    if (r->child > 0) {
        kill(r->child, SIGKILL); /* it is ours, and may be waiting to write */
        waitpid(r->child, NULL, 0);
    }
    free(r);
}
