/* SPDX-License-Identifier: MIT */
#include "identify/session.h"

#include "base/option.h"
#include "base/param.h"

#include "identify/identify.h"

#include "exhand/run/log.h"
#include "exhand/run/loop.h"

#include "exhand/error.h"

#include "sim/random.h"

#include <string.h>

#define GO_ID 0x890A

static struct {
    const struct identify_session *s;
    struct identify_data *data;
    int asked;    /* stages that the person was asked to prepare */
    uint32_t end; /* ticks behind the end */
    uint32_t last_tick;
} run;

static struct identify_signals signals(void)
{
    struct identify_signals s;
    memcpy(&s, exh_scene_signals(&exh_scene_identify), sizeof s);
    return s;
}

static void start(const struct exh_scene *sc, struct exh_scene_board board)
{
    identify_data_begin(run.data, board.T);
    exh_log_start(sc, board);
}

/* A stage waits: ask for its place, and say so when it is prepared. */
static void before(uint32_t tick, struct exh_scene_in *in)
{
    const struct identify_signals s = signals();
    const int stage = identify_state()->run.stage;
    if (tick == 0) { in->command = EXH_CMD_RUN; }
    if (tick > 0 && s.waits && run.asked == stage) {
        run.asked++;
        posix_bench(stage == IDENTIFY_MASS ? BENCH_MASS : BENCH_SLACK,
            run.s->hung_kg > 0 ? run.s->hung_kg : run.s->mass_kg);
    } else if (tick > 0 && s.waits && posix_bench_ready()) {
        (void)exh_params_stage(exh_scene_identify.params, GO_ID, 0, stage + 1);
    }
    exh_log_before(tick, in);
}

static void after(uint32_t tick, const struct exh_scene_in *in, const struct exh_drive_out *out)
{
    exh_log_after(tick, in, out);
    run.last_tick = tick;
    identify_data_tick(run.data);
    if (signals().result != EXH_PROBE_BUSY || run.data->no_memory) { posix_stop(); }
}

/* To two digits: what a data sheet says of a pulley. */
static double about(double v)
{
    double unit = 1e-9;
    while (v / unit >= 100) { unit *= 10; }
    return (double)(int)(v / unit + 0.5) * unit;
}

/* The drive's clock is not ours. A ceramic resonator is off by up to half a percent; were it not
 * off at all, a run would see one phase of it and no other. */
static double drive_Hz(const struct identify_session *s)
{
    struct sim_random chance = {s->board.seed ^ 0x64726976};
    return s->board.device.servo_hz * (1 + 0.002 * (sim_random_unit(&chance) - 0.5));
}

static int set_parameters(const struct identify_session *s)
{
    const struct sim_device *d = &s->board.device;
    const struct identify_setting known[] = {
        {"step", s->step_m > 0 ? s->step_m : about(d->step_m / d->decode)},
        {"dac_scale", d->dac_perA},
        {"dac_zero", d->dac_zero},
        {"mon_scale", d->mon_apc},
        {"mass", s->mass_kg},
        {"repeats", s->repeats},
    };
    struct exh_params *p = exh_scene_identify.params;
    int err = 0;
    exh_scene_identify.defaults();
    if (s->par) {
        memcpy(p->active, s->par, sizeof *s->par);
        ((struct identify_par *)p->active)->own.go = 0;
        memcpy(p->staged, p->active, sizeof *s->par);
        return 0;
    }
    for (size_t i = 0; err == 0 && i < sizeof known / sizeof known[0]; i++) {
        if (known[i].value > 0) { err = cli_param_set(p, known[i].name, known[i].value); }
    }
    for (int i = 0; err == 0 && i < s->settings; i++) {
        err = cli_param_set(p, s->setting[i].name, s->setting[i].value);
    }
    return err;
}

int identify_session(const struct identify_session *s, struct identify_data *data)
{
    static const struct exh_loop_hooks hooks = {start, before, after};
    struct posix_config board = s->board;
    int err;
    memset(&run, 0, sizeof run);
    memset(data, 0, sizeof *data);
    run.s = s;
    run.data = data;
    board.bench = 1;
    board.device.servo_hz = drive_Hz(s);
    err = set_parameters(s);
    if (err < 0) { return err; }
    posix_configure(&board);
    err = exh_loop(&exh_scene_identify, s->rate_Hz, &hooks);
    (void)exh_log_end(run.last_tick + 1);
    if (err < 0) { cli_complain("%s", exh_error_text(err)); }
    return err;
}
