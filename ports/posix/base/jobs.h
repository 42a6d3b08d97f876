/* SPDX-License-Identifier: MIT */
/* Independent jobs over all cores: one process each, results in order. */
#ifndef CLI_JOBS_H
#define CLI_JOBS_H

#include <stddef.h>

#define JOBS_INTERRUPTED  130 /* what shells say of a program ended by Ctrl-C */
#define JOBS_PARALLEL_MAX 1024

struct jobs {
    int n;           /* how many */
    int parallel;    /* at a time; 1 runs them in this process */
    size_t result_B; /* of one result, <= 1024 */
    void *result;    /* n of them; what no job wrote stays as it was */
    void (*work)(const void *ctx, int i, void *result);
    const void *ctx;
    const char *label;       /* for the progress line on a terminal; NULL for none */
    void (*interrupt)(void); /* makes work() return early, in its process, from
                                a signal handler; NULL: it runs to its end */
};

/* 0, or 1 after a line on stderr: a job died. SIGINT and SIGTERM are passed on to
 * the jobs that run and no new one starts: then, with all of them reaped, 130. */
int jobs_run(const struct jobs *j);

/* Cores of this machine, at least 1. */
int jobs_cores(void);

#endif
