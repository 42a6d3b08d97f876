/* SPDX-License-Identifier: MIT */
/* exhand drop: its options, and what a study of the lab adds to it. */
#ifndef DROP_OPTIONS_H
#define DROP_OPTIONS_H

#include "box/contacts.h"
#include "box/images.h"
#include "base/option.h"
#include "base/params_file.h"
#include "box/table2_runs.h"

#define DROP_RATES_MAX    64
#define DROP_SETTINGS_MAX 64

struct drop_options {
    struct params_file params;
    double rate_Hz[DROP_RATES_MAX];
    int rates, rates_given;
    double k_Npm, b_Nspm, scale;     /* < 0: the paper's at that rate */
    int64_t falls, runs, seed, jobs; /* runs 0: not given */
    double phase;                    /* of the wall between two encoder counts; < 0: drawn */
    int pace, cards, guarded, custom;
    const char *out, *blackbox;
    double let_go_s;
    struct run_setting setting[DROP_SETTINGS_MAX];
    int settings;
    struct sim_device device;
    struct images images;
    struct exh_period T;
    struct contacts gpio;
    /* For a study: it chooses the gains; it also runs at 1.5 times both gains and judges both
     * gates; it judges each run, too. */
    int plane, gates;
    table2_judge *more;
};

/* Additional work of exhand-lab with the options. */
struct drop_study {
    struct cli_more more;
    int (*refuse)(struct drop_options *o); /* 0, or 2 after a line on stderr; NULL: nothing */
    int (*run)(const struct drop_options *o);
};

/* The command; study->run NULL: the experiment. Exit status. */
int drop_command(int argc, char **argv, struct drop_options *o, const struct drop_study *study);

/* take.c: options by cli_call, ctx the struct above. 0, or 2 after a line on stderr. */
int drop_take_rates(void *ctx, const char *text);
int drop_take_period(void *ctx, const char *text);
int drop_take_setting(void *ctx, const char *text);
int drop_take_device(void *ctx, const char *text);
void drop_print_params(const struct exh_scene *scene);
const struct exh_scene *drop_scene(const struct drop_options *o);

/* experiment.c. The run of rate i at so many times both gains; run and written under its rate. */
struct run_cfg drop_run_cfg(const struct drop_options *o, int i, double scale, uint64_t seed);
struct table2_result drop_shown(const struct drop_options *o, int i);
/* Behind the tables: all results, `stride` a rate. 0, or 1 after a line on stderr. */
typedef int drop_after(const struct drop_options *o, const struct table2_result *r, int stride);
/* The runs at each rate, judged, printed, written. Exit status; 1 also where a gate fails. */
int drop_experiment(const struct drop_options *o, drop_after *after);

#endif
