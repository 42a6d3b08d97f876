/* SPDX-License-Identifier: MIT */
#include "box/hand_record.h"

#include "base/fifo.h"
#include "base/option.h"
#include "box/recording.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SENSORS EXH_GLOVE_SENSORS
#define GRID_HZ 60.0
#define LINE_B  1024
#define FIELDS  30
#define BACK_S  1.0 /* from the last row to the first */

/* Of 30 numbers: a date, a flag, and 23 angles, four of each finger, then palm and wrist. The
 * index's abduction is left out, which this glove does not have. */
#define DATED "8-14,16-30,clock=4-6"

/* --- to strings --- */

static int allocate(struct hand_record *h, long rows)
{
    h->rows = rows;
    for (unsigned i = 0; i < SIM_FINGERS; i++) {
        h->string_m[i] = malloc((size_t)rows * sizeof *h->string_m[i]);
        if (h->string_m[i] == NULL) {
            cli_complain("out of memory");
            hand_record_free(h);
            return 2;
        }
    }
    return 0;
}

static void put(struct hand_record *h, long n, const double row_rad[SENSORS], double sign,
    const struct sim_exo_par *exo)
{
    for (unsigned i = 0; i < SIM_FINGERS; i++) {
        h->string_m[i][n] = sim_path_string(row_rad, i, sign, exo->finger[i].arm_m);
    }
}

static int even(
    struct hand_record *h, const struct recording *r, double row_hz, const struct sim_exo_par *exo)
{
    const double sign = sim_path_sign((const double(*)[SENSORS])r->row, r->rows);
    const int err = allocate(h, r->rows);
    h->row_hz = row_hz;
    for (long n = 0; err == 0 && n < r->rows; n++) { put(h, n, r->row[n], sign, exo); }
    return err;
}

static int onto_grid(
    struct hand_record *h, const struct recording *r, const struct sim_exo_par *exo)
{
    const double sign = sim_path_sign((const double(*)[SENSORS])r->row, r->rows);
    const long rows = (long)(r->t_s[r->rows - 1] * GRID_HZ) + 1;
    const int err = allocate(h, rows);
    long at = 0;
    h->row_hz = GRID_HZ;
    for (long n = 0; err == 0 && n < rows; n++) {
        const double t_s = (double)n / GRID_HZ;
        double row[SENSORS];
        while (at + 2 < r->rows && r->t_s[at + 1] <= t_s) { at++; }
        for (int k = 0; k < SENSORS; k++) {
            const long next = at + 1 < r->rows ? at + 1 : at;
            const double span_s = r->t_s[next] - r->t_s[at];
            const double share = span_s > 0 ? (t_s - r->t_s[at]) / span_s : 0;
            row[k] = r->row[at][k] + share * (r->row[next][k] - r->row[at][k]);
        }
        put(h, n, row, sign, exo);
    }
    return err;
}

/* --- either --- */

/* Whether the first line is FIELDS numbers. */
static int is_dated(const char *path)
{
    char line[LINE_B];
    const char *at = line;
    int n = 0;
    FILE *f = fifo_read(path);
    if (f == NULL) { return 0; }
    if (fgets(line, sizeof line, f) == NULL) { line[0] = '\0'; }
    fclose(f);
    for (;; n++) {
        char *end;
        at += strspn(at, " \t\r\n");
        (void)strtod(at, &end);
        if (end == at) { break; }
        at = end;
    }
    return n == FIELDS && *at == '\0';
}

int hand_record_read(struct hand_record *h, const char *path, const char *columns, double row_hz,
    const struct sim_exo_par *exo)
{
    const struct recording_ask ask = {
        RECORDING_GUESS, columns == NULL && is_dated(path) ? DATED : columns, NULL};
    struct recording r;
    int err = recording_read(&r, path, &ask);
    memset(h, 0, sizeof *h);
    if (err) { return err; }
    if (r.codes) {
        cli_complain("%s: codes: angles are wanted", path);
        err = 2;
    } else {
        recording_hold(&r);
        err = r.t_s != NULL ? onto_grid(h, &r, exo) : even(h, &r, row_hz, exo);
    }
    recording_free(&r);
    return err;
}

/* Minimum jerk: no more than a finger makes. */
static double eased(double s) { return s * s * s * (10 - 15 * s + 6 * s * s); }

int hand_record_again(struct hand_record *h)
{
    const long back = (long)ceil(BACK_S * h->row_hz);
    for (unsigned i = 0; i < SIM_FINGERS; i++) {
        double *more = realloc(h->string_m[i], (size_t)(h->rows + back) * sizeof *more);
        if (more == NULL) {
            cli_complain("out of memory");
            return 2;
        }
        h->string_m[i] = more;
        for (long n = 0; n < back; n++) {
            const double s = eased((double)(n + 1) / (double)(back + 1));
            more[h->rows + n] = more[h->rows - 1] + s * (more[0] - more[h->rows - 1]);
        }
    }
    h->rows += back;
    h->again = 1;
    return 0;
}

void hand_record_free(struct hand_record *h)
{
    for (unsigned i = 0; i < SIM_FINGERS; i++) { free(h->string_m[i]); }
    memset(h, 0, sizeof *h);
}

void hand_record_use(const struct hand_record *h, struct sim_exo_par *exo)
{
    for (unsigned i = 0; i < SIM_FINGERS; i++) {
        exo->record[i] = (struct sim_path_record){h->string_m[i], h->rows, h->row_hz, h->again};
    }
}
