/* SPDX-License-Identifier: MIT */
#include "bilateral.h"

#include "exhand/error.h"

#define SIGNALS    ((uint32_t)(sizeof(struct bilateral_signals) / sizeof(int32_t)))
#define WAIT_TICKS 100u /* longest wait of a frame for others */

/* Restores what is no state, and keeps damaged pointers and indices within arrays. */
static struct exh_trace *of(struct bilateral_trace *t)
{
    t->of.frame = t->frame;
    t->of.mask = BILATERAL_FRAMES - 1;
    t->of.signals = SIGNALS;
    for (unsigned i = 0; i < EXH_TRACE_SIGNALS; i++) {
        if (t->of.what.index[i] >= SIGNALS) { t->of.what.index[i] = 0; }
    }
    return &t->of;
}

static int start(struct bilateral_trace *t, const struct exh_trace_request *what)
{
    const int err = exh_trace_start(of(t), what);
    if (err == 0) {
        t->next = t->of.first;
        t->wait_ticks = 0;
    }
    return err;
}

void bilateral_trace_stop(struct bilateral_trace *t)
{
    static const struct exh_trace_request nothing;
    (void)start(t, &nothing);
    t->answer = 0;
    t->result = 0;
}

static int same(const struct exh_trace_request *a, const struct exh_trace_request *b)
{
    int is = a->every == b->every;
    for (unsigned i = 0; i < EXH_TRACE_SIGNALS; i++) { is &= a->index[i] == b->index[i]; }
    return is;
}

/* A repeated request means that the answer was lost: the trace continues. A refused request ends
 * the present trace, so that all frames belong to the newest request. */
void bilateral_trace_ask(struct bilateral_trace *t, const struct exh_wire_packet *p)
{
    struct exh_trace_request what = {p->u.trace_ask.every, {0}};
    for (unsigned i = 0; i < EXH_TRACE_SIGNALS; i++) { what.index[i] = p->u.trace_ask.index[i]; }
    if (t->result < 0 || !same(&what, &t->of.what)) {
        const int err = start(t, &what);
        if (err < 0) { bilateral_trace_stop(t); }
        t->result = (int16_t)err;
    }
    t->request_seq = p->seq;
    t->answer = 1;
}

/* Number of frames not sent; frames no longer held are lost. */
static uint32_t waiting(struct bilateral_trace *t)
{
    const uint32_t oldest = exh_trace_oldest(&t->of), held = t->of.head - oldest;
    if (t->next - oldest > held) { t->next = oldest; }
    return t->of.head - t->next;
}

static void put_frames(struct bilateral_wire *w, struct exh_scene_mail *out, uint32_t n)
{
    struct bilateral_trace *t = &w->trace;
    struct exh_wire_packet p = {.type = EXH_WIRE_TRACE};
    p.u.trace.request_seq = t->request_seq;
    p.u.trace.result = t->result;
    p.u.trace.first = t->next;
    p.u.trace.frames = (uint8_t)n;
    for (uint32_t i = 0; i < n; i++) {
        const struct exh_trace_frame *f = &t->frame[(t->next + i) & (BILATERAL_FRAMES - 1)];
        p.u.trace.frame[i].tick = f->tick;
        for (unsigned k = 0; k < EXH_TRACE_SIGNALS; k++) { p.u.trace.frame[i].raw[k] = f->raw[k]; }
    }
    bilateral_wire_put(w, out, &p);
    t->next += n;
    t->wait_ticks = 0;
    t->answer = 0;
}

void bilateral_trace_write(struct bilateral *s, const struct bilateral_cfg *cfg,
    struct bilateral_signals *sig, struct exh_scene_mail *out)
{
    struct bilateral_trace *t = &s->wire.trace;
    uint32_t n;
    if (t->of.what.every == 0 && !t->answer) { return; } /* no request */
    if (exh_trace_reads(&t->of)) { bilateral_tell(s, cfg, sig); }
    exh_trace_step(of(t), s->safety.tick, (const int32_t *)(const void *)sig);
    n = waiting(t);
    if (n > 0 && t->wait_ticks < WAIT_TICKS) { t->wait_ticks++; }
    if (out->packets == EXH_SCENE_PACKETS) { return; }
    if (!t->answer && n < EXH_WIRE_FRAMES && t->wait_ticks < WAIT_TICKS) { return; }
    put_frames(&s->wire, out, n < EXH_WIRE_FRAMES ? n : EXH_WIRE_FRAMES);
}

void bilateral_trace_bytes(struct exh_bytes *c, struct bilateral_trace *t)
{
    exh_trace_serialize(c, of(t));
    exh_bytes_u32(c, &t->request_seq);
    exh_bytes_u32(c, &t->next);
    exh_bytes_u32(c, &t->wait_ticks);
    exh_bytes_i16(c, &t->result);
    if (t->result > 0) { t->result = 0; }
    exh_bytes_u8(c, &t->answer);
    t->answer = t->answer != 0;
}
