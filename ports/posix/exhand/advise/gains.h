/* SPDX-License-Identifier: MIT */
/* exhand advise gains, in parts. */
#ifndef CLI_GAINS_H
#define CLI_GAINS_H

#include "lab/drop/cells.h"
#include "advise/region.h"

#include "exhand/gains.h"

#include <stdio.h>

#define GAINS_RATES 16

/* --- the rule: straight pieces of k over b, inside of what is allowed (gains_rule.c) --- */

/* 0, or 1 after a line on stderr: too little is allowed for one. */
int gains_rule(struct exh_gains_par *rule, struct region *r);

/* As `--set` takes it, and as C has it. */
void gains_rule_print(FILE *f, const struct exh_gains_par *rule);

/* --- against a simulated map (gains_judge.c) --- */

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

/* All cells of a file that `exhand drop --sweep` wrote. 0, or a status after a line on stderr: 3
 * without the file. */
int gains_map(struct gains_map *m, const char *path);

/* The cells of the region's rate. */
struct gains_share gains_judge(struct region *r, const struct exh_gains_par *rule,
                               const struct gains_map *m);
void gains_judge_print(const struct gains_share *s, int n);

/* mu > (pi/2) w (T/2 + delay + lag - (b + c)/k), w = sqrt(k / (mass + rotor)): what friction in
 * proportion to the tension takes out of a bounce, against what hold and delay put in. */
int gains_energy(const struct region_opt *o, double k_Npm, double b_Nspm);

/* --- files (gains_out.c) --- */

/* One rate of what was asked. */
struct gains_rate {
    struct region region;
    struct exh_gains_par rule;
    struct gains_share share;
    int has_rule;
};

/* DIR/gains.csv (nodes), allowed.csv, rule.csv, gains.gp and with a map map.csv, judge.csv. 0, or 1
 * after a line on stderr. */
int gains_write(const char *dir, struct gains_rate *r, int n, const struct gains_map *map);

#endif
