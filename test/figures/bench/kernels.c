/* SPDX-License-Identifier: MIT */
/* kernels errors | count | anchors | build: the tables of the bench, as CSV for bench.sh.
 *
 * count runs every op BENCH_OPS times, the empty one first, and prints the order: the
 * k-th line belongs to the k-th profile that callgrind dumps after bench_measure().
 */
#include "bench.h"
#include "force.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#ifndef BENCH_FLAGS
#define BENCH_FLAGS "flags not told"
#endif

static const struct kernel_group *const groups[] = {&number_group, &estimate_group, &force_group,
    &filter_group, &glove_group, &hand_group, &precontact_group, &passivity_group, &scene_group,
    &modbus_group, &params_group, &keyed_group, &box_group, &limiter_group};

static void for_each(void (*visit)(const struct kernel *k))
{
    for (size_t g = 0; g < sizeof groups / sizeof groups[0]; g++) {
        for (size_t i = 0; i < groups[g]->n; i++) { visit(&groups[g]->kernel[i]); }
    }
}

static void print_error(const struct kernel *k)
{
    struct error e = {0, 0, 0};
    double rms;
    k->error(&e);
    rms = sqrt((double)(e.sum_squares / (long double)(e.n ? e.n : 1)));
    printf("%s,%s,%.4g,%.4g,%.4g,%.4g,%g,%llu,%s\n", k->name, k->unit[0] ? k->unit : "-",
        (double)e.max * k->lsb, rms * k->lsb, (double)e.max, rms, k->bound_lsb,
        (unsigned long long)e.n, k->why);
}

static void errors(void)
{
    struct force_drift d;
    for_each(print_error);
    d = force_drift();
    printf("# drift over 1 h of 2 kHz ticks, worst error in LSB of force (0.95 uN), first second /"
           " last second: contact_law %.3f / %.3f, plain float law %.1f / %.1f\n",
        d.law.first_second_lsb, d.law.last_second_lsb, d.law_float.first_second_lsb,
        d.law_float.last_second_lsb);
}

static void empty(uint32_t i) { (void)i; }

/* One unmeasured round first: it binds symbols and warms the states. */
static void run(void (*op)(uint32_t i))
{
    for (uint32_t i = 0; i < BENCH_OPS; i++) { op(i); }
    bench_measure(op, BENCH_OPS);
}

static void count_kernel(const struct kernel *k)
{
    k->setup();
    run(k->op);
    printf("%s,%lu\n", k->name, (unsigned long)(BENCH_OPS * k->per));
}

static void count(void)
{
    run(empty);
    printf("empty,%lu\n", (unsigned long)BENCH_OPS);
    for_each(count_kernel);
}

static void print_anchor(const struct kernel *k)
{
    if (k->source != NULL) { printf("%s,%g,%s\n", k->name, k->anchor, k->source); }
}

static void anchors(void) { for_each(print_anchor); }

static void build(void)
{
#if defined __clang__
    printf("clang " __clang_version__ BENCH_FLAGS "\n"); /* the version ends in a space */
#else
    printf("gcc " __VERSION__ " " BENCH_FLAGS "\n");
#endif
}

int main(int argc, char **argv)
{
    static const struct {
        const char *name;
        void (*run)(void);
    } mode[] = {{"errors", errors}, {"count", count}, {"anchors", anchors}, {"build", build}};

    for (size_t i = 0; argc == 2 && i < sizeof mode / sizeof mode[0]; i++) {
        if (strcmp(argv[1], mode[i].name) == 0) {
            mode[i].run();
            return 0;
        }
    }
    fprintf(stderr, "usage: kernels errors|count|anchors|build\n");
    return 2;
}
