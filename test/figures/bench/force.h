/* SPDX-License-Identifier: MIT */
/* Growth of the laws' errors with time: the reason for a law without a memory. */
#ifndef BENCH_FORCE_H
#define BENCH_FORCE_H

struct force_window {
    double first_second_lsb, last_second_lsb;
};
struct force_drift {
    struct force_window law, law_float;
};

/* Known once the errors of the laws were taken. */
struct force_drift force_drift(void);

#endif
