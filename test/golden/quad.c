/* SPDX-License-Identifier: MIT */
/* quad: extension of a counter, position, and the decoder of two lines. */
#include "modules.h"

#include "exhand/fix.h"
#include "exhand/quad.h"

/* The narrowest counter, of 16, 20, 24, 28 or 32 bits, that set-up takes. */
static unsigned narrowest(
    struct exh_quad_cfg *cfg, const struct exh_quad_par *par, struct exh_period T)
{
    unsigned bits = 16;
    while (exh_quad_setup(cfg, par, T, bits) != 0 && bits < 32) { bits += 4; }
    return bits;
}

void golden_quad(struct golden *g, uint32_t rate_Hz)
{
    static struct golden_wave moves;
    struct golden_rng r = golden_rng("quad", rate_Hz, 0);
    struct exh_quad_par par = {golden_step(&r), 0};
    struct exh_quad_cfg cfg = {.par = NULL};
    struct exh_quad s = {.raw = 0};
    uint32_t raw = 0;
    unsigned bits = 0;
    while (g->tick < GOLDEN_TICKS) {
        const uint32_t k = g->tick;
        uint32_t shown;
        int32_t cnt;
        if (k == 0 || k == GOLDEN_AGAIN) {
            par.speed_max_mps_q27 = (int32_t)golden_draw(&r, 13421773, INT32_MAX);
            bits = narrowest(&cfg, &par, golden_period(rate_Hz, k));
            s = (struct exh_quad){.raw = 0};
            golden_wave(&moves, "quad", rate_Hz, 1 + (k > 0), -cfg.jump_cnt, cfg.jump_cnt,
                cfg.jump_cnt < 16 ? 1 : cfg.jump_cnt / 16);
            raw = (uint32_t)(golden_u64(&r) & UINT32_MAX);
        }
        raw += (uint32_t)moves.at[k];
        if (k >= 184 && k < GOLDEN_AGAIN) {
            raw += (uint32_t)golden_draw(&r, -cfg.jump_cnt, cfg.jump_cnt);
        }
        /* What is above the counter's width is nothing. */
        shown =
            (uint32_t)((raw & ((UINT64_C(1) << bits) - 1)) | (golden_u64(&r) << bits & UINT32_MAX));
        cnt = exh_quad_step(&s, &cfg, shown);
        golden_put(g, shown);
        golden_put(g, bits);
        golden_put(g, cfg.jump_cnt);
        golden_put(g, cnt);
        golden_put(g, exh_quad_pos_m_q30(&par, cnt));
        golden_put(g, exh_quad_pos_m_q30(&par, exh_from_u32(shown)));
        GOLDEN_STATE(g, exh_quad_serialize, &s);
        golden_tick(g);
    }
}

/* --- the two lines --- */

#define SAMPLES 16

/* One of SAMPLES movements: mostly on, now and then rest, back or an illegal step. */
static uint8_t move(uint64_t bits, uint32_t way)
{
    const unsigned n = (unsigned)(bits & 15);
    if (n < 2) { return 0; }
    if (n == 2) { return 2; }
    return (uint8_t)(n == 3 ? 4 - way : way);
}

/* Bit 0 of each sample from `at` on is the first of a word; bit `line` of the sample. */
static uint64_t word_of(const uint8_t *ab, unsigned line)
{
    uint64_t w = 0;
    for (unsigned i = 0; i < 64; i++) { w |= (uint64_t)(ab[i] >> line & 1u) << i; }
    return w;
}

struct decoders {
    struct exh_quad_ab x1, x2, x4, word;
    struct exh_quad_index index;
    uint8_t waiting[4 * SAMPLES];
};

static void decode(struct decoders *d, uint32_t k, const uint8_t *ab, unsigned level)
{
    const size_t part = k % (SAMPLES + 1);
    for (unsigned i = 0; i < SAMPLES; i++) { exh_quad_ab_step(&d->x1, &exh_quad_x1, ab[i]); }
    exh_quad_ab_run(&d->x2, &exh_quad_x2, ab, SAMPLES);
    exh_quad_ab_run(&d->x4, &exh_quad_x4, ab, part);
    for (size_t i = part; i < SAMPLES; i++) { exh_quad_ab_step(&d->x4, &exh_quad_x4, ab[i]); }
    if (k == 0) { /* near their ends */
        d->x4.cnt = INT32_MAX - 19;
        d->x4.edges = UINT32_MAX - 20;
        d->x4.illegal = UINT32_MAX - 3;
    }
    (void)memcpy(d->waiting + k % 4 * SAMPLES, ab, SAMPLES);
    if (k % 4 == 3) { exh_quad_ab_word(&d->word, word_of(d->waiting, 1), word_of(d->waiting, 0)); }
    exh_quad_index_step(&d->index, d->x4.cnt, level);
}

static void put_decoders(struct golden *g, struct decoders *d)
{
    golden_put(g, d->x1.cnt);
    golden_put(g, d->x2.cnt);
    golden_put(g, d->x4.cnt);
    golden_put(g, d->x4.edges);
    golden_put(g, d->x4.illegal);
    golden_put(g, d->word.cnt);
    golden_put(g, d->index.cnt);
    GOLDEN_STATE(g, exh_quad_ab_serialize, &d->x1);
    GOLDEN_STATE(g, exh_quad_ab_serialize, &d->x2);
    GOLDEN_STATE(g, exh_quad_ab_serialize, &d->x4);
    GOLDEN_STATE(g, exh_quad_ab_serialize, &d->word);
    GOLDEN_STATE(g, exh_quad_index_serialize, &d->index);
}

void golden_quad_ab(struct golden *g, uint32_t rate_Hz)
{
    static struct decoders d;
    struct golden_rng r = golden_rng("quad_ab", rate_Hz, 0);
    unsigned place = 0;
    while (g->tick < GOLDEN_TICKS) {
        const uint64_t bits = golden_u64(&r);
        const unsigned level = (unsigned)golden_draw(&r, 0, 1);
        uint8_t ab[SAMPLES];
        uint32_t all = 0;
        if (g->tick == 0 || g->tick == GOLDEN_AGAIN) { (void)memset(&d, 0, sizeof d); }
        for (unsigned i = 0; i < SAMPLES; i++) {
            place = (place + move(bits >> 4 * i, g->tick & 16 ? 3 : 1)) & 3;
            ab[i] = (uint8_t)(place ^ place >> 1);
            all |= (uint32_t)ab[i] << 2 * i;
        }
        decode(&d, g->tick, ab, level);
        golden_put(g, all);
        golden_put(g, level);
        put_decoders(g, &d);
        golden_tick(g);
    }
}
