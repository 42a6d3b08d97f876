/* SPDX-License-Identifier: MIT */
/* exhand-lab advise gains: against a simulated map, and what its picture needs. */
#ifndef LAB_GAINS_GAINS_H
#define LAB_GAINS_GAINS_H

#include "advise/gains.h"
#include "lab/drop/cells.h"

struct gains_share {
    double rate_Hz;
    int cells, stable, at_rest;          /* of the map's grid; nine of ten falls, all falls */
    int allowed_stable, allowed_at_rest; /* of those, inside */
    int linear_stable, linear_unstable;  /* rho < 1, of the grid */
    int energy_stable, energy_unstable;  /* the closed form with friction, of the grid */
    int rule_stable;
    int inside, unstable; /* of all cells inside: how many, how many unstable */
    long falls, restless; /* in these */
};

struct gains_map {
    struct cell *at; /* the caller's to free */
    int n, columns, rows;
};

/* All cells of a file that `exhand-lab drop --sweep` wrote. 0, or a status after a line on stderr:
 * 3 without the file. */
int gains_map(struct gains_map *m, const char *path);

/* The cells of the region's rate. */
struct gains_share gains_judge(
    struct region *r, const struct exh_gains_par *rule, const struct gains_map *m);
void gains_judge_print(const struct gains_share *s, int n);

/* DIR/gains.csv (nodes), allowed.csv, rule.csv, gains.gp and with a map map.csv, judge.csv. 0, or 1
 * after a line on stderr. */
int gains_write(const char *dir, struct gains_rate *r, const struct gains_share *s, int n,
    const struct gains_map *map);

#endif
