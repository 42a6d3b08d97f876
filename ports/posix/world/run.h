/* SPDX-License-Identifier: MIT */
/* What a run of the program was asked to do, and the three ways to do it. */
#ifndef WORLD_RUN_H
#define WORLD_RUN_H

#include "world.h"

#include <stdint.h>

struct run {
    const char *scene, *listen, *peer, *key, *png, *list, *video, *trace, *trace_signals;
    double fps, seconds, video_fps;
    int64_t frames, width, height, samples; /* frames 0: no end */
    int64_t trace_every;
    int headless, script, bench;
    struct world *world;
};

/* In a window or not, paced by the clock, linked or not. Exit status. */
int run_live(struct run *r);

/* Headless and without a link: in the scene's own time, as fast as possible. */
int run_alone(struct run *r);

/* The table of frames and looks a second. */
int run_bench(struct run *r);

#endif
