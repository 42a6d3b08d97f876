/* SPDX-License-Identifier: MIT */
#include "box/recording.h"

#include "base/fifo.h"
#include "base/option.h"
#include "box/recording_columns.h"

#include <errno.h>
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SENSORS EXH_GLOVE_SENSORS
#define PI      3.14159265358979323846
#define DAY_S   86400.0
#define STEP_S  10.0 /* no two rows are farther apart */

struct reader {
    const char *path;
    struct recording_text text;
    struct recording_line now;
    struct recording_columns columns;
    long line; /* of the file, from 1: now */
    int timed; /* by our own header: the first column is time */
    int wide;  /* columns of the first line, if all have as many; else 0 */
    enum recording_unit unit;
    double last_s; /* of the row before */
    double lo, hi; /* of all values */
    int whole;     /* all are whole numbers */
    long cap;
    struct recording_scale scale;
    long blank, blanks; /* lines: since the last row; between rows */
    long no_number;
};

static int bad(const struct reader *in, int column, const char *what)
{
    if (column > 0) {
        cli_complain("%s: line %ld, column %d: %s", in->path, in->line, column, what);
    } else {
        cli_complain("%s: line %ld: %s", in->path, in->line, what);
    }
    return 2;
}

static int is_number(const char *text, double *v)
{
    char *end;
    *v = strtod(text, &end);
    return end != text && *end == '\0' && strlen(text) < RECORDING_FIELD_B - 1 && *v >= -DBL_MAX &&
           *v <= DBL_MAX;
}

/* Nothing, or nan or inf. */
static int is_none(const char *text)
{
    char *end;
    const double v = strtod(text, &end);
    return *end == '\0' && (end == text || !isfinite(v));
}

/* Value of a sensor: a number, or NAN, which is counted. */
static int is_value(struct reader *in, const char *text, double *v)
{
    if (is_number(text, v)) { return 1; }
    if (!is_none(text)) { return 0; }
    *v = (double)NAN;
    in->no_number++;
    return 1;
}

static int no_number(const struct reader *in, int column)
{
    char text[RECORDING_FIELD_B + 40];
    snprintf(text, sizeof text, "\"%.*s\" is no number", RECORDING_FIELD_B - 1,
        in->now.field[column - 1]);
    return bad(in, column, text);
}

/* --- the first line --- */

/* What a name of the header says of the unit. */
static void take_name(struct reader *in, int column)
{
    const char *unit = strrchr(in->now.field[column - 1], '_');
    if (in->unit == RECORDING_GUESS && unit != NULL) { in->unit = recording_unit_of(unit + 1); }
}

static int is_word(const char *text)
{
    double ignored;
    return !is_number(text, &ignored) && !is_none(text);
}

/* No columns were given. A number after a first word indicates a row, which must not be taken for a
 * header. */
static int first_plain(struct reader *in, int *header)
{
    const char *first = in->now.field[0], *second = in->now.n > 1 ? in->now.field[1] : "";
    double ignored;
    *header = is_word(first) || (is_none(first) && is_word(second));
    in->timed = *header && strcmp(first, "t_s") == 0;
    recording_columns_plain(&in->columns, in->timed ? 2 : 1);
    if (*header && is_number(second, &ignored)) { return no_number(in, 1); }
    if (in->timed && in->now.n > 1) { take_name(in, 2); }
    return 0;
}

/* Columns were given. A line is a header if it has their names, or if the sensors are words. */
static int first_told(struct reader *in, const char *columns, int *header)
{
    int words = 0, numbers = 0;
    double ignored;
    if (recording_columns_read(&in->columns, columns, &in->now, in->path)) { return 2; }
    for (int i = 0; i < in->columns.last && i < in->now.n; i++) {
        const int use = in->columns.use[i];
        if (use < RECORDING_SENSOR || use >= RECORDING_TIME) { continue; }
        words += is_word(in->now.field[i]);
        numbers += is_number(in->now.field[i], &ignored);
        if (use == RECORDING_SENSOR) { take_name(in, i + 1); }
    }
    in->wide = in->now.n;
    *header = in->columns.named || (words > 0 && numbers == 0);
    return 0;
}

/* --- a row --- */

static int more_room(struct recording *r, const struct reader *in, long cap)
{
    const size_t n = (size_t)cap;
    double(*row)[SENSORS] = realloc(r->row, n * sizeof *row);
    double *t_s = NULL;
    char(*label)[RECORDING_LABEL_B] = NULL;
    const int timed = recording_columns_has(&in->columns, RECORDING_TIME);
    const int labelled = recording_columns_has(&in->columns, RECORDING_LABEL);
    if (row != NULL) { r->row = row; }
    if (timed && (t_s = realloc(r->t_s, n * sizeof *t_s)) != NULL) { r->t_s = t_s; }
    if (labelled && (label = realloc(r->label, n * sizeof *label)) != NULL) { r->label = label; }
    return row != NULL && (t_s != NULL || !timed) && (label != NULL || !labelled);
}

