/* SPDX-License-Identifier: MIT */
#include "lab/drop/cells.h"

#include "base/option.h"
#include "base/outfile.h"

#include <errno.h>
#include <fcntl.h>
#include <float.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define LINE_B 4096 /* the settings are the longest */

static const char header[] = "rate_hz,ray,gain,k_n_per_m,b_ns_per_m,resting_falls,falls,rho\n";

/* --- in memory --- */

static int same(double a, double b)
{
    const double off = a < b ? b - a : a - b;
    return off <= 1e-6 * (a < 0 ? -a : a) + 1e-9; /* a file gives nine digits */
}

static int compare(const struct cell *a, const struct cell *b)
{
    const double left[] = {a->rate_Hz, a->ray, a->gain};
    const double right[] = {b->rate_Hz, b->ray, b->gain};
    for (int i = 0; i < 3; i++) {
        if (!same(left[i], right[i])) { return left[i] < right[i] ? -1 : 1; }
    }
    return 0;
}

/* Where it is, or belongs. */
static int place(const struct cells *c, const struct cell *key)
{
    int low = 0, high = c->n;
    while (low < high) {
        const int mid = (low + high) / 2;
        if (compare(&c->at[mid], key) < 0) {
            low = mid + 1;
        } else {
            high = mid;
        }
    }
    return low;
}

const struct cell *cells_find(const struct cells *c, double rate_Hz, int ray, double gain)
{
    const struct cell key = {rate_Hz, ray, gain, 0, 0, 0, 0, 0};
    const int i = place(c, &key);
    return i < c->n && compare(&c->at[i], &key) == 0 ? &c->at[i] : NULL;
}

int cells_add(struct cells *c, const struct cell *add)
{
    if (c->n == c->cap) {
        const int cap = c->cap ? 2 * c->cap : 1024;
        struct cell *more = realloc(c->at, (size_t)cap * sizeof *more);
        if (more == NULL) {
            cli_complain("out of memory for %d cells: a smaller --grid", cap);
            return 1;
        }
        c->at = more;
        c->cap = cap;
    }
    c->at[c->n++] = *add;
    return 0;
}

static int compare_any(const void *a, const void *b) { return compare(a, b); }

void cells_sort(struct cells *c)
{
    int n = 0;
    if (c->n > 1) { qsort(c->at, (size_t)c->n, sizeof *c->at, compare_any); }
    for (int i = 0; i < c->n; i++) {
        if (n == 0 || compare(&c->at[n - 1], &c->at[i]) != 0) { c->at[n++] = c->at[i]; }
    }
    c->n = n;
}

void cells_free(struct cells *c)
{
    free(c->at);
    memset(c, 0, sizeof *c);
}

/* --- a line --- */

static void format(char line[LINE_B], const struct cell *c)
{
    int n = snprintf(line, LINE_B, "%.9g,%d,%.9g,%.9g,%.9g,%d,%d,", c->rate_Hz, c->ray, c->gain,
        c->k_Npm, c->b_Nspm, c->resting, c->falls);
    if (c->rho >= 0) { n += snprintf(line + n, LINE_B - (size_t)n, "%.6f", c->rho); }
    snprintf(line + n, LINE_B - (size_t)n, "\n");
}

/* A field up to its comma or the end of the line; an empty one is `none`. */
static int take(const char **at, char end, double none, double *v)
{
    char *stop;
    if (**at == end) {
        *v = none;
    } else {
        *v = strtod(*at, &stop);
        if (stop == *at || *stop != end) { return 0; }
        *at = stop;
    }
    ++*at;
    return 1;
}

static int within(double v, double lo, double hi) { return v >= lo && v <= hi; }

