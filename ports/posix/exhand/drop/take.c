/* SPDX-License-Identifier: MIT */
/* exhand drop: options with a syntax of their own, and what --params lists. */
#include "drop/options.h"

#include "base/names.h"
#include "base/assign.h"
#include "base/param.h"
#include "base/scenes.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const struct exh_scene *drop_scene(const struct drop_options *o)
{
    return o->custom ? cli_scene_more : o->guarded ? &exh_scene_guarded : &exh_scene_drop;
}

static int bad_rates(const char *text, const char *why)
{
    cli_complain(
        "--rate: %s: %s (whole numbers 1..20000 Hz, each once, commas between, at most %d): "
        "e.g. --rate 90,2000",
        text, why, DROP_RATES_MAX);
    return 2;
}

int drop_take_rates(void *ctx, const char *text)
{
    struct drop_options *o = ctx;
    const char *at = text;
    o->rates = 0;
    o->rates_given = 1;
    for (;;) {
        char *end;
        const double v = strtod(at, &end);
        if (end == at || *at == ' ' || !(v >= 1 && v <= 20000) || v != (double)(long)v ||
            strpbrk(at, "xX")) {
            return bad_rates(text, "not a list of rates");
        }
        for (int i = 0; i < o->rates; i++) {
            if (o->rate_Hz[i] == v) { return bad_rates(text, "a rate comes twice"); }
        }
        if (o->rates == DROP_RATES_MAX) { return bad_rates(text, "too many"); }
        o->rate_Hz[o->rates++] = v;
        if (*end == '\0') { return 0; }
        if (*end != ',') { return bad_rates(text, "not a list of rates"); }
        at = end + 1;
    }
}

static int is_digit(char c) { return c >= '0' && c <= '9'; }

int drop_take_period(void *ctx, const char *text)
{
    struct drop_options *o = ctx;
    unsigned long long num = 0, den = 0;
    char *end = NULL;
    if (is_digit(text[0])) { num = strtoull(text, &end, 10); }
    if (end && end[0] == '/' && is_digit(end[1])) { den = strtoull(end + 1, &end, 10); }
    if (den == 0 || *end != '\0' || num < 1 || num > den || den > UINT32_MAX || den > 20000 * num) {
        cli_complain("--period: %s (N/D seconds, 1/20000..1, both whole and below 2^32): "
                     "e.g. --period 597/1193182",
            text);
        return 2;
    }
    o->T = (struct exh_period){(uint32_t)num, (uint32_t)den};
    return 0;
}

int drop_take_setting(void *ctx, const char *text)
{
    struct drop_options *o = ctx;
    char name[ASSIGN_NAME_B];
    double value;
    if (assign_split("set", text, name, &value)) { return 2; }
    if (o->settings == DROP_SETTINGS_MAX) {
        cli_complain("--set: at most %d", DROP_SETTINGS_MAX);
        return 2;
    }
    if (strcmp(name, "k") == 0 || strcmp(name, "b") == 0) {
        cli_complain(
            "--set: %.60s: give --%s %.12g: k and b are options of their own", text, name, value);
        return 2;
    }
    exh_scene_guarded.defaults(); /* knows all that drop knows */
    if (cli_param_set_by(exh_scene_guarded.params, "--set: ", name, value) < 0) { return 2; }
    o->setting[o->settings++] = (struct run_setting){
        cli_signal_find(exh_scene_guarded.params->table, name, NULL)->name, value};
    return 0;
}

int drop_take_device(void *ctx, const char *text)
{
    struct drop_options *o = ctx;
    return assign_device(&o->device, "drop", text);
}

void drop_print_params(const struct exh_scene *scene)
{
    scene->defaults();
    printf("Parameters of the scene (--set NAME=VALUE)\n");
    cli_signal_print(stdout, scene->params->table, NULL);
    printf(
        "\nThe simulated device (--device NAME=VALUE); step, kf and the scales also calibrate the "
        "scene\n");
    for (int i = 0; i < sim_device_rows; i++) {
        const struct sim_device_row *r = &sim_device_row[i];
        printf("  %-13s %-8s %14.12g  %14.12g .. %-14.12g %-8s %s\n", r->name, names_unit(r->unit),
            r->value, r->min, r->max, r->sure, r->help);
    }
}
