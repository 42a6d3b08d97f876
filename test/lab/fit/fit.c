/* SPDX-License-Identifier: MIT */
/* exhand-lab fit: which plant, under which reading of the paper's analysis, comes closest. */
#include "lab/lab.h"
#include "base/jobs.h"
#include "base/option.h"

#include "lab/fit/winners.h"
#include "lab/fit/search.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#define PATH_B 1024

/* Seeds: the search's two plans, then those the winners are judged by. The tests use
 * 101 .. 120, the demo 1 .. 21. */
#define SEED_FIRST  10001
#define SEED_SECOND 20001

struct fit_options {
    int64_t budget, seed, jobs, runs, further;
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
    struct plant_point p;
    struct score s;
};

struct batch {
    const struct plant_point *p;
    const struct score_plan *plan;
    double bound;
};

static void work(const void *ctx, int i, void *to)
{
    const struct batch *b = ctx;
    const struct score s = score_plant(&b->p[i], b->plan, b->bound);
    memcpy(to, &s, sizeof s);
}

/* Takes from the journal what it holds of these, else runs them. 0, or as jobs_run(). */
static int evaluate(const struct fit_options *o, struct journal *j, const struct score_plan *plan,
    const struct plant_point *p, int n, struct score *s)
{
    const struct batch b = {p, plan, search_bound(&o->search)};
    const struct jobs jobs = {n, (int)o->jobs, sizeof *s, s, work, &b, NULL, posix_interrupt};
    struct entry e;
    int err;
    if (j->at + n <= j->held) {
        for (int i = 0; i < n; i++) {
            if (fread(&e, sizeof e, 1, j->f) != 1 || memcmp(&e.p, &p[i], sizeof e.p) != 0) {
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
        e.p = p[i];
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
    int n =
        snprintf(to, size, "budget %ld, seed %ld, wall %s, by %s", (long)o->budget, (long)o->seed,
            o->search.fixed_wall ? "fixed" : "anywhere", o->only ? o->only : "all readings");
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
    f = open_out(o, "settings", "w");
    if (f == NULL) { return 1; }
    fputs(mine, f);
    return fclose(f) != 0;
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

/* Best cost of every reading, now and then. */
static void progress_line(FILE *f, const struct search *s, int64_t at)
{
    fprintf(f, "%ld", (long)at);
    for (int i = 0; i < READINGS; i++) {
        const struct search_member *m = search_best(s, i);
        if (m) {
            fprintf(f, ",%.4f", m->cost);
        } else {
            fprintf(f, ",");
        }
    }
    fprintf(f, "\n");
    fflush(f);
}

static int offer_all(const struct fit_options *o, struct search *s, struct journal *j,
    const struct score_plan *plan, const struct plant_point *p, int n)
{
    static struct score score[SEARCH_STARTS];
    const int err = evaluate(o, j, plan, p, n, score);
    for (int i = 0; err == 0 && i < n; i++) { search_offer(s, &p[i], &score[i]); }
    return err;
}

static int rounds(const struct fit_options *o, struct search *s, struct journal *j,
    const struct score_plan *plan, int64_t until, FILE *progress)
{
    struct plant_point child[READINGS];
    int err = 0;
    for (int64_t round = 0; err == 0 && j->at < until; round++) {
        const int n = search_round(s, child);
        err = offer_all(o, s, j, plan, child, n);
        if (round % 16 == 0) { progress_line(progress, s, j->at); }
    }
    return err;
}

static int searched(struct fit_options *o, FILE *progress)
{
    /* Shorter and coarser than the experiment, which is what judges in the end. */
    const struct score_plan first = {1, 4, 3, 5, SEED_FIRST, o->search.fixed_wall};
    const struct score_plan second = {3, 8, 3, 5, SEED_SECOND, o->search.fixed_wall};
    static struct plant_point some[SEARCH_STARTS];
    const int64_t turn = o->budget * 2 / 3;
    const int starts = o->budget < 3 * SEARCH_STARTS ? (int)(o->budget / 3) : SEARCH_STARTS;
    struct search *s = &o->search;
    struct journal j;
    int n, err;

    if (journal_open(o, &j)) { return 1; }
    for (int i = 0; i < starts; i++) { some[i] = search_first(s, i); }
    err = offer_all(o, s, &j, &first, some, starts);
    if (err == 0) { err = rounds(o, s, &j, &first, turn, progress); }
    if (err == 0) {
        n = search_cull(s, some);
        err = offer_all(o, s, &j, &second, some, n);
    }
    if (err == 0) { err = rounds(o, s, &j, &second, o->budget, progress); }
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
    printf("\nReadings: DIRECTION-PAIRS-PART\n"
           "  a, b                     fits force over position; position over force, inverted\n"
           "  same, aligned            F_mon(n) with q(n); with q(n - 1), which it answers\n"
           "  all first moves whole    all contacts; the first of each fall; till the motor\n"
           "                           stops; the whole fall, in contact or not\n");
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
    progress = open_out(o, "progress.csv", "w");
    if (progress == NULL) { return 1; }
    fprintf(progress, "evaluations");
    for (int i = 0; i < READINGS; i++) { fprintf(progress, ",%s", reading_table[i].name); }
    fprintf(progress, "\n");
    err = searched(o, progress);
    if (fclose(progress) != 0 && err == 0) { err = 1; }
    if (err) { return err; }
    return winners_judge(&o->search, (int)o->runs, (int)o->further, (int)o->jobs, o->out);
}

int cli_fit(int argc, char **argv)
{
    static struct fit_options o;
    int list = 0, err;
    struct cli_call pin = {take_pin, &o};
    const struct cli_option option[] = {
        {"budget", CLI_INT, &o.budget, 8, 1e8, "N", "plants run; every reading judges each (6000)"},
        {"variant", CLI_TEXT, &o.only, 0, 0, "NAME", "only this reading makes plants (all)"},
        {"pin", CLI_CALL, &pin, 0, 0, "NAME=VALUE", "keep a value instead of searching it"},
        {"fixed-wall", CLI_FLAG, &o.search.fixed_wall, 0, 0, NULL,
            "the wall where q_lim and step put it between two counts, not anywhere"},
        {"seed", CLI_INT, &o.seed, 0, 1e9, "N", "of the search (1)"},
        {"runs", CLI_INT, &o.runs, 1, 200, "N", "the winners are judged by, a row (20)"},
        {"further", CLI_INT, &o.further, 0, 200, "N", "runs at gains not in the table (8)"},
        {"jobs", CLI_INT, &o.jobs, 1, 1024, "N", "processes at a time (one a core)"},
        {"out", CLI_TEXT, &o.out, 0, 0, "DIR", "state and results; continues what is there (fit)"},
        {"space", CLI_FLAG, &list, 0, 0, NULL, "list what is searched, and the readings"},
    };
    const struct cli_command c = {"fit", "[options]",
        "Searches for a plant that rests at the paper's six points, not at 1.5 times both gains,\n"
        "and gives its Table II; once for each reading of its analysis, all with equal effort.",
        option, (int)(sizeof option / sizeof option[0]), 0};

    search_init(&o.search, 0);
    o.budget = 6000;
    o.seed = 1;
    o.runs = 20;
    o.further = 8;
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
        const int x = reading_find(o.only);
        if (x < 0) {
            cli_complain(
                "--variant: %s: no such reading: `exhand-lab fit --space` lists them", o.only);
            return 2;
        }
        for (int i = 0; i < READINGS; i++) { o.search.used[i] = x == i; }
    }
    return fit(&o);
}
