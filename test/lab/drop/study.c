/* SPDX-License-Identifier: MIT */
/* What studies of the k-b plane share: options, a cell, a directory. */
#include "lab/drop/study.h"

#include "base/option.h"
#include "base/param.h"
#include "box/table2.h"

#include "sim/linear.h"

#include "drop/drop.h"

#include <errno.h>
#include <string.h>
#include <sys/stat.h>

#define R2_MIN 0.3 /* a fit below |r| = 0.55 has no slope worth the name */

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

struct cell sweep_cell(
    const struct run_cfg *base, double rate_Hz, double k_Npm, double b_Nspm, int *error)
{
    struct run_cfg c = *base;
    struct table2_result r;
    struct cell cell = {rate_Hz, k_Npm, b_Nspm, 0, base->board.falls, 0, -1};
    c.rate_Hz = (uint32_t)(rate_Hz + 0.5);
    c.k_Npm = k_Npm;
    c.b_Nspm = b_Nspm;
    r = table2_measure(&c, NULL, TABLE2_LINE);
    *error = r.error ? 1 : r.done ? 0 : -1;
    cell.stable_falls = r.falls - r.oscillating - r.incomplete;
    if (r.faults) { cell.stable_falls = 0; } /* the box stopped: nothing held the mass */
    if (r.b_Npm > 0 && r.r2 >= R2_MIN) { cell.stiffness_Npm = r.b_Npm; }
    cell.rho = linear_rho(&base->board.device, 1 / rate_Hz, k_Npm, b_Nspm, sweep_window(base));
    return cell;
}

int sweep_open_dir(const char *dir, const char *option)
{
    struct stat st;
    if (dir == NULL) {
        cli_complain("--%s: needs --out DIR: there it leaves its files", option);
        return 2;
    }
    if (strlen(dir) > 700) {
        cli_complain("--out: %.40s...: longer than 700 bytes: choose a shorter path", dir);
        return 2;
    }
    if (mkdir(dir, 0777) != 0 && errno != EEXIST) {
        cli_complain("--out: %s: %s: give a directory that can be made", dir, strerror(errno));
        return 2;
    }
    if (stat(dir, &st) != 0 || !S_ISDIR(st.st_mode)) {
        cli_complain("--out: %s: no directory: give another", dir);
        return 2;
    }
    return 0;
}