static int store(struct reader *in, struct recording *r, const double value[SENSORS])
{
    if (r->rows == in->cap) {
        const long cap = in->cap ? 2 * in->cap : 1024;
        if (!more_room(r, in, cap)) { return bad(in, 0, "out of memory"); }
        in->cap = cap;
    }
    memcpy(r->row[r->rows], value, SENSORS * sizeof *value);
    in->blanks += r->rows > 0 ? in->blank : 0;
    in->blank = 0;
    for (int i = 0; i < SENSORS; i++) {
        if (isnan(value[i])) { continue; }
        if (value[i] < in->lo) { in->lo = value[i]; }
        if (value[i] > in->hi) { in->hi = value[i]; }
        if (value[i] > 1e9 || value[i] < -1e9 || value[i] != (double)(long)value[i]) {
            in->whole = 0;
        }
    }
    return 0;
}

/* Time of the row that is stored: from the first on, a clock over midnight. */
static int take_time(struct reader *in, struct recording *r, const double part[3])
{
    const int clock = in->columns.time_s == 0;
    const double now_s =
        clock ? (part[0] * 60 + part[1]) * 60 + part[2] : part[0] * in->columns.time_s;
    double step_s = now_s - in->last_s;
    if (r->rows > 0 && clock && step_s < -DAY_S / 2) { step_s += DAY_S; }
    if (r->rows > 0 && !(step_s > 0 && step_s <= STEP_S)) {
        return bad(in, 0, "its clock stands or jumps");
    }
    r->t_s[r->rows] = r->rows > 0 ? r->t_s[r->rows - 1] + step_s : 0;
    in->last_s = now_s;
    return 0;
}

static int take_label(struct reader *in, struct recording *r, int column)
{
    const char *text = in->now.field[column - 1];
    char *to = r->label[r->rows];
    if (strlen(text) >= RECORDING_LABEL_B) { return bad(in, column, "a label of over 31 bytes"); }
    for (; *text != '\0'; text++) { *to++ = (unsigned char)*text < ' ' ? '?' : *text; }
    *to = '\0';
    return 0;
}

/* As many columns as there should be? */
static int check_width(const struct reader *in)
{
    const int n = in->now.n;
    char text[80];
    double ignored;
    if (in->wide > 0 && n != in->wide) {
        snprintf(text, sizeof text, "%d columns (%d in the first line)", n, in->wide);
        return bad(in, 0, text);
    }
    if (in->wide == 0 && !in->timed &&
        (n > SENSORS + 1 || (n > SENSORS && is_number(in->now.field[SENSORS], &ignored)))) {
        snprintf(
            text, sizeof text, "more than %d columns and a label: --columns says which", SENSORS);
        return bad(in, 0, text);
    }
    return 0;
}

/* The field of a column as what it is used for; 0 if it is no such thing. */
static int take_field(struct reader *in, int column, double value[RECORDING_USES])
{
    const char *text = in->now.field[column - 1];
    const int use = in->columns.use[column - 1];
    if (use == RECORDING_LABEL) { return 1; }
    if (use == RECORDING_NOTHING) {
        return !(in->timed && column == 1) || is_number(text, &value[use]);
    }
    if (use >= RECORDING_TIME) { return is_number(text, &value[use]); }
    if (!is_value(in, text, &value[use])) { return 0; }
    value[use] = in->scale.gain * value[use] + in->scale.offset;
    return 1;
}

static int take_row(struct reader *in, struct recording *r)
{
    double value[RECORDING_USES];
    char text[80];
    int label = 0, err;
    for (int column = 1; column <= in->columns.last; column++) {
        if (column > in->now.n) {
            snprintf(text, sizeof text, "%d columns (%d wanted)", in->now.n, in->columns.last);
            return bad(in, 0, text);
        }
        if (!take_field(in, column, value)) { return no_number(in, column); }
        if (in->columns.use[column - 1] == RECORDING_LABEL) { label = column; }
    }
    err = check_width(in);
    if (err == 0) { err = store(in, r, value + RECORDING_SENSOR); }
    if (err == 0 && r->t_s != NULL) { err = take_time(in, r, value + RECORDING_TIME); }
    if (err == 0 && label > 0) { err = take_label(in, r, label); }
    r->rows += err == 0;
    return err;
}

