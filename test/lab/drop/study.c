/* SPDX-License-Identifier: MIT */
/* What studies of the k-b plane share: options, a cell, a directory. */
#include "lab/drop/study.h"

#include "base/option.h"
#include "base/outfile.h"
#include "base/param.h"
#include "box/table2.h"

#include "sim/random.h"

#include "drop/drop.h"

#include <string.h>

int sweep_take_shard(const char *text, int *shard, int *shards)
{
    char more;
    if (sscanf(text, "%d/%d%c", shard, shards, &more) == 2 && *shard >= 1 && *shard <= *shards &&
        *shards <= 1000) {
        return 0;
    }
    cli_complain("--shard: %s (I/N, 1 <= I <= N <= 1000): e.g. --shard 1/4", text);
    return 2;
}

int sweep_window(const struct run_cfg *base)
{
    double p;
    exh_scene_drop.defaults();
    p = cli_signal_find(exh_scene_drop.params->table, "vel_p", NULL)->dflt;
    for (int i = 0; i < base->settings; i++) {
        if (strcmp(base->setting[i].name, "vel_p") == 0) { p = base->setting[i].value; }
    }
    return 1 << (int)(p + 0.5);
}

uint64_t study_seed(uint64_t seed, double rate_Hz, double k_Npm, double b_Nspm, int number)
{
    struct sim_random r = {seed};
    const double v[] = {rate_Hz, k_Npm, b_Nspm, number};
    uint64_t out = 0;
    for (size_t i = 0; i < sizeof v / sizeof v[0]; i++) {
        r.state ^= (uint64_t)(v[i] * 1024 + 0.5); /* a file's nine digits are the same number */
        out = sim_random_u64(&r);
    }
    return out >> 16;
}

int study_rest(const struct run_cfg *base, double rate_Hz, double k_Npm, double b_Nspm)
{
    struct run_cfg c = *base;
    int rest = 0;
    c.rate_Hz = (uint32_t)(rate_Hz + 0.5);
    c.k_Npm = k_Npm;
    c.b_Nspm = b_Nspm;
    c.board.falls = 1;
    for (int i = 0; i < base->board.falls; i++) {
        struct table2_result r;
        c.board.seed = study_seed(base->board.seed, rate_Hz, k_Npm, b_Nspm, i);
        r = table2_measure(&c, NULL, TABLE2_REST);
        if (r.error || !r.done) { return r.error ? -1 : -2; }
        /* A box that stopped holds no mass. */
        rest += r.faults == 0 && r.falls == 1 && r.oscillating + r.incomplete == 0;
    }
    return rest;
}

int sweep_open_dir(const char *dir, const char *option)
{
    if (dir == NULL) {
        cli_complain("--%s: needs --out DIR: there it leaves its files", option);
        return 2;
    }
    if (strlen(dir) > 700) {
        cli_complain("--out: %.40s...: longer than 700 bytes: choose a shorter path", dir);
        return 2;
    }
    return outfile_dir(dir, "");
}
