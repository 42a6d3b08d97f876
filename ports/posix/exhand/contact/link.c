/* SPDX-License-Identifier: MIT */
/* --link: what the network between controller and world is like. */
#include "contact/bilateral.h"

#include "base/fifo.h"
#include "base/names.h"
#include "base/option.h"

#include <stdlib.h>
#include <string.h>

#define PATH_B 512

static int bad(const char *text, const char *why)
{
    cli_complain(
        "--link: %s: %s: e.g. none, trace=FILE, delay=0.02,jitter=0.005,loss=0.1", text, why);
    return 2;
}

/* Whether a pair before this one, the first one's name and value cut apart, has its name. */
static int is_twice(const char *first, const char *name)
{
    while (first < name) {
        if (strcmp(first, name) == 0) { return 1; }
        first += strlen(first) + 1; /* its value */
        first += strlen(first) + 1;
    }
    return 0;
}

static int is_log(const char *path) { return strstr(path, ".csv") != NULL; }

int bilateral_take_trace(struct bilateral_options *o, const char *option, const char *path)
{
    const enum sim_trace_kind kind = is_log(path) ? SIM_TRACE_ROUND : SIM_TRACE_MS;
    char why[256];
    if (fifo_is(path)) {
        cli_complain("%s: %s: a FIFO: give a file", option, path);
        return 2;
    }
    if (sim_trace_read(&o->trace, path, kind, why, sizeof why) < 0) {
        cli_complain("%s: %s", option, why);
        return 2;
    }
    for (int w = 0; w < SIM_LINK_WAYS; w++) {
        o->run.board.line.trace[w] = &o->trace;
        o->run.board.line.way[w].trace_scale = 0.5; /* recorded there and back */
    }
    return 0;
}

static int take_value(struct bilateral_options *o, const char *name, const char *text)
{
    const struct sim_device_row *row = NULL;
    double v;
    int err = 0;
    if (!cli_number(text, 0, &v)) {
        cli_complain("--link: %s=%.60s: the value is no number: give it in plain digits, without "
                     "a unit",
            name, text);
        return 2;
    }
    for (int w = 0; w < SIM_LINK_WAYS; w++) {
        struct sim_link_par *p = &o->run.board.line.way[w];
        err |= sim_link_set(p, name, v, &row);
        if (strcmp(name, "jitter") == 0 && p->jitter == SIM_LINK_CONSTANT) {
            p->jitter = SIM_LINK_UNIFORM;
        }
    }
    if (err && row) {
        cli_complain("--link: %s: %.12g (allowed %.12g..%.12g%s%s): choose a value in that range",
            name, v, row->min, row->max, row->unit[0] ? " " : "", names_unit(row->unit));
    }
    return err == 0 ? 0 : row ? 2 : bad(name, "no such property of a link: --params lists them");
}

int bilateral_take_link(void *ctx, const char *text)
{
    struct bilateral_options *o = ctx;
    char all[PATH_B], *at = all;
    if (strlen(text) >= sizeof all) { return bad(text, "too long"); }
    strcpy(all, text);
    o->link = text;
    if (strcmp(text, "none") == 0) { return 0; }
    while (at != NULL) {
        char *name = at, *comma = strchr(at, ','), *equals;
        int err;
        if (comma != NULL) { *comma = '\0'; }
        at = comma ? comma + 1 : NULL;
        equals = strchr(name, '=');
        if (equals == NULL) { return bad(name, "give NAME=VALUE"); }
        *equals = '\0';
        if (is_twice(all, name)) { return bad(name, "it comes twice: give it once"); }
        err = strcmp(name, "trace") == 0 ? bilateral_take_trace(o, "--link: trace", equals + 1)
                                         : take_value(o, name, equals + 1);
        if (err) { return err; }
    }
    return 0;
}
