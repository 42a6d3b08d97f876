/* SPDX-License-Identifier: MIT */
#include "lab/gains/gains.h"

#include "lab/drop/cells.h"
#include "base/option.h"

#include "sim/linear.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

/* --- the map --- */

static int parse(const char *line, struct cell *c)
{
    memset(c, 0, sizeof *c);
    return sscanf(line, "%lf,%lf,%lf,%d,%d,", &c->rate_Hz, &c->k_Npm, &c->b_Nspm, &c->stable_falls,
               &c->falls) == 5 &&
           c->rate_Hz >= 1 && c->k_Npm > 0 && c->b_Nspm >= 0 && c->falls > 0 &&
           c->stable_falls >= 0 && c->stable_falls <= c->falls;
}

static int setting(const char *line, const char *name)
{
    const char *at = strstr(line, name);
    return at ? atoi(at + strlen(name)) : 0;
}

/* 0, or 1: out of memory. */
static int read_all(FILE *f, struct gains_map *m)
{
    static char line[4096]; /* the settings are the longest */
    int cap = 0;
    while (fgets(line, sizeof line, f) != NULL) {
        struct cell c;
        if (line[0] == '#') {
            m->columns = setting(line, " columns=");
            m->rows = setting(line, " rows=");
        }
        if (!parse(line, &c)) { continue; }
        if (m->n == cap) {
            struct cell *more = realloc(m->at, (size_t)(cap += 1024) * sizeof *more);
            if (more == NULL) { return 1; }
            m->at = more;
        }
        m->at[m->n++] = c;
    }
    return 0;
}

int gains_map(struct gains_map *m, const char *path)
{
    FILE *f = fopen(path, "r");
    int err;
    memset(m, 0, sizeof *m);
    if (f == NULL) {
        cli_complain("--judge: %s: %s: give the stability.csv of exhand-lab drop --sweep", path,
            strerror(errno));
        return 3;
    }
    err = read_all(f, m);
    fclose(f);
    if (err == 0 && m->n > 0 && m->columns > 1 && m->rows > 1) { return 0; }
    cli_complain(
        err ? "--judge: %s: out of memory"
            : "--judge: %s: no cell in it: give the stability.csv of exhand-lab drop --sweep",
        path);
    return err ? 1 : 2;
}

static int same(double a, double b) { return a - b <= 1e-6 * a && b - a <= 1e-6 * a; }

/* 1 for each cell of the grid of a rate, what counts as area: a sweep also has octaves and what
 * bisection asked for. A row of the grid has a cell in each column, a column one in each such row.
 */
static void mark_grid(const struct gains_map *m, double rate_Hz, char *grid)
{
    const struct cell *c = m->at;
    for (int i = 0; i < m->n; i++) {
        int count = 0;
        for (int j = 0; j < m->n && same(c[i].rate_Hz, rate_Hz); j++) {
            count += same(c[j].rate_Hz, rate_Hz) && same(c[i].b_Nspm, c[j].b_Nspm);
        }
        grid[i] = count >= m->columns;
    }
    for (int i = 0; i < m->n; i++) {
        int count = 0;
        for (int j = 0; j < m->n && grid[i]; j++) {
            count += grid[j] && same(c[i].k_Npm, c[j].k_Npm);
        }
        if (grid[i] && count < m->rows) { grid[i] = 2; } /* still counted for the others */
    }
    for (int i = 0; i < m->n; i++) { grid[i] = grid[i] == 1; }
}

/* --- the shares --- */

static int rule_allows(const struct exh_gains_par *rule, const struct cell *c)
{
    return exh_gains_ok(rule, (int32_t)(c->k_Npm * 1024), (int32_t)(c->b_Nspm * 1048576));
}

static void count_grid(struct gains_share *s, struct region *r, const struct exh_gains_par *rule,
    const struct cell *c, int allowed)
{
    const int stable = cell_stable(c), rests = c->stable_falls == c->falls;
    const double rho =
        linear_rho(&r->o.device, r->o.wall.T_s, c->k_Npm, c->b_Nspm, r->o.wall.window);
    const int linear = rho >= 0 && rho < 1, energy = region_energy(&r->o, c->k_Npm, c->b_Nspm);
    s->cells++;
    s->stable += stable;
    s->at_rest += rests;
    s->allowed_stable += allowed && stable;
    s->allowed_at_rest += allowed && rests;
    s->linear_stable += linear && stable;
    s->linear_unstable += linear && !stable;
    s->energy_stable += energy && stable;
    s->energy_unstable += energy && !stable;
    s->rule_stable += stable && rule_allows(rule, c);
}

struct gains_share gains_judge(
    struct region *r, const struct exh_gains_par *rule, const struct gains_map *m)
{
    char *grid = calloc((size_t)m->n, 1);
    struct gains_share s;
    memset(&s, 0, sizeof s);
    s.rate_Hz = 1 / r->o.wall.T_s;
    if (grid != NULL) { mark_grid(m, s.rate_Hz, grid); }
    for (int i = 0; i < m->n && grid != NULL; i++) {
        const struct cell *c = &m->at[i];
        int allowed;
        if (!same(c->rate_Hz, s.rate_Hz)) { continue; }
        allowed = region_allows(r, c->k_Npm, c->b_Nspm);
        if (grid[i]) { count_grid(&s, r, rule, c, allowed); }
        if (!allowed) { continue; }
        s.inside++;
        s.unstable += !cell_stable(c);
        s.falls += c->falls;
        s.restless += c->falls - c->stable_falls;
    }
    free(grid);
    return s;
}

static double percent(int part, int whole) { return whole > 0 ? 100.0 * part / whole : 0; }

void gains_judge_print(const struct gains_share *s, int n)
{
    printf("\nAgainst the map: cells of its grid that are stable (nine of ten falls come to rest) "
           "and of which "
           "all falls do,\nwhat share of both is allowed, what share of the stable ones the rule, "
           "the linear "
           "test and the closed form\nwith friction (energy) allow, with how many unstable cells; "
           "and of all "
           "cells allowed, what did not rest\n\n"
           "  rate | stable    all | advised:  of all |    rule |  linear   unstable |  energy   "
           "unstable | "
           "allowed unstable |  falls  not at rest\n");
    for (int i = 0; i < n; i++, s++) {
        printf("%6.6g | %6d %6d | %5.1f %%  %5.1f %% | %5.1f %% | %5.1f %% %10d | %5.1f %% %10d | "
               "%7d %8d | %6ld "
               "%12ld\n",
            s->rate_Hz, s->stable, s->at_rest, percent(s->allowed_stable, s->stable),
            percent(s->allowed_at_rest, s->at_rest), percent(s->rule_stable, s->stable),
            percent(s->linear_stable, s->stable), s->linear_unstable,
            percent(s->energy_stable, s->stable), s->energy_unstable, s->inside, s->unstable,
            s->falls, s->restless);
    }
}
