/* SPDX-License-Identifier: MIT */
/* Every parameter of one way of the simulated link, with unit and range. All are choices of the
 * simulation; where a network was recorded, a trace says more than any model. */
#include "link.h"

#include <string.h>

#define FAR_S 1e30

const struct sim_device_row sim_link_row[] = {
    {"delay", "s", 0, 0, 10, "ours", "of every packet"},
    {"jitter_kind", "", 0, 0, 3, "ours", "0 none, 1 uniform, 2 normal, 3 normal with memory"},
    {"jitter", "s", 0, 0, 10, "ours", "at most so much more or less; a delay is never below 0"},
    {"memory", "", 0.9, 0, 0.9999, "ours",
        "correlation of one packet's jitter with the next one's"},
    {"loss", "", 0, 0, 1, "ours", "share of packets that never arrive"},
    {"duplicate", "", 0, 0, 1, "ours", "share that arrives twice"},
    {"duplicate_after", "s", 0.001, 0, 10, "ours", "the second so much later"},
    {"reorder", "", 0, 0, 1, "ours", "share that is held back"},
    {"reorder_by", "s", 0.01, 0, 10, "ours", "for so long"},
    {"hole_at", "s", 0, 0, 1e9, "ours", "the first hole begins"},
    {"hole", "s", 0, 0, 1e9, "ours", "what would arrive within so long is lost"},
    {"hole_every", "s", 0, 0, 1e9, "ours", "from hole to hole; 0: there is one"},
    {"in_order", "", 0, 0, 1, "ours", "1: none arrives before one sent earlier"},
    {"queue", "", 1024, 1, SIM_LINK_QUEUE, "ours", "packets on their way at most"},
    {"trace_scale", "", 1, 0, 1000, "ours", "of a recorded delay; 0.5 for round trips"},
};
SIM_ROWS(sim_link_par, sim_link_row);

struct sim_link_par sim_link_default(void)
{
    struct sim_link_par p;
    sim_rows_default(&p, sim_link_row, sim_link_rows);
    return p;
}

int sim_link_set(
    struct sim_link_par *p, const char *name, double value, const struct sim_device_row **row)
{
    return sim_rows_set(p, sim_link_row, sim_link_rows, name, value, row);
}

/* --- chance --- */

/* Newton from above; v in 0..1. */
static double root(double v)
{
    double r = 1;
    for (int i = 0; i < 60 && v > 0; i++) { r = 0.5 * (r + v / r); }
    return v > 0 ? r : 0;
}

static double within_one(double v) { return v > 1 ? 1 : v < -1 ? -1 : v; }

/* Of jitter_s. Both draws every time: the kinds share one sequence. */
static double jitter(struct sim_link_way *w)
{
    const int kind = (int)w->par.jitter;
    double even, bell;
    if (kind == SIM_LINK_CONSTANT) {
        sim_random_skip(&w->delay_rng, 4);
        return 0;
    }
    even = 2 * sim_random_unit(&w->delay_rng) - 1;
    bell = sim_random_normal(&w->delay_rng) / 3;
    w->wander = w->par.memory * w->wander + w->fresh * bell;
    return kind == SIM_LINK_UNIFORM ? even : within_one(kind == SIM_LINK_NORMAL ? bell : w->wander);
}

/* An effect that is off counts its draw without computing it. */
static int happens(struct sim_random *r, double share)
{
    if (share > 0) { return sim_random_unit(r) < share; }
    sim_random_skip(r, 1);
    return 0;
}

/* < 0: lost on the recorded way. */
static double delay_s(struct sim_link_way *w)
{
    const double more_s = w->par.jitter_s * jitter(w);
    double s = w->par.delay_s;
    if (w->trace != NULL) {
        const double recorded_s = w->trace->delay_s[w->next_number % (uint64_t)w->trace->n];
        if (recorded_s < 0) { return -1; }
        s += w->par.trace_scale * recorded_s;
    }
    s += more_s;
    return s > 0 ? s : 0;
}

static int in_hole(const struct sim_link_par *p, double t_s)
{
    double since_s = t_s - p->hole_at_s;
    if (!(p->hole_s > 0) || since_s < 0) { return 0; }
    if (p->hole_every_s > 0) {
        since_s -= p->hole_every_s * (double)(uint64_t)(since_s / p->hole_every_s);
    }
    return since_s < p->hole_s;
}

/* --- the queue: the earliest last, so that handing out moves nothing --- */

