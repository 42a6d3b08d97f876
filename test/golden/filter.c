/* SPDX-License-Identifier: MIT */
/* filter and quantizer: low-pass of several channels, and codes that stay constant. */
#include "modules.h"

#include "exhand/filter.h"
#include "exhand/fix.h"
#include "exhand/quantizer.h"

#define CHANNELS 3

/* The error of some cut-off, and a configuration that is one. */
static int any_config(struct exh_filter_cfg *cfg, struct golden_rng *r, struct exh_period T)
{
    const int64_t most = (((int64_t)T.den << 15) - 1) / T.num;
    const int64_t least = (T.den >> 5) / T.num + 1;
    struct exh_filter_par par = {(int32_t)golden_draw(r, 1, 2), 0};
    int64_t fc = golden_draw(r, 0, 2 * most);
    int far;
    int err;
    far = golden_draw(r, 0, 2) == 0;
    fc >>= golden_draw(r, 0, far ? 26 : 1);
    par.fc_Hz_q16 = (int32_t)fc;
    err = exh_filter_setup(cfg, &par, T);
    if (err != 0) {
        fc = golden_draw(r, 1, most);
        fc >>= golden_draw(r, 0, 8);
        par.fc_Hz_q16 = (int32_t)(fc < least ? least : fc);
        CHECK_EQ_I64(exh_filter_setup(cfg, &par, T), 0);
    }
    return err;
}

/* Of the coefficients those that its kind has. */
static void put_config(struct golden *g, const struct exh_filter_cfg *f)
{
    const int low = f->kind == EXH_FILTER_LOW2 || f->kind == EXH_FILTER_LOW1;
    const int two = f->kind == EXH_FILTER_LOW2 || f->kind == EXH_FILTER_HIGH2;
    golden_put(g, f->kind);
    golden_put(g, f->a);
    golden_put(g, two ? f->b : 0);
    golden_put(g, f->kind == EXH_FILTER_LOW2 ? f->c : 0);
    golden_put(g, low ? f->shift : 0);
}

void golden_filter(struct golden *g, uint32_t rate_Hz)
{
    static struct golden_wave w[CHANNELS];
    struct golden_rng r = golden_rng("filter", rate_Hz, 0);
    struct exh_filter s[CHANNELS];
    struct exh_filter_cfg cfg[2]; /* before and now */
    int err = 0;
    for (uint32_t i = 0; i < CHANNELS; i++) {
        golden_wave(&w[i], "filter", rate_Hz, 1 + i, INT32_MIN, INT32_MAX,
            INT32_C(1) << golden_draw(&r, 8, 28));
    }
    while (g->tick < GOLDEN_TICKS) {
        const uint32_t k = g->tick;
        int32_t x[CHANNELS];
        int32_t y[CHANNELS];
        for (int i = 0; i < CHANNELS; i++) { golden_put(g, x[i] = w[i].at[k]); }
        if (k % 16 == 0) {
            cfg[0] = cfg[1];
            err = any_config(&cfg[1], &r, golden_period(rate_Hz, k));
            if (k == 0 || k == GOLDEN_AGAIN) {
                exh_filter_reset(s, x, CHANNELS);
            } else {
                exh_filter_retune(s, &cfg[0], &cfg[1], CHANNELS);
            }
        }
        golden_put(g, err);
        put_config(g, &cfg[1]);
        exh_filter_step(s, &cfg[1], x, y, CHANNELS);
        for (int i = 0; i < CHANNELS; i++) { golden_put(g, y[i]); }
        for (int i = 0; i < CHANNELS; i++) { GOLDEN_STATE(g, exh_filter_serialize, &s[i]); }
        golden_tick(g);
    }
}

void golden_quantizer(struct golden *g, uint32_t rate_Hz)
{
    static struct golden_wave w;
    struct golden_rng r = golden_rng("quantizer", rate_Hz, 0);
    struct exh_quantizer_par par = {1, 0};
    struct exh_quantizer_par other = {1, 0};
    struct exh_quantizer_cfg cfg = {0, 0};
    struct exh_quantizer s = {0, 0};
    int err = 0;
    golden_wave(
        &w, "quantizer", rate_Hz, 1, INT32_MIN, INT32_MAX, INT32_C(1) << golden_draw(&r, 4, 30));
    while (g->tick < GOLDEN_TICKS) {
        int32_t x = w.at[g->tick];
        if (g->tick == GOLDEN_AGAIN) { s = (struct exh_quantizer){0, 0}; }
        if (g->tick % 32 == 0) {
            int64_t hyst;
            par.bits = (int32_t)golden_draw(&r, 1, 24);
            hyst = golden_draw(&r, 0, INT64_C(1) << (32 - par.bits));
            par.hyst_raw_q16 = hyst > INT32_MAX ? INT32_MAX : (int32_t)hyst;
            other.bits = (int32_t)golden_draw(&r, 0, 25);
            other.hyst_raw_q16 = (int32_t)golden_draw(&r, -1, INT32_C(1) << 24);
            err = exh_quantizer_setup(&cfg, &other);
            CHECK_EQ_I64(exh_quantizer_setup(&cfg, &par), 0);
        }
        if (g->tick & 1) { /* at the edge of what is kept, if there is one */
            const int64_t keep = (INT64_C(1) << (31 - par.bits)) + par.hyst_raw_q16 / 2;
            const int64_t side = golden_draw(&r, -1, 1);
            x = exh_sat32(s.value + side * (keep + golden_draw(&r, 0, 1)));
        }
        golden_put(g, x);
        golden_put(g, par.bits);
        golden_put(g, par.hyst_raw_q16);
        golden_put(g, other.bits);
        golden_put(g, other.hyst_raw_q16);
        golden_put(g, err);
        golden_put(g, exh_quantizer_step(&s, &cfg, x));
        GOLDEN_STATE(g, exh_quantizer_serialize, &s);
        golden_tick(g);
    }
}
