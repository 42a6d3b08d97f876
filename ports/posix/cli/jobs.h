/* Independent jobs over all cores: one process each, results in order. */
#ifndef CLI_JOBS_H
#define CLI_JOBS_H

#include <stddef.h>

struct jobs {
    int n;             /* how many                                             */
    int parallel;      /* at a time; 1 runs them in this process               */
    size_t result_B;   /* of one result, <= 1024                               */
    void *result;      /* n of them                                            */
    void (*work)(const void *ctx, int i, void *result);
    const void *ctx;
    const char *label; /* for the progress line on a terminal; NULL for none    */
};

/* 0, or 1 after a line on stderr: a job died, or was interrupted. */
int jobs_run(const struct jobs *j);

/* Cores of this machine, at least 1. */
int jobs_cores(void);

#endif
