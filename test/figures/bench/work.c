/* SPDX-License-Identifier: MIT */
/* work errors | count | time: kernels of ours and of others, as CSV for the report.
 *
 * errors: kernel, name, kind, unit, when, the largest and the rms error. when is "all", or the
 * seconds of 2 kHz ticks: then the errors are those of the second before. count: as kernels count
 * does. time: kernel, name, ns of one op, the least of 15 runs.
 */
#define _POSIX_C_SOURCE 200809L
#include "work.h"
#include "clock.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define SECOND 2000u

static const struct work_group *const groups[] = {
    &law_works,
    &table_works,
    &hand_works,
    &freeze_works,
    &passivity_works,
    &speed_works,
#ifdef PEERS_CMSIS
    &cmsis_works,
#endif
#ifdef PEERS_FIXMATH
    &fixmath_works,
#endif
};

static double rms_of(const struct error *e)
{
    return sqrt((double)(e->sum_squares / (long double)(e->n ? e->n : 1)));
}

static void print_errors(const struct work *w)
{
    static const uint32_t until[] = {1, 10, 60, 600, 3600};
    struct error all = {0, 0, 0}, second = {0, 0, 0};
    if (w->ticks == 0) { return; }
    w->setup();
    for (uint32_t i = 0; i < w->ticks; i++) {
        const long double off = w->off(i);
        error_add(&all, off);
        error_add(&second, off);
        if (w->ticks != WORK_HOUR || (i + 1) % SECOND != 0) { continue; }
        for (size_t k = 0; k < sizeof until / sizeof until[0]; k++) {
            if (i + 1 == until[k] * SECOND) {
                printf("%s,%s,%s,%s,%u,%.4g,%.4g\n", w->kernel, w->name, w->kind, w->unit,
                    (unsigned)until[k], (double)second.max, rms_of(&second));
            }
        }
        second = (struct error){0, 0, 0};
    }
    printf("%s,%s,%s,%s,all,%.4g,%.4g\n", w->kernel, w->name, w->kind, w->unit, (double)all.max,
        rms_of(&all));
}

static void run(void (*op)(uint32_t i))
{
    for (uint32_t i = 0; i < BENCH_OPS; i++) { op(i); }
    bench_measure(op, BENCH_OPS);
}

static void print_count(const struct work *w)
{
    w->setup();
    run(w->op);
    printf("%s,%s,%lu\n", w->kernel, w->name, (unsigned long)BENCH_OPS);
}

static void empty(uint32_t i) { (void)i; }

static void print_time(const struct work *w)
{
    w->setup();
    printf("%s,%s,%.2f\n", w->kernel, w->name, bench_least_ns(w->op) - bench_least_ns(empty));
}

static void for_each(void (*visit)(const struct work *w))
{
    for (size_t g = 0; g < sizeof groups / sizeof groups[0]; g++) {
        for (size_t i = 0; i < groups[g]->n; i++) { visit(&groups[g]->work[i]); }
    }
}

int main(int argc, char **argv)
{
    const char *mode = argc == 2 ? argv[1] : "";
    if (strcmp(mode, "errors") == 0) {
        for_each(print_errors);
    } else if (strcmp(mode, "count") == 0) {
        run(empty);
        printf("empty,,%lu\n", (unsigned long)BENCH_OPS);
        for_each(print_count);
    } else if (strcmp(mode, "time") == 0) {
        for_each(print_time);
    } else {
        fprintf(stderr, "usage: work errors|count|time\n");
        return 2;
    }
    return 0;
}
