/* SPDX-License-Identifier: MIT */
/* The gate: the last step of a tick makes a D/A code of each finger's current. */
#include "exhand/safety.h"

#include "exhand/error.h"
#include "exhand/fix.h"

/* The code for one current: within the span, the peak current and the person's limit, at most
 * most_raw from zero, and within 16 bits. */
static uint16_t code_of(
    const struct exh_drive_par *par, int32_t cur_A_q26, uint16_t most_raw, uint32_t *limits)
{
    const int32_t asked = (int32_t)exh_mul_shr(
        cur_A_q26, par->dac_rawpA_q16, EXH_Q_CUR + EXH_Q_DAC); /* 20 bits and a sign */
    const int32_t top_A_q26 =
        par->person_A_q26 < par->i_peak_A_q26 ? par->person_A_q26 : par->i_peak_A_q26;
    const int64_t peak = (int64_t)top_A_q26 * par->dac_rawpA_q16 >> (EXH_Q_CUR + EXH_Q_DAC);
    const int32_t most = par->dac_span_raw < most_raw ? par->dac_span_raw : most_raw;
    const int32_t span = exh_clamp(peak, 0, most);
    const int32_t spanned = exh_clamp32(asked, -span, span);
    const int32_t code = exh_clamp32(par->dac_zero_raw + spanned, 0, UINT16_MAX);
    if (code != par->dac_zero_raw + asked) { *limits |= EXH_LIMIT_DAC; }
    return (uint16_t)code;
}

void exh_gate_step(struct exh_safety *s, const struct exh_drive_cfg *cfg, unsigned n,
    struct exh_current_ledger *i, uint32_t *limits, struct exh_drive_out *out)
{
    const int open = exh_safety_is_open(s), falls = s->state == EXH_STATE_RELEASE;

    EXH_ASSERT(n >= 1);
    EXH_ASSERT(n <= s->fingers);
    out->enable = (uint8_t)(open ? (1u << n) - 1u : 0u);
    out->alive = ++s->alive;
    s->limits = 0;
    for (unsigned k = 0; k < EXH_FINGERS; k++) {
        out->dac_raw[k] = (uint16_t)cfg[0].par->dac_zero_raw;
    }
    for (unsigned k = 0; k < n; k++) {
        const struct exh_drive_par *par = cfg[k].par;
        /* Wraps by definition: no content of the ledger may cause undefined behaviour. */
        const int64_t held_back = exh_wrap_add64(i[k].peak_A_q26, i[k].i2t_A_q26);
        const int64_t asked = exh_wrap_add64(i[k].table_A_q26, held_back);
        const int32_t passed = open ? exh_sat32(asked) : 0;
        int32_t off;

        if (passed != asked) { limits[k] |= EXH_LIMIT_GATE; }
        /* A falling current never rises, even if table, scale or limits have changed. */
        out->dac_raw[k] = code_of(par, passed, falls ? s->off_raw[k] : UINT16_MAX, &limits[k]);
        off = (int32_t)out->dac_raw[k] - par->dac_zero_raw;
        s->off_raw[k] = (uint16_t)(off < 0 ? -off : off);
        i[k].coded_A_q26 = exh_sat32(exh_gain_mul(cfg[k].dac_A_q26, off));
        i[k].gate_A_q26 = exh_wrap_diff64(passed, asked);
        i[k].dac_A_q26 = (int64_t)i[k].coded_A_q26 - passed;
        s->limits |= limits[k];
    }
}

void exh_gate_shut(struct exh_safety *s, uint16_t dac_zero_raw, struct exh_drive_out *out)
{
    out->enable = 0;
    out->alive = ++s->alive;
    for (unsigned f = 0; f < EXH_FINGERS; f++) { out->dac_raw[f] = dac_zero_raw; }
}
