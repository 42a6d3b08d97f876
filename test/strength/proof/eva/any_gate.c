/* SPDX-License-Identifier: MIT */
/* PROVES: the gate
 * Any state of the box, any ledger, any output frame, every number of fingers. Parameters and
 * constants are those that exh_drive_setup() accepts.
 *
 * WP: Every code is within `dac_zero` +- `dac_span`, `i_peak`, the person's ceiling and 16 bits.
 * In RELEASE no code is farther from `dac_zero` than in the tick before. A closed gate codes
 * `dac_zero` for each finger and enables none. Fingers not in use have `dac_zero`. Nothing else is
 * written.
 *
 * PLANT: lib/src/act/gate.c: (1u << n) - 1u : 0u -> (1u << n) : 0u
 * PLANT: lib/src/act/gate.c: out->enable = 0; -> out->enable = 1;
 * PLANT: lib/src/act/gate.c: exh_wrap_diff64(passed, asked) -> passed - asked
 */
#include "act/gate.c"
#include "safe/safety_open.c"

#define MAY_STOP /* a box whose state says fewer fingers than are used */
#include "any.h"

static struct exh_safety s;
static struct exh_drive_par par[EXH_FINGERS];
static struct exh_drive_cfg cfg[EXH_FINGERS];
static struct exh_current_ledger i[EXH_FINGERS];
static uint32_t limits[EXH_FINGERS];
static struct exh_drive_out out;

int main(void)
{
    const unsigned n = Frama_C_unsigned_int_interval(1, EXH_FINGERS);
    /*@ assert n == 1 || n == 2 || n == 3 || n == 4 || n == 5; */
    ANY(s);
    ANY(par);
    ANY(cfg);
    ANY(i);
    ANY(limits);
    ANY(out);
    for (unsigned k = 0; k < EXH_FINGERS; k++) {
        par[k].dac_zero_raw = Frama_C_interval(0, UINT16_MAX);
        par[k].dac_span_raw = Frama_C_interval(0, INT16_MAX);
        par[k].i_peak_A_q26 = Frama_C_interval(6710886, 442918502);
        par[k].person_A_q26 = Frama_C_interval(0, 442918502);
        par[k].dac_rawpA_q16 = Frama_C_interval(65536, INT32_MAX);
        cfg[k].par = &par[k];
        cfg[k].dac_A_q26.mant = Frama_C_interval(0, INT32_MAX);
        cfg[k].dac_A_q26.shift = (uint8_t)Frama_C_unsigned_int_interval(0, 62);
    }
    exh_gate_step(&s, cfg, n, i, limits, &out);
    /*@ assert no_other_drive: out.enable == 0 || out.enable == (1 << n) - 1; */
    for (unsigned k = 0; k < EXH_FINGERS; k++) {
        limits[k] = Frama_C_unsigned_int_interval(0, (1u << EXH_LIMITS) - 1);
    }
    exh_gate_step(&s, cfg, 1, i, limits, &out);
    /*@ assert bits_of_limits: limits[0] < 1 << 12; */
    exh_gate_shut(&s, (uint16_t)par[0].dac_zero_raw, &out);
    /*@ assert drives_nothing: out.enable == 0; */
    END();
    return 0;
}
