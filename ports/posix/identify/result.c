/* SPDX-License-Identifier: MIT */
#include "identify/result.h"

#include "base/fifo.h"
#include "base/option.h"
#include "identify/estimate.h"

#include <errno.h>
#include <stddef.h>
#include <string.h>

#define HEAD "exhand identify 2"

/* Lines of one value. */
static const struct {
    const char *name, *unit;
    double min, max;
    size_t at;
} single[] = {
    {"rate", "hz", 1, 20000, offsetof(struct result_file, rate_Hz)},
    {"known_mass", "kg", 0.001, 5, offsetof(struct result_file, mass_kg)},
    {"residual", "", 0, RESULT_RESIDUAL_MAX, offsetof(struct result_file, residual)},
    {"monitor_lag", "s", 0, 0.01, offsetof(struct result_file, monitor_lag_s)},
};
#define SINGLES (sizeof single / sizeof single[0])

/* Lines of a value and its interval: of the model's, then of their sum. */
#define ROWS (MODEL_PARS + 1)
static const struct model_row sum_row = {"mu_both", "", 0, 4, 0};
#define SUM_OFF 1e-5 /* allowed difference from the sum of the two others: cut digits */

static const struct model_row *row_of(int i) { return i < MODEL_PARS ? &model_row[i] : &sum_row; }

/* A lower lag lets more through, so use the lower bound: no false rest. */
static double at_least(const struct lag *lag)
{
    const double s = lag->monitor_s - 2 * lag->monitor_error_s;
    return s > 0 ? s : 0;
}

void result_take(struct result_file *r, const struct estimate_of *e, double T_s, double mass_kg)
{
    const struct fit *f = &e->fit;
    memset(r, 0, sizeof *r);
    r->rate_Hz = 1 / T_s;
    r->mass_kg = mass_kg;
    r->residual = f->cost;
    r->monitor_lag_s = e->lag_told ? at_least(&e->lag) : 0;
    r->value = f->at;
    for (int i = 0; i < MODEL_PARS; i++) {
        const double low = f->low[i], high = f->high[i];
        r->low.value[i] = low < model_row[i].min ? model_row[i].min : low;
        r->high.value[i] = high > model_row[i].max ? model_row[i].max : high;
    }
    r->mu_low = f->mu_low;
    r->mu_high = f->mu_high > sum_row.max ? sum_row.max : f->mu_high;
}

void result_write(FILE *f, const struct result_file *r)
{
    fprintf(f,
        HEAD "\n# value, low and high of its 95 %% interval, unit\n"
             "rate = %.9g hz\nknown_mass = %.9g kg\nresidual = %.4g\n"
             "monitor_lag = %.4g s\n",
        r->rate_Hz, r->mass_kg, r->residual, r->monitor_lag_s);
    for (int i = 0; i < MODEL_PARS; i++) {
        fprintf(f, "%s = %.7g %.7g %.7g%s%s\n", model_row[i].name, r->value.value[i],
            r->low.value[i], r->high.value[i], model_row[i].unit[0] ? " " : "", model_row[i].unit);
    }
    fprintf(f, "%s = %.7g %.7g %.7g\n", sum_row.name, model_mu(&r->value), r->mu_low, r->mu_high);
}

static int bad(const char *name, int line, const char *what)
{
    cli_complain("%s:%d: %s: give a file that exhand identify wrote", name, line, what);
    return 2;
}

static int finite_in(double v, double min, double max) { return v >= min && v <= max; }

static int take_single(
    struct result_file *r, size_t i, const char *text, const char *name, int line)
{
    char unit[16] = "", more[2];
    unsigned char *to = (unsigned char *)r + single[i].at;
    double v;
    const int n = sscanf(text, "%lf %15s %1s", &v, unit, more);
    if (n != (single[i].unit[0] ? 2 : 1) || strcmp(unit, single[i].unit) != 0) {
        return bad(name, line, "not one value and its unit");
    }
    if (!finite_in(v, single[i].min, single[i].max)) {
        return bad(name, line, "a value outside its range");
    }
    memcpy(to, &v, sizeof v);
    return 0;
}

