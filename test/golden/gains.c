/* SPDX-License-Identifier: MIT */
/* gains: rules set up and refused, pairs asked, values staged under a rule and moved under it. */
#include "modules.h"

#include "exhand/contact.h"
#include "exhand/gains.h"

#define K_MAX 1024000000
#define B_MAX 1048576000

static const struct exh_signal_group groups[] = {{exh_contact_rows, EXH_CONTACT_ROWS, 2}};
static const struct exh_signal_table table = {groups, 1};

static struct exh_gains_par rule;
static struct exh_contact_par active[2];
static struct exh_contact_par staged[2];
static struct exh_params params;

static struct exh_gains_par any_rule(struct golden_rng *r, struct exh_period T)
{
    struct exh_gains_par p;
    int64_t b = golden_draw(r, 0, INT32_C(1) << 24);
    const int line = golden_draw(r, 0, 2) == 0; /* knots that are none: the way grazes them */
    p.rate_Hz_q8 = (int32_t)((256 * (int64_t)T.den + T.num / 2) / T.num);
    p.knots = (int32_t)golden_draw(r, 2, 8);
    p.k_min_Npm_q10 = (int32_t)(golden_draw(r, 0, 1) * golden_draw(r, 0, INT32_C(1) << 24));
    for (int i = 0; i < EXH_GAINS_KNOTS; i++) {
        p.b_Nspm_q20[i] = (int32_t)b;
        p.k_Npm_q10[i] = (int32_t)golden_draw(r, 0, K_MAX);
        if (line) { p.k_Npm_q10[i] = (int32_t)b; }
        b += golden_draw(r, 1, INT32_C(1) << 26);
    }
    return p;
}

static void spoil(struct exh_gains_par *p, int64_t how)
{
    switch ((int)how) {
    case 1: p->knots = 1; break;
    case 2: p->knots = 9; break;
    case 3: p->rate_Hz_q8 = 255; break;
    case 4: p->k_min_Npm_q10 = -1; break;
    case 5: p->b_Nspm_q20[0] = -1; break;
    case 6: p->b_Nspm_q20[p->knots - 1] = B_MAX + 1; break;
    case 7: p->k_Npm_q10[1] = -1; break;
    case 8: p->b_Nspm_q20[1] = p->b_Nspm_q20[0]; break;
    case 9:
    case 12:
    case 13: p->rate_Hz_q8 += p->rate_Hz_q8 / 50; break;
    case 10: p->k_Npm_q10[7] = K_MAX + 1; break;
    case 11: p->rate_Hz_q8 -= p->rate_Hz_q8 / 120; break;
    case 14:
    case 15: /* between two or at the end */
        p->k_min_Npm_q10 |= 1;
        p->k_Npm_q10[1] = p->k_min_Npm_q10 - 1;
        break;
    default: break;
    }
}

/* Taken only every 16th tick, so that there is a way to go under it. */
static int set_up(struct golden_rng *r, struct exh_period T, int must, int take)
{
    struct exh_gains_par p = any_rule(r, T);
    int err;
    const int64_t how = golden_draw(r, 0, 15);
    if (!must) { spoil(&p, how); }
    for (int i = 0; must && i < EXH_GAINS_KNOTS; i++) { /* in one piece, all of them */
        if (p.k_Npm_q10[i] < p.k_min_Npm_q10) { p.k_Npm_q10[i] = p.k_min_Npm_q10; }
    }
    err = exh_gains_setup(&p, T);
    if (err == 0 && take) { rule = p; }
    return err;
}

