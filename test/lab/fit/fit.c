/* SPDX-License-Identifier: MIT */
/* exhand-lab fit: which plants, with which velocity, rest at the paper's points and not beyond. */
#include "lab/lab.h"
#include "base/jobs.h"
#include "base/option.h"
#include "base/outfile.h"

#include "lab/fit/winners.h"
#include "lab/fit/search.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define PATH_B 1024

/* Cases of the model: the search's two plans, then those the winners are judged by. */
static const struct score_plan first_plan = {24, 12, 0}, second_plan = {96, 48, 1000};

struct fit_options {
    int64_t budget, seed, jobs, falls;
    const char *out, *only;
    struct search search;
};

/* Every evaluation in order, so that a search that was cut off repeats itself up to there
 * and goes on: the file is the state. */
struct journal {
    FILE *f;
    int64_t at, held; /* the next to come; how many the file held */
};

struct entry {
    struct search_child c;
    struct score s;
};

struct batch {
    const struct search_child *c;
    const struct score_plan *plan;
    double bound[ESTIMATES];
};

static void work(const void *ctx, int i, void *to)
{
    const struct batch *b = ctx;
    const struct search_child *c = &b->c[i];
    const struct score s = score_plant(&c->p, c->kind, b->plan, b->bound[c->kind]);
    memcpy(to, &s, sizeof s);
}

/* Takes from the journal what it holds of these, else runs them. 0, or as jobs_run(). */
static int evaluate(const struct fit_options *o, struct journal *j, const struct score_plan *plan,
    const struct search_child *c, int n, struct score *s)
{
    struct batch b = {c, plan, {0}};
    const struct jobs jobs = {n, (int)o->jobs, sizeof *s, s, work, &b, NULL, posix_interrupt};
    struct entry e;
    int err;
    for (int k = 0; k < ESTIMATES; k++) {
        b.bound[k] = search_bound(&o->search, (enum estimate_kind)k);
    }
    if (j->at + n <= j->held) {
        for (int i = 0; i < n; i++) {
            if (fread(&e, sizeof e, 1, j->f) != 1 || memcmp(&e.c, &c[i], sizeof e.c) != 0) {
                cli_complain(
                    "the journal is of another program's search: remove it, or give another --out");
                return 1;
            }
            s[i] = e.s;
        }
        j->at += n;
        return 0;
    }
    fseek(j->f, (long)j->at * (long)sizeof e, SEEK_SET); /* past a batch cut off in the middle */
    j->held = j->at;
    err = jobs_run(&jobs);
    if (err) { return err; }
    for (int i = 0; i < n; i++) {
        memset(&e, 0, sizeof e);
        e.c = c[i];
        e.s = s[i];
        if (fwrite(&e, sizeof e, 1, j->f) != 1) {
            cli_complain("%s/journal: %s", o->out, strerror(errno));
            return 1;
        }
    }
    j->at += n;
    return fflush(j->f) != 0;
}

static FILE *open_out(const struct fit_options *o, const char *name, const char *mode)
{
    char path[PATH_B];
    FILE *f;
    snprintf(path, sizeof path, "%s/%s", o->out, name);
    f = fopen(path, mode);
    if (f == NULL) { cli_complain("%s: %s", path, strerror(errno)); }
    return f;
}

/* What the search depends on, in words: DIR/settings says of which one the state is. */
static void settings_text(const struct fit_options *o, char *to, size_t size)
{
    int n = snprintf(to, size, "budget %ld, seed %ld, velocity %s", (long)o->budget, (long)o->seed,
        o->only ? o->only : "any");
    for (int i = 0; i < SPACE_ROWS && n > 0 && (size_t)n < size; i++) {
        if (!o->search.pinned[i]) { continue; }
        n += snprintf(to + n, size - (size_t)n, ", %s %.9g", space_row[i].name,
            space_value(i, o->search.start.u[i]));
    }
}

