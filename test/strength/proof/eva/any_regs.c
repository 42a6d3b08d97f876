/* SPDX-License-Identifier: MIT */
/* PROVES: register map, read
 * Set-up of tables with anything in their rows. A request of any address and number in tables of
 * any size finds registers within its block only. The map has two tables of eight values and a
 * trace of two frames, with any content. One register, two, all and one more, at each address of
 * each block and after its end. Any bits; binary32 of any value.
 *
 * EVA: -eva-slevel 100 -eva-slevel-function block:1000,staged_count:600 -eva-slevel-merge-after-loop staged_count -eva-split-return-function exh_regs_trace_locate:0
 * PLANT: lib/src/talk/regs.c: return s->end <= 2 * values ? 0 : EXH_MODBUS_ADDRESS; -> return s->end <= 2 * values + 1 ? 0 : EXH_MODBUS_ADDRESS;
 * PLANT: lib/src/talk/regs_trace.c: return s->end <= 2 * values ? 0 : EXH_MODBUS_ADDRESS; -> return s->end <= 3 * values ? 0 : EXH_MODBUS_ADDRESS;
 * PLANT: lib/src/talk/regs.c: while (r->name != NULL && i < 4 * part && r->name[i] != '\0') { i++; } -> while (r->name != NULL && i < 4 * part) { i++; }
 * PLANT: lib/src/talk/regs.c: if (2 * i + 1 < s->end) { -> {
 * PLANT: lib/src/talk/regs.c: if ((k & 7u) == 0) { to[k >> 3] = 0; } -> to[(k + 7u) >> 3] = 0;
 * PLANT: lib/src/talk/regs.c: r->box.state < 32 ? UINT32_C(1) << r->box.state : 0 -> UINT32_C(1) << r->box.state
 * PLANT: lib/src/talk/regs_parts.h: if (++w.instance == w.group->instances) { -> {
 * PLANT: lib/src/talk/regs_trace.c: if (r->trace == NULL) { return EXH_MODBUS_ADDRESS; } -> (void)0;
 */
#include "num/bytes.c"
#include "num/fix.c"
#define exh_signal_crc     table_crc /* its proof is any_signal.c */
#define exh_float_from_raw any_float /* below */
#include "talk/regs.c"
#undef exh_signal_crc
#undef exh_float_from_raw
#include "talk/regs_float.c"
#define head_of head_of_trace
#include "talk/regs_trace.c"
#undef head_of
#include "safe/safety.c"
#include "talk/trace.c"
#include "num/signal.c" /* not that of Frama-C */

#include "registers.h"

#define ALL_B (2 * 2 * EXH_HEADS + 2)

static uint8_t to[ALL_B];

uint32_t table_crc(const struct exh_signal_table *t)
{
    (void)t;
    return any_u32();
}

uint32_t any_float(int32_t raw, unsigned frac)
{
    /*@ assert frac_of: frac <= 126; */
    (void)raw;
    return any_u32();
}

static void set_up(void)
{
    any_regs();
    any_rows();
    r.signals = &table;
    if (exh_regs_setup(&r) == 0) { /*@ assert no_empty_group: \false; */
    }
    r.signals = &full_table;
    if (exh_regs_setup(&r) == 0) { /*@ assert counted: r.signals_n == 8 && r.params_n == 8; */
    }
}

/* Addresses from..end-1 of any number, where a block has so many registers at most. */
static void located(enum exh_regs_kind kind, uint32_t from, uint32_t end, uint32_t registers)
{
    struct exh_regs_span s;
    any_regs();
    r.signals_n = Frama_C_unsigned_int_interval(0, EXH_REGS_VALUES);
    r.params_n = Frama_C_unsigned_int_interval(0, EXH_REGS_VALUES);
    trace.mask = EXH_TRACE_FRAMES - 1;
    r.trace = Frama_C_interval(0, 1) ? &trace : NULL;
    if (exh_regs_locate(&r, kind, (uint16_t)Frama_C_unsigned_int_interval(from, end - 1),
            (uint16_t)any_u32(), &s) == 0) {
        /*@ assert within: s.end <= registers; */
    }
}