static int before(const struct sim_link_packet *a, const struct sim_link_packet *b)
{
    return a->due_s < b->due_s || (a->due_s == b->due_s && a->serial < b->serial);
}

static void enqueue(struct sim_link_way *w, double t_s, double due_s, const void *buf, size_t len_B)
{
    struct sim_link_packet *p;
    uint16_t free_slot;
    unsigned at = w->queued;
    if (in_hole(&w->par, due_s)) {
        w->counts.in_hole++;
        return;
    }
    if ((double)w->queued >= w->par.queue) {
        w->counts.overflow++;
        return;
    }
    free_slot = w->order[w->queued++];
    p = &w->slot[free_slot];
    p->due_s = due_s;
    p->sent_s = t_s;
    p->number = w->next_number;
    p->serial = w->next_serial++;
    p->len_B = (uint16_t)len_B;
    memcpy(p->byte, buf, len_B);
    for (; at > 0 && before(&w->slot[w->order[at - 1]], p); at--) {
        w->order[at] = w->order[at - 1];
    }
    w->order[at] = free_slot;
}

void sim_link_start(struct sim_link_way *w, const struct sim_link_par *p,
    const struct sim_trace *trace, uint64_t seed)
{
    struct sim_random r = {seed};
    w->par = *p;
    w->trace = trace != NULL && trace->n > 0 ? trace : NULL;
    w->delay_rng.state = sim_random_u64(&r);
    w->loss_rng.state = sim_random_u64(&r);
    w->duplicate_rng.state = sim_random_u64(&r);
    w->reorder_rng.state = sim_random_u64(&r);
    w->fresh = root(1 - p->memory * p->memory);
    w->wander = sim_random_normal(&w->delay_rng) / 3; /* as if it had always been on */
    w->last_due_s = 0;
    w->next_number = w->next_serial = w->newest = 0;
    w->queued = 0;
    memset(&w->counts, 0, sizeof w->counts);
    for (unsigned i = 0; i < SIM_LINK_QUEUE; i++) { w->order[i] = (uint16_t)i; }
}

int sim_link_send(struct sim_link_way *w, double t_s, const void *buf, size_t len_B)
{
    const struct sim_link_par *p = &w->par;
    const double delayed_s = delay_s(w);
    const int lost = happens(&w->loss_rng, p->loss) || delayed_s < 0;
    const int twice = happens(&w->duplicate_rng, p->duplicate);
    const int back = happens(&w->reorder_rng, p->reorder);
    double due_s = t_s + delayed_s;
    if (len_B > SIM_LINK_PACKET_B) {
        w->counts.too_long++;
        return -1;
    }
    if (back) { due_s += p->reorder_s; }
    if (p->in_order != 0 && due_s < w->last_due_s) { due_s = w->last_due_s; }
    w->counts.sent++;
    if (lost) {
        w->counts.lost++;
    } else {
        if (due_s > w->last_due_s) { w->last_due_s = due_s; }
        enqueue(w, t_s, due_s, buf, len_B);
        if (twice) {
            w->counts.doubled++;
            enqueue(w, t_s, due_s + p->duplicate_s, buf, len_B);
        }
    }
    w->next_number++;
    return (int)len_B;
}

double sim_link_next_s(const struct sim_link_way *w)
{
    return w->queued ? w->slot[w->order[w->queued - 1]].due_s : FAR_S;
}

__attribute__((noinline)) const struct sim_link_packet *sim_link_take(
    struct sim_link_way *w, double t_s, size_t cap_B)
{
    while (sim_link_next_s(w) <= t_s) {
        const struct sim_link_packet *p = &w->slot[w->order[--w->queued]];
        w->counts.arrived++;
        w->counts.overtaken += p->number + 1 < w->newest;
        if (p->number + 1 > w->newest) { w->newest = p->number + 1; }
        if (p->len_B <= cap_B && p->len_B > 0) { return p; }
        w->counts.too_long += p->len_B > cap_B;
    }
    return NULL;
}

int sim_link_recv(struct sim_link_way *w, double t_s, void *buf, size_t cap_B)
{
    const int arrived = sim_link_next_s(w) <= t_s; /* mostly not, which takes no call */
    const struct sim_link_packet *p = arrived ? sim_link_take(w, t_s, cap_B) : NULL;
    if (p) { memcpy(buf, p->byte, p->len_B); }
    return p ? p->len_B : 0;
}
