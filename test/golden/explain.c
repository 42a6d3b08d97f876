/* SPDX-License-Identifier: MIT */
#include "explain.h"

#define NO_TRACE "no trace from: "

#if __STDC_HOSTED__

#include <stdio.h>
#include <stdlib.h>

#define LINE_B 12288 /* the longest state as hex, and its columns */
#define DIR    "test/golden/"

struct golden_rates golden_rates(void)
{
    struct golden_rates r = {1, GOLDEN_RATES, 1};
    const char *text = getenv("EXH_RATES");
    unsigned lo;
    unsigned hi;
    unsigned step = 1;
    int n;
    if (text == NULL) { return r; }
    n = sscanf(text, "%u..%u:%u", &lo, &hi, &step);
    if (n == 1) { hi = lo; }
    CHECK(n > 0 && lo >= 1 && lo <= hi && hi <= GOLDEN_BEYOND && step >= 1,
          "EXH_RATES=%s is no lo..hi or lo..hi:step of 1..%u", text, GOLDEN_BEYOND);
    r.lo = lo;
    r.hi = hi;
    r.step = step;
    return r;
}

int golden_cells(void)
{
    const char *asked = getenv("EXH_CELLS");
    return asked != NULL && check_same_text(asked, "1");
}

int golden_quiet(void)
{
    const char *asked = getenv("EXH_EXPLAIN");
    return asked != NULL && check_same_text(asked, "0");
}

/* A trace being read beside a run. */
struct reader {
    FILE *f;
    const char *name;
    uint32_t rate_Hz;
    int whole; /* inputs, too, and the state's bytes instead of their CRC */
    int ended;
    uint32_t shown; /* columns but the state */
    char columns[LINE_B];
    char before[GOLDEN_COLUMNS + 1][LINE_B];
    char said[LINE_B]; /* the first difference, "" while there is none */
};

static int next_line(struct reader *r, char *line)
{
    size_t n;
    line[0] = '\0';
    if (fgets(line, LINE_B, r->f) == NULL) { return 0; }
    n = strlen(line);
    if (n > 0 && line[n - 1] == '\n') { line[n - 1] = '\0'; }
    return 1;
}

/* The next word of a line into word; what is behind it. */
static const char *word_of(const char *p, char *word, size_t cap)
{
    size_t n = 0;
    while (*p == ' ') { p++; }
    for (; *p != '\0' && *p != ' '; p++) {
        if (n + 1 < cap) { word[n++] = *p; }
    }
    word[n] = '\0';
    return p;
}

/* The state of this tick as the trace has it. */
static void state_text(const struct golden *g, int whole, char *text)
{
    size_t n = 0;
    if (!whole) {
        (void)snprintf(text, LINE_B, "%08" PRIx32, exh_crc32(0, g->state, g->state_B));
        return;
    }
    (void)snprintf(text, LINE_B, "-");
    for (uint32_t i = 0; i < g->state_B && n + 3 < LINE_B; i++) {
        n += (size_t)snprintf(text + n, LINE_B - n, "%02x", g->state[i]);
    }
}

static void say(struct reader *r, const struct golden *g, const char *column, const char *want,
                const char *got)
{
    unsigned at = 0;
    while (want[at] != '\0' && want[at] == got[at]) { at++; }
    if (check_same_text(column, "state") && r->whole) {
        (void)snprintf(r->said, sizeof r->said,
                       "%s at %" PRIu32 " Hz, tick %" PRIu32
                       ": state differs from byte %u on\n    expected %.200s\n    got      %.200s",
                       r->name, r->rate_Hz, g->tick, at / 2, want, got);
    } else {
        (void)snprintf(r->said, sizeof r->said,
                       "%s at %" PRIu32 " Hz, tick %" PRIu32 ": %.60s: expected %.60s, got %.60s",
                       r->name, r->rate_Hz, g->tick, column, want, got);
    }
}

/* The sink: one tick beside one line. */
static void see(struct golden *g)
{
    static char line[LINE_B];
    static char want[LINE_B];
    static char got[LINE_B];
    char column[64];
    struct reader *r = g->file;
    const char *p = line;
    const char *c = r->columns;
    if (r->said[0] != '\0' || r->ended) { return; }
    if (!next_line(r, line)) {
        r->ended = 1;
        return;
    }
    for (uint32_t i = 0; i <= r->shown; i++) {
        p = word_of(p, want, sizeof want);
        c = word_of(c, column, sizeof column);
        if (check_same_text(want, ".")) { (void)memcpy(want, r->before[i], LINE_B); }
        if (i < r->shown) {
            (void)snprintf(got, sizeof got, "%" PRId64, g->v[g->columns - r->shown + i]);
        } else {
            state_text(g, r->whole, got);
        }
        if (!check_same_text(want, got)) {
            say(r, g, column, want, got);
            return;
        }
        (void)memcpy(r->before[i], want, LINE_B);
    }
}

