/* SPDX-License-Identifier: MIT */
#include "count.h"

#include <inttypes.h>
#include <stdlib.h>

static void keep(struct count *c, struct figure *f, uint64_t value)
{
    if (f->n == f->cap) {
        const size_t cap = f->cap ? 2 * f->cap : 4096;
        uint32_t *more = realloc(f->at, cap * sizeof *more);
        if (more == NULL) {
            c->no_memory = 1;
            return;
        }
        f->at = more;
        f->cap = cap;
    }
    f->at[f->n++] = value > UINT32_MAX ? UINT32_MAX : (uint32_t)value;
}

void count_wait(struct count *c, const struct hil *h)
{
    if (!c->ticking) {
        c->boot_insns = h->insns;
        c->boot_ports = h->ports;
        c->boot_ps = h->now_ps;
        return;
    }
    keep(c, &c->insns, h->insns - c->at_insns);
    keep(c, &c->ports, h->ports + h->hpets - c->at_ports);
    keep(c, &c->cards, h->cards - c->at_cards);
    keep(c, &c->busy_ns, (h->now_ps - c->at_ps) / 1000);
}

void count_tick(struct count *c, const struct hil *h)
{
    c->ticking = 1;
    c->at_insns = h->insns;
    c->at_ports = h->ports + h->hpets;
    c->at_cards = h->cards;
    c->at_ps = h->now_ps;
}

void count_scene(struct count *c, const struct hil *h) { c->scene_at = h->insns; }

uint32_t count_scene_end(struct count *c, const struct hil *h, unsigned key)
{
    const uint32_t n = (uint32_t)(h->insns - c->scene_at);
    unsigned i = 0;
    keep(c, &c->scene, n);
    while (i < c->classes && c->class[i].key != key) { i++; }
    if (i == COUNT_CLASSES) {
        c->no_memory = 1;
        return n;
    }
    if (i == c->classes) { c->class[c->classes++] = (struct count_class){key, 0, n, n}; }
    c->class[i].n++;
    if (n < c->class[i].min) { c->class[i].min = n; }
    if (n > c->class[i].max) { c->class[i].max = n; }
    return n;
}

void count_free(struct count *c)
{
    free(c->insns.at);
    free(c->ports.at);
    free(c->cards.at);
    free(c->busy_ns.at);
    free(c->scene.at);
}

static int by_value(const void *a, const void *b)
{
    const uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return (x > y) - (x < y);
}

struct count_range count_range(struct figure *f)
{
    struct count_range r = {0, 0, 0};
    if (f->n == 0) { return r; }
    qsort(f->at, f->n, sizeof *f->at, by_value);
    r.min = f->at[0];
    r.median = f->at[f->n / 2];
    r.max = f->at[f->n - 1];
    return r;
}

static void print_row(const char *what, struct figure *f)
{
    const struct count_range r = count_range(f);
    printf("  %-34s %9" PRIu32 " %9" PRIu32 " %9" PRIu32 "\n", what, r.min, r.median, r.max);
}

/* "runs, a glove frame, 2 track, 1 planes" */
static const char *class_name(unsigned key, char *text, size_t cap_B)
{
    static const struct {
        unsigned of;
        const char *name;
    } count[] = {{COUNT_TRACKS, "track"}, {COUNT_HELLO, "hello"}, {COUNT_PLANES, "planes"},
        {COUNT_PARAM, "param"}, {COUNT_REFUSED, "refused"}};
    size_t at = (size_t)snprintf(text, cap_B, "%s%s%s", key & COUNT_RUNS ? "runs" : "off",
        key & COUNT_FIRST ? ", first" : "", key & COUNT_GLOVE ? ", glove" : "");
    for (unsigned i = 0; i < sizeof count / sizeof count[0]; i++) {
        const unsigned n = key / count[i].of & COUNT_MASK;
        if (n && at < cap_B) {
            at += (size_t)snprintf(text + at, cap_B - at, ", %u %s", n, count[i].name);
        }
    }
    return text;
}

static int by_key(const void *a, const void *b)
{
    const struct count_class *x = a, *y = b;
    return (x->key > y->key) - (x->key < y->key);
}

/* Returns the widest spread. */
static uint32_t print_classes(struct count *c)
{
    uint32_t widest_ppm = 0;
    qsort(c->class, c->classes, sizeof c->class[0], by_key);
    printf("  the scene's, by class of ticks: key, ticks, min, max, (max - min) / max\n");
    for (unsigned i = 0; i < c->classes; i++) {
        const struct count_class *k = &c->class[i];
        char name[96];
        const uint32_t ppm = (uint32_t)((uint64_t)(k->max - k->min) * 1000000 / k->max);
        printf("  %6u %-40s %8" PRIu64 " %6" PRIu32 " %6" PRIu32 " %6.2f %%\n", k->key,
            class_name(k->key, name, sizeof name), k->n, k->min, k->max, ppm * 1e-4);
        if (ppm > widest_ppm) { widest_ppm = ppm; }
    }
    return widest_ppm;
}

uint32_t count_print(struct count *c, const struct hil *h, double period_s)
{
    const double insn_us = (double)h->cost.insn_ps * 1e-6;
    printf("  boot to the first tick: %" PRIu64 " instructions, %" PRIu64
           " port accesses, %.3f ms\n",
        c->boot_insns, c->boot_ports, (double)c->boot_ps * 1e-9);
    printf("  %-34s %9s %9s %9s\n", "per tick", "min", "median", "max");
    print_row("instructions", &c->insns);
    print_row("of them the scene's", &c->scene);
    print_row("accesses to ports and timer", &c->ports);
    print_row("of them to the cards", &c->cards);
    print_row("busy, ns", &c->busy_ns);
    printf("  share of %.3f us: instructions %.2f %% (max), all %.2f %% (max)\n", period_s * 1e6,
        100 * count_range(&c->insns).max * insn_us / (period_s * 1e6),
        100 * count_range(&c->busy_ns).max * 1e-9 / period_s);
    return print_classes(c);
}
