/* SPDX-License-Identifier: MIT */
/* guard and supply: has constant memory changed, and do the drives have power? */
#include "modules.h"

#include "exhand/fix.h"
#include "exhand/integrity.h"
#include "exhand/supply.h"

#define AREA_B 40

struct still {
    struct exh_integrity guard;
    struct exh_params params;
    int32_t active[GOLDEN_VALUES], staged[GOLDEN_VALUES];
    uint8_t area[AREA_B];
    uint32_t len_B;
    uint32_t at, word; /* what is changed while the masks are not 0 */
    uint8_t flip, off;
};

static void change(struct still *s, uint8_t flip, uint8_t off)
{
    s->area[s->at] ^= s->flip ^ flip;
    s->active[s->word] ^= s->off ^ off;
    s->flip = flip;
    s->off = off;
}

static void any_still(struct still *s, struct golden_rng *r)
{
    change(s, 0, 0);
    s->len_B = (uint32_t)golden_draw(r, 0, AREA_B);
    for (uint32_t i = 0; i < AREA_B; i++) { s->area[i] = (uint8_t)golden_draw(r, 0, 255); }
    exh_integrity_seal(&s->guard, s->area, s->len_B, golden_draw(r, 0, 3) ? &s->params : NULL);
}

/* A bit of the area or of a parameter turned over, and back again; a value being staged. */
static void any_change(struct still *s, struct golden_rng *r)
{
    const int64_t how = golden_draw(r, 0, 9);
    const uint32_t at = (uint32_t)golden_draw(r, 0, s->len_B > 0 ? s->len_B - 1 : 0);
    const uint32_t word = (uint32_t)golden_draw(r, 0, GOLDEN_VALUES - 1);
    const uint8_t bit = (uint8_t)(INT32_C(1) << golden_draw(r, 0, 7));
    if (how < 5) { change(s, 0, 0); }
    if (how < 3) {
        s->at = at;
        s->word = word;
        change(s, how == 0 ? bit : 0, how == 0 ? 0 : bit);
    }
    if (how == 2) { s->params.pending = 1; }
    if (how == 5 || how == 6) { s->params.pending ^= 1; }
    if (how == 6 || how == 7) { s->params.moving ^= 1; }
}

void golden_guard(struct golden *g, uint32_t rate_Hz)
{
    static struct still s;
    struct golden_rng r = golden_rng("guard", rate_Hz, 0);
    (void)memset(&s, 0, sizeof s);
    exh_params_setup(&s.params, &golden_signals, s.active, s.staged);
    while (g->tick < GOLDEN_TICKS) {
        const int anew = golden_draw(&r, 0, 13) == 0;
        if (g->tick == 0 || g->tick == GOLDEN_AGAIN || anew) { any_still(&s, &r); }
        any_change(&s, &r);
        golden_put(g, s.len_B);
        golden_put(g, s.flip);
        golden_put(g, s.off);
        golden_put(g, s.params.pending);
        golden_put(g, s.params.moving);
        golden_put(g, exh_integrity_step(&s.guard));
        golden_put(g, s.guard.at);
        golden_put(g, s.guard.crc);
        golden_put(g, s.params.at);
        golden_tick(g);
    }
}

/* --- supply --- */

void golden_supply_par(struct exh_supply_par *p, struct golden_rail *rail, struct golden_rng *r,
    uint32_t rate_Hz, int64_t seldom)
{
    const int64_t scale = golden_draw(r, 100000, 1500000);
    const int64_t low = golden_draw(r, 1, 20000), high = golden_draw(r, low + 1, 32000);
    p->scale_V_q30 = (int32_t)scale;
    p->min_V_q20 = golden_draw(r, 0, seldom) ? (int32_t)(low * scale >> 10) : 0;
    p->max_V_q20 = (int32_t)(high * scale >> 10);
    p->time_ms = (int32_t)exh_clamp(golden_draw(r, 1, 12) * 1000 / rate_Hz, 1, 1000);
    rail->good_raw = (int16_t)((low + high) >> 1);
    rail->off = 0;
}

int16_t golden_rail(struct golden_rail *rail, struct golden_rng *r, uint32_t k)
{
    if (golden_draw(r, 0, rail->off ? 15 : 95) == 0) {
        const int64_t how = golden_draw(r, 0, 2);
        const int64_t any = golden_draw(r, -32768, 32767);
        rail->off = !rail->off;
        rail->off_raw = (int16_t)(how == 0 ? 0 : how == 1 ? 32766 : any);
    }
    return k % 96 >= 72 && k % 96 < 88 ? 32766 : rail->off ? rail->off_raw : rail->good_raw;
}

/* Limits that may be none, and what set-up says of them. */
static int any_limits(struct exh_supply_cfg *cfg, struct golden_rail *rail, struct golden_rng *r,
    uint32_t rate_Hz, uint32_t k)
{
    struct exh_supply_par p;
    int err;
    do {
        golden_supply_par(&p, rail, r, rate_Hz, 31);
        if (p.min_V_q20 == 0) { p.min_V_q20 = 1; }
        if (golden_draw(r, 0, 3) == 0) {
            p.max_V_q20 = p.min_V_q20 + (int32_t)golden_draw(r, 0, 2000);
        }
        if (golden_draw(r, 0, 1) == 0) { p.scale_V_q30 >>= 1; }
        err = exh_supply_setup(cfg, &p, golden_period(rate_Hz, k));
    } while (err != 0 && golden_draw(r, 0, 3) != 0);
    return err;
}

void golden_supply(struct golden *g, uint32_t rate_Hz)
{
    struct golden_rng r = golden_rng("supply", rate_Hz, 0);
    struct exh_supply_cfg cfg = {0, 0, 1};
    struct exh_supply s = {0};
    struct golden_rail rail = {0, 0, 0};
    int bad = 0;
    while (g->tick < GOLDEN_TICKS) {
        const uint32_t k = g->tick;
        int64_t raw;
        uint32_t missed;
        int err = 0;
        if (k % 16 == 0) {
            err = any_limits(&cfg, &rail, &r, rate_Hz, k);
            s.off_ticks = 0;
        }
        if (golden_draw(&r, 0, 7) == 0) { bad = (int)golden_draw(&r, 0, 3); }
        raw = golden_draw(&r, -32768, 32767);
        if (bad == 1) { raw = cfg.min_raw + golden_draw(&r, -1, 0); }
        if (bad == 2) { raw = cfg.max_raw + golden_draw(&r, 0, 1); }
        if (bad == 0 || raw < INT16_MIN || raw > INT16_MAX) { raw = rail.good_raw; }
        missed = golden_draw(&r, 0, 15) == 0
                     ? (uint32_t)(golden_u64(&r) & UINT32_MAX) >> golden_draw(&r, 0, 31)
                     : 0;
        golden_put(g, raw);
        golden_put(g, missed);
        golden_put(g, err);
        golden_put(g, cfg.min_raw);
        golden_put(g, cfg.max_raw);
        golden_put(g, cfg.ticks);
        golden_put(g, exh_supply_step(&s, &cfg, (int16_t)raw, missed));
        GOLDEN_STATE(g, exh_supply_serialize, &s);
        golden_tick(g);
    }
}
