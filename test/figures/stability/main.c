/* SPDX-License-Identifier: MIT */
/* Stability: stiff and extreme cases against theory. `make stability`; parts of it are sections of
 * `make report`.
 *
 *   map      Every rate, k to 10^6 N/m, b to 10^3 Ns/m, 1 g to 5 kg, 0 to 3 ticks of delay. Does
 *            the library's law with an exact mass grow or decay as the spectral radius says?
 *   device   The same with dry friction, encoder steps, a string that only pulls and a peak force,
 *            one by one and together.
 *   plane    Limit cycles of encoder steps over friction and damping (the sigma-beta plane),
 *            against its borders.
 *   filters  Every filter and velocity estimator comes to rest exactly, from any state; direct
 *            forms for comparison.
 *   drift    10^9 ticks of cheap laws. The last period gives the bits of the first. Counters wrap.
 *
 * Prints one line for each rule: the rule, what held, ok or FAIL. Exit status 1 on any FAIL. */
#include "stability.h"

#include "sim/linear.h"
#include "sim/random.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

static const char *out_dir;
static FILE *rules; /* the same lines as Markdown, in that directory */
static struct sim_random rng = {1};

void exh_assert_failed(const char *file, int line);
void exh_assert_failed(const char *file, int line)
{
    fprintf(stderr, "%s:%d: the library's assertion\n", file, line);
    abort();
}

uint64_t any_u64(void) { return sim_random_u64(&rng); }

double spaced(double low, double high, int i, int n)
{
    return low * pow(high / low, n > 1 ? (double)i / (n - 1) : 0);
}

double rho_of(const struct wall *w)
{
    static struct matrix M;
    const double T_s = (double)w->T.num / w->T.den;
    const struct linear_plant p = linear_one_mass(w->mass_kg, w->viscous_Nspm, 0);
    const struct linear_wall law = {T_s, w->k_Npm, w->b_Nspm, w->delay * T_s, 1};
    return linear_monodromy(&M, &p, &law) == 0 ? eigen_radius(&M) : -1;
}

/* A file in the output directory, or /dev/null without one. */
static FILE *open_out(const char *name, const char *ends)
{
    char path[512];
    const int n = snprintf(path, sizeof path, "%s/%s%s", out_dir ? out_dir : "", name, ends);
    FILE *f = n < (int)sizeof path ? fopen(out_dir ? path : "/dev/null", "w") : NULL;
    if (f != NULL) { return f; }
    fprintf(stderr, "stability: %s: %s\n", path, strerror(errno));
    exit(2);
}

FILE *csv_open(const char *name, const char *header)
{
    FILE *f = open_out(name, ".csv");
    fprintf(f, "%s\n", header);
    return f;
}

void csv_close(FILE *f)
{
    if (fclose(f) == 0) { return; }
    fprintf(stderr, "stability: %s: %s\n", out_dir, strerror(errno));
    exit(2);
}

int must(int holds, const char *what, const char *fmt, ...)
{
    char held[200];
    va_list ap;
    va_start(ap, fmt);
    vsnprintf(held, sizeof held, fmt, ap);
    va_end(ap);
    printf("%-72s | %s | %s\n", what, held, holds ? "ok" : "FAIL");
    fflush(stdout);
    fprintf(rules, "| %s | %s | %s |\n", what, held, holds ? "ok" : "**FAIL**");
    return !holds;
}

static const char usage[] = "usage: stability [--short|--full] [--ticks N] [--out DIR] "
                            "[map|device|plane|filters|drift ...]\n"
                            "  --short, --full  fewer cells, for CI; more\n"
                            "  --ticks N        of each law of drift, 2000000 or more (short "
                            "2000000, usual 2*10^7, full 10^9)\n"
                            "  --out DIR        CSV files go there\n"
                            "Exit status: 0 ok, 1 a rule does not hold, 2 bad usage.\n";

static int bad(const char *arg)
{
    fprintf(stderr, "stability: %s?\n%s", arg, usage);
    return 2;
}

int main(int argc, char **argv)
{
    static const char *const part[] = {"map", "device", "plane", "filters", "drift"};
    static const uint64_t of_size[] = {2000000, 20000000, 1000000000};
    unsigned parts = 0;
    uint64_t ticks = 0;
    enum size size = USUAL;
    int failed = 0;
    for (int i = 1; i < argc; i++) {
        size_t p = 0;
        while (p < LEN(part) && strcmp(argv[i], part[p]) != 0) { p++; }
        if (p < LEN(part)) {
            parts |= 1u << p;
        } else if (strcmp(argv[i], "--short") == 0) {
            size = SHORT;
        } else if (strcmp(argv[i], "--full") == 0) {
            size = FULL;
        } else if (strcmp(argv[i], "--help") == 0) {
            return fputs(usage, stdout) < 0;
        } else if (strcmp(argv[i], "--out") == 0 && i + 1 < argc) {
            out_dir = argv[++i];
        } else if (strcmp(argv[i], "--ticks") == 0 && i + 1 < argc) {
            ticks = strtoull(argv[++i], NULL, 10);
            if (ticks < 2000000) { return bad(argv[i]); }
        } else {
            return bad(argv[i]);
        }
    }
    if (parts == 0) { parts = 31; }
    rules = open_out("stability", ".md");
    fprintf(rules, "| must hold | held | |\n|--|--|--|\n");
    if (parts & 1) { failed += linear_map(size); }
    if (parts & 2) { failed += device_map(size); }
    if (parts & 4) { failed += quantized_plane(size); }
    if (parts & 8) { failed += filters_at_rest(size); }
    if (parts & 16) { failed += drifts(ticks ? ticks : of_size[size]); }
    csv_close(rules);
    printf("%d failed\n", failed);
    return failed != 0;
}