/* 0; or 1 after a line on stderr: the state in the folder is of another search. */
static int settings_agree(const struct fit_options *o)
{
    char mine[PATH_B], theirs[PATH_B], path[PATH_B];
    FILE *f;
    int same = 1;
    settings_text(o, mine, sizeof mine);
    snprintf(path, sizeof path, "%s/settings", o->out);
    f = fopen(path, "r");
    if (f != NULL) {
        same = fgets(theirs, sizeof theirs, f) != NULL && strcmp(theirs, mine) == 0;
        fclose(f);
        if (!same) { cli_complain("--out: %s holds another search: give another folder", o->out); }
        return same ? 0 : 2;
    }
    f = outfile_in(o->out, "settings");
    if (f == NULL) { return 1; }
    fputs(mine, f);
    return outfile_close(f);
}

static int journal_open(const struct fit_options *o, struct journal *j)
{
    char path[PATH_B];
    struct stat st;
    snprintf(path, sizeof path, "%s/journal", o->out);
    memset(j, 0, sizeof *j);
    if (stat(path, &st) != 0) {
        j->f = open_out(o, "journal", "w+b");
    } else {
        j->held = (int64_t)st.st_size / (int64_t)sizeof(struct entry);
        j->f = open_out(o, "journal", "r+b");
    }
    return j->f == NULL;
}

/* Lowest cost of every velocity, now and then: in a file, and on a terminal. */
static void progress_line(const struct fit_options *o, FILE *f, int64_t at)
{
    const int person = isatty(2);
    fprintf(f, "%ld", (long)at);
    if (person) { fprintf(stderr, "\rplants: %ld of %ld, lowest cost", (long)at, (long)o->budget); }
    for (int k = 0; k < ESTIMATES; k++) {
        const struct search_population *of = &o->search.of[k];
        fprintf(f, ",");
        if (of->members == 0) { continue; }
        fprintf(f, "%.4f", (double)of->member[0].s.cost);
        if (person) { fprintf(stderr, " %s %.3f", estimate_name[k], (double)of->member[0].s.cost); }
    }
    fprintf(f, "\n");
    fflush(f);
}

static int offer_all(struct fit_options *o, struct journal *j, const struct score_plan *plan,
    const struct search_child *c, int n)
{
    static struct score score[SEARCH_BATCH];
    const int err = evaluate(o, j, plan, c, n, score);
    for (int i = 0; err == 0 && i < n; i++) { search_offer(&o->search, &c[i], &score[i]); }
    return err;
}

static struct search_child child[SEARCH_BATCH];

static int rounds(struct fit_options *o, struct journal *j, const struct score_plan *plan,
    int64_t until, FILE *progress)
{
    int err = 0;
    for (int64_t round = 0; err == 0 && j->at < until; round++) {
        const int n = search_round(&o->search, child);
        if (n == 0) { break; } /* no start is an ancestor */
        err = offer_all(o, j, plan, child, n);
        if (round % 8 == 0) { progress_line(o, progress, j->at); }
    }
    return err;
}

static int searched(struct fit_options *o, FILE *progress)
{
    struct search *s = &o->search;
    struct journal j;
    int n, err;
    if (journal_open(o, &j)) { return 1; }
    n = search_first(s, child);
    err = offer_all(o, &j, &first_plan, child, n < o->budget ? n : (int)o->budget);
    if (err == 0) { err = rounds(o, &j, &first_plan, o->budget * 2 / 3, progress); }
    if (err == 0) {
        n = search_cull(s, child);
        err = offer_all(o, &j, &second_plan, child, n);
    }
    if (err == 0) { err = rounds(o, &j, &second_plan, o->budget, progress); }
    progress_line(o, progress, j.at);
    if (isatty(2)) { fprintf(stderr, "\n"); }
    fclose(j.f);
    return err;
}

static int take_pin(void *ctx, const char *text)
{
    struct fit_options *o = ctx;
    const char *equals = strchr(text, '=');
    char name[32], *end = NULL;
    int row = -1;
    double v = 0;
    if (equals != NULL && equals - text < 32) {
        memcpy(name, text, (size_t)(equals - text));
        name[equals - text] = '\0';
        row = space_find(name);
        v = strtod(equals + 1, &end);
    }
    if (row < 0 || end == equals + 1 || *end != '\0' ||
        !(v >= space_row[row].lo && v <= space_row[row].hi) || !space_exact(row, v)) {
        cli_complain("--pin: %s: give NAME=VALUE, of what --space lists and in its range", text);
        return 2;
    }
    o->search.start.u[row] = space_unit(row, v);
    o->search.pinned[row] = 1;
    return 0;
}

