/* SPDX-License-Identifier: MIT */
/* limiter: each kind, any watched quantities, refusals of set-up, and wrong inputs. */
#include "modules.h"

#include "exhand/limiter.h"

struct guarded_drive {
    struct exh_limiter_par par;
    struct exh_limiter_cfg cfg;
    struct exh_limiter s;
    struct exh_limiter_in in;
    int32_t us; /* a step */
    int code;
};

/* n to m steps in units of which one second has `units`, lo .. hi. */
static int32_t any_time(struct golden_rng *r, int64_t n, int64_t m, const struct exh_limiter_par *p,
    uint64_t units, int32_t lo, int32_t hi)
{
    const uint64_t steps = (uint64_t)golden_draw(r, n, m) * units * 1000;
    return exh_clamp((int64_t)exh_udiv64(steps, (uint64_t)p->rate_milli, NULL), lo, hi);
}

/* A change a second: `most` in n to m steps. */
static int32_t any_change(struct golden_rng *r, int64_t most, int64_t m, int64_t rate_Hz)
{
    const uint64_t v = (uint64_t)(most * rate_Hz);
    return exh_clamp((int64_t)exh_udiv64(v, (uint64_t)golden_draw(r, 2, m), NULL), 1, 1000000000);
}

static void any_motion(struct exh_limiter_par *p, struct golden_rng *r)
{
    const int stalls = (int)golden_draw(r, 0, 1), warms = (int)golden_draw(r, 0, 2) > 0;
    const int seen = (p->uses & EXH_LIMITER_MEASURED) || p->kind != EXH_LIMITER_POSITION;
    p->speed_max = (int32_t)golden_draw(r, 300000, 3000000);
    if (!(p->uses & EXH_LIMITER_VEL)) { p->speed_max = 0; }
    p->speed_ms = any_time(r, 0, 5, p, 1000, 0, 1000);
    p->stall_effort = (int32_t)golden_draw(r, 0, 4000000);
    if (!stalls || !seen || !(p->uses & EXH_LIMITER_POS)) { p->stall_effort = 0; }
    p->stall_move = (int32_t)golden_draw(r, 0, 20000);
    p->stall_ms = any_time(r, 1, 20, p, 1000, 1, 60000);
    p->heat_peak = (int32_t)golden_draw(r, 3000, 6000000 >> golden_draw(r, 0, 4));
    p->heat_nominal = p->heat_peak >> golden_draw(r, 1, 3);
    if (!warms || !seen) { p->heat_peak = 0; }
    p->heat_ms = any_time(r, 65, 150, p, 1000, 1, 600000);
}

static void any_par(struct exh_limiter_par *p, struct golden_rng *r, struct exh_period T)
{
    static const int32_t needs[EXH_LIMITER_KINDS] = {
        0, EXH_LIMITER_POS, EXH_LIMITER_POS | EXH_LIMITER_VEL};
    const int64_t rate_Hz = (int64_t)exh_udiv64(T.den, T.num, NULL) + 1;
    p->kind = (int32_t)golden_draw(r, 0, EXH_LIMITER_KINDS - 1);
    p->uses = (int32_t)golden_draw(r, 0, EXH_LIMITER_USE_ALL) | needs[p->kind];
    p->rate_milli = (int32_t)exh_udiv64((uint64_t)T.den * 1000, T.num, NULL);
    p->effort_max = (int32_t)golden_draw(r, 100000, 5000000);
    p->effort_up_milli = any_change(r, p->effort_max / 1000, 40, rate_Hz);
    p->effort_down_milli = any_change(r, p->effort_max / 1000, 40, rate_Hz);
    p->ramp_ms = any_time(r, 1, 20, p, 1000, 1, 10000);
    p->release_ms = any_time(r, 0, 10, p, 1000, 1, 1000);
    p->pos_min = -(int32_t)golden_draw(r, 100000, 2000000);
    p->pos_max = (int32_t)golden_draw(r, 100000, 2000000);
    p->pos_over = (int32_t)golden_draw(r, 0, 1000000);
    p->vel_max = any_change(r, p->pos_max, 50, rate_Hz);
    p->acc_max_milli = any_change(r, p->vel_max / 1000 + 1, 30, rate_Hz);
    p->first_max = (int32_t)golden_draw(r, 0, 3000000);
    p->first = (int32_t)golden_draw(r, 0, 1);
    p->after = (int32_t)golden_draw(r, 0, 1);
    p->age_max_us = (int32_t)golden_draw(r, 1, 100000);
    p->gap_max_us = any_time(r, 3, 9, p, 1000000, 0, 9999999) + 1;
    any_motion(p, r);
    p->wall_below = (int32_t)golden_draw(r, 0, 1);
    p->wall_k_milli = (int32_t)golden_draw(r, 0, 100000000 >> golden_draw(r, 0, 8));
    p->wall_b = (int32_t)golden_draw(r, 0, 10000000 >> golden_draw(r, 0, 4));
    p->wall_f0 = (int32_t)golden_draw(r, 0, 1000000);
}

