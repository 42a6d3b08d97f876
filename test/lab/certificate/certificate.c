/* SPDX-License-Identifier: MIT */
/* exhand-lab certificate: random devices. `exhand identify` finds the parameters of each, the
 * advisor reads its file, and runs inside the rule follow. A file keeps the results, so that an
 * interrupted run can go on. */
#include "lab/lab.h"

#include "base/jobs.h"
#include "base/option.h"
#include "lab/certificate/one.h"

#include "posix.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#define DEVICES_MAX 1000
#define LINE_B      2048

struct certificate {
    struct one_opt o;
    int64_t devices, jobs, grid;
    const char *path;
    struct one one[DEVICES_MAX];
    int todo[DEVICES_MAX];
};

/* --- a line a device --- */

static void print(FILE *f, const struct one_opt *o, int i, const struct one *r)
{
    char line[LINE_B];
    int n = snprintf(line, sizeof line, "%d,%d,%d,%d,%d,%d,%d,%d,%d,%d,%d,%d,%d,%.4g,%.5g,%.5g",
        (int)o->seed, (int)o->rate_Hz, o->grid, i, r->failed, r->fits, r->advised, r->runs[0],
        r->single[0], r->unstable[0], r->runs[1], r->single[1], r->unstable[1], r->mass_kg,
        r->device_s, r->residual);
    for (int p = 0; p < ONE_PLACES; p++) {
        n += snprintf(line + n, sizeof line - (size_t)n, ",%d,%d", r->stable[p], r->covered[p]);
    }
    for (int p = 0; p < ONE_VALUES; p++) {
        n += snprintf(line + n, sizeof line - (size_t)n, ",%.7g,%.7g,%.7g,%.7g", r->truth[p],
            r->value[p], r->low[p], r->high[p]);
    }
    fprintf(f, "%s\n", line);
}

static int parse(const char *line, const struct one_opt *o, int *i, struct one *r)
{
    int seed, rate, grid, at = 0;
    memset(r, 0, sizeof *r);
    if (sscanf(line, "%d,%d,%d,%d,%d,%d,%d,%d,%d,%d,%d,%d,%d,%lf,%lf,%lf%n", &seed, &rate, &grid, i,
            &r->failed, &r->fits, &r->advised, &r->runs[0], &r->single[0], &r->unstable[0],
            &r->runs[1], &r->single[1], &r->unstable[1], &r->mass_kg, &r->device_s, &r->residual,
            &at) != 16 ||
        seed != o->seed || rate != o->rate_Hz || grid != o->grid || *i < 0 || *i >= DEVICES_MAX) {
        return 0;
    }
    for (int p = 0; p < ONE_PLACES; p++) {
        int n = 0;
        line += at;
        if (sscanf(line, ",%d,%d%n", &r->stable[p], &r->covered[p], &n) != 2) { return 0; }
        at = n;
    }
    for (int p = 0; p < ONE_VALUES; p++) {
        int n = 0;
        line += at;
        if (sscanf(line, ",%lf,%lf,%lf,%lf%n", &r->truth[p], &r->value[p], &r->low[p], &r->high[p],
                &n) != 4) {
            return 0;
        }
        at = n;
    }
    r->done = strchr(line, '\n') != NULL;
    return r->done;
}

static void load(struct certificate *c)
{
    char line[LINE_B];
    FILE *f = c->path ? fopen(c->path, "r") : NULL;
    while (f && fgets(line, sizeof line, f)) {
        struct one r;
        int i;
        if (parse(line, &c->o, &i, &r)) { c->one[i] = r; }
    }
    if (f) { fclose(f); }
}

/* --- the table --- */

