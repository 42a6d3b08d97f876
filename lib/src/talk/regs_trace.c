/* SPDX-License-Identifier: MIT */
/* Registers of the trace. */
#include "regs_parts.h"

#define VALUES EXH_REGS_FRAME_VALUES

int exh_regs_trace_locate(const struct exh_regs *r, enum exh_regs_kind kind, uint16_t at,
    uint16_t n, struct exh_regs_span *s)
{
    uint32_t values = kind == EXH_REGS_INPUT ? EXH_TRACE_HEADS : EXH_REGS_TRACE_SET;
    s->source = kind == EXH_REGS_INPUT ? EXH_REGS_TRACE : EXH_REGS_SET;
    s->is_float = 0;
    s->from = (uint32_t)at - EXH_REGS_TRACE_AT;
    if (r->trace == NULL) { return EXH_MODBUS_ADDRESS; }
    if (kind == EXH_REGS_INPUT && at >= EXH_REGS_FRAMES_AT) {
        s->source = EXH_REGS_FRAMES;
        s->from = (uint32_t)at - EXH_REGS_FRAMES_AT;
        values = VALUES * (r->trace->mask + 1u);
    }
    s->end = s->from + n;
    return s->end <= 2 * values ? 0 : EXH_MODBUS_ADDRESS;
}

static uint32_t head_of(const struct exh_trace *t, enum exh_regs_trace h)
{
    switch (h) {
    case EXH_TRACE_HEAD_FRAMES: return t->mask + 1u;
    case EXH_TRACE_HEAD_NEXT: return t->head;
    case EXH_TRACE_HEAD_OLDEST: return exh_trace_oldest(t);
    case EXH_TRACE_HEAD_RUN: return t->run;
    case EXH_TRACE_HEAD_EVERY: return t->what.every;
    case EXH_TRACE_HEAD_SIGNAL_0: return t->what.index[0];
    case EXH_TRACE_HEAD_SIGNAL_1: return t->what.index[1];
    case EXH_TRACE_HEAD_SIGNAL_2: return t->what.index[2];
    case EXH_TRACE_HEAD_SIGNAL_3: return t->what.index[3];
    case EXH_TRACE_HEADS: break;
    }
    return 0;
}

uint32_t exh_regs_trace_value(const struct exh_regs *r, enum exh_regs_source source, uint32_t i)
{
    const struct exh_trace *t = r->trace;
    const uint32_t slot = i * 43691u >> 18; /* i / 6, below 2^16 */
    const uint32_t k = i - VALUES * slot;
    if (source == EXH_REGS_TRACE) { return head_of(t, (enum exh_regs_trace)i); }
    if (source == EXH_REGS_SET) {
        return head_of(t, (enum exh_regs_trace)(EXH_TRACE_HEAD_EVERY + i));
    }
    if (k < 2) { return k == 0 ? t->frame[slot].number : t->frame[slot].tick; }
    return (uint32_t)t->frame[slot].raw[k - 2];
}

/* Completes each value with its other half, which is unchanged. */
int exh_regs_trace_request(const struct exh_regs *r, const struct exh_regs_span *s,
    const uint8_t *from, struct exh_trace_request *what)
{
    *what = r->trace->what;
    for (uint32_t at = s->from; at < s->end; at++, from += 2) {
        uint32_t *v = at < 2 ? &what->every : &what->index[(at >> 1) - 1u];
        const uint32_t word = (uint32_t)from[0] << 8 | from[1];
        *v = (at & 1u) ? (*v & 0xFFFF0000u) | word : (*v & 0xFFFFu) | word << 16;
    }
    for (unsigned i = 0; i < EXH_TRACE_SIGNALS; i++) {
        if (what->index[i] >= r->trace->signals) { return EXH_MODBUS_VALUE; }
    }
    return 0;
}
