/* SPDX-License-Identifier: MIT */
/* exhand-lab drop --preset original: the falling mass on the wall of the system before, and on this
 * box's. */
#include "lab/drop/original.h"

#include "lab/drop/preset.h"
#include "base/outfile.h"
#include "box/table2.h"

#include <stdio.h>
#include <string.h>

#define COLUMNS 3

enum row {
    RATE,
    K,
    B,
    STIFFNESS,
    LOW,
    HIGH,
    PEAK,
    DEEPEST,
    FIRST,
    LATEST,
    ERROR,
    SHARE,
    OSCILLATING,
    ROWS
};

static const struct original_row row[ROWS] = {
    [RATE] = {"loop", "Hz", 0},
    [K] = {"k", "N/m", 0},
    [B] = {"b", "Ns/m", 0},
    [STIFFNESS] = {"stiffness, as Table II's", "N/m", 0},
    [LOW] = {"  95 % interval from", "N/m", 0},
    [HIGH] = {"  to", "N/m", 0},
    [PEAK] = {"largest force, monitored", "N", 2},
    [DEEPEST] = {"deepest past the wall", "mm", 2},
    [FIRST] = {"past the wall when contact is known, mean", "mm", 2},
    [LATEST] = {"  at most", "mm", 2},
    [ERROR] = {"force less what it should be, rms", "N", 2},
    [SHARE] = {"  of what it should be, rms", "%", 0},
    [OSCILLATING] = {"falls that do not come to rest, of all", "", 2},
};

static void fill(double *v, const struct table2_result *r)
{
    const int line = r->line == FALL_OK && r->b_Npm > 0;
    v[RATE * COLUMNS] = r->rate_Hz;
    v[K * COLUMNS] = r->k_Npm;
    v[B * COLUMNS] = r->b_Nspm;
    v[STIFFNESS * COLUMNS] = line ? r->b_Npm : 2 * ORIGINAL_NONE;
    v[LOW * COLUMNS] = line && r->ci_bounded ? r->ci_low_Npm : 2 * ORIGINAL_NONE;
    v[HIGH * COLUMNS] = line && r->ci_bounded ? r->ci_high_Npm : 2 * ORIGINAL_NONE;
    v[OSCILLATING * COLUMNS] = r->falls ? (double)r->oscillating / r->falls : 2 * ORIGINAL_NONE;
}

/* Where the mass is when the law first knows of each fall's contact. */
static void fill_contacts(double *v, const struct fall_log *log, double wall_m, size_t *first)
{
    struct original_contact c = {0, 0, 0, 0, 0};
    double sum_m = 0, most_m = 0;
    for (size_t i = 0; i < log->falls; i++) {
        const size_t end = i + 1 < log->falls ? log->start[i + 1] : log->samples;
        size_t at = log->start[i];
        while (at < end && !log->sample[at].c) { at++; }
        if (i == 0) { *first = at < end ? at : 0; }
        if (at < end) {
            const double past_m = log->sample[at].q_m - wall_m;
            sum_m += past_m;
            most_m = past_m > most_m ? past_m : most_m;
        }
    }
    for (size_t i = 0; i < log->samples; i++) { original_add(&c, &log->sample[i], wall_m); }
    original_end(&c);
    v[PEAK * COLUMNS] = c.peak_N;
    v[DEEPEST * COLUMNS] = 1e3 * c.deepest_m;
    v[FIRST * COLUMNS] = log->falls ? 1e3 * sum_m / (double)log->falls : 0;
    v[LATEST * COLUMNS] = 1e3 * most_m;
    v[ERROR * COLUMNS] = c.err_N;
    v[SHARE * COLUMNS] = c.rms_N > 0 ? 100 * c.err_N / c.rms_N : 2 * ORIGINAL_NONE;
}

/* The run twice, for the table and for its samples: it is the same. */
static int column(double *v, const struct run_cfg *c, const char *dir, int n)
{
    const struct table2_result r = table2_measure(c, NULL, TABLE2_SAME);
    struct run run;
    size_t first = 0;
    int err = r.error || !r.done || run_drop(c, &run) < 0;
    if (r.error || !r.done) { return 1; }
    if (err == 0 && run.log.falls > 0) {
        const double wall_m = run.q_lim_m;
        const size_t end = run.log.falls > 1 ? run.log.start[1] : run.log.samples;
        fill(v, &r);
        fill_contacts(v, &run.log, wall_m, &first);
        if (dir) { err = original_trace(dir, n, run.log.sample, end, first, wall_m); }
    }
    run_free(&run);
    return err;
}

int drop_original(const struct run_cfg *original, const struct run_cfg *box, const char *dir)
{
    static const char *const name[COLUMNS] = {"original", "a frame late", "this box"};
    double value[ROWS * COLUMNS] = {0};
    const struct original_table t = {row, ROWS, COLUMNS, name, value};
    struct run_cfg c[COLUMNS] = {*original, *original, *box};
    int err = 0;
    c[1].board.device.delay_tick += 1;
    for (int k = 0; err == 0 && k < COLUMNS; k++) { err = column(value + k, &c[k], dir, k); }
    if (err) { return posix_interrupted() ? 130 : 1; }
    original_print(&t);
    printf(
        "\n\"Original\" is a loop at 90 Hz with the paper's gains for that rate. Its glove has no "
        "part in a fall.\n"
        "\"A frame late\" adds the frame of the glove as a delay between encoder and motor.\n"
        "\"Force less what it should be\" is monitored less demanded force of the same tick, over "
        "all ticks in contact.\n");
    return dir ? original_out(dir, &t, name, COLUMNS) : 0;
}
