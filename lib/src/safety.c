#include "exhand/safety.h"

#include "exhand/error.h"
#include "exhand/fix.h"

#define MISSED_MAX 1

const struct exh_signal exh_safety_rows[EXH_SAFETY_ROWS] = {
    {0x0601, 0, EXH_WHEN_SETUP, 0, MISSED_MAX, 1, "missed_max", "", "missed ticks tolerated, in 64"},
};

static uint32_t add_sat(uint32_t a, uint32_t b)
{
    return a > UINT32_MAX - b ? UINT32_MAX : a + b;
}

/* Causes present in this tick. */
static uint32_t causes(uint32_t late, const struct exh_safety_par *par, struct exh_safety_in in)
{
    const uint32_t drives = ((1u << in.fingers) - 1u) * EXH_DIN_DRIVE0;
    const int in_range = par->missed_max >= 0 && par->missed_max <= MISSED_MAX;
    uint32_t c = in.raised;
    if (!(in.din & EXH_DIN_ESTOP)) { c |= EXH_FAULT_ESTOP; }
    if (!(in.din & EXH_DIN_DEADMAN)) { c |= EXH_FAULT_DEADMAN; }
    if ((in.din & drives) != drives) { c |= EXH_FAULT_DRIVE; }
    if (late > (in_range ? (uint32_t)par->missed_max * EXH_LATE_TICKS : 0)) { c |= EXH_FAULT_OVERRUN; }
    return c;
}

uint8_t exh_safety_step(struct exh_safety *s, const struct exh_safety_par *par,
                        struct exh_safety_in in)
{
    uint32_t now;

    EXH_ASSERT(in.fingers >= 1);
    EXH_ASSERT(in.fingers <= EXH_FINGERS);
    s->missed = add_sat(s->missed, in.missed);
    s->fingers = in.fingers;
    /* A tick too long by half a period misses every other one: it must add up. */
    if (s->late > 0) { s->late--; }
    for (uint32_t k = 0; k < in.missed && k <= MISSED_MAX; k++) {
        s->late = add_sat(s->late, EXH_LATE_TICKS);
    }
    now = causes(s->late, par, in);
    s->present = now;
    if (s->state == EXH_STATE_RUN && now != 0) {
        s->state = EXH_STATE_FAULT;
        s->first = now;
        s->first_tick = s->tick;
    }
    if (s->state > EXH_STATE_FAULT) { s->state = EXH_STATE_FAULT; }
    if (s->state == EXH_STATE_FAULT) {
        s->faults |= now;
        if (in.command == EXH_CMD_CLEAR && now == 0) {
            s->state = EXH_STATE_OFF;
            s->faults = 0;
        }
    } else if (in.command == EXH_CMD_OFF) {
        s->state = EXH_STATE_OFF;
    } else if (in.command == EXH_CMD_RUN && now == 0) {
        s->state = EXH_STATE_RUN;
    }
    s->tick++;
    return s->state;
}

/* The code for one current: within the span of zero, and of 16 bits. */
static uint16_t code_of(const struct exh_drive_par *par, int32_t cur_A_q26, uint32_t *limits)
{
    const int64_t asked = exh_mul_shr(cur_A_q26, par->dac_rawpA_q16, EXH_Q_CUR + EXH_Q_DAC);
    const int32_t spanned = exh_clamp(asked, -par->dac_span_raw, par->dac_span_raw);
    const int32_t code = exh_clamp((int64_t)par->dac_zero_raw + spanned, 0, UINT16_MAX);
    if (code != par->dac_zero_raw + asked) { *limits |= EXH_LIMIT_DAC; }
    return (uint16_t)code;
}

void exh_gate(struct exh_safety *s, const struct exh_drive_cfg *cfg, unsigned n,
              struct exh_current_ledger *i, uint32_t *limits, struct exh_drive_out *out)
{
    const int open = s->state == EXH_STATE_RUN;

    EXH_ASSERT(n >= 1);
    EXH_ASSERT(n <= s->fingers);
    out->enable = (uint8_t)(open ? (1u << n) - 1u : 0u);
    out->alive = ++s->alive;
    for (unsigned k = 0; k < EXH_FINGERS; k++) {
        out->dac_raw[k] = (uint16_t)cfg[k < n ? k : 0].par->dac_zero_raw;
    }
    for (unsigned k = 0; k < n; k++) {
        const struct exh_drive_par *par = cfg[k].par;
        const int64_t asked = i[k].table_A_q26 + i[k].peak_A_q26 + i[k].i2t_A_q26;
        const int32_t passed = open ? exh_sat32(asked) : 0;

        if (passed != asked) { limits[k] |= EXH_LIMIT_GATE; }
        out->dac_raw[k] = code_of(par, passed, &limits[k]);
        i[k].coded_A_q26 = exh_sat32(
            exh_gain_mul(cfg[k].dac_A_q26, (int32_t)out->dac_raw[k] - par->dac_zero_raw));
        i[k].gate_A_q26 = passed - asked;
        i[k].dac_A_q26 = (int64_t)i[k].coded_A_q26 - passed;
    }
}

void exh_safety_bytes(struct exh_bytes *c, struct exh_safety *s)
{
    exh_bytes_u32(c, &s->present);
    exh_bytes_u32(c, &s->faults);
    exh_bytes_u32(c, &s->first);
    exh_bytes_u32(c, &s->first_tick);
    exh_bytes_u32(c, &s->tick);
    exh_bytes_u32(c, &s->missed);
    exh_bytes_u32(c, &s->late);
    exh_bytes_u8(c, &s->state);
    exh_bytes_u8(c, &s->alive);
    /* Nothing that was damaged may leave a fault behind by itself. */
    if (s->state > EXH_STATE_FAULT || s->faults != 0) { s->state = EXH_STATE_FAULT; }
}
