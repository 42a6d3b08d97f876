/* SPDX-License-Identifier: MIT */
#include "trace.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define LINE_B      512
#define PATH_MAX_B  1024
#define DELAY_MAX_S 1e6
#define STAMP_HZ    44100.0

/* --- a file, or what xz makes of it --- */

static int is_xz(const char *path)
{
    const size_t n = strlen(path);
    return n > 3 && strcmp(path + n - 3, ".xz") == 0;
}

/* The path in single quotes, with each of its quotes as '\''. */
static FILE *unpacked(const char *path)
{
    char command[2 * PATH_MAX_B] = "xz -dc -- '";
    size_t n = strlen(command);
    for (; *path != '\0' && n < sizeof command - 8; path++) {
        if (*path == '\'') {
            memcpy(command + n, "'\\''", 4);
            n += 4;
        } else {
            command[n++] = *path;
        }
    }
    if (*path != '\0') {
        errno = ENAMETOOLONG;
        return NULL;
    }
    memcpy(command + n, "'", 2);
    return popen(command, "r");
}

/* --- lines --- */

struct reader {
    enum sim_trace_kind kind;
    long cap;
    double first_ns, first_stamp; /* of the first arrival */
};

static int is_blank(const char *text) { return text[strspn(text, " \t\r\n")] == '\0'; }

static int put(struct sim_trace *t, struct reader *in, double delay_s)
{
    if (t->n == in->cap) {
        const long cap = in->cap ? 2 * in->cap : 1024;
        double *more = realloc(t->delay_s, (size_t)cap * sizeof *more);
        if (more == NULL) { return -1; }
        t->delay_s = more;
        in->cap = cap;
    }
    t->delay_s[t->n++] = delay_s;
    return 0;
}

/* One packet a line. 0, or what is wrong. */
static const char *take_ms(struct sim_trace *t, struct reader *in, char *line)
{
    char *end;
    double ms;
    line[strcspn(line, "#")] = '\0';
    if (is_blank(line)) { return NULL; }
    line += strspn(line, " \t");
    if (strncmp(line, "lost", 4) == 0 && is_blank(line + 4)) {
        return put(t, in, SIM_TRACE_LOST) < 0 ? "out of memory" : NULL;
    }
    ms = strtod(line, &end);
    if (end == line || !is_blank(end)) { return "no number"; }
    if (!(ms >= 0 && ms <= DELAY_MAX_S * 1e3)) { return "a delay is 0 .. 1e9 ms"; }
    return put(t, in, ms / 1e3) < 0 ? "out of memory" : NULL;
}

/* Up to n numbers behind the letter; how many there were. */
static int fields(const char *line, double *v, int n)
{
    int got = 0;
    for (line++; got < n && *line == ','; got++) {
        char *end;
        v[got] = strtod(line + 1, &end);
        if (end == line + 1) { break; }
        line = end;
    }
    return got;
}

static const char *take_csv(struct sim_trace *t, struct reader *in, const char *line)
{
    double v[2], delay_s;
    if (line[0] != (in->kind == SIM_TRACE_ROUND ? 'r' : 'm')) { return NULL; }
    if (fields(line, v, 2) < 2) { return "two numbers are wanted behind the letter"; }
    if (in->kind == SIM_TRACE_ROUND) {
        delay_s = v[1] / 1e9;
        if (!(delay_s >= 0 && delay_s <= DELAY_MAX_S)) { return "no round trip"; }
    } else {
        if (t->n == 0) {
            in->first_ns = v[0];
            in->first_stamp = v[1];
        }
        delay_s = (v[0] - in->first_ns) / 1e9 - (v[1] - in->first_stamp) / STAMP_HZ;
        if (!(delay_s > -DELAY_MAX_S && delay_s < DELAY_MAX_S)) { return "no arrival"; }
    }
    return put(t, in, delay_s) < 0 ? "out of memory" : NULL;
}

/* Arrivals: above the quickest. */
static void settle(struct sim_trace *t, const struct reader *in)
{
    double least = t->delay_s[0];
    if (in->kind != SIM_TRACE_ARRIVAL) { return; }
    for (long n = 1; n < t->n; n++) { least = t->delay_s[n] < least ? t->delay_s[n] : least; }
    for (long n = 0; n < t->n; n++) { t->delay_s[n] -= least; }
}

/* --- all of it --- */

static int refuse(
    struct sim_trace *t, char *why, size_t why_B, const char *path, long line, const char *what)
{
    if (line > 0) {
        snprintf(why, why_B, "%s: line %ld: %s", path, line, what);
    } else {
        snprintf(why, why_B, "%s: %s", path, what);
    }
    sim_trace_free(t);
    return -1;
}

int sim_trace_read(
    struct sim_trace *t, const char *path, enum sim_trace_kind kind, char *why, size_t why_B)
{
    struct reader in = {kind, 0, 0, 0};
    const char *what = NULL;
    const int xz = is_xz(path);
    char line[LINE_B];
    long number = 0;
    int bad = 0;
    FILE *f = fopen(path, "r");
    t->delay_s = NULL;
    t->n = 0;
    if (f != NULL && xz) {
        fclose(f);
        f = unpacked(path);
    }
    if (f == NULL) { return refuse(t, why, why_B, path, 0, strerror(errno)); }
    while (what == NULL && fgets(line, sizeof line, f) != NULL) {
        number++;
        if (strchr(line, '\n') == NULL && !feof(f)) {
            what = "it does not end: give a text of rows";
            break;
        }
        what = kind == SIM_TRACE_MS ? take_ms(t, &in, line) : take_csv(t, &in, line);
    }
    bad = ferror(f);
    if (what != NULL) { /* the rest is of no use, but xz is to end in peace */
        while (xz && fgets(line, sizeof line, f) != NULL) {}
    }
    if (xz) {
        bad |= pclose(f) != 0;
    } else {
        fclose(f);
    }
    if (what != NULL) { return refuse(t, why, why_B, path, number, what); }
    if (bad) {
        return refuse(t, why, why_B, path, 0, xz ? "xz cannot unpack it" : "cannot be read");
    }
    if (t->n == 0) { return refuse(t, why, why_B, path, 0, "holds no packet"); }
    settle(t, &in);
    return 0;
}

void sim_trace_free(struct sim_trace *t)
{
    free(t->delay_s);
    t->delay_s = NULL;
    t->n = 0;
}

int sim_trace_write(const struct sim_trace *t, const char *path)
{
    FILE *f = fopen(path, "w");
    int bad = 0;
    if (f == NULL) { return -1; }
    fprintf(f, "# delay of each packet, ms\n");
    for (long n = 0; n < t->n; n++) {
        if (t->delay_s[n] < 0) {
            fprintf(f, "lost\n");
        } else {
            fprintf(f, "%.9g\n", t->delay_s[n] * 1e3);
        }
    }
    bad = ferror(f);
    return fclose(f) != 0 || bad ? -1 : 0;
}
