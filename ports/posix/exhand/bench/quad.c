/* SPDX-License-Identifier: MIT */
/* exhand quad: samples of two lines to counts, through the library's decoder. */
#include "base/cli.h"

#include "base/option.h"
#include "bench/positions.h"
#include "bench/samples.h"

#include "exhand/quad.h"

#include <inttypes.h>
#include <string.h>

/* The sums of a recording, which may be longer than the decoder's words are wide. */
struct sums {
    int64_t net, index_cnt;
    uint64_t edges, illegal, indices;
    int64_t changed_at; /* the last change of the lines */
    int64_t min_gap;    /* between two changes; 0: there were no two */
    uint64_t changes;
    uint8_t ab; /* the last sample, for changed_at */
    uint64_t samples;
};

static void take_gaps(struct sums *sum, const struct samples_chunk *c)
{
    for (size_t i = 0; i < c->n; i++) {
        const uint8_t ab = c->line[i] & 3;
        if (sum->samples++ > 0 && ab != sum->ab) {
            const int64_t gap = c->at[i] - sum->changed_at;
            if (sum->changes > 0 && (sum->min_gap == 0 || gap < sum->min_gap)) {
                sum->min_gap = gap;
            }
            sum->changed_at = c->at[i];
            sum->changes++;
        }
        sum->ab = ab;
    }
}

/* Counts a chunk from zero and adds it up. */
static void take_counts(struct sums *sum, struct exh_quad_ab *lines, struct exh_quad_index *index,
    const struct exh_quad_mode *mode, const struct samples_chunk *c)
{
    lines->cnt = 0;
    lines->edges = lines->illegal = 0;
    if (index == NULL) {
        exh_quad_ab_run(lines, mode, c->line, c->n);
    } else {
        index->seen = 0;
        for (size_t i = 0; i < c->n; i++) {
            exh_quad_ab_step(lines, mode, c->line[i]);
            exh_quad_index_step(index, lines->cnt, c->line[i] >> 2);
        }
        if (index->seen > 0) { sum->index_cnt = sum->net + index->cnt; }
        sum->indices += index->seen;
    }
    sum->net += lines->cnt;
    sum->edges += lines->edges;
    sum->illegal += lines->illegal;
}

/* To the nanosecond, without zeros at its end. */
static void print_us(double us)
{
    char text[40];
    size_t n;
    snprintf(text, sizeof text, "%.3f", us);
    n = strlen(text);
    while (text[n - 1] == '0') { n--; }
    if (text[n - 1] == '.') { n--; }
    printf("%.*s", (int)n, text);
}

/* The exit status. */
static int print_sums(const struct sums *sum, const struct samples *s)
{
    printf("net=%" PRId64 " edges=%" PRIu64 " illegal=%" PRIu64 " min_gap_us=", sum->net,
        sum->edges, sum->illegal);
    if (sum->min_gap > 0) {
        print_us(samples_us(s, sum->min_gap));
    } else {
        printf("-");
    }
    if (s->opt->index >= 0) {
        printf(" index_cnt=");
        if (sum->indices > 0) {
            printf("%" PRId64, sum->index_cnt);
        } else {
            printf("-");
        }
        printf(" indices=%" PRIu64, sum->indices);
    }
    printf("\n");
    if (sum->illegal > 0) {
        cli_complain("%" PRIu64 " of %" PRIu64 " changes were of both lines at once: sampled too "
                     "slowly, or broken; net is not to be trusted",
            sum->illegal, sum->changes);
    }
    return sum->illegal > 0;
}

static int decode(const struct samples_opt *opt, const struct exh_quad_mode *mode)
{
    static struct samples_chunk c;
    struct samples s;
    struct sums sum = {0};
    struct exh_quad_ab lines = {0};
    struct exh_quad_index index = {0};
    int err = samples_open(&s, opt);
    do {
        if (err == 0) { err = samples_next(&s, &c); }
        if (err == 0) {
            take_gaps(&sum, &c);
            take_counts(&sum, &lines, opt->index < 0 ? NULL : &index, mode, &c);
        }
    } while (err == 0 && c.n > 0);
    if (err == 0) { err = print_sums(&sum, &s); }
    samples_close(&s);
    return err;
}

