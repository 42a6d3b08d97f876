/* SPDX-License-Identifier: MIT */
/* PROVES: register map, written
 * Writes to the map of unit regs: one register, two, all and one more, of any bytes, staged or
 * commanded. At each address of the writable blocks and after their ends. Any coils. Staged values
 * are passed on, dropped and taken. Commands of any content. No value leaves the range of its
 * table.
 *
 * EVA: -eva-slevel 100 -eva-slevel-function block:1000 -eva-slevel-merge-after-loop exh_regs_validate,write_all -eva-split-return-function judge:0,written:0,from_float:0
 * PLANT: lib/src/talk/regs_stage.c: if ((uint32_t)at + n > EXH_COILS) { return EXH_MODBUS_ADDRESS; } -> (void)0;
 * PLANT: lib/src/talk/regs_stage.c: r->touched[i >> 5] &= ~bit; -> r->touched[i >> 2] &= ~bit;
 * PLANT: lib/src/talk/regs_stage.c: const int high = 2 * i >= s->from, low = 2 * i + 1 < s->end; -> const int high = 2 * i >= s->from, low = 1;
 * PLANT: lib/src/talk/regs_stage.c: if (raw < row->min || raw > row->max) { return EXH_MODBUS_VALUE; } -> (void)0;
 * PLANT: lib/src/talk/regs_stage.c: const uint32_t apply = 1u << EXH_COIL_APPLY, discard = 1u << EXH_COIL_DISCARD; -> const uint32_t apply = 1u << EXH_COILS * at, discard = 1u << EXH_COIL_DISCARD;
 * PLANT: lib/src/talk/regs_trace.c: &what->index[(at >> 1) - 1u] -> &what->index[at >> 1]
 */
#include "num/bytes.c"
#include "num/authority.c"
#include "num/fix.c"
#define exh_float_from_raw any_float /* any_regs.c has them */
#define exh_float_to_raw   any_raw
#include "talk/regs.c"
#include "talk/regs_stage.c"
#undef exh_float_from_raw
#undef exh_float_to_raw
#define head_of head_of_trace
#include "talk/regs_trace.c"
#undef head_of
#include "safe/safety.c"
#include "talk/trace.c"
#include "num/signal.c" /* not that of Frama-C */

#include "registers.h"

#define LEAST  (-1000) /* of each row */
#define MOST   2000
#define FROM_B (2 * REGISTERS + 2)

static uint8_t from[FROM_B];
static struct exh_params p; /* any_params.c */

uint32_t any_float(int32_t raw, unsigned frac)
{
    /*@ assert frac_of: frac <= 126; */
    (void)raw;
    return any_u32();
}

int any_raw(uint32_t bits, unsigned frac, int32_t *raw)
{
    /*@ assert frac_to: frac <= 126; */
    (void)bits;
    if (Frama_C_interval(0, 1)) { return -EXH_E_RANGE; }
    *raw = any32();
    return 0;
}

int exh_params_validate_by(
    const struct exh_params *of, struct exh_authority who, uint32_t i, int32_t raw)
{
    (void)who;
    /*@ assert a_value: i < 8; */
    /*@ assert in_range: -1000 <= raw <= 2000; */
    (void)of;
    return Frama_C_interval(-EXH_E_COUNT, 0);
}

int exh_params_stage_by(struct exh_params *of, struct exh_authority who, uint32_t i, int32_t raw)
{
    return exh_params_validate_by(of, who, i, raw);
}

static void any_staged(void)
{
    any_regs();
    for (unsigned i = 0; i < TABLE_ROWS; i++) {
        table_row[i].min = LEAST;
        table_row[i].max = MOST;
    }
    for (unsigned i = 0; i < TABLE_VALUES; i++) { staged[i] = Frama_C_interval(LEAST, MOST); }
}

/* From the end of an array. */
static void write(uint32_t at, uint16_t n)
{
    const int err = exh_regs_write(&r, (uint16_t)at, n, from + (FROM_B - 2 * n));
    /*@ assert told: 0 <= err <= 6; */
}

static void block(uint32_t at, uint32_t registers)
{
    for (uint32_t k = 0; k <= registers; k++) {
        for (uint16_t n = 1; n <= 2; n++) { write(at + k, n); }
    }
    write(at, 0);
    write(at, (uint16_t)registers);
    write(at, (uint16_t)(registers + 1));
    (void)exh_regs_apply(&r, &p);
}

static void coils(uint16_t n)
{
    any_staged();
    (void)exh_regs_write_bits(&r, (uint16_t)any_u32(), n, from + (FROM_B - (n + 7u) / 8));
}

int main(void)
{
    ANY(from);
    ANY(p);
    any_staged();
    block(EXH_REGS_TRACE_AT, 2 * EXH_REGS_TRACE_SET);
    /*@ assert traced: trace.what.index[0] < 8 && trace.what.index[3] < 8; */
    any_staged();
    block(EXH_REGS_PARAM_AT, REGISTERS);
    any_staged();
    block(EXH_REGS_PARAM_FLOAT_AT, REGISTERS);
    for (uint16_t n = 0; n <= EXH_COILS + 1; n++) { coils(n); }
    any_staged();
    (void)exh_regs_command(exh_regs_poll(&r));
    exh_regs_discard(&r);
    END();
    return 0;
}
