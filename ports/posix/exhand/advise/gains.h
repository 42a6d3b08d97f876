/* SPDX-License-Identifier: MIT */
/* exhand advise gains, in parts. */
#ifndef CLI_GAINS_H
#define CLI_GAINS_H

#include "advise/region.h"

#include "base/option.h"
#include "identify/result.h"

#include "exhand/gains.h"

#include <stdio.h>

#define GAINS_RATES 16

struct gains_options {
    struct region_opt o;
    double rate_Hz[GAINS_RATES], k_Npm, b_Nspm, phase, off_percent, margin_percent;
    int64_t cases, window, jobs;
    int rates, rates_given, rule, has_file;
    struct result_file file; /* of exhand identify */
};

/* One rate of what was asked. */
struct gains_rate {
    double rate_Hz;
    struct region region;
    struct exh_gains_par rule;
};

/* Additional work of exhand-lab. Returns an exit status after a line on stderr, or 0. NULL: none.
 */
struct gains_study {
    struct cli_more more;
    int (*begin)(struct gains_options *a);            /* may choose the rates */
    int (*rate)(struct gains_rate *r, int i);         /* 1: what it allows does not rest */
    int (*end)(struct gains_rate *r, int n, int all); /* all: every rate came to its end */
};

/* `exhand advise`, study of `advise gains`: exit status. */
int advise_command(int argc, char **argv, const struct gains_study *study);
int gains_command(int argc, char **argv, const struct gains_study *study);

/* Defaults first, then the given options into o. 0, or 2 after a line on stderr. */
void gains_defaults(struct gains_options *a);
int gains_refuse(struct gains_options *a);

/* The devices of o, of a file, at a rate. 0, or 2 after a line on stderr. */
int gains_told(struct region_opt *o, const struct result_file *f, double rate_Hz);

/* --- the rule: straight pieces of k over b, inside of what is allowed (rule.c) --- */

/* 0, or 1 after a line on stderr: too little is allowed for one. */
int gains_rule(struct exh_gains_par *rule, const struct region *r);

/* Shrinks the rule by this share of k, and of its width in b. On the original line, the few falls
 * of a pair hardly show one fall in a hundred that does not come to rest. The result allows nothing
 * that the rule did not. */
void gains_rule_inwards(struct exh_gains_par *rule, double by);

/* A rule, and every pair that is then tried along its line and below it holds: what does not cuts
 * the rows beside it. At last it moves inwards, where the options say so (prove.c). */
int gains_proved(struct gains_rate *x);

/* As a scene with this rule answers: the one answer there is. */
int gains_allows(const struct exh_gains_par *rule, double k_Npm, double b_Nspm);

/* The largest k at this b; 0: none. */
double gains_k_max(const struct exh_gains_par *rule, double b_Nspm);

/* As `--set` takes it, and as C has it. */
void gains_rule_print(FILE *f, const struct exh_gains_par *rule);

#endif