/* What the options say of the input fits together; status. */
static int check(const struct samples_opt *o, int raw)
{
    const int own = o->a >= 0 || o->b >= 0 || o->index >= 0;
    const struct {
        int wrong;
        const char *why;
    } row[] = {
        {raw && o->csv, "--raw, --csv: give one of them"},
        {!raw && !o->csv, "no input: give --raw with samples on standard input, or --csv FILE"},
        {raw && o->rate_Hz == 0, "--raw: bytes have no time: give --rate HZ"},
        {raw && o->a < 0, "--raw: give --a BIT, where line A is"},
        {raw && o->b < 0, "--raw: give --b BIT, where line B is"},
        {raw && o->a == o->b, "--a, --b: the same bit: give two"},
        {o->index >= 0 && (o->index == o->a || o->index == o->b),
            "--index: the bit of a line: give another"},
        {!raw && own, "--a, --b, --index: CSV has columns: they are for --raw alone"},
    };
    for (size_t i = 0; i < sizeof row / sizeof row[0]; i++) {
        if (row[i].wrong) {
            cli_complain("%s", row[i].why);
            return 2;
        }
    }
    return 0;
}

int cli_quad(int argc, char **argv)
{
    struct samples_opt opt = {.a = -1, .b = -1, .index = -1, .every = 1};
    int raw = 0, x1 = 0, x2 = 0, x4 = 0;
    const char *position = NULL;
    double step = 1;
    const struct cli_option option[] = {
        {"raw", CLI_FLAG, &raw, 0, 0, NULL, "samples on standard input, one a byte"},
        {"rate", CLI_REAL, &opt.rate_Hz, 1, 1e9, "HZ", "samples a second"},
        {"a", CLI_INT, &opt.a, 0, 7, "BIT", "where line A is in a byte"},
        {"b", CLI_INT, &opt.b, 0, 7, "BIT", "where line B is; 00 01 11 10 of AB counts up"},
        {"index", CLI_INT, &opt.index, 0, 7, "BIT",
            "where an index is: prints also index_cnt=, net at its last rising edge, and indices="},
        {"csv", CLI_TEXT, &opt.csv, 0, 0, "FILE",
            "rows of time in s, a, b; with --rate of a, b; - is standard input"},
        {"position", CLI_TEXT, &position, 0, 0, "COLUMN",
            "the rows of --csv hold positions instead, in the column of this name or number"},
        {"step", CLI_REAL, &step, 1e-12, 1e12, "X", "of --position: what one count is there (1)"},
        {"every", CLI_INT, &opt.every, 1, 1e9, "N",
            "keep one sample in N: what a slower reader would have seen"},
        {"x4", CLI_FLAG, &x4, 0, 0, NULL, "count all edges (default)"},
        {"x2", CLI_FLAG, &x2, 0, 0, NULL, "count edges of A"},
        {"x1", CLI_FLAG, &x1, 0, 0, NULL, "count edges of A where B is 1"},
    };
    const struct cli_command c = {"quad", "--raw|--csv FILE [options]",
        "Decodes the two lines of an encoder and prints one line: net count, edges (legal changes\n"
        "of either line, whatever counts), illegal steps (both lines at once), and the shortest\n"
        "time between two changes, - if there were no two. Illegal steps: exit status 1, and\n"
        "a line on standard error. A sigrok session holds samples in bytes:\n"
        "  unzip -p FILE.sr 'logic-1*' | exhand quad --raw --rate 1e6 --a 1 --b 2\n"
        "CSV may begin with a line of names; lines that begin with # or ; are left out.\n"
        "With --position: rows, net count, lowest, highest, most counts from row to row, share of\n"
        "rows without a count, and how far from a whole count a position is at most.",
        option, sizeof option / sizeof option[0], 0};
    int err = cli_parse(&c, argc, argv, NULL);

    if (err) { return err == 1 ? 0 : err; }
    if (position) {
        if (opt.csv == NULL || raw) {
            cli_complain("--position: goes with --csv FILE");
            return 2;
        }
        return positions_print(opt.csv, position, step);
    }
    if (x1 + x2 + x4 > 1) {
        cli_complain("--x1, --x2, --x4: give one of them");
        return 2;
    }
    err = check(&opt, raw);
    return err ? err : decode(&opt, x1 ? &exh_quad_x1 : x2 ? &exh_quad_x2 : &exh_quad_x4);
}
