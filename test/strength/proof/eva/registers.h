/* SPDX-License-Identifier: MIT */
/* The register map over the tables of table.h: anything in the box, in all values, in what is staged and traced. */
#ifndef PROOF_REGISTERS_H
#define PROOF_REGISTERS_H

#include "table.h"

#include "exhand/regs.h"

#define FRAMES    2
#define REGISTERS (2 * TABLE_VALUES)

static struct exh_regs r;
static struct exh_trace trace;
static struct exh_trace_frame frame[FRAMES];
static int32_t signal[TABLE_VALUES], active[TABLE_VALUES], wanted[TABLE_VALUES],
    staged[TABLE_VALUES];
static uint32_t touched[EXH_REGS_WORDS(TABLE_VALUES)];
static char name[6];

static void any_regs(void)
{
    ANY(r);
    ANY(signal);
    ANY(active);
    ANY(wanted);
    ANY(staged);
    touched[0] = Frama_C_unsigned_int_interval(0, (1u << TABLE_VALUES) - 1);
    ANY(frame);
    ANY(trace);
    any_rows();
    for (unsigned i = 0; i < TABLE_ROWS; i++) {
        table_row[i].frac = (uint8_t)Frama_C_unsigned_int_interval(0, 126);
    }
    for (unsigned i = 0; i + 1 < sizeof name; i++) { name[i] = (char)Frama_C_interval(-128, 127); }
    name[sizeof name - 1] = '\0';
    trace.frame = frame;
    trace.mask = FRAMES - 1;
    trace.signals = TABLE_VALUES;
    for (unsigned i = 0; i < EXH_TRACE_SIGNALS; i++) {
        trace.what.index[i] = Frama_C_unsigned_int_interval(0, TABLE_VALUES - 1);
    }
    r.name = Frama_C_interval(0, 1) ? name : NULL;
    r.signals = r.params = &full_table;
    r.signals_n = r.params_n = TABLE_VALUES;
    r.signal = signal;
    r.active = active;
    r.wanted = wanted;
    r.staged = staged;
    r.touched = touched;
    r.trace = &trace;
}

#endif
