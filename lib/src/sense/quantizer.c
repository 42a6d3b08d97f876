/* SPDX-License-Identifier: MIT */
/* Quantizer with hysteresis: a code without jitter from noise. */
#include "exhand/quantizer.h"

#include "exhand/error.h"
#include "exhand/fix.h"
#include "exhand/units.h"

#include "quantizer_tick.h"

const struct exh_signal exh_quantizer_rows[EXH_QUANTIZER_ROWS] = {
    {0x0801, 0, EXH_WHEN_SETUP, 1, 24, 14, "bits", "", "stable bits"},
    {0x0802, 16, EXH_WHEN_SETUP, 0, INT32_MAX, EXH_Q(4, 1, 16), "hyst", "raw",
        "noise that shall not show, peak to peak"},
};

int exh_quantizer_setup(struct exh_quantizer_cfg *cfg, const struct exh_quantizer_par *par)
{
    if (par->bits < 1 || par->bits > 24 || par->hyst_raw_q16 < 0 ||
        par->hyst_raw_q16 > INT64_C(1) << (32 - par->bits)) {
        return -EXH_E_RANGE;
    }
    cfg->half = UINT32_C(1) << (31 - par->bits);
    cfg->keep = cfg->half + (uint32_t)par->hyst_raw_q16 / 2;
    return 0;
}

int32_t exh_quantizer_step(struct exh_quantizer *s, const struct exh_quantizer_cfg *cfg, int32_t x)
{
    return quantizer_in_place(s, cfg, x);
}

void exh_quantizer_serialize(struct exh_bytes *c, struct exh_quantizer *s)
{
    exh_bytes_i32(c, &s->value);
    exh_bytes_u8(c, &s->started);
}
