/* SPDX-License-Identifier: MIT */
#include "lab/fit/search.h"

#include <string.h>

#define BEST     5    /* children go towards one of these */
#define GIVE_UP  100  /* a start that lacks more is no ancestor */
#define TOO_NEAR 0.01 /* in every row: the better of the two stays */

void search_init(struct search *s, uint64_t seed)
{
    memset(s, 0, sizeof *s);
    s->rng.state = seed;
    s->start = space_start();
    s->kept = SEARCH_MEMBERS;
    for (int i = 0; i < ESTIMATES; i++) { s->used[i] = 1; }
}

/* Normal enough: deviation 1, within +-3.5. */
static double bell(struct sim_random *r) { return 6.9 * sim_random_bell(r); }

static double mirrored(double u)
{
    if (u < 0) { u = -u; }
    if (u > 1) { u = 2 - u; }
    return u < 0 ? 0 : u;
}

/* Mirrors at the walls; pinned rows keep the start's value. */
static void tidy(const struct search *s, struct plant_point *p)
{
    for (int i = 0; i < SPACE_ROWS; i++) {
        p->u[i] = s->pinned[i] ? s->start.u[i] : mirrored(p->u[i]);
    }
}

/* The start itself, then every other one anywhere, every other one near the start. */
int search_first(struct search *s, struct search_child *child)
{
    int n = 0;
    for (int i = 0; i < SEARCH_STARTS; i++) {
        struct plant_point p = s->start;
        for (int k = 0; i > 0 && k < SPACE_ROWS; k++) {
            p.u[k] = i % 2 ? sim_random_unit(&s->rng) : p.u[k] + 0.1 * bell(&s->rng);
        }
        tidy(s, &p);
        for (int k = 0; k < ESTIMATES; k++) {
            if (s->used[k]) { child[n++] = (struct search_child){p, (enum estimate_kind)k}; }
        }
    }
    return n;
}

static int pick(struct sim_random *r, int n) { return (int)(sim_random_unit(r) * n); }

static struct plant_point evolve(struct search *s, const struct search_population *of, int best)
{
    const struct plant_point *towards = &of->member[best].p;
    const struct plant_point *a = &of->member[pick(&s->rng, of->members)].p;
    const struct plant_point *b = &of->member[pick(&s->rng, of->members)].p;
    const struct plant_point *from = &of->member[pick(&s->rng, of->members)].p;
    const double step = 0.3 + 0.6 * sim_random_unit(&s->rng);
    const double share = 0.3 + 0.7 * sim_random_unit(&s->rng);
    struct plant_point p = pick(&s->rng, 2) ? *from : *towards;
    for (int i = 0; i < SPACE_ROWS; i++) {
        if (sim_random_unit(&s->rng) < share) {
            p.u[i] = from->u[i] + step * (towards->u[i] - from->u[i]) + step * (a->u[i] - b->u[i]);
        }
    }
    return p;
}

static struct plant_point nudge(struct search *s, const struct search_population *of, int best)
{
    static const double size[] = {0.005, 0.01, 0.02, 0.04, 0.08, 0.16};
    const double by = size[pick(&s->rng, 6)];
    const double share = 0.1 + 0.6 * sim_random_unit(&s->rng);
    struct plant_point p = of->member[best].p;
    for (int i = 0; i < SPACE_ROWS; i++) {
        if (sim_random_unit(&s->rng) < share) { p.u[i] += by * bell(&s->rng); }
    }
    return p;
}

int search_round(struct search *s, struct search_child *child)
{
    int n = 0;
    for (int i = 0; i < ESTIMATES * SEARCH_BROOD; i++) {
        const int k = i / SEARCH_BROOD;
        const struct search_population *of = &s->of[k];
        if (!s->used[k] || of->members == 0) { continue; }
        const int best = pick(&s->rng, of->members < BEST ? of->members : BEST);
        child[n].p = pick(&s->rng, 2) ? evolve(s, of, best) : nudge(s, of, best);
        child[n].kind = (enum estimate_kind)k;
        tidy(s, &child[n++].p);
    }
    return n;
}

double search_bound(const struct search *s, enum estimate_kind kind)
{
    const struct search_population *of = &s->of[kind];
    return of->members < s->kept ? GIVE_UP : (double)of->member[of->members - 1].s.cost;
}

static int near(const struct plant_point *a, const struct plant_point *b)
{
    for (int i = 0; i < SPACE_ROWS; i++) {
        const double d = a->u[i] - b->u[i];
        if (d > TOO_NEAR || d < -TOO_NEAR) { return 0; }
    }
    return 1;
}

/* Keeps the members in order of cost. */
static void insert(struct search_population *of, int kept, const struct search_member *m)
{
    int at;
    for (int i = 0; i < of->members; i++) {
        if (!near(&of->member[i].p, &m->p)) { continue; }
        if (of->member[i].s.cost <= m->s.cost) { return; }
        memmove(&of->member[i], &of->member[i + 1],
            (size_t)(of->members - 1 - i) * sizeof of->member[0]);
        of->members--;
        i--;
    }
    for (at = of->members; at > 0 && m->s.cost < of->member[at - 1].s.cost; at--) {}
    if (at >= kept) { return; }
    if (of->members == kept) { of->members--; }
    memmove(
        &of->member[at + 1], &of->member[at], (size_t)(of->members - at) * sizeof of->member[0]);
    of->member[at] = *m;
    of->members++;
}

void search_offer(struct search *s, const struct search_child *c, const struct score *score)
{
    const struct search_member m = {c->p, *score};
    if (score->done) { insert(&s->of[c->kind], s->kept, &m); }
}

int search_cull(struct search *s, struct search_child *child)
{
    int n = 0;
    for (int k = 0; k < ESTIMATES; k++) {
        for (int i = 0; i < s->of[k].members && i < SEARCH_KEPT; i++) {
            child[n++] = (struct search_child){s->of[k].member[i].p, (enum estimate_kind)k};
        }
        s->of[k].members = 0;
    }
    s->kept = SEARCH_KEPT;
    return n;
}