/* Anything, a pair of a piece, or beside its line. */
static void any_pair(struct golden_rng *r, int32_t *k, int32_t *b)
{
    const int64_t how = golden_draw(r, 0, 3);
    const int64_t i = golden_draw(r, 0, rule.knots - 2);
    const int64_t b0 = rule.b_Nspm_q20[i];
    const int64_t b1 = rule.b_Nspm_q20[i + 1];
    const int64_t k0 = rule.k_Npm_q10[i];
    const int64_t k1 = rule.k_Npm_q10[i + 1];
    *k = (int32_t)golden_draw(r, how == 0 ? INT32_MIN : 0, how == 0 ? INT32_MAX : K_MAX);
    *b = (int32_t)golden_draw(r, how == 0 ? INT32_MIN : b0, how == 0 ? INT32_MAX : b1);
    if (how == 2) { *b = (int32_t)b0; }
    if (how < 2) { return; }
    *k = (int32_t)(k1 >= k0 ? k0 + (k1 - k0) * (*b - b0) / (b1 - b0)
                            : k1 + (k0 - k1) * (b1 - *b) / (b1 - b0));
    *k += (int32_t)golden_draw(r, -2, 2);
}

/* What golden_put() has of it is what the loop has: one step behind what is applied. */
static int32_t move(void)
{
    const int done = exh_params_apply(&params);
    exh_gains_step(&params, &rule);
    return done;
}

/* Stages both k and b. No wall and knots are among the goals. */
static void wish(struct golden_rng *r, int32_t k, int32_t b)
{
    const int64_t how = golden_draw(r, 0, 15);
    const uint16_t instance = (uint16_t)golden_draw(r, 0, 1);
    const int64_t knot = golden_draw(r, 0, rule.knots - 1);
    if (how < 3) { k = b = 0; }
    if (how >= 3 && how < 8) {
        k = rule.k_Npm_q10[knot];
        b = rule.b_Nspm_q20[knot];
    }
    if (how > 9 || !exh_gains_ok(&rule, k, b)) { return; }
    (void)exh_params_stage(&params, 0x0401, instance, k);
    (void)exh_params_stage(&params, 0x0402, instance, b);
}

static void stage(struct golden *g, struct golden_rng *r, int32_t k, int32_t b)
{
    uint16_t instance = (uint16_t)golden_draw(r, 0, 8);
    uint16_t at = 99;
    const uint16_t id = (uint16_t)(0x0401 + golden_draw(r, 0, 5));
    const int64_t how = golden_draw(r, 0, 3);
    const int32_t any = (int32_t)golden_draw(r, INT32_MIN, INT32_MAX);
    const int32_t raw = how == 0 ? any : how == 1 ? any & 0xFFFFFF : id == 0x0401 ? k : b;
    const int past = golden_draw(r, 0, 7) == 0;
    int err;
    instance /= 4;
    golden_put(g, past ? exh_params_stage(&params, id, instance, raw)
                       : exh_gains_stage(&params, &rule, id, instance, raw));
    golden_put(g, id);
    golden_put(g, instance);
    golden_put(g, raw);
    err = exh_gains_validate(&params, &rule, &at);
    if (err < 0) { exh_params_discard(&params); }
    golden_put(g, err);
    golden_put(g, at);
    golden_put(g, golden_draw(r, 0, 3) ? move() : -1);
    golden_put(g, params.pending);
    golden_put(g, params.moving);
    for (int i = 0; i < 2; i++) {
        golden_put(g, staged[i].k_Npm_q10);
        golden_put(g, staged[i].b_Nspm_q20);
        golden_put(g, active[i].k_Npm_q10);
        golden_put(g, active[i].b_Nspm_q20);
    }
}

/* Inside a rule whose knots are none below k_min: no wall, a knot, below it, or anything under a
 * piece. */