static void any_address(void)
{
    located(EXH_REGS_INPUT, 0, EXH_REGS_TRACE_AT, 2 * EXH_HEADS);
    located(EXH_REGS_INPUT, EXH_REGS_TRACE_AT, EXH_REGS_FRAMES_AT, 2 * EXH_TRACE_HEADS);
    located(EXH_REGS_INPUT, EXH_REGS_FRAMES_AT, EXH_REGS_SIGNAL_AT,
        2 * EXH_REGS_FRAME_VALUES * EXH_TRACE_FRAMES);
    located(EXH_REGS_INPUT, EXH_REGS_SIGNAL_AT, 0x10000, 2 * EXH_REGS_VALUES);
    located(EXH_REGS_HOLDING, 0, EXH_REGS_TRACE_AT, 0);
    located(EXH_REGS_HOLDING, EXH_REGS_TRACE_AT, EXH_REGS_SIGNAL_AT, 2 * EXH_REGS_TRACE_SET);
    located(EXH_REGS_HOLDING, EXH_REGS_SIGNAL_AT, 0x10000, 2 * EXH_REGS_VALUES);
}

/* To the end of an array. */
static void read(enum exh_regs_kind kind, uint32_t at, uint16_t n)
{
    const int err = exh_regs_read(&r, kind, (uint16_t)at, n, to + (ALL_B - 2 * n));
    /*@ assert told: 0 <= err <= 6; */
}

static void block(enum exh_regs_kind kind, uint32_t at, uint32_t registers)
{
    for (uint32_t k = 0; k <= registers; k++) {
        for (uint16_t n = 1; n <= 2; n++) { read(kind, at + k, n); }
    }
    read(kind, at, 0);
    read(kind, at, (uint16_t)registers);
    read(kind, at, (uint16_t)(registers + 1));
}

static void blocks(void)
{
    any_regs();
    block(EXH_REGS_INPUT, EXH_REGS_HEAD_AT, 2 * EXH_HEADS);
    block(EXH_REGS_INPUT, EXH_REGS_TRACE_AT, 2 * EXH_TRACE_HEADS);
    block(EXH_REGS_INPUT, EXH_REGS_FRAMES_AT, 2 * EXH_REGS_FRAME_VALUES * FRAMES);
    block(EXH_REGS_HOLDING, EXH_REGS_TRACE_AT, 2 * EXH_REGS_TRACE_SET);
    block(EXH_REGS_INPUT, EXH_REGS_SIGNAL_AT, REGISTERS);
    block(EXH_REGS_INPUT, EXH_REGS_SIGNAL_FLOAT_AT, REGISTERS);
    block(EXH_REGS_INPUT, EXH_REGS_PARAM_AT, REGISTERS);
    block(EXH_REGS_INPUT, EXH_REGS_PARAM_FLOAT_AT, REGISTERS);
    block(EXH_REGS_HOLDING, EXH_REGS_PARAM_AT, REGISTERS);
    block(EXH_REGS_HOLDING, EXH_REGS_PARAM_FLOAT_AT, REGISTERS);
}

static void bits(enum exh_regs_kind kind, uint16_t n)
{
    any_regs();
    (void)exh_regs_read_bits(&r, kind, (uint16_t)any_u32(), n, to + (ALL_B - (n + 7u) / 8));
}

static void floats(void)
{
    int32_t raw;
    (void)exh_float_from_raw(any32(), Frama_C_unsigned_int_interval(0, 126));
    (void)exh_float_to_raw(any_u32(), Frama_C_unsigned_int_interval(0, 126), &raw);
}

int main(void)
{
    static struct exh_safety box;
    set_up();
    any_address();
    blocks();
    for (uint16_t n = 0; n <= 17; n += n < 8 ? 4 : 1) {
        bits(EXH_REGS_COIL, n);
        bits(EXH_REGS_DISCRETE, n);
    }
    floats();
    ANY(box);
    exh_regs_update(&r, &box, any_u32());
    END();
    return 0;
}
