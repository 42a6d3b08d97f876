/* SPDX-License-Identifier: MIT */
#include "lab/gains/gains.h"

#include "lab/drop/cells.h"
#include "base/fifo.h"
#include "base/lines.h"
#include "base/option.h"

#include "sim/linear.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

/* --- the map --- */

#define IT_IS "give the stability.csv of exhand-lab drop --sweep"

static int parse(const char *line, struct cell *c)
{
    memset(c, 0, sizeof *c);
    return sscanf(line, "%lf,%d,%lf,%lf,%lf,%d,%d,", &c->rate_Hz, &c->ray, &c->gain, &c->k_Npm,
               &c->b_Nspm, &c->resting, &c->falls) == 7 &&
           c->rate_Hz >= 1 && c->gain > 0 && c->k_Npm > 0 && c->b_Nspm >= 0 && c->falls > 0 &&
           c->resting >= 0 && c->resting <= c->falls;
}

/* 0, or an exit status. */
static int read_all(FILE *f, struct gains_map *m, const char *path)
{
    static char line[4096]; /* the settings are the longest */
    int cap = 0, more;
    while ((more = lines_next(f, line, sizeof line)) != 0) {
        struct cell c;
        if (more < 0) {
            cli_complain("--judge: %s: a line does not end: " IT_IS, path);
            return 2;
        }
        if (!parse(line, &c)) { continue; }
        if (m->n == cap) {
            struct cell *room = realloc(m->at, (size_t)(cap += 1024) * sizeof *room);
            if (room == NULL) {
                cli_complain("--judge: %s: out of memory", path);
                return 1;
            }
            m->at = room;
        }
        m->at[m->n++] = c;
    }
    return 0;
}

int gains_map(struct gains_map *m, const char *path)
{
    FILE *f = fifo_read(path);
    int err;
    memset(m, 0, sizeof *m);
    if (f == NULL) {
        cli_complain("--judge: %s: %s: " IT_IS, path, strerror(errno));
        return 3;
    }
    err = read_all(f, m, path);
    fclose(f);
    if (err || m->n > 0) { return err; }
    cli_complain("--judge: %s: no cell in it: " IT_IS, path);
    return 2;
}

static int same(double a, double b) { return a - b <= 1e-6 * a && b - a <= 1e-6 * a; }

/* --- the shares --- */

static int stable(const struct cell *c) { return 10 * c->resting >= 9 * c->falls; }

static void add(
    struct gains_share *s, const struct region_opt *o, const struct cell *c, int allowed)
{
    const int is = stable(c), rests = c->resting == c->falls;
    const double rho =
        linear_rho(&o->device[0], o->wall.T_s, c->k_Npm, c->b_Nspm, o->wall.velocity.window);
    const int linear = rho >= 0 && rho < 1, energy = region_energy(o, c->k_Npm, c->b_Nspm);
    const double area = c->gain * c->gain;
    s->all += area;
    s->stable += area * is;
    s->at_rest += area * rests;
    s->allowed_stable += area * (allowed && is);
    s->allowed_at_rest += area * (allowed && rests);
    s->linear_stable += area * (linear && is);
    s->linear_unstable += area * (linear && !is);
    s->energy_stable += area * (energy && is);
    s->energy_unstable += area * (energy && !is);
}

struct gains_share gains_judge(const struct gains_rate *r, const struct gains_map *m)
{
    struct gains_share s;
    memset(&s, 0, sizeof s);
    s.rate_Hz = r->rate_Hz;
    for (int i = 0; i < m->n; i++) {
        const struct cell *c = &m->at[i];
        const int allowed = gains_allows(&r->rule, c->k_Npm, c->b_Nspm);
        if (!same(c->rate_Hz, s.rate_Hz)) { continue; }
        add(&s, &r->region.o, c, allowed);
        if (!allowed) { continue; }
        s.inside++;
        s.unstable += !stable(c);
        s.falls += c->falls;
        s.restless += c->falls - c->resting;
    }
    return s;
}

static double percent(double part, double whole) { return whole > 0 ? 100 * part / whole : 0; }

void gains_judge_print(const struct gains_share *s, int n)
{
    printf("\nAgainst the map: what share of the area that is stable (nine of ten falls come to "
           "rest), and of that\nwhere all falls do, is allowed; what share of the stable area the "
           "linear test and the closed form\nwith friction (energy) allow, with how much "
           "unstable area beside it; and of all nodes allowed, what did not rest\n\n"
           "  rate | allowed:  of all |  linear   unstable |  energy   unstable | allowed "
           "unstable |  falls  not at rest\n");
    for (int i = 0; i < n; i++, s++) {
        printf("%6.6g | %5.1f %%  %5.1f %% | %5.1f %%   %5.1f %% | %5.1f %%   %5.1f %% | "
               "%7d %8d | %6ld %12ld\n",
            s->rate_Hz, percent(s->allowed_stable, s->stable),
            percent(s->allowed_at_rest, s->at_rest), percent(s->linear_stable, s->stable),
            percent(s->linear_unstable, s->stable), percent(s->energy_stable, s->stable),
            percent(s->energy_unstable, s->stable), s->inside, s->unstable, s->falls, s->restless);
    }
}