/* Plays the run beside the trace in f. Returns 1 if all of it was there. */
static int beside(struct reader *r, golden_run *run)
{
    static struct golden g;
    static char line[LINE_B];
    r->ended = 0;
    r->said[0] = '\0';
    if (!next_line(r, line) || line[0] != '#' || !next_line(r, r->columns)) { return 0; }
    r->shown = 0;
    for (const char *p = r->columns; *p != '\0'; p++) { r->shown += *p == ' '; }
    g = (struct golden){.see = see, .file = r};
    run(&g, r->rate_Hz);
    return !r->ended;
}

const char *golden_explain(const char *name, golden_run *run, uint32_t rate_Hz)
{
    static struct reader r;
    char command[200];
    int all = 0;
    (void)snprintf(command, sizeof command, "python3 " DIR "golden.py --module %s --rate %" PRIu32,
                   name, rate_Hz);
    r = (struct reader){.f = popen(command, "r"), .name = name, .rate_Hz = rate_Hz, .whole = 1};
    if (r.f != NULL) {
        all = beside(&r, run);
        while (next_line(&r, r.columns)) {}
        (void)pclose(r.f);
    }
    if (!all) {
        (void)snprintf(r.said, sizeof r.said, NO_TRACE "%s", command);
    } else if (r.said[0] == '\0') {
        (void)snprintf(r.said, sizeof r.said,
                       "%s at %" PRIu32 " Hz is as the generator says, its digest is an old one: "
                       "make golden",
                       name, rate_Hz);
    }
    return r.said;
}

int golden_hundreds(const char *name, uint32_t crc[GOLDEN_HUNDREDS])
{
    char path[200];
    FILE *f;
    unsigned v;
    uint32_t n = 0;
    (void)snprintf(path, sizeof path, DIR "beyond/%s.inc", name);
    f = fopen(path, "r");
    if (f == NULL) { return 0; }
    while (n < GOLDEN_HUNDREDS && fscanf(f, "%x,", &v) == 1) { crc[n++] = v; }
    (void)fclose(f);
    return n == GOLDEN_HUNDREDS;
}

const char *golden_trace(const char *name, golden_run *run, uint32_t rate_Hz)
{
    static struct reader r;
    char path[200];
    int all = 0;
    (void)snprintf(path, sizeof path, DIR "trace/%s-%" PRIu32 ".txt", name, rate_Hz);
    r = (struct reader){.f = fopen(path, "r"), .name = name, .rate_Hz = rate_Hz};
    if (r.f != NULL) {
        all = beside(&r, run);
        (void)fclose(r.f);
    }
    if (!all) { (void)snprintf(r.said, sizeof r.said, "%s: not there, or not whole", path); }
    return r.said;
}

#else

static uint32_t number(const char **p)
{
    uint32_t v = 0;
    while (**p == '.' || **p == ':') { (*p)++; }
    for (; **p >= '0' && **p <= '9'; (*p)++) { v = v * 10u + (uint32_t)(**p - '0'); }
    return v;
}

struct golden_rates golden_rates(void)
{
    struct golden_rates r = {1, GOLDEN_RATES, 1};
    const char *text = check_env("EXH_RATES"); /* lo..hi:step, all three */
    if (text == NULL) { return r; }
    r.lo = number(&text);
    r.hi = number(&text);
    r.step = number(&text);
    CHECK(*text == '\0' && r.lo >= 1 && r.lo <= r.hi && r.hi <= GOLDEN_RATES && r.step >= 1,
          "EXH_RATES");
    return r;
}

int golden_cells(void)
{
    return 1;
}

int golden_quiet(void)
{
    return 0;
}

int golden_hundreds(const char *name, uint32_t crc[GOLDEN_HUNDREDS])
{
    (void)name;
    (void)crc;
    return 0;
}

const char *golden_explain(const char *name, golden_run *run, uint32_t rate_Hz)
{
    (void)name;
    (void)run;
    (void)rate_Hz;
    return NO_TRACE "here";
}

const char *golden_trace(const char *name, golden_run *run, uint32_t rate_Hz)
{
    (void)name;
    (void)run;
    (void)rate_Hz;
    return "";
}

#endif