/* What set-up says where one field is any number. */
static int any_wrong(const struct exh_limiter_par *right, struct golden_rng *r)
{
    static struct exh_limiter_cfg cfg;
    struct exh_limiter_par par = *right;
    const int64_t k = golden_draw(r, 0, EXH_LIMITER_FIELDS - 1);
    const int64_t any = golden_draw(r, INT32_MIN, INT32_MAX);
    const int32_t v = (int32_t)(any >> golden_draw(r, 0, 31));
    (void)memcpy((char *)&par + (size_t)k * sizeof v, &v, sizeof v);
    return exh_limiter_setup(&cfg, &par);
}

static void any_drive(struct guarded_drive *d, struct golden_rng *r, uint32_t rate_Hz, uint32_t k)
{
    (void)memset(d, 0, sizeof *d);
    any_par(&d->par, r, golden_period(rate_Hz, k));
    d->us = (int32_t)exh_udiv64(1000000000, (uint64_t)d->par.rate_milli, NULL);
    d->code = exh_limiter_setup(&d->cfg, &d->par);
    d->in.now_us = (uint32_t)golden_draw(r, 0, UINT32_MAX);
}

/* Now and then none. */
static int32_t any_number(struct golden_rng *r, int32_t v)
{
    return golden_draw(r, 0, 1023) == 0 ? EXH_LIMITER_NONE : v;
}

static void any_in(struct guarded_drive *d, struct golden_rng *r)
{
    struct exh_limiter_in *in = &d->in;
    const int rests = d->s.state == EXH_STATE_OFF || d->s.state == EXH_STATE_FAULT;
    const int64_t way = d->par.kind == EXH_LIMITER_EFFORT ? d->par.effort_max : d->par.pos_max;
    const int64_t event = golden_draw(r, 0, 127);
    if (event != 0) { in->now_us += (uint32_t)d->us; }
    if (event == 1) { in->now_us += (uint32_t)(golden_draw(r, 0, 8) * d->us); }
    in->deadman = rests ? golden_draw(r, 0, 3) > 0 : event != 2;
    in->run = rests ? golden_draw(r, 0, 3) > 0 : event != 3;
    if (golden_draw(r, 0, 7) == 0) { in->command = (int32_t)golden_draw(r, -way, way); }
    if (event == 4) { in->command = (int32_t)golden_draw(r, -INT32_MAX, INT32_MAX); }
    if (in->command == EXH_LIMITER_NONE) { in->command = 0; }
    if (in->pos == EXH_LIMITER_NONE) { in->pos = 0; }
    if (golden_draw(r, 0, 3) > (d->par.stall_effort ? 2 : 0)) {
        in->pos =
            exh_clamp(in->pos + golden_draw(r, -30000, 30000), d->par.pos_min, d->par.pos_max);
    }
    if (event == 5) { in->pos = (int32_t)golden_draw(r, INT32_MIN, INT32_MAX); }
    in->vel = (int32_t)golden_draw(r, -400000, 400000);
    if (event < 16) { in->vel = in->vel * 16; }
    in->effort = (int32_t)golden_draw(r, -d->par.effort_max, d->par.effort_max);
    in->age_us = (uint32_t)golden_draw(r, 0, d->par.age_max_us);
    if (event == 6) { in->age_us = (uint32_t)golden_draw(r, 0, UINT32_MAX); }
    in->command = any_number(r, in->command);
    in->pos = any_number(r, in->pos);
    in->vel = any_number(r, in->vel);
    in->effort = any_number(r, in->effort);
}

static void put_all(
    struct golden *g, const struct guarded_drive *d, const struct exh_limiter_out *o)
{
    golden_put(g, d->par.kind);
    golden_put(g, d->in.now_us);
    golden_put(g, d->in.command);
    golden_put(g, d->in.pos);
    golden_put(g, d->in.vel);
    golden_put(g, d->in.effort);
    golden_put(g, d->in.age_us);
    golden_put(g, d->in.deadman);
    golden_put(g, d->in.run);
    golden_put(g, d->code);
    golden_put(g, o->send);
    golden_put(g, o->enable);
    golden_put(g, o->state);
    golden_put(g, o->limits);
    golden_put(g, o->first);
    golden_put(g, o->causes);
    golden_put(g, o->present);
    golden_put(g, d->s.heat);
    golden_put(g, d->s.part);
    golden_put(g, d->s.vel);
    golden_put(g, d->s.share_q30);
    golden_put(g, d->s.stood);
}

void golden_limiter(struct golden *g, uint32_t rate_Hz)
{
    static struct guarded_drive d;
    struct golden_rng r = golden_rng("limiter", rate_Hz, 0);
    while (g->tick < GOLDEN_TICKS) {
        struct exh_limiter_out out;
        int wrong = 0;
        if (g->tick == 0 || g->tick == GOLDEN_AGAIN) { any_drive(&d, &r, rate_Hz, g->tick); }
        if (g->tick % 16 == 0) { wrong = any_wrong(&d.par, &r); }
        any_in(&d, &r);
        (void)memset(&out, 0, sizeof out);
        if (d.code == 0) { exh_limiter_step(&d.s, &d.cfg, &d.in, &out); }
        put_all(g, &d, &out);
        golden_put(g, wrong);
        golden_tick(g);
    }
}
