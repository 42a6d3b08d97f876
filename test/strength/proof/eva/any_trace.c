/* SPDX-License-Identifier: MIT */
/* PROVES: trace
 * Memory of 2, 8 and 128 frames with any content, five signals, any state read from bytes, any
 * requested trace, any values. Frames passed on between any two states. Set-up with any number of
 * frames and signals.
 *
 * EVA: -eva-slevel 200
 * PLANT: lib/src/talk/trace.c: t->what.index[i] >= t->signals -> t->what.index[i] > t->signals
 * PLANT: lib/src/talk/trace.c: (what->index[i] >= t->signals) -> (0)
 * PLANT: lib/src/talk/trace.c: &t->frame[t->head & t->mask] -> &t->frame[t->head & (t->mask + 1)]
 * PLANT: lib/src/talk/trace.c: frames > EXH_TRACE_FRAMES -> frames > 2 * EXH_TRACE_FRAMES
 * PLANT: lib/src/talk/trace.c: shown->frame[n & shown->mask] -> shown->frame[n & (shown->mask + 1)]
 */
#include "num/bytes.c"
#include "talk/trace.c"

#include "any.h"

#define SIGNALS 5

static struct exh_trace own, shown;
static struct exh_trace_frame own_frame[EXH_TRACE_FRAMES], shown_frame[EXH_TRACE_FRAMES];

/* The last frames of the array. */
static struct exh_trace_frame *of(struct exh_trace_frame *all, uint32_t frames)
{
    return all + EXH_TRACE_FRAMES - frames;
}

static void any_trace(struct exh_trace *t, struct exh_trace_frame *frame, uint32_t frames)
{
    (void)exh_trace_setup(t, of(frame, frames), frames, SIGNALS);
    FROM_BYTES(*t, exh_trace_serialize);
    /*@ assert signals: t->what.index[0] < 5 && t->what.index[1] < 5 && t->what.index[2] < 5 && t->what.index[3] < 5; */
}

static void traced(uint32_t frames)
{
    struct exh_trace_request what;
    int32_t signal[SIGNALS];
    static uint8_t image_B[64];
    struct exh_bytes c = exh_bytes_writer(image_B, sizeof image_B);
    any_trace(&own, own_frame, frames);
    ANY(signal);
    (void)exh_trace_reads(&own);
    exh_trace_step(&own, any_u32(), signal);
    exh_trace_serialize(&c, &own);
    ANY(what);
    (void)exh_trace_start(&own, &what);
    exh_trace_step(&own, any_u32(), signal);
    any_trace(&own, own_frame, frames);
    any_trace(&shown, shown_frame, frames);
    exh_trace_copy(&own, &shown);
    exh_trace_step(&own, any_u32(), signal);
}

int main(void)
{
    (void)exh_trace_setup(&own, own_frame, any_u32(), any_u32());
    traced(2);
    traced(8);
    traced(EXH_TRACE_FRAMES);
    END();
    return 0;
}