static int parse(const char *line, struct cell *c)
{
    double ray, resting, falls;
    const int ok = take(&line, ',', -1, &c->rate_Hz) && take(&line, ',', -1, &ray) &&
                   take(&line, ',', -1, &c->gain) && take(&line, ',', -1, &c->k_Npm) &&
                   take(&line, ',', -1, &c->b_Nspm) && take(&line, ',', -1, &resting) &&
                   take(&line, ',', -1, &falls) && take(&line, '\n', -1, &c->rho) && *line == '\0';
    if (!ok || !within(c->rate_Hz, 1, 20000) || !within(ray, 0, 1e6) || !within(c->gain, 0, 1e6) ||
        !within(c->k_Npm, 0, 1e6) || !within(c->b_Nspm, 0, 1e3) || !within(falls, 1, 1e6) ||
        !within(resting, 0, falls) || !within(c->rho, -1, DBL_MAX)) {
        return 0;
    }
    c->ray = (int)ray;
    c->resting = (int)resting;
    c->falls = (int)falls;
    return 1;
}

/* --- a file --- */

/* The first word in which two lines of settings differ, NAME=VALUE each; one may end. */
static int other_settings(const char *path, const char *there, const char *here)
{
    int start = 0, i = 0;
    for (; there[i] == here[i] && there[i] != '\0'; i++) {
        if (there[i] == ' ') { start = i + 1; }
    }
    if (there[i] + here[i] == ' ') { start = i; } /* one has ended, with a whole word */
    there += start + (there[start] == ' ');
    here += start + (here[start] == ' ');
    cli_complain("%s: made with %.*s, not with %.*s: choose another --out, or remove the file",
        path, *there ? (int)strcspn(there, " ") : 15, *there ? there : "nothing further",
        *here ? (int)strcspn(here, " ") : 15, *here ? here : "nothing further");
    return 2;
}

static int load(struct cells *c, FILE *f, const char *path)
{
    char line[LINE_B];
    int number = 0;
    while (fgets(line, sizeof line, f) != NULL) {
        struct cell cell;
        number++;
        if (strchr(line, '\n') == NULL && feof(f)) { break; } /* cut off: its cell is run again */
        if (number == 1 && (line[0] != '#' || strncmp(line, "# exhand", 8) != 0)) {
            cli_complain("%s: not a file of a sweep: choose another --out, or remove it", path);
            return 2;
        }
        if (line[0] == '#') {
            line[strcspn(line, "\n")] = '\0';
            if (strcmp(line, c->settings) != 0) { return other_settings(path, line, c->settings); }
        } else if (strcmp(line, header) != 0) {
            if (!parse(line, &cell)) {
                cli_complain("%s:%d: %.40s: no cell: remove this line, it will be run again", path,
                    number, line);
                return 2;
            }
            if (cells_add(c, &cell)) { return 1; }
        }
    }
    if (!ferror(f)) { return 0; }
    cli_complain("%s: can't be read: %s", path, strerror(errno));
    return 1;
}

int cells_load(struct cells *c, const char *path)
{
    FILE *f = fopen(path, "r");
    int err;
    if (f == NULL && errno == ENOENT) { return 0; }
    if (f == NULL) {
        cli_complain("%s: %s", path, strerror(errno));
        return 1;
    }
    err = load(c, f, path);
    fclose(f);
    cells_sort(c);
    return err;
}

static FILE *put_all(const struct cells *c, const char *path)
{
    char line[LINE_B];
    FILE *f = outfile_open("out", path);
    if (f == NULL) { return NULL; }
    fprintf(f, "%s\n%s", c->settings, header);
    for (int i = 0; i < c->n; i++) {
        format(line, &c->at[i]);
        fputs(line, f);
    }
    return f;
}

int cells_save(const struct cells *c, const char *path)
{
    FILE *f = put_all(c, path);
    return f == NULL || outfile_close(f) != 0;
}

FILE *cells_grow(const struct cells *c, const char *path)
{
    FILE *f = put_all(c, path);
    if (f == NULL) { return NULL; }
    if (outfile_goes_on(f) == 0 && fcntl(fileno(f), F_SETFL, O_APPEND) == 0) { return f; }
    outfile_abandon(f);
    return NULL;
}

int cells_append(int fd, const char *path, const struct cell *c)
{
    char line[LINE_B];
    size_t n;
    format(line, c);
    n = strlen(line);
    if (write(fd, line, n) == (ssize_t)n) { return 0; }
    cli_complain("%s: can't be written: %s", path, strerror(errno));
    return 1;
}
