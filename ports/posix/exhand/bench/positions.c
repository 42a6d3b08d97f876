/* SPDX-License-Identifier: MIT */
#include "bench/positions.h"

#include "base/fifo.h"
#include "base/lines.h"
#include "base/option.h"

#include "exhand/quad.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define LINE_B  4096
#define OFF_MAX 0.25 /* of a count: more, and it is another step */
#define BITS    24   /* of the counter that is played */
#define CNT_MAX 1e9

struct positions {
    const char *csv, *name; /* of the column */
    long column;            /* from 1; 0: not found yet */
    double step, off;       /* off: the farthest from a whole count */
    long line, rows, still;
    int32_t first, last, lo, hi, most;
    struct exh_quad quad;
    struct exh_quad_cfg cfg;
};

static int bad(const struct positions *p, const char *what)
{
    cli_complain("%s: line %ld: %s", p->csv, p->line, what);
    return 2;
}

/* Field number n of a line, from 1; NULL: it has fewer. Its length without blanks around. */
static const char *field(const char *line, long n, size_t *len)
{
    for (; n > 1; n--) {
        line += strcspn(line, ",");
        if (*line == '\0') { return NULL; }
        line++;
    }
    line += strspn(line, " \t");
    *len = strcspn(line, ",");
    while (*len > 0 && (line[*len - 1] == ' ' || line[*len - 1] == '\t')) { --*len; }
    return line;
}

static int find_column(struct positions *p, const char *names)
{
    const char *at;
    size_t len;
    for (long n = 1; (at = field(names, n, &len)) != NULL; n++) {
        if (len == strlen(p->name) && strncmp(at, p->name, len) == 0) {
            p->column = n;
            return 0;
        }
    }
    cli_complain("--position: %s: its first line has no %s", p->csv, p->name);
    return 2;
}

/* Through the counter that a card would have shown. */
static void count(struct positions *p, int32_t cnt)
{
    const int32_t was = p->last;
    p->last = exh_quad_step(&p->quad, &p->cfg, (uint32_t)cnt & ((1u << BITS) - 1));
    if (p->rows++ == 0) {
        p->first = p->lo = p->hi = p->last;
        return;
    }
    p->still += p->last == was;
    if (abs(p->last - was) > p->most) { p->most = abs(p->last - was); }
    if (p->last < p->lo) { p->lo = p->last; }
    if (p->last > p->hi) { p->hi = p->last; }
}

static int take_line(struct positions *p, const char *line)
{
    size_t len = 0;
    const char *at = field(line, p->column, &len);
    char *end = NULL;
    const double v = at ? strtod(at, &end) / p->step : 0;
    const double whole = floor(v + 0.5);
    if (at == NULL || end == at || end != at + len || !(fabs(v) < CNT_MAX)) {
        return bad(p, "no number in the column of --position");
    }
    if (fabs(v - whole) > p->off) { p->off = fabs(v - whole); }
    if (p->off > OFF_MAX) {
        return bad(p, "not a whole count: give --step, the unit of one count");
    }
    count(p, (int32_t)whole);
    return 0;
}

static int read_all(struct positions *p, FILE *f)
{
    char line[LINE_B];
    int err = 0, more;
    while (err == 0 && (more = lines_next(f, line, sizeof line)) != 0) {
        p->line++;
        if (more < 0) {
            err = bad(p, "far too long");
        } else if (p->column == 0) {
            err = find_column(p, line);
        } else if (line[strspn(line, " \t")] != '\0') {
            char *end;
            (void)strtod(line, &end);
            if (end == line && p->line == 1) { continue; } /* names */
            err = take_line(p, line);
        }
    }
    if (err == 0 && p->rows == 0) {
        cli_complain("%s: holds no row", p->csv);
        err = 2;
    }
    return err;
}

int positions_print(const char *csv, const char *column, double step)
{
    static const struct exh_quad_par par = {EXH_Q(1, 1000000, EXH_Q_STEP), EXH_Q(15, 1, EXH_Q_VEL)};
    struct positions p = {.csv = csv, .name = column, .step = step};
    char *end;
    FILE *f = strcmp(csv, "-") == 0 ? stdin : fifo_read(csv);
    int err;
    if (f == NULL) {
        cli_complain("%s: %s", csv, strerror(errno));
        return 3;
    }
    p.column = strtol(column, &end, 10);
    if (end == column || *end != '\0' || p.column < 1) { p.column = 0; }
    err = exh_quad_setup(&p.cfg, &par, (struct exh_period){1, 10}, BITS) < 0;
    if (err == 0) { err = read_all(&p, f); }
    if (f != stdin) { fclose(f); }
    if (err == 0) {
        printf("rows=%ld net=%ld low=%ld high=%ld most=%ld still=%.1f%% off=%.2g\n", p.rows,
            (long)(p.last - p.first), (long)p.lo, (long)p.hi, (long)p.most,
            100.0 * (double)p.still / (double)(p.rows > 1 ? p.rows - 1 : 1), p.off);
    }
    return err;
}
