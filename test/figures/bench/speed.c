/* SPDX-License-Identifier: MIT */
/* How much faster than real time is the simulation? It runs through the port and the firmware's
 * loop. The runs are the paper's two experiments at 2 kHz: ten falls, and a hand with one and with
 * five fingers at the three speeds, of eight seeds. As in `exhand bilateral`, one run takes one
 * core and several go at a time. A core is judged; what all cores do is printed beside it.
 * Usage: speed [EXPERIMENT [MAX_TICKS]]; with MAX_TICKS, one seed in this process, for a profile.
 */
#include "base/jobs.h"
#include "box/hand_options.h"
#include "posix.h"

#include "drop/drop.h"
#include "exhand/run/loop.h"

#include "exhand/exhand.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <time.h>

#define SEEDS   8
#define RUNS    (3 * SEEDS)
#define RATE_HZ 2000

/* The paper's point at 2 kHz; the rest are the scene's defaults. */
static int set_parameters(void)
{
    struct exh_params *p;
    int err;
    exh_scene_drop.defaults();
    p = exh_scene_drop.params;
    err = exh_params_stage(p, exh_calib_set_rows[2].id, 0, 1); /* uncalibrated */
    if (err == 0) {
        err = exh_params_stage(p, exh_contact_rows[0].id, 0, EXH_Q(20000, 1, EXH_Q_K));
    }
    return err < 0 ? err : exh_params_stage(p, exh_contact_rows[1].id, 0, EXH_Q(60, 1, EXH_Q_B));
}

static double falls(int run, unsigned fingers, uint32_t max_ticks)
{
    struct posix_config c = posix_config_default();
    int err = set_parameters();
    (void)fingers;
    c.falls = 10;
    c.seed = (uint64_t)(1 + run);
    c.max_ticks = max_ticks;
    posix_configure(&c);
    if (err == 0) { err = exh_loop(&exh_scene_drop, RATE_HZ, NULL); }
    if (err == 0 &&
        ((const struct drop_signals *)exh_scene_signals(&exh_scene_drop))->faults != 0) {
        err = -EXH_E_STATE;
    }
    return err < 0 ? err : posix_time_s();
}

static double hand(int run, unsigned fingers, uint32_t max_ticks)
{
    static struct bilateral_options o;
    struct bilateral_run_cfg c;
    struct bilateral_run r;
    int err;
    bilateral_defaults(&o);
    o.run.rate_Hz = RATE_HZ;
    o.run.bare = 1;
    o.run.k_Npm = 20000;
    o.run.b_Nspm = 60;
    o.run.board.exo.fingers = fingers;
    o.run.board.max_ticks = max_ticks;
    c = bilateral_at_speed(&o, o.speed[run % o.speeds].mps);
    c.board.seed = (uint64_t)(1 + run / o.speeds);
    err = bilateral_run(&c, &r);
    if (err == 0 && r.faults != 0) { err = -EXH_E_STATE; }
    bilateral_run_free(&r);
    return err < 0 ? err : posix_time_s();
}

static const struct experiment {
    const char *name, *says;
    double (*run)(
        int run, unsigned fingers, uint32_t max_ticks); /* s of simulation, or -EXH_E... */
    int runs;                                           /* of one seed */
    unsigned fingers;
    double want;
} experiment[] = {
    {"drop", "a fall", falls, 1, 0, 2500},
    {"bilateral", "a hand with one finger", hand, 3, 1u << EXH_INDEX, 1000},
    {"bilateral5", "a hand with five fingers", hand, 3, (1u << EXH_FINGERS) - 1, 300},
};
static uint32_t max_ticks;

static void work(const void *ctx, int i, void *result)
{
    const struct experiment *e = ctx;
    *(double *)result = e->run(i, e->fingers, max_ticks);
}

static double clock_s(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Of this process and of the jobs that have ended. */
static double cpu_s(void)
{
    struct rusage own, jobs;
    getrusage(RUSAGE_SELF, &own);
    getrusage(RUSAGE_CHILDREN, &jobs);
    return (double)(own.ru_utime.tv_sec + own.ru_stime.tv_sec + jobs.ru_utime.tv_sec +
                    jobs.ru_stime.tv_sec) +
           1e-6 * (double)(own.ru_utime.tv_usec + own.ru_stime.tv_usec + jobs.ru_utime.tv_usec +
                           jobs.ru_stime.tv_usec);
}

static int measure(const struct experiment *e)
{
    double second[RUNS] = {0}, s = 0, cpu = cpu_s(), took = clock_s();
    const struct jobs j = {.n = e->runs * (max_ticks ? 1 : SEEDS),
        .parallel = max_ticks ? 1 : jobs_cores(),
        .result_B = sizeof second[0],
        .result = second,
        .work = work,
        .ctx = e};
    if (jobs_run(&j) != 0) { return 1; }
    cpu = cpu_s() - cpu;
    took = clock_s() - took;
    for (int i = 0; i < j.n; i++) {
        if (second[i] < 0) {
            fprintf(stderr, "speed: %s: %s\n", e->name, exh_error_text((int)second[i]));
            return 1;
        }
        s += second[i];
    }
    printf(
        "simulation: %.1f s of %s at %d Hz: a core %.0f x real time, wanted %.0f: %s; %d at a time"
        " %.0f x\n",
        s, e->says, RATE_HZ, s / cpu, e->want, s >= e->want * cpu ? "PASS" : "FAIL", j.parallel,
        s / took);
    return 0;
}

int main(int argc, char **argv)
{
    max_ticks = argc > 2 ? (uint32_t)strtoul(argv[2], NULL, 10) : 0;
    for (size_t i = 0; i < sizeof experiment / sizeof experiment[0]; i++) {
        if (argc > 1 && strcmp(argv[1], experiment[i].name) != 0) { continue; }
        if (measure(&experiment[i]) != 0) { return 1; }
    }
    return 0;
}
