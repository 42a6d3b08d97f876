/* SPDX-License-Identifier: MIT */
/* Common parts of the register map's sources. Not part of the library's interface. */
#ifndef EXH_REGS_PRIVATE_H
#define EXH_REGS_PRIVATE_H

#include "exhand/regs.h"

/* --- walking a table --- */

/* Iterates over the rows of all values, without a search for each. */
struct exh_regs_walk {
    const struct exh_signal_group *group;
    uint16_t instance, row;
};

static inline struct exh_regs_walk exh_regs_walk_to(const struct exh_signal_table *t, uint32_t i)
{
    struct exh_regs_walk w = {t->group, 0, 0};
    while (i >= w.group->rows) {
        i -= w.group->rows;
        if (++w.instance == w.group->instances) {
            w.instance = 0;
            w.group++;
        }
    }
    w.row = (uint16_t)i;
    return w;
}

/* After the last value it points beyond the table. */
static inline void exh_regs_walk_on(struct exh_regs_walk *w)
{
    if (++w->row < w->group->rows) { return; }
    w->row = 0;
    if (++w->instance < w->group->instances) { return; }
    w->instance = 0;
    w->group++;
}

static inline const struct exh_signal *exh_regs_row_of(const struct exh_regs_walk *w)
{
    return &w->group->row[w->row];
}

/* --- values --- */

static inline int exh_regs_is_staged(const struct exh_regs *r, uint32_t i)
{
    return (int)(r->touched[i >> 5] >> (i & 31u) & 1u);
}

/* The value of a holding register. */
static inline int32_t exh_regs_held(const struct exh_regs *r, uint32_t i)
{
    return exh_regs_is_staged(r, i) ? r->staged[i] : r->wanted[i];
}

/* --- blocks --- */

enum exh_regs_source {
    EXH_REGS_HEAD,
    EXH_REGS_SIGNAL,
    EXH_REGS_ACTIVE,
    EXH_REGS_HELD,
    EXH_REGS_TRACE,
    EXH_REGS_FRAMES,
    EXH_REGS_SET
};

/* The place of a request: registers from..end-1 of a block. */
struct exh_regs_span {
    enum exh_regs_source source;
    int is_float;
    uint32_t from, end;
};

/* Finds the block of a request. 0 or exception 2. */
int exh_regs_locate(const struct exh_regs *r, enum exh_regs_kind kind, uint16_t at, uint16_t n,
    struct exh_regs_span *s);

/* For the trace: locate finds a request after the head and below EXH_REGS_SIGNAL_AT, value reads
 * it, and request makes the trace request that a write would start. 0, or an exception. */
int exh_regs_trace_locate(const struct exh_regs *r, enum exh_regs_kind kind, uint16_t at,
    uint16_t n, struct exh_regs_span *s);
uint32_t exh_regs_trace_value(const struct exh_regs *r, enum exh_regs_source source, uint32_t i);
int exh_regs_trace_request(const struct exh_regs *r, const struct exh_regs_span *s,
    const uint8_t *from, struct exh_trace_request *what);

/* Clears all staged values. */
void exh_regs_discard(struct exh_regs *r);

#endif
