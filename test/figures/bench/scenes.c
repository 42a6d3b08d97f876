/* SPDX-License-Identifier: MIT */
/* scenes errors SECONDS | count | time: whole ticks of the scenes as shipped, beside the same in
 * double and float.
 *
 * errors: scene, rate, way, quantity, unit, largest and rms error against long double, at nine
 * rates, each for so many seconds of the box's time. count, time: as work has them.
 */
#define _POSIX_C_SOURCE 200809L
#include "scenes.h"
#include "clock.h"

#include "exhand/board.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *const scenes_way[WAYS] = {"fixed", "double", "float"};
static const uint32_t rates_Hz[] = {90, 100, 200, 500, 1000, 2000, 5000, 10000, 20000};
static const char *const wall_scene[] = {"minimal", "drop", "guarded"};
static const char *const hand_scene[] = {"glove", "bilateral"};

void scenes_gains(uint32_t rate_Hz, int32_t *k_Npm, int32_t *b_Nspm)
{
    static const int32_t row[][3] = {{90, 1500, 0}, {100, 2000, 0}, {200, 2000, 15},
        {500, 6000, 20}, {1000, 10000, 40}, {2000, 20000, 60}};
    for (size_t i = 0; i < sizeof row / sizeof row[0]; i++) {
        if ((uint32_t)row[i][0] <= rate_Hz) {
            *k_Npm = row[i][1];
            *b_Nspm = row[i][2];
        }
    }
}

void scenes_print(const char *scene, uint32_t rate_Hz, const char *quantity, const char *unit,
    const struct scenes_sum *sum)
{
    for (int w = 0; w < WAYS; w++) {
        const struct error *e = &sum->way[w];
        printf("%s,%u,%s,%s,%s,%.4g,%.4g\n", scene, (unsigned)rate_Hz, scenes_way[w], quantity,
            unit, (double)e->max, sqrt((double)(e->sum_squares / (long double)(e->n ? e->n : 1))));
    }
}

static void empty(uint32_t i) { (void)i; }

static void cost(const char *scene, void (*const op[WAYS])(uint32_t i), int timed)
{
    for (int w = 0; w < WAYS; w++) {
        if (timed) {
            printf("%s,%s,%.2f\n", scene, scenes_way[w],
                bench_least_ns(op[w]) - bench_least_ns(empty));
        } else {
            for (uint32_t i = 0; i < BENCH_OPS; i++) { op[w](i); }
            bench_measure(op[w], BENCH_OPS);
            printf("%s,%s,%lu\n", scene, scenes_way[w], (unsigned long)BENCH_OPS);
        }
    }
}

static void costs(int timed)
{
    if (!timed) {
        bench_measure(empty, BENCH_OPS);
        printf("empty,,%lu\n", (unsigned long)BENCH_OPS);
    }
    for (size_t i = 0; i < sizeof wall_scene / sizeof wall_scene[0]; i++) {
        scenes_wall_setup(wall_scene[i]);
        cost(wall_scene[i], scenes_wall_op, timed);
    }
    for (size_t i = 0; i < sizeof hand_scene / sizeof hand_scene[0]; i++) {
        scenes_hand_setup(hand_scene[i]);
        cost(hand_scene[i], scenes_hand_op, timed);
    }
}

int main(int argc, char **argv)
{
    const char *mode = argc > 1 ? argv[1] : "";
    if (argc == 3 && strcmp(mode, "errors") == 0) {
        for (size_t r = 0; r < sizeof rates_Hz / sizeof rates_Hz[0]; r++) {
            for (size_t i = 0; i < 3; i++) {
                scenes_wall(wall_scene[i], rates_Hz[r], atof(argv[2]));
            }
            for (size_t i = 0; i < 2; i++) {
                scenes_hand(hand_scene[i], rates_Hz[r], atof(argv[2]));
            }
        }
    } else if (argc == 2 && (strcmp(mode, "count") == 0 || strcmp(mode, "time") == 0)) {
        costs(mode[0] == 't');
    } else {
        fprintf(stderr, "usage: scenes errors SECONDS|count|time\n");
        return 2;
    }
    return 0;
}
