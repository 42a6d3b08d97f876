/* SPDX-License-Identifier: MIT */
/* Trace: a few signals of every n-th tick, kept in a ring until they are read. */
#include "exhand/trace.h"

#include "exhand/error.h"

int exh_trace_setup(
    struct exh_trace *t, struct exh_trace_frame *frame, uint32_t frames, uint32_t signals)
{
    static const struct exh_trace none = {0};
    static const struct exh_trace_frame empty = {0};
    if (frames < 2 || frames > EXH_TRACE_FRAMES || (frames & (frames - 1)) != 0 || signals == 0) {
        return -EXH_E_RANGE;
    }
    *t = none;
    t->frame = frame;
    t->mask = frames - 1;
    t->signals = signals;
    for (uint32_t i = 0; i < frames; i++) {
        frame[i] = empty;
        frame[i].number = i + 1; /* a number that this slot never holds */
    }
    return 0;
}

static void begin(struct exh_trace *t, const struct exh_trace_request *what)
{
    t->what = *what;
    t->first = t->head;
    t->left = 0;
}

int exh_trace_start(struct exh_trace *t, const struct exh_trace_request *what)
{
    for (unsigned i = 0; i < EXH_TRACE_SIGNALS; i++) {
        if (what->index[i] >= t->signals) { return -EXH_E_RANGE; }
    }
    begin(t, what);
    t->run++;
    return 0;
}

void exh_trace_step(struct exh_trace *t, uint32_t tick, const int32_t *signal)
{
    struct exh_trace_frame *f = &t->frame[t->head & t->mask];
    if (t->what.every == 0) { return; }
    if (t->left > 0) {
        t->left--;
        return;
    }
    t->left = t->what.every - 1;
    f->number = t->head++;
    f->tick = tick;
    for (unsigned i = 0; i < EXH_TRACE_SIGNALS; i++) { f->raw[i] = signal[t->what.index[i]]; }
}

void exh_trace_copy(struct exh_trace *own, struct exh_trace *shown)
{
    uint32_t n = exh_trace_oldest(own);
    if (own->run != shown->run) {
        own->head = shown->head; /* releases the numbers of frames not copied */
        begin(own, &shown->what);
        own->run = shown->run;
        return;
    }
    if (own->head - shown->head < own->head - n) { n = shown->head; }
    for (; n != own->head; n++) { shown->frame[n & shown->mask] = own->frame[n & own->mask]; }
    shown->head = own->head;
}

/* --- state --- */

static void frame_bytes(struct exh_bytes *c, struct exh_trace_frame *f)
{
    exh_bytes_u32(c, &f->number);
    exh_bytes_u32(c, &f->tick);
    exh_bytes_i32s(c, f->raw, EXH_TRACE_SIGNALS);
}

void exh_trace_serialize(struct exh_bytes *c, struct exh_trace *t)
{
    exh_bytes_u32(c, &t->what.every);
    for (unsigned i = 0; i < EXH_TRACE_SIGNALS; i++) {
        exh_bytes_u32(c, &t->what.index[i]);
        if (t->what.index[i] >= t->signals) { t->what.index[i] = 0; }
    }
    exh_bytes_u32(c, &t->first);
    exh_bytes_u32(c, &t->head);
    exh_bytes_u32(c, &t->run);
    exh_bytes_u32(c, &t->left);
    if (t->left >= t->what.every) { t->left = t->what.every > 0 ? t->what.every - 1 : 0; }
    for (uint32_t i = 0; i <= t->mask; i++) { frame_bytes(c, &t->frame[i]); }
}
