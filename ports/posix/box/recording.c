/* SPDX-License-Identifier: MIT */
#include "box/recording.h"

#include "base/option.h"

#include <errno.h>
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SENSORS EXH_GLOVE_SENSORS
#define FIELD_B RECORDING_NAME_B
#define PI      3.14159265358979323846

struct reader {
    const char *path;
    FILE *f;
    long line; /* of the field that was read last, from 1 */
    int ended; /* that field was the last of its line */
    int timed; /* the first column is time */
    enum recording_unit unit;
    double lo, hi; /* of all values */
    int whole;     /* all are whole numbers */
    long cap;
    struct recording_sensors at;
    long blank, blanks; /* lines: since the last row; between rows */
    long no_number;
};

enum recording_unit recording_unit_of(const char *name)
{
    static const char *const text[] = {"codes", "rad", "deg", "turn"};
    for (int i = 0; i < 4; i++) {
        if (strcmp(name, text[i]) == 0) { return (enum recording_unit)(i + 1); }
    }
    return RECORDING_GUESS;
}

/* --- lines --- */

static int bad(const struct reader *in, int column, const char *what)
{
    if (column > 0) {
        cli_complain("%s: line %ld, column %d: %s", in->path, in->line, column, what);
    } else {
        cli_complain("%s: line %ld: %s", in->path, in->line, what);
    }
    return 2;
}

static int is_separator(int c) { return c == ',' || c == ';' || c == ' ' || c == '\t'; }

/* The next field of the line, without blanks around; 0 at the end of the file. A longer one
 * is cut off, which makes it no number. */
static int next_field(struct reader *in, char to[FIELD_B])
{
    size_t n = 0;
    int c = getc(in->f), blank;
    while (c == ' ' || c == '\t') { c = getc(in->f); }
    for (; c != EOF && c != '\n' && c != '\r' && !is_separator(c); c = getc(in->f)) {
        if (n < FIELD_B - 1) { to[n++] = c == '\0' ? '?' : (char)c; }
    }
    to[n] = '\0';
    blank = c == ' ' || c == '\t';
    while (c == ' ' || c == '\t') { c = getc(in->f); }
    if (blank && c != ',' && c != ';' && c != '\n' && c != '\r' && c != EOF) {
        ungetc(c, in->f); /* the blank was the separator */
        c = ' ';
    }
    if (c == '\r') {
        c = getc(in->f);
        if (c != '\n' && c != EOF) { ungetc(c, in->f); }
        c = '\n';
    }
    in->ended = c == '\n' || c == EOF;
    return c != EOF || n > 0;
}

static void skip_line(struct reader *in)
{
    char field[FIELD_B];
    while (!in->ended && next_field(in, field)) {}
}

static int is_number(const char *text, double *v)
{
    char *end;
    *v = strtod(text, &end);
    return end != text && *end == '\0' && strlen(text) < FIELD_B - 1 && *v >= -DBL_MAX &&
           *v <= DBL_MAX;
}

/* Or one that is none, nan or inf. */
static int is_any_number(const char *text)
{
    char *end;
    (void)strtod(text, &end);
    return end != text && *end == '\0' && strlen(text) < FIELD_B - 1;
}

/* Of a sensor: a number, or NAN and counted where there is nothing or none that is finite. */
static int is_value(struct reader *in, const char *text, double *v)
{
    if (is_number(text, v)) { return 1; }
    if (text[0] != '\0' && !is_any_number(text)) { return 0; }
    *v = (double)NAN;
    in->no_number++;
    return 1;
}

/* What a name of the header says of the unit. */
static void take_name(struct reader *in, const char *name)
{
    const char *unit = strrchr(name, '_');
    if (in->unit == RECORDING_GUESS && unit != NULL) { in->unit = recording_unit_of(unit + 1); }
}

static int no_number(const struct reader *in, int column, const char *field)
{
    char text[FIELD_B + 40], plain[FIELD_B];
    size_t n = 0;
    for (; field[n]; n++) { plain[n] = field[n] >= ' ' && field[n] <= '~' ? field[n] : '?'; }
    plain[n] = '\0'; /* what is no text must not reach a terminal */
    snprintf(text, sizeof text, "\"%s\" is no number", plain);
    return bad(in, column, text);
}

/* The first line, if it is a header. Its first field has been read. A number behind that one
 * says that it is a row, which must not get lost as if it were a header. */
static int names_missing(const struct reader *in)
{
    for (int i = 0; in->at.given && i < SENSORS; i++) {
        if (in->at.column[i] == 0) {
            cli_complain("%s: --columns: its header has no %s", in->path, in->at.name[i]);
            return 2;
        }
    }
    return 0;
}

/* Names that were asked for. */
static int take_names(struct reader *in, const char *first)
{
    char name[FIELD_B];
    strcpy(name, first);
    for (int column = 1;; column++) {
        for (int i = 0; i < SENSORS; i++) {
            if (in->at.column[i] == 0 && strcmp(in->at.name[i], name) == 0) {
                in->at.column[i] = column;
                if (in->unit == RECORDING_GUESS) { take_name(in, name); }
            }
        }
        if (in->ended || !next_field(in, name)) { return names_missing(in); }
    }
}

static int take_header(struct reader *in, const char *first)
{
    char name[FIELD_B], *end = name;
    if (in->at.given) { return take_names(in, first); }
    in->timed = strcmp(first, "t_s") == 0;
    if (in->ended || !next_field(in, name)) { return 0; }
    (void)strtod(name, &end);
    if (end != name && *end == '\0') { return no_number(in, 1, first); }
    if (in->timed) { take_name(in, name); }
    skip_line(in);
    return 0;
}