static int rising(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

struct sums {
    int devices, ran, fit, advised, runs[ONE_WHERES], single[ONE_WHERES], unstable[ONE_WHERES], hit,
        values;
    double share[ONE_PLACES][DEVICES_MAX]; /* of all devices: 0 where there is no rule */
    double ruled[DEVICES_MAX], most_s;     /* at sixteen places, of those with a rule */
};

/* Whether it has intervals: a model that fits may still have none. */
static int told(const struct one *r) { return r->fits && r->truth[MODEL_ROTOR] > 0; }

static struct sums sums_of(const struct certificate *c)
{
    static struct sums s;
    memset(&s, 0, sizeof s);
    for (int i = 0; i < c->devices; i++) {
        const struct one *r = &c->one[i];
        if (!r->done) { continue; }
        for (int p = 0; p < ONE_PLACES; p++) {
            s.share[p][s.devices] = r->stable[p] > 0 ? (double)r->covered[p] / r->stable[p] : 0;
        }
        if (r->advised) { s.ruled[s.advised++] = s.share[ONE_SIXTEEN][s.devices]; }
        s.devices++;
        s.ran += !r->failed;
        s.fit += r->fits;
        for (int w = 0; w < ONE_WHERES; w++) {
            s.runs[w] += r->runs[w];
            s.single[w] += r->single[w];
            s.unstable[w] += r->unstable[w];
        }
        if (r->device_s > s.most_s) { s.most_s = r->device_s; }
        for (int p = 0; told(r) && p < ONE_VALUES; p++) {
            s.values++;
            s.hit += r->low[p] <= r->truth[p] && r->truth[p] <= r->high[p];
        }
    }
    for (int p = 0; p < ONE_PLACES; p++) {
        qsort(s.share[p], (size_t)s.devices, sizeof s.share[p][0], rising);
    }
    qsort(s.ruled, (size_t)s.advised, sizeof s.ruled[0], rising);
    return s;
}

static void coverage(const struct certificate *c)
{
    printf("| value | unit | truth inside its interval | half the interval, median |\n"
           "|--|--|--|--|\n");
    for (int p = 0; p < ONE_VALUES; p++) {
        double half[DEVICES_MAX];
        int n = 0, hit = 0;
        for (int i = 0; i < c->devices; i++) {
            const struct one *r = &c->one[i];
            if (!r->done || !told(r) || !(r->truth[p] > 0)) { continue; }
            hit += r->low[p] <= r->truth[p] && r->truth[p] <= r->high[p];
            half[n++] = (r->high[p] - r->low[p]) / 2 / r->truth[p];
        }
        qsort(half, (size_t)n, sizeof half[0], rising);
        printf("| %s | %s | %.1f %% of %d | %.2g %% |\n",
            p == ONE_MU_BOTH ? "mu_both" : model_row[p].name,
            p == ONE_MU_BOTH ? "" : model_row[p].unit, n ? 100.0 * hit / n : 0, n,
            n ? 100 * half[n / 2] : 0);
    }
}

/* 1: what was promised does not hold. */
static int table(const struct certificate *c)
{
    const struct sums s = sums_of(c);
    const double hit = s.values ? 100.0 * s.hit / s.values : 0;
    const double median = s.share[ONE_SIXTEEN][s.devices / 2],
                 tenth = s.share[ONE_SIXTEEN][s.devices / 10];
    const int ok[] = {hit >= 93 && hit <= 97, s.unstable[0] == 0 && s.runs[0] > 0, median >= 0.8,
        tenth >= 0.5, s.most_s <= 120};
    int bad = 0;
    coverage(c);
    printf("\n| of %d random devices (seed %d, %d Hz) | found | wanted | |\n|--|--|--|--|\n",
        s.devices, (int)c->o.seed, (int)c->o.rate_Hz);
    printf("| the scene ran to its end; the model fits, and a rule | %d; %d, %d | | |\n", s.ran,
        s.fit, s.advised);
    printf("| truth inside its interval | %.1f %% of %d | 93 .. 97 %% | %s |\n", hit, s.values,
        ok[0] ? "holds" : "NOT");
    if (c->o.grid > 0) {
        printf("| unstable runs inside the rule | %d of %d | 0 | %s |\n", s.unstable[ONE_INSIDE],
            s.runs[ONE_INSIDE], ok[1] ? "holds" : "NOT");
        printf("| unstable runs on its line | %d of %d | | |\n", s.unstable[ONE_LINE],
            s.runs[ONE_LINE]);
        printf("| runs with one fall of ten not at rest, inside; on the line | %d; %d | | |\n",
            s.single[ONE_INSIDE], s.single[ONE_LINE]);
        printf("| stable area allowed, 0 without a rule, median | %.0f %% | >= 80 %% | %s |\n",
            100 * median, ok[2] ? "holds" : "NOT");
        printf("| the same, nine of ten | %.0f %% | >= 50 %% | %s |\n", 100 * tenth,
            ok[3] ? "holds" : "NOT");
        printf("| the same two, of devices with a rule | %.0f, %.0f %% | | |\n",
            100 * s.ruled[s.advised / 2], 100 * s.ruled[s.advised / 10]);
        printf(
            "| of all again, stable as seen at eight places; at four | %.0f, %.0f; %.0f, %.0f %% | "
            "| |\n",
            100 * s.share[ONE_EIGHT][s.devices / 2], 100 * s.share[ONE_EIGHT][s.devices / 10],
            100 * s.share[ONE_FOUR][s.devices / 2], 100 * s.share[ONE_FOUR][s.devices / 10]);
    }
    printf("| time of the device, longest | %.0f s | <= 120 s | %s |\n", s.most_s,
        ok[4] ? "holds" : "NOT");
    for (int i = 0; i < 5; i++) { bad |= !ok[i] && (c->o.grid > 0 || i == 0 || i == 4); }
    return bad;
}

/* --- all of them --- */

static FILE *results(const struct certificate *c)
{
    FILE *f = fopen(c->path, "a");
    if (f == NULL) { cli_complain("--results: %s: %s", c->path, strerror(errno)); }
    return f;
}

static void work(const void *ctx, int n, void *result)
{
    const struct certificate *c = ctx;
    struct one *r = result;
    FILE *f;
    one_run(r, &c->o, c->todo[n]);
    if (!r->done || c->path == NULL) { return; }
    f = results(c);
    if (f == NULL) { return; }
    print(f, &c->o, c->todo[n], r);
    if (fclose(f)) { cli_complain("--results: %s: %s", c->path, strerror(errno)); }
}

static int certify(struct certificate *c)
{
    struct one *fresh;
    struct jobs jobs;
    int n = 0, status;
    load(c);
    for (int i = 0; i < c->devices; i++) {
        if (!c->one[i].done) { c->todo[n++] = i; }
    }
    fresh = calloc(n ? (size_t)n : 1, sizeof *fresh);
    if (fresh == NULL) {
        cli_complain("out of memory");
        return 1;
    }
    jobs =
        (struct jobs){n, (int)c->jobs, sizeof *fresh, fresh, work, c, "devices", posix_interrupt};
    status = n ? jobs_run(&jobs) : 0;
    for (int k = 0; k < n; k++) { c->one[c->todo[k]] = fresh[k]; }
    free(fresh);
    return status ? status : table(c);
}

int cli_certificate(int argc, char **argv)
{
    static struct certificate c;
    const struct cli_option option[] = {
        {"devices", CLI_INT, &c.devices, 1, DEVICES_MAX, "N", "random devices (20)"},
        {"seed", CLI_INT, &c.o.seed, 0, 1e9, "N",
            "of the draw (1; those up to 1400 were developed with)"},
        {"rate", CLI_INT, &c.o.rate_Hz, 100, 20000, "HZ", "loop rate (2000)"},
        {"repeats", CLI_INT, &c.o.repeats, 2, 100, "N", "rounds (the scene's)"},
        {"grid", CLI_INT, &c.grid, 0, 40, "N",
            "N x N runs tell the stable area; 0: no advice (10)"},
        {"results", CLI_TEXT, &c.path, 0, 0, "FILE", "a line a device: goes on behind those there"},
        {"told", CLI_FLAG, &c.o.told, 0, 0, NULL,
            "the advisor is told the device: nothing is identified"},
        {"map", CLI_FLAG, &c.o.map, 0, 0, NULL,
            "the plane of each device: o rests, + is allowed, # both"},
        {"jobs", CLI_INT, &c.jobs, 1, 64, "N", "processes at a time (one a core)"},
    };
    const struct cli_command about = {"certificate", "[options]",
        "Random devices: identify, file, rule; then runs of the drop scene on the device itself,\n"
        "inside of the rule and all over. A pair is stable if every fall rests at 16 places of "
        "the\n"
        "wall between two counts, ten falls a place; a run is unstable if two falls of its ten do\n"
        "not rest. Exit status 1: something promised does not hold.",
        option, (int)(sizeof option / sizeof option[0]), 0};
    int err;
    memset(&c, 0, sizeof c);
    c.devices = 20;
    c.o.seed = 1;
    c.o.rate_Hz = 2000;
    c.grid = 10;
    c.jobs = jobs_cores();
    err = cli_parse(&about, argc, argv, NULL);
    if (err) { return err == 1 ? 0 : err; }
    c.o.grid = (int)c.grid;
    if (c.path) { /* before hours of work */
        FILE *f = results(&c);
        if (f == NULL) { return 2; }
        fclose(f);
    }
    return certify(&c);
}
