/* SPDX-License-Identifier: MIT */
/* How much faster than real time is the simulation? It runs through the port and the firmware's
 * loop. The runs are the paper's two experiments at 2 kHz: ten falls, and a hand with one and with
 * five fingers at the three speeds. Usage: speed [EXPERIMENT [MAX_TICKS]]. */
#include "box/hand_options.h"
#include "posix.h"

#include "drop/drop.h"
#include "exhand/run/loop.h"

#include "exhand/exhand.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

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

/* Seconds that were simulated, or -EXH_E… */
static double falls(unsigned fingers, uint32_t max_ticks)
{
    struct posix_config c = posix_config_default();
    int err = set_parameters();
    (void)fingers;
    c.falls = 10;
    c.max_ticks = max_ticks;
    posix_configure(&c);
    if (err == 0) { err = exh_loop(&exh_scene_drop, RATE_HZ, NULL); }
    if (err == 0 &&
        ((const struct drop_signals *)exh_scene_signals(&exh_scene_drop))->faults != 0) {
        err = -EXH_E_STATE;
    }
    return err < 0 ? err : posix_time_s();
}

static double hand(unsigned fingers, uint32_t max_ticks)
{
    static struct bilateral_options o;
    double all_s = 0;
    int err = 0;
    bilateral_defaults(&o);
    o.run.rate_Hz = RATE_HZ;
    o.run.bare = 1;
    o.run.k_Npm = 20000;
    o.run.b_Nspm = 60;
    o.run.board.exo.fingers = fingers;
    o.run.board.max_ticks = max_ticks;
    for (int i = 0; err == 0 && i < o.speeds; i++) {
        const struct bilateral_run_cfg c = bilateral_at_speed(&o, o.speed[i].mps);
        struct bilateral_run r;
        err = bilateral_run(&c, &r);
        if (err == 0 && r.faults != 0) { err = -EXH_E_STATE; }
        bilateral_run_free(&r);
        all_s += posix_time_s();
    }
    return err < 0 ? err : all_s;
}

static const struct {
    const char *name, *says;
    double (*run)(unsigned fingers, uint32_t max_ticks);
    unsigned fingers;
    double want;
} experiment[] = {
    {"drop", "a fall", falls, 0, 2500},
    {"bilateral", "a hand with one finger", hand, 1u << EXH_INDEX, 1000},
    {"bilateral5", "a hand with five fingers", hand, (1u << EXH_FINGERS) - 1, 300},
};

int main(int argc, char **argv)
{
    const uint32_t max_ticks = argc > 2 ? (uint32_t)strtoul(argv[2], NULL, 10) : 0;
    for (size_t i = 0; i < sizeof experiment / sizeof experiment[0]; i++) {
        const double want = experiment[i].want;
        const clock_t start = clock();
        double s, cpu_s;
        if (argc > 1 && strcmp(argv[1], experiment[i].name) != 0) { continue; }
        s = experiment[i].run(experiment[i].fingers, max_ticks);
        cpu_s = (double)(clock() - start) / CLOCKS_PER_SEC;
        if (s < 0) {
            fprintf(stderr, "speed: %s: %s\n", experiment[i].name, exh_error_text((int)s));
            return 1;
        }
        printf("simulation: %.1f s of %s at %d Hz in %.3f s of CPU: %.0f x real time, wanted %.0f:"
               " %s\n",
            s, experiment[i].says, RATE_HZ, cpu_s, s / cpu_s, want,
            s >= want * cpu_s ? "PASS" : "FAIL");
    }
    return 0;
}