static int take_row(
    struct result_file *r, double *sum, int i, const char *text, const char *name, int line)
{
    const struct model_row *row = row_of(i);
    char unit[16] = "", more[2];
    double v, low, high;
    const int n = sscanf(text, "%lf %lf %lf %15s %1s", &v, &low, &high, unit, more);
    if (n != (row->unit[0] ? 4 : 3) || strcmp(unit, row->unit) != 0) {
        return bad(name, line, "not value, low, high and its unit");
    }
    if (!finite_in(v, row->min, row->max) || !finite_in(low, row->min, row->max) ||
        !finite_in(high, row->min, row->max)) {
        return bad(name, line, "a value outside its range");
    }
    if (!(low <= v && v <= high)) { return bad(name, line, "a value outside its interval"); }
    if (i == MODEL_PARS) {
        *sum = v;
        r->mu_low = low;
        r->mu_high = high;
        return 0;
    }
    r->value.value[i] = v;
    r->low.value[i] = low;
    r->high.value[i] = high;
    return 0;
}

/* Of single lines, then of rows; -1: no such name. */
static int find(const char *word)
{
    for (size_t i = 0; i < SINGLES; i++) {
        if (strcmp(word, single[i].name) == 0) { return (int)i; }
    }
    for (int i = 0; i < ROWS; i++) {
        if (strcmp(word, row_of(i)->name) == 0) { return (int)SINGLES + i; }
    }
    return -1;
}

static int take_line(struct result_file *r, double *sum, unsigned *seen, const char *text,
    const char *name, int line)
{
    char word[32];
    int at = 0, i;
    if (sscanf(text, " %31[a-z_] = %n", word, &at) != 1 || at == 0) {
        return bad(name, line, "not NAME = VALUE");
    }
    i = find(word);
    if (i < 0) { return bad(name, line, "an unknown name"); }
    if (*seen >> i & 1) { return bad(name, line, "a name that came before"); }
    *seen |= 1u << i;
    return i < (int)SINGLES ? take_single(r, (size_t)i, text + at, name, line)
                            : take_row(r, sum, i - (int)SINGLES, text + at, name, line);
}

int result_parse(struct result_file *r, FILE *f, const char *name)
{
    char text[RESULT_LINE_B];
    double sum = 0, off;
    unsigned seen = 0;
    int line = 0;
    memset(r, 0, sizeof *r);
    while (fgets(text, sizeof text, f)) {
        const size_t n = strcspn(text, "\n");
        int err = 0;
        line++;
        if (text[n] != '\n') { return bad(name, line, "a line without an end"); }
        text[n] = '\0';
        if (line == 1) {
            if (strcmp(text, HEAD) != 0) { return bad(name, line, "not `" HEAD "`"); }
        } else if (text[0] != '#' && text[0] != '\0') {
            err = take_line(r, &sum, &seen, text, name, line);
        }
        if (err) { return err; }
    }
    for (int i = 0; i < (int)SINGLES + ROWS; i++) {
        if (!(seen >> i & 1)) {
            cli_complain("%s: has no %s: give a file that exhand identify wrote", name,
                i < (int)SINGLES ? single[i].name : row_of(i - (int)SINGLES)->name);
            return 2;
        }
    }
    off = sum - model_mu(&r->value);
    if (!finite_in(off, -SUM_OFF, SUM_OFF)) {
        cli_complain(
            "%s: mu_both is not mu_motor + mu_mass: give a file that exhand identify wrote", name);
        return 2;
    }
    return 0;
}

int result_read(struct result_file *r, const char *path)
{
    FILE *f = fifo_read(path);
    int err;
    if (f == NULL) {
        cli_complain(
            "--device: %s: %s: give a file that exhand identify wrote", path, strerror(errno));
        return 2;
    }
    err = result_parse(r, f, path);
    fclose(f);
    return err;
}
