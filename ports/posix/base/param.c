/* SPDX-License-Identifier: MIT */
#include "base/param.h"

#include "base/names.h"
#include "base/near.h"
#include "base/option.h"

#include "exhand/error.h"

#include <string.h>

double cli_signal_value(const struct exh_signal *row, int32_t raw)
{
    return (double)raw / (double)(INT64_C(1) << row->frac);
}

const struct exh_signal *cli_signal_find(
    const struct exh_signal_table *t, const char *name, uint32_t *index)
{
    const uint32_t n = exh_signal_count(t);
    for (uint32_t i = 0; i < n; i++) {
        const struct exh_signal *row = exh_signal_at(t, i, NULL);
        if (strcmp(row->name, name) == 0) {
            if (index != NULL) { *index = i; }
            return row;
        }
    }
    return NULL;
}

void cli_setup_complain(const struct exh_params *p, double rate_Hz, int err)
{
    const uint32_t n = exh_signal_count(p->table);
    int named = 0;
    for (uint32_t i = 0; err == -EXH_E_CUTOFF && i < n; i++) {
        const struct exh_signal *row = exh_signal_at(p->table, i, NULL);
        const double fc_Hz = cli_signal_value(row, p->staged[i]);
        const char *end = strstr(row->name, "fc");
        if (end == NULL || end[2] != '\0' || fc_Hz < rate_Hz / 2) { continue; }
        cli_complain("%s: %.6g Hz (below half the rate of %.6g Hz): --set %s=%.4g would do",
            row->name, fc_Hz, rate_Hz, row->name, rate_Hz / 4);
        named = 1;
    }
    if (!named) { cli_complain("%.6g Hz: %s: see --rate and --set", rate_Hz, exh_error_text(err)); }
}

/* Of every finger, material or whatever there are several of. */
static int stage_all(struct exh_params *p, uint16_t id, int32_t raw)
{
    int err = 0;
    for (uint16_t k = 0; err == 0 && (k == 0 || exh_signal_find(p->table, id, k) >= 0); k++) {
        err = exh_params_stage(p, id, k, raw);
    }
    return err;
}

static void no_such(const struct exh_params *p, const char *by, const char *name)
{
    struct near near = near_to(name, strlen(name));
    char mean[NEAR_B];
    for (uint32_t i = 0; i < exh_signal_count(p->table); i++) {
        near_try(&near, exh_signal_at(p->table, i, NULL)->name);
    }
    cli_complain("%s%s: no such parameter%s: the command's --params lists them", by, name,
        near_text(mean, &near, ""));
}

int cli_param_set(struct exh_params *p, const char *name, double value)
{
    return cli_param_set_by(p, "", name, value);
}

int cli_param_set_by(struct exh_params *p, const char *by, const char *name, double value)
{
    const struct exh_signal *row = cli_signal_find(p->table, name, NULL);
    double scaled;
    int err = -EXH_E_RANGE;

    if (row == NULL) {
        no_such(p, by, name);
        return -EXH_E_UNKNOWN;
    }
    scaled = value * (double)(INT64_C(1) << row->frac);
    scaled += scaled < 0 ? -0.5 : 0.5; /* the cast cuts it off */
    if (scaled > -2147483649.0 && scaled < 2147483648.0) {
        err = stage_all(p, row->id, (int32_t)scaled);
    }
    if (err == -EXH_E_RANGE) { /* 12 digits: the ends as they are printed are allowed */
        cli_complain("%s%s: %.12g (allowed %.12g..%.12g%s%s): choose a value in that range", by,
            name, value, cli_signal_value(row, row->min), cli_signal_value(row, row->max),
            row->unit[0] ? " " : "", names_unit(row->unit));
    } else if (err < 0) {
        cli_complain("%s%s: %.12g: %s", by, name, value, exh_error_text(err));
    }
    return err;
}

const char *cli_signal_when(const struct exh_signal *row)
{
    static const char *const when[EXH_WHENS] = {"output", "set-up", "any time", "slewed", "limit",
        "person", "bound", "wall", "at rest", "material", "word"};
    return row->when < EXH_WHENS ? when[row->when] : "";
}

void cli_signal_print(FILE *f, const struct exh_signal_table *t, const int32_t *raw)
{
    const uint32_t n = exh_signal_count(t);
    for (uint32_t i = 0; i < n; i++) {
        uint16_t instance;
        const struct exh_signal *r = exh_signal_at(t, i, &instance);
        if (instance > 0) { continue; }
        fprintf(f, "  %-13s %-8s %14.12g  %14.12g .. %-14.12g %-8s %s\n", r->name,
            names_unit(r->unit), cli_signal_value(r, raw ? raw[i] : r->dflt),
            cli_signal_value(r, r->min), cli_signal_value(r, r->max), cli_signal_when(r), r->help);
    }
}