static struct exh_contact_par place(struct golden_rng *r, const struct exh_gains_par *p)
{
    struct exh_contact_par at = {0};
    const int64_t how = golden_draw(r, 0, 7);
    const int64_t i = golden_draw(r, 0, p->knots - 1);
    const int64_t j = i > 0 ? i - 1 : 1;
    const int32_t least = p->k_Npm_q10[i] < p->k_Npm_q10[j] ? p->k_Npm_q10[i] : p->k_Npm_q10[j];
    const int32_t b = p->b_Nspm_q20[i];
    at.k_Npm_q10 = (int32_t)golden_draw(r, p->k_min_Npm_q10, least);
    at.b_Nspm_q20 =
        (int32_t)golden_draw(r, i < j ? b : p->b_Nspm_q20[j], i < j ? p->b_Nspm_q20[j] : b);
    if (how == 0) { at.k_Npm_q10 = at.b_Nspm_q20 = 0; }
    if (how > 0 && how < 5) { at.k_Npm_q10 = p->k_Npm_q10[i]; }
    if (how == 5) { at.k_Npm_q10 = p->k_min_Npm_q10; }
    if (how > 0 && how < 6) { at.b_Nspm_q20 = b; }
    return at;
}

/* Some ticks of two ways under a rule of their own, to somewhere else after them: as many corners
 * as there are ticks. */
static void walk(struct golden *g, struct golden_rng *r, struct exh_period T)
{
    static struct exh_contact_par is[2], wanted[2];
    struct exh_params p;
    struct exh_gains_par own = any_rule(r, T);
    if (golden_draw(r, 0, 1)) { own.b_Nspm_q20[0] = 0; } /* no wall is at a knot */
    for (int i = 0; i < EXH_GAINS_KNOTS; i++) {
        if (own.k_Npm_q10[i] < own.k_min_Npm_q10) { own.k_Npm_q10[i] = own.k_min_Npm_q10; }
    }
    exh_params_setup(&p, &table, (int32_t *)is, (int32_t *)wanted);
    exh_gains_enable(&p, 1);
    for (int i = 0; i < 2; i++) { is[i] = place(r, &own); }
    p.locked = 1;
    p.shift = (uint8_t)golden_draw(r, 0, 5);
    for (int part = 0; part < 2; part++) {
        int64_t ticks = golden_draw(r, 1, 4);
        for (int i = 0; i < 2; i++) { wanted[i] = place(r, &own); }
        p.pending = 1;
        while (ticks-- > 0) {
            (void)exh_params_apply(&p);
            exh_gains_step(&p, &own);
        }
        for (int i = 0; i < 2; i++) {
            golden_put(g, is[i].k_Npm_q10);
            golden_put(g, is[i].b_Nspm_q20);
        }
    }
}

/* Two walls at power on: none, and the least at the first knot. */
static void start(void)
{
    exh_params_setup(&params, &table, (int32_t *)active, (int32_t *)staged);
    active[0].k_Npm_q10 = staged[0].k_Npm_q10 = 0; /* no wall: b first is outside */
    active[1].k_Npm_q10 = staged[1].k_Npm_q10 = rule.k_min_Npm_q10;
    active[1].b_Nspm_q20 = staged[1].b_Nspm_q20 = rule.b_Nspm_q20[0];
    exh_gains_enable(&params, 1);
}

void golden_gains(struct golden *g, uint32_t rate_Hz)
{
    struct golden_rng r = golden_rng("gains", rate_Hz, 0);
    while (g->tick < GOLDEN_TICKS) {
        const int anew = g->tick == 0 || g->tick == GOLDEN_AGAIN;
        int32_t k;
        int32_t b;
        int err = 1;
        if (anew || g->tick % 8 == 0) {
            const int take = anew || g->tick % 16 == 0;
            err = set_up(&r, golden_period(rate_Hz, g->tick), anew, take);
            if (err == 0 && take) { start(); }
            params.shift = (uint8_t)golden_draw(&r, 0, 4);
        }
        params.locked = g->tick % 16 > 1;
        any_pair(&r, &k, &b);
        golden_put(g, err);
        golden_put(g, k);
        golden_put(g, b);
        golden_put(g, exh_gains_ok(&rule, k, b));
        wish(&r, k, b);
        stage(g, &r, k, b);
        walk(g, &r, golden_period(rate_Hz, g->tick));
        golden_tick(g);
    }
}
