/* SPDX-License-Identifier: MIT */
/* Trace: recorded delays for the simulated link, one per packet. The format is text: one packet per
 * line, its delay in ms, or "lost". Empty lines and comments after # are skipped. A file of round
 * trip times in ms is valid, too; halve it by the link's `trace_scale`.
 *
 * Also reads the log of an audio receiver that accompanies such data: CSV whose lines begin with a
 * letter, optionally compressed by xz. Its 'm' lines are packets (arrival in ns, the sender's stamp
 * in samples of 44100 Hz); the delays are those above the quickest. Its 'r' lines are round trips
 * (second field, ns). */
#ifndef SIM_TRACE_H
#define SIM_TRACE_H

#include <stddef.h>

#define SIM_TRACE_LOST (-1.0)

enum sim_trace_kind {
    SIM_TRACE_MS,      /* a line a packet */
    SIM_TRACE_ARRIVAL, /* 'm' lines */
    SIM_TRACE_ROUND    /* 'r' lines */
};

struct sim_trace {
    double *delay_s; /* >= 0, or SIM_TRACE_LOST */
    long n;
};

/* 0, or -1 and in why what is wrong, with the line. A path that ends in .xz goes through
 * `xz -dc`. */
int sim_trace_read(
    struct sim_trace *t, const char *path, enum sim_trace_kind kind, char *why, size_t why_B);
void sim_trace_free(struct sim_trace *t);

/* In the format above, 9 digits; 0, or -1 with errno. */
int sim_trace_write(const struct sim_trace *t, const char *path);

#endif
