/* SPDX-License-Identifier: MIT */
/* Jobs over processes: each result at its place, and where the work may put any structure. */
#include "base/jobs.h"
#include "check.h"

#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#define JOBS 7

struct result {
    double square;
    int64_t i;
    int aligned;
};

static void work(const void *ctx, int i, void *result)
{
    struct result *r = result;
    const int *dies = ctx;
    if (i == *dies) { _Exit(3); }
    r->aligned = (uintptr_t)result % sizeof(double) == 0;
    r->square = (double)i * i;
    r->i = i;
}

static int run(int parallel, int dies, struct result r[JOBS])
{
    const struct jobs j = {JOBS, parallel, sizeof r[0], r, work, &dies, NULL, NULL};
    return jobs_run(&j);
}

TEST(results_are_at_their_places_and_aligned)
{
    for (int parallel = 1; parallel <= 3; parallel++) {
        struct result r[JOBS] = {{0, 0, 0}};
        CHECK_EQ_I64(run(parallel, -1, r), 0);
        for (int i = 0; i < JOBS; i++) {
            CHECK(r[i].i == i && r[i].square == (double)i * i, "%d processes: job %d", parallel, i);
            CHECK(r[i].aligned, "%d processes: job %d", parallel, i);
        }
    }
}

TEST(a_job_that_dies_is_told_and_costs_only_its_own_result)
{
    struct result r[JOBS] = {{0, 0, 0}};
    CHECK_EQ_I64(run(2, 3, r), 1);
    for (int i = 0; i < JOBS; i++) { CHECK(r[i].aligned == (i != 3), "job %d", i); }
}

TEST_MAIN("jobs", results_are_at_their_places_and_aligned,
    a_job_that_dies_is_told_and_costs_only_its_own_result);
