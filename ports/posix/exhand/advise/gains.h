/* SPDX-License-Identifier: MIT */
/* exhand advise gains, in parts. */
#ifndef CLI_GAINS_H
#define CLI_GAINS_H

#include "advise/region.h"

#include "base/option.h"

#include "exhand/gains.h"

#include <stdio.h>

#define GAINS_RATES 16

struct gains_options {
    struct region_opt o;
    double rate_Hz[GAINS_RATES], k_Npm, b_Nspm, off_percent, margin_percent;
    int64_t cases, window, jobs;
    int rates, rates_given, rule;
    const char *grid;
};

/* One rate of what was asked. */
struct gains_rate {
    double rate_Hz;
    struct region region;
    struct exh_gains_par rule;
    int has_rule;
};

/* What the lab does besides. An exit status after a line on stderr, or 0; NULL: nothing. */
struct gains_study {
    struct cli_more more;
    int (*begin)(struct gains_options *a);            /* may choose the rates */
    int (*rate)(struct gains_rate *r, int i);         /* 1: what it allows does not rest */
    int (*end)(struct gains_rate *r, int n, int all); /* all: every rate came to its end */
};

/* `exhand advise`, study of `advise gains`: exit status. */
int advise_command(int argc, char **argv, const struct gains_study *study);
int gains_command(int argc, char **argv, const struct gains_study *study);

/* --- the rule: straight pieces of k over b, inside of what is allowed (rule.c) --- */

/* 0, or 1 after a line on stderr: too little is allowed for one. */
int gains_rule(struct exh_gains_par *rule, struct region *r);

/* As `--set` takes it, and as C has it. */
void gains_rule_print(FILE *f, const struct exh_gains_par *rule);

#endif
