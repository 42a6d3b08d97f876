/* SPDX-License-Identifier: MIT */
/* exhand-lab advise gains: against a simulated map, and what its picture needs. */
#ifndef LAB_GAINS_GAINS_H
#define LAB_GAINS_GAINS_H

#include "advise/gains.h"
#include "lab/drop/cells.h"

/* Areas of the k-b plane. A node of a ray covers the area around it, gain squared. */
struct gains_share {
    double rate_Hz;
    double all, stable, at_rest;            /* of the map; nine of ten falls, all falls rest */
    double allowed_stable, allowed_at_rest; /* of those, inside of the rule */
    double linear_stable, linear_unstable;  /* rho < 1 */
    double energy_stable, energy_unstable;  /* the closed form with friction */
    int inside, unstable;                   /* nodes inside: how many, how many unstable */
    long falls, restless;                   /* in these */
};

struct gains_map {
    struct cell *at; /* the caller's to free */
    int n;
};

/* All cells of a file that `exhand-lab drop --sweep` wrote. 0, or a status after a line on stderr:
 * 3 without the file. */
int gains_map(struct gains_map *m, const char *path);

/* The cells of its rate. */
struct gains_share gains_judge(const struct gains_rate *r, const struct gains_map *m);
void gains_judge_print(const struct gains_share *s, int n);

/* DIR/allowed.csv (rows), rule.csv, gains.gp and with a map map.csv, judge.csv. 0, or 1
 * after a line on stderr. */
int gains_write(const char *dir, struct gains_rate *r, const struct gains_share *s, int n,
    const struct gains_map *map);

#endif
