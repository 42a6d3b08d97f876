/* SPDX-License-Identifier: MIT */
/* Trace: records a few signals of every n-th tick in the caller's memory until a client reads them.
 *
 * It reads the outputs of a tick and changes nothing. The trace of Modbus is outside the scene,
 * keyframe and log; a trace that goes over the wire is part of the scene's state. Each frame has a
 * number, one more than the frame before. Numbers continue across traces, so a reader detects
 * losses.
 *
 *   err = exh_trace_start(&trace, &(struct exh_trace_request){.every = 4, .index = {0, 1, 2, 3}});
 *   exh_trace_step(&trace, tick, signal); // after each tick */
#ifndef EXHAND_TRACE_H
#define EXHAND_TRACE_H

#include "exhand/bytes.h"

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define EXH_TRACE_SIGNALS 4    /* values per frame; for fewer signals, repeat one */
#define EXH_TRACE_FRAMES  128u /* most frames in memory */

/* The values kept of one tick. */
struct exh_trace_frame {
    uint32_t number;                /* modulo 2^32 */
    uint32_t tick;                  /* argument of exh_trace_step() */
    int32_t raw[EXH_TRACE_SIGNALS]; /* the signals requested, in the formats of their rows */
};

/* The signals to trace. */
struct exh_trace_request {
    uint32_t every;                    /* ticks between frames; 0: no trace */
    uint32_t index[EXH_TRACE_SIGNALS]; /* indices into the scene's table of outputs */
};

/* A trace. All members except frame, mask and signals are state. */
struct exh_trace {
    struct exh_trace_frame *frame; /* the caller's array; number k is frame[k & mask] */
    uint32_t mask;                 /* frames - 1 */
    uint32_t signals;              /* number of values in the table */
    struct exh_trace_request what; /* present request */
    uint32_t first;                /* number of the first frame of this trace */
    uint32_t head;                 /* number of the next frame, modulo 2^32 */
    uint32_t run;                  /* traces started, modulo 2^32 */
    uint32_t left;                 /* ticks until the next frame */
};

/* Set-up of an idle, empty trace. -EXH_E_RANGE: frames is not a power of two from 2 to
 * EXH_TRACE_FRAMES, or signals is 0. */
int exh_trace_setup(
    struct exh_trace *t, struct exh_trace_frame *frame, uint32_t frames, uint32_t signals);

/* Starts another trace from the next tick; drops the frames of the last one. -EXH_E_RANGE: an index
 * not below signals; nothing changes. */
int exh_trace_start(struct exh_trace *t, const struct exh_trace_request *what);

/* 1 if the next exh_trace_step() reads the values. Otherwise they are not needed. */
static inline int exh_trace_reads(const struct exh_trace *t)
{
    return t->what.every != 0 && t->left == 0;
}

/* Call it after each tick, with the values of the table. */
void exh_trace_step(struct exh_trace *t, uint32_t tick, const int32_t *signal);

/* Number of the oldest frame held; head if there is none. */
static inline uint32_t exh_trace_oldest(const struct exh_trace *t)
{
    return t->head - t->first > t->mask ? t->head - t->mask - 1u : t->first;
}

/* Copies new frames to shown, a trace of the same size that the reader owns. Call it while the
 * reader is idle. If the reader started a trace on shown, it starts on own. Otherwise copies the
 * frames that shown lacks. */
void exh_trace_copy(struct exh_trace *own, struct exh_trace *shown);

/* State through a cursor, including the frames; t must be set up for the same frames and signals.
 * Restored values are brought into range: an unknown index becomes 0, the wait at most every. 36
 * bytes plus 24 per frame. */
void exh_trace_serialize(struct exh_bytes *c, struct exh_trace *t);

#ifdef __cplusplus
}
#endif
#endif
