/* SPDX-License-Identifier: MIT */
/* exhand-lab advise gains: the advisor held against a simulated map, and what its picture needs. */
#include "lab/gains/gains.h"

#include "lab/drop/study.h"
#include "lab/lab.h"

#include <stdlib.h>
#include <string.h>

static struct {
    const char *out, *judge;
    struct gains_map map;
    struct gains_share share[GAINS_RATES];
} is;

/* The map's rates, unless the options have others. */
static void rates_of(struct gains_options *a, const struct gains_map *map)
{
    if (a->rates_given) { return; }
    a->rates = 0;
    for (int i = 0; i < map->n && a->rates < GAINS_RATES; i++) {
        int known = 0;
        for (int m = 0; m < a->rates; m++) { known |= a->rate_Hz[m] == map->at[i].rate_Hz; }
        if (!known) { a->rate_Hz[a->rates++] = map->at[i].rate_Hz; }
    }
}

static int begin(struct gains_options *a)
{
    int err = is.out ? sweep_open_dir(is.out, "out") : 0;
    if (err == 0 && is.judge) {
        err = gains_map(&is.map, is.judge);
        if (err == 0) { rates_of(a, &is.map); }
        if (is.map.n == 0) { a->rates = 0; }
    }
    return err;
}

static int rate(struct gains_rate *r, int i)
{
    if (is.judge) { is.share[i] = gains_judge(r, &is.map); }
    return is.share[i].unstable > 0;
}

static int end(struct gains_rate *r, int n, int all)
{
    int err = 0;
    if (all && is.judge) { gains_judge_print(is.share, n); }
    if (all && is.out) { err = gains_write(is.out, r, is.share, n, is.judge ? &is.map : NULL); }
    free(is.map.at);
    return err;
}

int lab_advise(int argc, char **argv)
{
    static const struct cli_option option[] = {
        {"judge", CLI_TEXT, &is.judge, 0, 0, "FILE",
            "against a stability.csv of exhand-lab drop --sweep"},
        {"out", CLI_TEXT, &is.out, 0, 0, "DIR",
            "CSVs and what gnuplot needs for the picture there"},
    };
    static const struct gains_study study = {
        {option, (int)(sizeof option / sizeof option[0]), NULL}, begin, rate, end};
    memset(&is, 0, sizeof is);
    return advise_command(argc, argv, &study);
}
