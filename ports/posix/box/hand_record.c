/* SPDX-License-Identifier: MIT */
#include "box/hand_record.h"

#include "base/option.h"
#include "box/recording.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SENSORS EXH_GLOVE_SENSORS
#define FIELDS  30
#define FIRST   7 /* angle */
#define DAY_S   86400.0
#define GRID_HZ 60.0
#define STEP_S  10.0 /* no two rows are farther apart */
#define LINE_B  1024
#define BACK_S  1.0 /* from the last row to the first */

/* The order of 23 angles (four of each finger, then palm and wrist; -1: the index's abduction,
 * which this glove does not have) in that of 22. */
static const signed char place[23] = {
    0, 1, 2, 3, 4, 5, 6, -1, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21};

struct timed {
    double (*row)[SENSORS];
    double *t_s; /* from the first */
    long rows, cap;
};

static int complain(const char *path, long line, const char *what)
{
    cli_complain("%s: line %ld: %s", path, line, what);
    return 2;
}

/* How many numbers there are; up to FIELDS of them into v; -1: something else. */
static int numbers(const char *line, double v[FIELDS])
{
    int n = 0;
    for (;;) {
        char *end;
        double x;
        line += strspn(line, " \t\r\n");
        if (*line == '\0') { return n; }
        x = strtod(line, &end);
        if (end == line || !(x >= -1e9 && x <= 1e9)) { return -1; }
        if (n < FIELDS) { v[n] = x; }
        n++;
        line = end;
    }
}

static int room(struct timed *r)
{
    if (r->rows == r->cap) {
        const long cap = r->cap ? 2 * r->cap : 1024;
        double(*row)[SENSORS] = realloc(r->row, (size_t)cap * sizeof *row);
        double *t_s;
        if (row == NULL) { return -1; }
        r->row = row;
        t_s = realloc(r->t_s, (size_t)cap * sizeof *t_s);
        if (t_s == NULL) { return -1; }
        r->t_s = t_s;
        r->cap = cap;
    }
    return 0;
}

/* Seconds of the day, made to go on over midnight. */
static const char *take(struct timed *r, const double v[FIELDS], double *last_s)
{
    const double s = (v[3] * 60 + v[4]) * 60 + v[5];
    double step_s = s - *last_s;
    if (r->rows > 0 && step_s < -DAY_S / 2) { step_s += DAY_S; }
    if (r->rows > 0 && !(step_s > 0 && step_s <= STEP_S)) { return "its clock stands or jumps"; }
    if (room(r) < 0) { return "out of memory"; }
    r->t_s[r->rows] = r->rows > 0 ? r->t_s[r->rows - 1] + step_s : 0;
    for (int k = 0; k < 23; k++) {
        if (place[k] >= 0) { r->row[r->rows][place[k]] = v[FIRST + k]; }
    }
    r->rows++;
    *last_s = s;
    return NULL;
}

static int read_timed(struct timed *r, const char *path, FILE *f)
{
    char line[LINE_B];
    double v[FIELDS], last_s = 0;
    for (long n = 1; fgets(line, sizeof line, f) != NULL; n++) {
        const int got = numbers(line, v);
        const char *what = NULL;
        if (got == 0) { continue; }
        what = got == FIELDS ? take(r, v, &last_s) : "not 30 numbers";
        if (what != NULL) { return complain(path, n, what); }
    }
    if (ferror(f)) {
        cli_complain("%s: %s", path, strerror(errno));
        return 2;
    }
    return 0;
}

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

static int onto_grid(struct hand_record *h, const struct timed *r, const struct sim_exo_par *exo)
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

static int is_timed(FILE *f)
{
    char line[LINE_B];
    double v[FIELDS];
    const int yes = fgets(line, sizeof line, f) != NULL && numbers(line, v) == FIELDS;
    rewind(f);
    return yes;
}

static int read_rows(
    struct hand_record *h, const char *path, double row_hz, const struct sim_exo_par *exo)
{
    struct recording r;
    const struct recording_ask ask = {RECORDING_GUESS, NULL, NULL};
    int err = recording_read(&r, path, &ask);
    if (err) { return err; }
    if (r.codes) {
        cli_complain("%s: codes: angles are wanted", path);
        err = 2;
    } else {
        recording_hold(&r);
        err = even(h, &r, row_hz, exo);
    }
    recording_free(&r);
    return err;
}

int hand_record_read(
    struct hand_record *h, const char *path, double row_hz, const struct sim_exo_par *exo)
{
    struct timed timed = {NULL, NULL, 0, 0};
    FILE *f = fopen(path, "rb");
    int err;
    memset(h, 0, sizeof *h);
    if (f == NULL) {
        cli_complain("%s: %s", path, strerror(errno));
        return 3;
    }
    if (!is_timed(f)) {
        fclose(f);
        return read_rows(h, path, row_hz, exo);
    }
    err = read_timed(&timed, path, f);
    fclose(f);
    if (err == 0) { err = onto_grid(h, &timed, exo); }
    free(timed.row);
    free(timed.t_s);
    return err;
}

/* Least jerk: no more of it than a finger makes by itself. */
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
