/* SPDX-License-Identifier: MIT */
/* A trace of the controller's outputs as CSV, a line a frame. Requests are repeated until the
 * answer. */
#include "link_part.h"

#include "base/none.h"
#include "base/outfile.h"

#include "exhand/error.h"

#include <stdlib.h>
#include <string.h>

#define AGAIN_US 100000 /* without an answer for so long, the request is repeated */

/* "name" or "name[instance]": its index in the table; -1: none. */
static int32_t index_of(const struct exh_signal_table *t, const char *name, size_t len)
{
    const char *end = memchr(name, '[', len);
    const size_t own = end ? (size_t)(end - name) : len;
    char *behind = NULL;
    const unsigned long k = end ? strtoul(end + 1, &behind, 10) : 0;
    if (end && (behind == end + 1 || behind + 1 != name + len || *behind != ']')) { return -1; }
    for (uint32_t i = 0; i < exh_signal_count(t); i++) {
        uint16_t instance;
        const struct exh_signal *row = exh_signal_at(t, i, &instance);
        if (strlen(row->name) == own && memcmp(row->name, name, own) == 0 && instance == k) {
            return (int32_t)i;
        }
    }
    return -1;
}

static int pick(struct link_trace *t, const char *names, char *error, size_t error_B)
{
    for (const char *at = names; *at != '\0';) {
        const size_t len = strcspn(at, ",");
        const int32_t i = index_of(t->table, at, len);
        if (i < 0 || t->signals == EXH_TRACE_SIGNALS) {
            snprintf(error, error_B, "--trace-signals: %.*s: %s", (int)len, at,
                i < 0 ? "no output of the controller: see `exhand regs --scene bilateral`"
                      : "one too many: give four at most");
            return 1;
        }
        t->ask.index[t->signals++] = (uint16_t)i;
        at += len + (at[len] == ',');
    }
    if (t->signals == 0) { snprintf(error, error_B, "--trace-signals: give at least one"); }
    return t->signals == 0;
}

static void head(const struct link_trace *t)
{
    fputs("number,tick", t->file);
    for (unsigned i = 0; i < t->signals; i++) {
        uint16_t k;
        const struct exh_signal *row = exh_signal_at(t->table, t->ask.index[i], &k);
        const int many = exh_signal_find(t->table, row->id, 1) >= 0;
        fprintf(t->file, many ? ",%s[%u]" : ",%s", row->name, (unsigned)k);
        if (row->unit[0] != '\0') { fprintf(t->file, "_%s", row->unit); }
    }
    fputc('\n', t->file);
}

int link_trace_open(struct link *l, const struct link_trace_want *want, char *error, size_t error_B)
{
    struct link_trace *t = &l->trace;
    memset(t, 0, sizeof *t);
    t->table = want->table;
    t->path = want->path;
    if (pick(t, want->signals, error, error_B)) { return 2; }
    t->file = outfile_open("trace", want->path);
    if (t->file == NULL) {
        error[0] = '\0'; /* it was said */
        return 1;
    }
    head(t);
    t->ask.every = want->every;
    return 0;
}

int link_trace_close(struct link *l)
{
    struct link_trace *t = &l->trace;
    char text[300];
    int bad;
    if (t->file == NULL) { return 0; }
    bad = outfile_end(t->file, t->frames > 0);
    t->file = NULL;
    snprintf(text, sizeof text, "--trace: %.200s: %lu frames, %lu missed", t->path, t->frames,
        t->missed);
    if (l->say && (t->missed || t->frames == 0)) { l->say(text); }
    return bad;
}

void link_trace_anew(struct link *l, int64_t now_us)
{
    l->trace.asked = l->trace.answered = 0;
    l->trace.asked_us = now_us - AGAIN_US;
}

void link_trace_ask(struct link *l, int64_t now_us)
{
    struct link_trace *t = &l->trace;
    struct exh_wire_packet p;
    if (t->ask.every == 0 || t->answered || now_us - t->asked_us < AGAIN_US) { return; }
    memset(&p, 0, sizeof p);
    p.type = EXH_WIRE_TRACE_ASK;
    p.u.trace_ask = t->ask;
    link_put(l, &p, now_us);
    if (!t->asked) { t->first_seq = p.seq; }
    t->last_seq = p.seq;
    t->asked = 1;
    t->asked_us = now_us;
}

static void frame(struct link_trace *t, uint32_t number, const struct exh_wire_frame *f)
{
    fprintf(t->file, "%lu,%lu", (unsigned long)number, (unsigned long)f->tick);
    for (unsigned i = 0; i < t->signals; i++) {
        none_or_cell(t->file, exh_signal_at(t->table, t->ask.index[i], NULL), f->raw[i]);
    }
    fputc('\n', t->file);
    t->frames++;
}

/* All that was asked of this controller is the same, so an answer to any of it will do; frames of
 * another request are of a world before. */
void link_trace_take(struct link *l, const struct exh_wire_trace *in)
{
    struct link_trace *t = &l->trace;
    char text[200];
    if (t->file == NULL || !t->asked ||
        in->request_seq - t->first_seq > t->last_seq - t->first_seq) {
        return;
    }
    if (!t->answered && in->result < 0 && l->say) {
        snprintf(text, sizeof text, "--trace: refused by the controller: %s",
            exh_error_text(in->result));
        l->say(text);
    }
    if (!t->answered) { t->next = in->first; }
    t->answered = 1;
    t->missed += exh_wire_trace_missed(t->next, in);
    for (unsigned i = 0; i < in->frames; i++) { frame(t, in->first + i, &in->frame[i]); }
    t->next = in->first + in->frames;
}
