/* SPDX-License-Identifier: MIT */
/* Trace: a few signals of every n-th tick, in memory of the caller's, until somebody fetches them.
 *
 * It reads what a tick has made and changes nothing. Modbus keeps one that is no part of a scene,
 * in no keyframe and no log; one whose frames go out over the wire is its scene's state. Each frame
 * has a number, one more than the frame before it; numbers go on when another trace is started, so
 * that whoever reads sees each frame that he did not get.
 */
#ifndef EXHAND_TRACE_H
#define EXHAND_TRACE_H

#include "exhand/bytes.h"

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define EXH_TRACE_SIGNALS 4    /* values in a frame, always; who wants fewer names one again */
#define EXH_TRACE_FRAMES  128u /* in memory, at most */

/* What is kept of one tick. */
struct exh_trace_frame {
    uint32_t number;                /* modulo 2^32 */
    uint32_t tick;                  /* of the loop, as exh_trace_step() was told it */
    int32_t raw[EXH_TRACE_SIGNALS]; /* the signals asked for, in their order and rows' formats */
};

/* What is to be traced. */
struct exh_trace_request {
    uint32_t every;                    /* ticks from frame to frame; 0: none */
    uint32_t index[EXH_TRACE_SIGNALS]; /* of values in the scene's table of outputs */
};

/* A trace; all but frame, mask and signals is its state. */
struct exh_trace {
    struct exh_trace_frame *frame; /* the caller's; number k is in frame[k & mask] */
    uint32_t mask;                 /* frames - 1 */
    uint32_t signals;              /* values in the table */
    struct exh_trace_request what; /* what is traced now */
    uint32_t first;                /* number of this trace's first frame */
    uint32_t head;                 /* number of the next frame, modulo 2^32 */
    uint32_t run;                  /* traces started, modulo 2^32 */
    uint32_t left;                 /* ticks without a frame until the next */
};

/* Nothing is traced, nothing is held. -EXH_E_RANGE: frames is no power of two from 2 to
 * EXH_TRACE_FRAMES, or there are no signals. */
int exh_trace_setup(
    struct exh_trace *t, struct exh_trace_frame *frame, uint32_t frames, uint32_t signals);

/* Another trace, from the next tick on; frames of the one before are not held any more.
 * -EXH_E_RANGE: an index of none of the signals; nothing changes. */
int exh_trace_start(struct exh_trace *t, const struct exh_trace_request *what);

/* 1: the coming exh_trace_step() reads the values, in other ticks nobody has to make them. */
static inline int exh_trace_reads(const struct exh_trace *t)
{
    return t->what.every != 0 && t->left == 0;
}

/* Behind each tick, with the values of the table. */
void exh_trace_step(struct exh_trace *t, uint32_t tick, const int32_t *signal);

/* Number of the oldest frame held; `head` if there is none. */
static inline uint32_t exh_trace_oldest(const struct exh_trace *t)
{
    return t->head - t->first > t->mask ? t->head - t->mask - 1u : t->first;
}

/* Copies new frames to `shown`, a trace of the reader's with the same size. Call while the reader
 * is idle. A trace that was started on `shown` is started on `own`; else
 * the frames that `shown` has not yet are copied, at most all that `own` holds. */
void exh_trace_copy(struct exh_trace *own, struct exh_trace *shown);

/* State through a cursor, the frames in memory with it; t is set up, for as many frames and
 * signals. What is read is brought back into range: an index of none of the signals is 0, no wait
 * is longer than the trace has. 36 bytes and 24 more a frame. */
void exh_trace_serialize(struct exh_bytes *c, struct exh_trace *t);

#ifdef __cplusplus
}
#endif
#endif