/* --- all rows --- */

/* Guessed, checked, and angles in rad. */
static int settle_unit(struct reader *in, struct recording *r)
{
    static const double scale[] = {0, 1, 1, PI / 180, 2 * PI};
    const int codes = in->unit == RECORDING_CODES || in->scale.given ||
                      (in->unit == RECORDING_GUESS && in->whole && (in->hi > PI || in->lo < -PI));
    const double unit = in->unit == RECORDING_GUESS ? 1 : scale[in->unit];
    r->codes = codes;
    if (codes && (in->lo < -32768 || in->hi > 32767 || (!in->whole && !in->scale.given))) {
        cli_complain("%s: %.9g..%.9g: codes are whole numbers -32768..32767: --unit says what else "
                     "they are, --scale what makes codes of them",
            in->path, in->lo, in->hi);
        return 2;
    }
    if (!codes && (in->lo * unit < -PI || in->hi * unit > PI)) {
        cli_complain("%s: %.9g..%.9g: angles are within half a turn: --unit says what they are",
            in->path, in->lo, in->hi);
        return 2;
    }
    for (long n = 0; !codes && n < r->rows; n++) {
        for (int i = 0; i < SENSORS; i++) { r->row[n][i] *= unit; }
    }
    return 0;
}

static int read_rows(struct reader *in, struct recording *r, const char *columns)
{
    int err = 0, begun = 0;
    for (in->line = 1; err == 0 && recording_text_next(&in->text, &in->now); in->line++) {
        int header = 0;
        if (in->text.endless) { return bad(in, 0, "it does not end: give a text of rows"); }
        if (in->now.n == 1 && in->now.field[0][0] == '\0') {
            in->blank++;
            continue;
        }
        if (!begun) {
            err = columns ? first_told(in, columns, &header) : first_plain(in, &header);
            begun = 1;
        }
        if (err == 0 && !header) { err = take_row(in, r); }
    }
    if (err == 0 && ferror(in->text.f)) { err = bad(in, 0, strerror(errno)); }
    if (err == 0 && r->rows == 0) {
        cli_complain("%s: holds no row", in->path);
        err = 2;
    }
    return err;
}

/* What was passed over, said once. */
static void say(const struct reader *in, const struct recording *r)
{
    if (in->no_number) {
        cli_complain("%s: %ld of %ld values are no number: faults of their channels in their rows",
            in->path, in->no_number, r->rows * SENSORS);
    }
    if (in->blanks && r->t_s == NULL) {
        cli_complain(
            "%s: %ld empty lines between rows: no time goes by in them", in->path, in->blanks);
    }
}

int recording_read(struct recording *r, const char *path, const struct recording_ask *ask)
{
    static struct reader in;
    const int standard = strcmp(path, "-") == 0;
    FILE *f;
    int err;
    memset(r, 0, sizeof *r);
    memset(&in, 0, sizeof in);
    if (recording_scale_of(&in.scale, ask->scale)) { return 2; }
    f = standard ? stdin : fifo_read(path);
    if (f == NULL) {
        cli_complain("%s: %s: give a recording, 22 codes or angles a line", path, strerror(errno));
        return 3;
    }
    in.path = standard ? "standard input" : path;
    in.unit = ask->unit;
    in.whole = 1;
    in.lo = DBL_MAX;
    in.hi = -DBL_MAX;
    recording_text_begin(&in.text, f, ask->columns != NULL);
    err = read_rows(&in, r, ask->columns);
    if (!standard) { fclose(f); }
    if (err == 0) { err = settle_unit(&in, r); }
    if (err == 0) { say(&in, r); }
    if (err) { recording_free(r); }
    return err;
}

void recording_hold(struct recording *r)
{
    for (long n = 0; n < r->rows; n++) {
        for (int i = 0; i < SENSORS; i++) {
            if (isnan(r->row[n][i])) { r->row[n][i] = n ? r->row[n - 1][i] : 0; }
        }
    }
}

double recording_row_hz(const struct recording *r)
{
    return r->t_s != NULL && r->rows > 1 ? (double)(r->rows - 1) / r->t_s[r->rows - 1] : 0;
}

long recording_gaps(const struct recording *r)
{
    const double hz = recording_row_hz(r);
    long gaps = 0;
    for (long n = 1; hz > 0 && n < r->rows; n++) { gaps += (r->t_s[n] - r->t_s[n - 1]) * hz > 1.5; }
    return gaps;
}

void recording_free(struct recording *r)
{
    free(r->row);
    free(r->t_s);
    free(r->label);
    memset(r, 0, sizeof *r);
}