static void print_space(void)
{
    printf("What is searched, where it starts, and why within these bounds\n");
    for (int i = 0; i < SPACE_ROWS; i++) {
        const struct space_row *r = &space_row[i];
        printf("  %-11s %10.4g  %8.4g .. %-8.4g %-4s %s\n", r->name, r->start, r->lo,
            r->scale == SPACE_WHOLE ? r->hi - 1 : r->hi,
            r->scale == SPACE_LOG     ? "log"
            : r->scale == SPACE_WHOLE ? "int"
                                      : "lin",
            r->why);
    }
}

static int fit(struct fit_options *o)
{
    FILE *progress;
    int err;
    if (mkdir(o->out, 0777) != 0 && errno != EEXIST) {
        cli_complain("--out: %s: %s", o->out, strerror(errno));
        return 2;
    }
    err = settings_agree(o); /* before anything of another search is touched */
    if (err) { return err; }
    progress = outfile_in(o->out, "progress.csv");
    if (progress == NULL) { return 1; }
    fprintf(progress, "evaluations");
    for (int k = 0; k < ESTIMATES; k++) { fprintf(progress, ",%s", estimate_name[k]); }
    fprintf(progress, "\n");
    err = searched(o, progress);
    if (outfile_end(progress, err == 0) != 0) { err = 1; }
    if (err) { return err; }
    return winners_judge(&o->search, (int)o->falls, (int)o->jobs, o->out);
}

int cli_fit(int argc, char **argv)
{
    static struct fit_options o;
    int list = 0, err;
    struct cli_call pin = {take_pin, &o};
    const struct cli_option option[] = {
        {"budget", CLI_INT, &o.budget, 8, 1e8, "N", "plants run (20000)"},
        {"velocity", CLI_TEXT, &o.only, 0, 0, "NAME",
            "window, pole, foaw or track: only plants with this estimator (all)"},
        {"pin", CLI_CALL, &pin, 0, 0, "NAME=VALUE", "keep a value instead of searching it"},
        {"seed", CLI_INT, &o.seed, 0, 1e9, "N", "of the search (1)"},
        {"falls", CLI_INT, &o.falls, 10, 1e5, "N", "the winners are judged by, a row (400)"},
        {"jobs", CLI_INT, &o.jobs, 1, 1024, "N", "processes at a time (one a core)"},
        {"out", CLI_TEXT, &o.out, 0, 0, "DIR", "state and results; continues what is there (fit)"},
        {"space", CLI_FLAG, &list, 0, 0, NULL, "list what is searched"},
    };
    const struct cli_command c = {"fit", "[options]",
        "Searches for a plant that rests at the paper's six points (95 % of falls) and oscillates "
        "at\n"
        "1.5 times both gains (75 %), wherever the wall lies between two encoder counts, with each "
        "of\n"
        "the library's velocity estimators. Plants that cannot become better than what is known "
        "are\n"
        "given up early. Stopped or killed, the same command goes on.",
        option, (int)(sizeof option / sizeof option[0]), 0};

    search_init(&o.search, 0);
    o.budget = 20000;
    o.seed = 1;
    o.falls = 400;
    o.jobs = jobs_cores();
    o.out = "fit";
    err = cli_parse(&c, argc, argv, NULL);
    if (err) { return err == 1 ? 0 : err; }
    o.search.rng.state = (uint64_t)o.seed;
    if (list) {
        print_space();
        return 0;
    }
    if (o.only != NULL) {
        int any = 0;
        for (int k = 0; k < ESTIMATES; k++) {
            o.search.used[k] = strcmp(o.only, estimate_name[k]) == 0;
            any |= o.search.used[k];
        }
        if (!any) {
            cli_complain("--velocity: %s: window, pole, foaw or track", o.only);
            return 2;
        }
    }
    return fit(&o);
}
