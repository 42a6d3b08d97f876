/* SPDX-License-Identifier: MIT */
/* exhand bilateral: what its parts share. */
#ifndef CONTACT_BILATERAL_H
#define CONTACT_BILATERAL_H

#include "base/jobs.h"
#include "base/option.h"
#include "box/hand_options.h"
#include "box/hand_judge.h"
#include "box/table2_runs.h"

#include <stdio.h>

/* link.c: an option by cli_call, into both ways. */
int bilateral_take_link(void *ctx, const char *text);
/* Recorded round trips, for both ways. Else 2, and words that begin with the option. */
int bilateral_take_trace(struct bilateral_options *o, const char *option, const char *path);

/* experiment.c: exit status. */
int bilateral_experiment(const struct bilateral_options *o);

/* seeds.c. One speed with the seeds behind the first: adds them to count, by finger, which is the
 * first's. 0, or an exit status after a line on stderr. */
int bilateral_seeds(
    const struct bilateral_options *o, double mps, struct bilateral_count count[BILATERAL_FINGERS]);

/* report.c. What a speed gave, of one finger. */
#define BILATERAL_CONTACTS_MAX 1000
struct bilateral_result {
    const struct bilateral_speed *speed;
    unsigned finger;
    struct bilateral_contact *contact; /* of the first seed */
    int contacts;
    struct bilateral_count count; /* of all seeds */
    double drawn_Npm;             /* the first seed's line, as the picture has it; 0: none */
    double scale;
    long refused; /* planes */
};
void bilateral_print_head(FILE *f);
void bilateral_print(FILE *f, const struct bilateral_result *r);
/* Prints the paper's figures beside equal measurements. local->b_Npm 0: none. */
void bilateral_print_paper(FILE *f, const struct bilateral_options *o,
    const struct bilateral_result *r, int n, const struct table2_runs *local);
void bilateral_csv_head(FILE *f);
void bilateral_csv(FILE *f, const struct bilateral_result *r);
/* Whether d_lim is far enough off for these speeds; and what it should be. */
void bilateral_print_advice(
    FILE *f, const struct bilateral_options *o, const struct bilateral_result *r, int n);

/* out.c: DIR. 0, or 1 or 2 after a line on stderr. */
int bilateral_out_open(const char *dir);
FILE *bilateral_out_file(const char *dir, const char *name);
/* Last: tables and pictures of an earlier experiment do not stay beside this one's, if it made any.
 */
void bilateral_out_clear(const char *dir);
void bilateral_out_name(
    char *to, size_t cap_B, const char *dir, const char *speed, int finger, const char *suffix);
int bilateral_out_csv(
    const char *dir, const struct bilateral_run *r, unsigned f, const char *speed);
int bilateral_out_pictures(const char *dir, const struct bilateral_result *r, int n, double k_Npm,
    double b_Nspm, const char *link);

/* Additional work of exhand-lab with the options. */
struct bilateral_study {
    struct cli_more more;
    int (*refuse)(struct bilateral_options *o, double rate_Hz); /* 0 or 2; NULL: nothing */
    int (*run)(const struct bilateral_options *o);              /* NULL: the experiment */
};

/* The command: exit status. */
int bilateral_command(int argc, char **argv, const struct bilateral_study *study);

#endif
