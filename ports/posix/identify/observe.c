/* SPDX-License-Identifier: MIT */
#include "identify/observe.h"

#include "identify/identify.h"

#include <stdlib.h>
#include <string.h>

#define FLOOR_CNT 0.3 /* no count is better known: edges are not even */

void observe_free(struct observations *o)
{
    free(o->o);
    memset(o, 0, sizeof *o);
}

static int size_of(int v) { return v < 0 ? -v : v; }

/* ticks: since the edge before. */
static float weight(const struct identify_data *d, uint32_t ticks, int32_t moved)
{
    /* Where in its period the drive takes a current over is not known: that is a time. */
    const double late = 1 / (d->servo_Hz * d->T_s);
    const double speed = (double)size_of(moved) / ticks; /* counts a tick */
    const double within = speed < 1 ? speed : 1, by_time = speed * late;
    return (float)(1 / (FLOOR_CNT * FLOOR_CNT + (within * within + by_time * by_time) / 12));
}

/* The first round of the mass begins after its first pull; before, the mass may be on its
 * support. */
static int wanted(const struct identify_sample *x, unsigned stages, unsigned rounds)
{
    return x->busy && stages >> x->stage & 1 && (rounds == 0 || x->repeat < rounds) &&
           (x->stage == IDENTIFY_SLACK || x->part >= IDENTIFY_PART_ROUND);
}

static int same(const struct identify_sample *a, const struct identify_sample *b)
{
    return a->part == b->part && a->repeat == b->repeat && a->stage == b->stage &&
           a->busy == b->busy;
}

static int add(struct observations *to, size_t *cap, const struct observation *o)
{
    struct observation *more = to->o;
    if (to->n == *cap) {
        more = realloc(more, (*cap + 4096) * sizeof *more);
        if (more == NULL) { return -1; }
        to->o = more;
        *cap += 4096;
    }
    to->o[to->n++] = *o;
    return 0;
}

static int calm(const struct identify_sample *x)
{
    return x->stage == IDENTIFY_SLACK ||
           (x->part >= IDENTIFY_PART_UP && x->part < IDENTIFY_PART_WAVE);
}

static int choose(struct observations *to, const struct identify_data *d, unsigned stages,
    unsigned rounds, double group_s, int only_calm)
{
    size_t cap = 0, from = 0, began = 0;
    memset(to, 0, sizeof *to);
    for (size_t i = 1; i + 1 < d->n; i++) {
        const struct identify_sample *x = d->sample;
        if (!same(&x[i], &x[i - 1]) || (double)(i - began) * d->T_s >= group_s) {
            to->groups++;
            began = i;
        }
        if (wanted(&x[i], stages, rounds)) { to->last = i + 2; }
        if (x[i].cnt == x[i - 1].cnt) { continue; }
        if (only_calm && !calm(&x[i])) {
            from = i;
            continue;
        }
        if (wanted(&x[i], stages, rounds) && same(&x[i], &x[i - 1])) {
            const struct observation o = {.from = (uint32_t)i - 1,
                .ticks = 2,
                .cnt = ((float)x[i].cnt + (float)x[i - 1].cnt + 1) / 2,
                .weight = weight(d, (uint32_t)(i - from), x[i].cnt - x[i - 1].cnt),
                .share = 1,
                .group = to->groups,
                .round = x[i].repeat};
            if (add(to, &cap, &o)) { return -1; }
            if (o.round + 1u > to->rounds) { to->rounds = o.round + 1u; }
        }
        from = i;
    }
    to->groups++;
    to->counted = (double)to->n;
    return 0;
}

int observe(struct observations *to, const struct identify_data *d, unsigned stages,
    unsigned rounds, double group_s)
{
    return choose(to, d, stages, rounds, group_s, 0);
}

int observe_calm(struct observations *to, const struct identify_data *d, unsigned stages,
    unsigned rounds, double group_s)
{
    return choose(to, d, stages, rounds, group_s, 1);
}
