/* SPDX-License-Identifier: MIT */
/* exhand-lab drop: the falling mass as it is studied. */
#include "lab/lab.h"

#include "base/assign.h"
#include "base/outfile.h"
#include "drop/options.h"
#include "lab/drop/border.h"
#include "lab/drop/friction.h"
#include "lab/drop/original.h"
#include "lab/drop/preset.h"
#include "lab/drop/ray.h"
#include "lab/drop/readings.h"
#include "lab/drop/sweep.h"

#include <stdlib.h>
#include <string.h>

static struct {
    int64_t friction;
    int gates, sweep, check, readings;
    const char *grid, *shard, *preset;
} is;

static int report_readings(const struct drop_options *o, const struct table2_result *r, int stride)
{
    const struct table2_readings t = {r, o->rates, stride, (int)o->runs};
    FILE *f;
    table2_readings_print(stdout, &t);
    if (o->out == NULL) { return 0; }
    f = outfile_in(o->out, "readings.csv");
    if (f == NULL) { return 1; }
    table2_readings_csv(f, &t);
    return outfile_close(f);
}

/* --- the system before, beside this one --- */

static int beside_original(const struct drop_options *o)
{
    const struct run_cfg original = drop_run_cfg(o, 0, 1, (uint64_t)o->seed),
                         box = drop_run_cfg(o, 1, 1, (uint64_t)o->seed);
    return drop_original(&original, &box, o->out);
}

/* --- the plane of gains instead of the table's points --- */

static int plane(const struct drop_options *o)
{
    struct sweep_opt s = {.rate_Hz = o->rate_Hz,
        .rates = o->rates,
        .jobs = (int)o->jobs,
        .base = drop_run_cfg(o, 0, 1, (uint64_t)o->seed),
        .dir = o->out};
    if (is.sweep + is.check + (is.friction > 0) > 1) {
        cli_complain("--sweep, --border-check, --friction: one at a time");
        return 2;
    }
    if (o->k_Npm >= 0 || o->b_Nspm >= 0 || o->scale != 1 || is.gates || o->pace ||
        o->let_go_s > 0) {
        cli_complain(
            "--%s: chooses k and b itself: leave out --k, --b, --scale, --gates, --pace, --let-go",
            is.sweep   ? "sweep"
            : is.check ? "border-check"
                       : "friction");
        return 2;
    }
    if (is.check && o->falls >= 0) {
        cli_complain("--falls and --border-check: it has its own falls: leave out one of them");
        return 2;
    }
    const char *rays = is.sweep && is.grid ? is.grid : is.sweep ? "16x6" : "2x3";
    if (assign_grid(is.check && is.grid ? is.grid : "16x16", &s.columns, &s.rows) ||
        assign_grid(rays, &s.rays, &s.per_octave) ||
        sweep_take_shard(is.shard ? is.shard : "1/1", &s.shard, &s.shards)) {
        return 2;
    }
    if (s.per_octave > RAY_PER_OCTAVE) {
        cli_complain("--grid: %s: at most %d nodes an octave", rays, RAY_PER_OCTAVE);
        return 2;
    }
    return is.sweep   ? sweep_run(&s)
           : is.check ? border_check(&s)
                      : friction_run(&s, (int)is.friction);
}

/* --- the command --- */

static int refuse(struct drop_options *o)
{
    int err = is.preset ? original_take(is.preset) : 0;
    o->plane = is.sweep || is.check || is.friction;
    o->gates = is.gates;
    o->more = is.readings ? readings_judge : NULL;
    if (err) { return err; }
    if (is.preset &&
        (o->T.num != 0 || o->rates_given || o->k_Npm >= 0 || o->b_Nspm >= 0 || o->scale != 1 ||
            o->gates || o->runs || o->pace || o->blackbox || o->gpio.given || o->params.load ||
            o->params.save || is.readings || o->guarded || o->custom || o->plane)) {
        cli_complain("--preset: goes with --falls, --seed, --out, --set, --device, --calibration, "
                     "--cards and --let-go alone");
        return 2;
    }
    if (is.preset) {
        o->rate_Hz[0] = ORIGINAL_RATE_HZ;
        o->rate_Hz[1] = ORIGINAL_BOX_HZ;
        o->rates = 2;
    }
    if (o->plane && is.readings) {
        cli_complain("--readings: of the table's runs: leave out --sweep, --border-check, "
                     "--friction");
        return 2;
    }
    if ((is.grid && !is.sweep && !is.check) || (is.shard && !is.sweep)) {
        cli_complain("--grid and --shard: only with --sweep, --grid with --border-check too");
        return 2;
    }
    return 0;
}

static int run(const struct drop_options *o)
{
    return o->plane    ? plane(o)
           : is.preset ? beside_original(o)
                       : drop_experiment(o, is.readings ? report_readings : NULL);
}

int lab_drop(int argc, char **argv)
{
    static struct drop_options o;
    static const struct cli_option option[] = {
        {"gates", CLI_FLAG, &is.gates, 0, 0, NULL,
            "as many runs at 1.5 times both gains; says whether both gates of the device hold"},
        {"sweep", CLI_FLAG, &is.sweep, 0, 0, NULL,
            "the stability border in the k-b plane, in DIR/stability.csv; stopped or killed, it "
            "goes "
            "on from there"},
        {"grid", CLI_TEXT, &is.grid, 0, 0, "AxB",
            "rays at each rate of --sweep, and nodes an octave of each (16x6); cells of "
            "--border-check (16x16)"},
        {"shard", CLI_TEXT, &is.shard, 0, 0, "I/N",
            "the I-th of N parts of the sweep, in a file of its own; then without: one map of all"},
        {"border-check", CLI_FLAG, &is.check, 0, 0, NULL,
            "the simulated border beside that of the linear test"},
        {"friction", CLI_INT, &is.friction, 2, FRICTION_POINTS_MAX, "N",
            "the border against N amounts of friction, 0..2 times"},
        {"preset", CLI_TEXT, &is.preset, 0, 0, "NAME",
            "original: the commercial system at 90 Hz, beside this box at 2 kHz"},
        {"readings", CLI_FLAG, &is.readings, 0, 0, NULL,
            "the stiffness by every reading of the paper's analysis"},
    };
    const struct drop_study study = {
        {option, (int)(sizeof option / sizeof option[0]), NULL}, refuse, run};
    memset(&is, 0, sizeof is);
    return drop_command(argc, argv, &o, &study);
}
