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

int golden_drawn(uint32_t first)
{
    const char *p = getenv("EXH_HUNDREDS");
    char *end;
    if (p == NULL) { return 1; }
    for (; *p != '\0'; p = end + (*end == ',')) {
        if (strtoul(p, &end, 10) == first) { return 1; }
        CHECK(end != p, "EXH_HUNDREDS=%s is no list of numbers", p);
        if (end == p) { return 0; }
    }
    return 0;
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

static void say(
    struct reader *r, const struct golden *g, const char *column, const char *want, const char *got)
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
            "%s at %" PRIu32 " Hz, tick %" PRIu32 ": %.60s: expected %.60s, got %.60s", r->name,
            r->rate_Hz, g->tick, column, want, got);
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
            "%s at %" PRIu32 " Hz is as the generator says, its digest is an old one: %s", name,
            rate_Hz, rate_Hz <= GOLDEN_RATES ? "make golden" : DIR "golden.py --beyond");
    }
    return r.said;
}

/* A hundred digests in hexadecimal. */
static int hundred_in(FILE *f, uint32_t digest[GOLDEN_HUNDRED])
{
    unsigned v;
    uint32_t n = 0;
    while (n < GOLDEN_HUNDRED && fscanf(f, "%x", &v) == 1) { digest[n++] = v; }
    return n == GOLDEN_HUNDRED;
}

/* From the table: a line a module, its name and a digest a rate. */
static int from_table(const char *name, uint32_t first, uint32_t digest[GOLDEN_HUNDRED])
{
    const char *path = getenv("EXH_DIGESTS");
    char word[32];
    int found = 0;
    FILE *f = fopen(path != NULL ? path : "build/golden/rates.txt", "r");
    if (f == NULL) { return 0; }
    while (!found && fscanf(f, "%31s", word) == 1) {
        found = check_same_text(word, name);
        if (!found && fscanf(f, "%*[^\n]") == EOF) { break; }
    }
    for (uint32_t at = 1; found && at <= first; at += GOLDEN_HUNDRED) {
        found = hundred_in(f, digest);
    }
    (void)fclose(f);
    return found;
}

static int from_generator(const char *name, uint32_t first, uint32_t digest[GOLDEN_HUNDRED])
{
    char command[200];
    int found;
    FILE *f;
    (void)snprintf(command, sizeof command,
        "python3 " DIR "golden.py --module %s --hundred %" PRIu32, name, first);
    f = popen(command, "r");
    if (f == NULL) { return 0; }
    found = hundred_in(f, digest);
    (void)pclose(f);
    return found;
}

int golden_singles(
    const char *name, uint32_t first, uint32_t crc, int ask, uint32_t digest[GOLDEN_HUNDRED])
{
    uint32_t all = 0;
    if (first <= GOLDEN_RATES && from_table(name, first, digest)) {
        for (uint32_t i = 0; i < GOLDEN_HUNDRED; i++) { all = golden_crc_u32(all, digest[i]); }
        if (all == crc) { return 1; }
    }
    return ask && from_generator(name, first, digest);
}

int golden_files(void) { return 1; }

void golden_write(const char *name, uint32_t first, const uint32_t digest[GOLDEN_HUNDRED])
{
    const char *path = getenv("EXH_WRITE");
    FILE *f;
    if (path == NULL || first > GOLDEN_RATES) { return; }
    f = fopen(path, "a");
    CHECK(f != NULL, "EXH_WRITE=%s cannot be written", path);
    if (f == NULL) { return; }
    if (first == 1) { (void)fprintf(f, "%s", name); }
    for (uint32_t i = 0; i < GOLDEN_HUNDRED; i++) { (void)fprintf(f, " %08" PRIx32, digest[i]); }
    if (first + GOLDEN_HUNDRED > GOLDEN_RATES) { (void)fputc('\n', f); }
    CHECK(fclose(f) == 0, "EXH_WRITE=%s cannot be written", path);
}

const char *golden_trace(const char *name, golden_run *run, uint32_t rate_Hz)
{
    static struct reader r;
    const char *where = getenv("EXH_TRACES");
    char path[400];
    int all = 0;
    if (where == NULL) { return ""; }
    (void)snprintf(path, sizeof path, "%s/%s-%" PRIu32 ".txt", where, name, rate_Hz);
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

int golden_drawn(uint32_t first)
{
    (void)first;
    return 1;
}

int golden_cells(void) { return 1; }

int golden_quiet(void) { return 0; }

int golden_singles(
    const char *name, uint32_t first, uint32_t crc, int ask, uint32_t digest[GOLDEN_HUNDRED])
{
    (void)name;
    (void)first;
    (void)crc;
    (void)ask;
    (void)digest;
    return 0;
}

int golden_files(void) { return 0; }

void golden_write(const char *name, uint32_t first, const uint32_t digest[GOLDEN_HUNDRED])
{
    (void)name;
    (void)first;
    (void)digest;
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
