/* SPDX-License-Identifier: MIT */
/* What the image's files share: inputs, and tables of what is counted. */
#ifndef BENCH_SOFT_H
#define BENCH_SOFT_H

#include <stdint.h>

#define OPS      1024u
#define CHANNELS 22u
#define FINGERS  5u

extern int32_t soft_x[OPS + CHANNELS], soft_y[CHANNELS]; /* an eighth of full scale; outputs */
extern volatile int64_t soft_sink;

/* Under the kernel and name that work.csv, filters.csv and sines.csv have it by. */
struct soft_op {
    const char *name;
    void (*op)(uint32_t i);
};
struct soft_group {
    const struct soft_op *op;
    unsigned n;
    void (*start)(void);
};
extern const struct soft_group soft_twins, soft_bare, soft_cmsis, soft_limiter[3];

#endif
