/* SPDX-License-Identifier: MIT */
#include "log/timeline.h"

#include "base/option.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdlib.h>

void timeline_say(struct timeline_notes *n, uint64_t tick, const char *format, ...)
{
    va_list args;
    if (n->n == n->cap) {
        const size_t cap = n->cap ? 2 * n->cap : 256;
        struct timeline_note *more = realloc(n->at, cap * sizeof *more);
        if (more == NULL) {
            n->no_memory = 1;
            return;
        }
        n->at = more;
        n->cap = cap;
    }
    n->at[n->n].tick = tick;
    n->at[n->n].order = n->n;
    va_start(args, format);
    (void)vsnprintf(n->at[n->n].text, sizeof n->at[n->n].text, format, args);
    va_end(args);
    n->n++;
}

static int by_tick(const void *a, const void *b)
{
    const struct timeline_note *x = a, *y = b;
    if (x->tick != y->tick) { return x->tick < y->tick ? -1 : 1; }
    return x->order < y->order ? -1 : 1;
}

static double seconds(const struct logfile *l, uint64_t ticks)
{
    return (double)ticks * l->header.T.num / l->header.T.den;
}

void timeline_out(struct timeline_notes *n, const struct logfile *l, FILE *to)
{
    if (n->n > 0) { qsort(n->at, n->n, sizeof n->at[0], by_tick); }
    fprintf(to, "%10s %12s%s  what\n", "tick", "time s", n->has_fault ? "  to fault ms" : "");
    for (size_t i = 0; i < n->n; i++) {
        const uint64_t t = n->at[i].tick, f = n->fault_tick;
        fprintf(to, "%10" PRIu64 " %12.6f", t, seconds(l, t));
        if (n->has_fault) {
            fprintf(to, " %+12.1f", 1e3 * (t < f ? -seconds(l, f - t) : seconds(l, t - f)));
        }
        fprintf(to, "  %s\n", n->at[i].text);
    }
    free(n->at);
    n->at = NULL;
    n->n = n->cap = 0;
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
