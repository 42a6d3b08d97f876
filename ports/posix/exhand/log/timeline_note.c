/* SPDX-License-Identifier: MIT */
#include "log/timeline.h"

#include "base/option.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

static int by_tick(const void *a, const void *b)
{
    const struct timeline_note *x = a, *y = b;
    if (x->tick != y->tick) { return x->tick < y->tick ? -1 : 1; }
    return x->order < y->order ? -1 : 1;
}

static double seconds(const struct timeline_notes *n, uint64_t ticks)
{
    return (double)ticks * n->log->header.T.num / n->log->header.T.den;
}

/* So many, the first in the order of their ticks. */
static void put_out(struct timeline_notes *n, size_t count)
{
    if (n->n > 0) { qsort(n->at, n->n, sizeof n->at[0], by_tick); }
    for (size_t i = 0; i < count; i++) {
        const uint64_t t = n->at[i].tick, f = n->fault_tick;
        fprintf(n->to, "%10" PRIu64 " %12.6f", t, seconds(n, t));
        if (n->has_fault) {
            fprintf(n->to, " %+12.1f", 1e3 * (t < f ? -seconds(n, f - t) : seconds(n, t - f)));
        }
        fprintf(n->to, "  %s\n", n->at[i].text);
    }
    n->n -= count;
    if (n->n > 0) { memmove(n->at, n->at + count, n->n * sizeof n->at[0]); }
}

static int make_room(struct timeline_notes *n)
{
    const size_t cap = n->cap ? 2 * n->cap : 256;
    struct timeline_note *more;
    if (n->n < n->cap) { return 1; }
    if (n->n == TIMELINE_NOTES) {
        put_out(n, TIMELINE_NOTES / 2);
        return 1;
    }
    more = realloc(n->at, cap * sizeof *more);
    if (more == NULL) {
        n->no_memory = 1;
        return 0;
    }
    n->at = more;
    n->cap = cap;
    return 1;
}

void timeline_say(struct timeline_notes *n, uint64_t tick, const char *format, ...)
{
    va_list args;
    if (n->to == NULL || !make_room(n)) { return; }
    n->at[n->n].tick = tick;
    n->at[n->n].order = n->said++;
    va_start(args, format);
    (void)vsnprintf(n->at[n->n].text, sizeof n->at[n->n].text, format, args);
    va_end(args);
    n->n++;
}

void timeline_head(const struct timeline_notes *n)
{
    fprintf(n->to, "%10s %12s%s  what\n", "tick", "time s", n->has_fault ? "  to fault ms" : "");
}

void timeline_out(struct timeline_notes *n)
{
    put_out(n, n->n);
    free(n->at);
    n->at = NULL;
    n->cap = 0;
}

int timeline_span(struct timeline_span *s, int on, uint64_t tick, uint64_t gap, double value,
    struct timeline_span *was)
{
    const int over = s->open && (on ? tick > s->last + 1 + gap : tick > s->last + gap);
    if (over) {
        *was = *s;
        s->open = 0;
    }
    if (!on) { return over; }
    if (!s->open) {
        *s = (struct timeline_span){.begin = tick, .peak = value, .open = 1};
    } else if (tick > s->last + 1) {
        s->times++;
    }
    s->last = tick;
    s->ticks++;
    s->times += s->times == 0;
    s->peak = value > s->peak ? value : s->peak;
    return over;
}