static int store(struct reader *in, struct recording *r, const double value[SENSORS])
{
    if (r->rows == in->cap) {
        const long cap = in->cap ? 2 * in->cap : 1024;
        double(*more)[SENSORS] = realloc(r->row, (size_t)cap * sizeof *more);
        if (more == NULL) { return bad(in, 0, "out of memory"); }
        r->row = more;
        in->cap = cap;
    }
    memcpy(r->row[r->rows++], value, SENSORS * sizeof *value);
    in->blanks += r->rows > 1 ? in->blank : 0;
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

/* A row of the columns that were asked for; its first field has been read. */
static int take_asked(struct reader *in, struct recording *r, char field[FIELD_B])
{
    double value[SENSORS];
    char text[80];
    int column = 1, got = 0;
    for (;; column++) {
        for (int i = 0; i < SENSORS; i++) {
            if (in->at.column[i] != column) { continue; }
            if (!is_value(in, field, &value[i])) { return no_number(in, column, field); }
            value[i] = in->at.gain * value[i] + in->at.offset;
            got++;
        }
        if (in->ended || !next_field(in, field)) { break; }
    }
    if (got == SENSORS) { return store(in, r, value); }
    snprintf(text, sizeof text, "%d columns: %d of the %d asked for", column, got, SENSORS);
    return bad(in, 0, text);
}

/* A row whose first field has been read. */
static int take_row(struct reader *in, struct recording *r, char field[FIELD_B])
{
    const int first = in->timed ? 2 : 1;
    double value[SENSORS], ignored;
    char text[80];
    int column;
    for (column = 1;; column++) {
        double *to = column >= first ? &value[column - first] : &ignored;
        if (!(column >= first ? is_value(in, field, to) : is_number(field, to))) {
            return no_number(in, column, field);
        }
        if (column >= first) { *to = in->at.gain * *to + in->at.offset; }
        if (column - first == SENSORS - 1) { break; }
        if (in->ended || !next_field(in, field)) {
            snprintf(text, sizeof text, "%d columns (%d wanted)", column, SENSORS + first - 1);
            return bad(in, 0, text);
        }
    }
    if (!in->ended && !in->timed && next_field(in, field) &&
        (!in->ended || is_number(field, &ignored))) {
        snprintf(
            text, sizeof text, "more than %d columns and a label: --columns says which", SENSORS);
        return bad(in, 0, text);
    }
    skip_line(in);
    return store(in, r, value);
}

/* Guessed, checked, and angles in rad. */
static int settle_unit(struct reader *in, struct recording *r)
{
    static const double scale[] = {0, 1, 1, PI / 180, 2 * PI};
    const int codes = in->unit == RECORDING_CODES || in->at.scaled ||
                      (in->unit == RECORDING_GUESS && in->whole && (in->hi > PI || in->lo < -PI));
    const double unit = in->unit == RECORDING_GUESS ? 1 : scale[in->unit];
    r->codes = codes;
    if (codes && (in->lo < -32768 || in->hi > 32767 || (!in->whole && !in->at.scaled))) {
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

static int read_rows(struct reader *in, struct recording *r)
{
    char field[FIELD_B];
    int err = 0;
    for (in->line = 1; err == 0 && next_field(in, field); in->line++) {
        if (in->line == 1 && strncmp(field, "\xEF\xBB\xBF", 3) == 0) {
            memmove(field, field + 3, strlen(field + 3) + 1); /* a byte order mark */
        }
        if (field[0] == '\0' && in->ended) {
            in->blank++;
            continue;
        }
        if (r->rows == 0 && in->line == 1 && !is_any_number(field)) {
            err = take_header(in, field);
        } else if (in->at.given) {
            err = r->rows ? 0 : names_missing(in);
            if (err == 0) { err = take_asked(in, r, field); }
        } else {
            err = take_row(in, r, field);
        }
    }
    if (err == 0 && ferror(in->f)) { err = bad(in, 0, strerror(errno)); }
    if (err == 0 && r->rows == 0) {
        cli_complain("%s: holds no row", in->path);
        err = 2;
    }
    return err;
}

/* What was passed over, said once. */
static void say(const struct reader *in, long rows)
{
    if (in->no_number) {
        cli_complain("%s: %ld of %ld values are no number: faults of their channels in their rows",
            in->path, in->no_number, rows * SENSORS);
    }
    if (in->blanks) {
        cli_complain(
            "%s: %ld empty lines between rows: no time goes by in them", in->path, in->blanks);
    }
}

int recording_read(struct recording *r, const char *path, const struct recording_ask *ask)
{
    const int standard = strcmp(path, "-") == 0;
    struct reader in;
    int err;
    memset(r, 0, sizeof *r);
    memset(&in, 0, sizeof in);
    in.path = standard ? "standard input" : path;
    in.unit = ask->unit;
    in.whole = 1;
    in.lo = DBL_MAX;
    in.hi = -DBL_MAX;
    err = recording_sensors_of(&in.at, ask);
    if (err) { return err; }
    in.f = standard ? stdin : fopen(path, "rb");
    if (in.f == NULL) {
        cli_complain("%s: %s: give a recording, 22 codes or angles a line", path, strerror(errno));
        return 3;
    }
    err = read_rows(&in, r);
    if (!standard) { fclose(in.f); }
    if (err == 0) { err = settle_unit(&in, r); }
    if (err == 0) { say(&in, r->rows); }
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

void recording_free(struct recording *r)
{
    free(r->row);
    r->row = NULL;
}
