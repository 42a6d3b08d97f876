/* SPDX-License-Identifier: MIT */
/* filter_cheap: low-pass of several channels, settled anew with each cut-off. */
#include "modules.h"

#include "exhand/filter_cheap.h"

#define CHANNELS 3

/* The error of some cut-off, and a configuration that is one. */
static int any_config(struct exh_filter_cheap_cfg *cfg, struct golden_rng *r, struct exh_period T)
{
    const int64_t most = (((int64_t)T.den << 15) - 1) / T.num;
    const int64_t least = (T.den >> 5) / T.num + 1;
    struct exh_filter_par par = {(int32_t)golden_draw(r, 0, 2), 0};
    int64_t fc = golden_draw(r, 0, 2 * most);
    int err;
    fc >>= golden_draw(r, 0, 12);
    par.fc_Hz_q16 = (int32_t)fc;
    err = exh_filter_cheap_setup(cfg, &par, T);
    fc = golden_draw(r, 1, most);
    fc >>= golden_draw(r, 0, 8);
    par.order = 2;
    par.fc_Hz_q16 = (int32_t)(fc < least ? least : fc);
    CHECK_EQ_I64(exh_filter_cheap_setup(cfg, &par, T), 0);
    return err;
}

void golden_filter_cheap(struct golden *g, uint32_t rate_Hz)
{
    static struct golden_wave w[CHANNELS];
    struct golden_rng r = golden_rng("filter_cheap", rate_Hz, 0);
    struct exh_filter_cheap s[CHANNELS];
    struct exh_filter_cheap_cfg cfg = {0, 0, 0, 0};
    int err = 0;
    for (uint32_t i = 0; i < CHANNELS; i++) {
        golden_wave(&w[i], "filter_cheap", rate_Hz, 1 + i, INT32_MIN, INT32_MAX,
            INT32_C(1) << golden_draw(&r, 8, 28));
    }
    while (g->tick < GOLDEN_TICKS) {
        const uint32_t k = g->tick;
        int32_t x[CHANNELS];
        int32_t y[CHANNELS];
        for (int i = 0; i < CHANNELS; i++) { golden_put(g, x[i] = w[i].at[k]); }
        if (k % 24 == 0) {
            err = any_config(&cfg, &r, golden_period(rate_Hz, k));
            exh_filter_cheap_reset(s, &cfg, x, CHANNELS);
        }
        golden_put(g, err);
        golden_put(g, cfg.high);
        golden_put(g, cfg.a);
        golden_put(g, cfg.b);
        golden_put(g, cfg.c);
        exh_filter_cheap_step(s, &cfg, x, y, CHANNELS);
        for (int i = 0; i < CHANNELS; i++) { golden_put(g, y[i]); }
        for (int i = 0; i < CHANNELS; i++) { GOLDEN_STATE(g, exh_filter_cheap_serialize, &s[i]); }
        golden_tick(g);
    }
}
