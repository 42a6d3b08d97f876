/* SPDX-License-Identifier: MIT */
/* Write access to the register map: staged values and commands. */
#include "regs_parts.h"

#include "exhand/error.h"
#include "exhand/fix.h"

/* --- staging --- */

static void stage(struct exh_regs *r, uint32_t i, int32_t raw)
{
    const uint32_t bit = UINT32_C(1) << (i & 31u);
    r->staged[i] = raw;
    r->touched[i >> 5] &= ~bit;
    if (raw != r->wanted[i]) { r->touched[i >> 5] |= bit; }
}

/* The raw value of a binary32 for value i. 0 or exception 3. */
static int from_float(
    const struct exh_regs *r, const struct exh_signal *row, uint32_t i, uint32_t bits, int32_t *raw)
{
    const int32_t now = exh_regs_held(r, i);
    if (bits == exh_float_from_raw(now, row->frac)) {
        *raw = now;
    } else if (bits == exh_float_from_raw(row->min, row->frac)) {
        *raw = row->min;
    } else if (bits == exh_float_from_raw(row->max, row->frac)) {
        *raw = row->max;
    } else if (exh_float_to_raw(bits, row->frac, raw) < 0) {
        return EXH_MODBUS_VALUE;
    }
    return 0;
}

/* The authority of a client in the present state of the device. */
static struct exh_authority client(const struct exh_regs *r)
{
    const struct exh_authority who = {
        EXH_FROM_REGISTER, r->locked, !exh_safety_is_at_rest(r->box.state)};
    return who;
}

/* Checks whether value i may be staged as raw. 0 or exception 3. */
static int judge(const struct exh_regs *r, const struct exh_signal *row, uint32_t i, int32_t raw)
{
    if (raw < row->min || raw > row->max) { return EXH_MODBUS_VALUE; }
    return exh_authority_check(client(r), row->when, r->wanted[i], raw) < 0 ? EXH_MODBUS_VALUE : 0;
}

static uint32_t word(const uint8_t *p) { return (uint32_t)p[0] << 8 | p[1]; }

/* The value i after the bytes of a request. 0 or exception 3. */
static int written(const struct exh_regs *r, const struct exh_regs_span *s,
    const struct exh_signal *row, uint32_t i, const uint8_t *from, int32_t *raw)
{
    const int high = 2 * i >= s->from, low = 2 * i + 1 < s->end;
    const uint32_t at_B =
        2 * (2 * i - s->from); /* of the high register; wraps if it is not in the span */
    uint32_t v = s->is_float ? 0 : (uint32_t)exh_regs_held(r, i);
    if (s->is_float && (!high || !low)) { return EXH_MODBUS_VALUE; }
    if (high) { v = word(&from[at_B]) << 16 | (v & 0xFFFFu); }
    if (low) { v = (v & 0xFFFF0000u) | word(&from[at_B + 2]); }
    if (s->is_float) {
        if (from_float(r, row, i, v, raw) != 0) { return EXH_MODBUS_VALUE; }
    } else {
        *raw = exh_from_u32(v);
    }
    return judge(r, row, i, *raw);
}

int exh_regs_validate(const struct exh_regs *r, uint16_t at, uint16_t n, const uint8_t *from)
{
    struct exh_regs_span s;
    struct exh_trace_request what;
    struct exh_regs_walk w;
    int err = exh_regs_locate(r, EXH_REGS_HOLDING, at, n, &s);
    if (err != 0 || n == 0) { return err; }
    if (s.source == EXH_REGS_SET) { return exh_regs_trace_request(r, &s, from, &what); }
    if (!(r->may >> EXH_COIL_APPLY & 1u)) { return EXH_MODBUS_VALUE; }
    if (r->asked >> EXH_COIL_APPLY & 1u) { return EXH_MODBUS_BUSY; }
    w = exh_regs_walk_to(r->params, s.from >> 1);
    for (uint32_t i = s.from >> 1; err == 0 && 2 * i < s.end; i++) {
        int32_t raw;
        err = written(r, &s, exh_regs_row_of(&w), i, from, &raw);
        exh_regs_walk_on(&w);
    }
    return err;
}

static int write_all(struct exh_regs *r, uint16_t at, uint16_t n, const uint8_t *from)
{
    struct exh_regs_span s;
    struct exh_trace_request what;
    struct exh_regs_walk w;
    int err = exh_regs_validate(r, at, n, from);
    if (err == 0) { err = exh_regs_locate(r, EXH_REGS_HOLDING, at, n, &s); }
    if (err != 0 || n == 0) { return err; }
    if (s.source == EXH_REGS_SET) {
        (void)exh_regs_trace_request(r, &s, from, &what);
        (void)exh_trace_start(r->trace, &what);
        return 0;
    }
    w = exh_regs_walk_to(r->params, s.from >> 1);
    for (uint32_t i = s.from >> 1; 2 * i < s.end; i++) {
        int32_t raw = 0;
        if (written(r, &s, exh_regs_row_of(&w), i, from, &raw) == 0) { stage(r, i, raw); }
        exh_regs_walk_on(&w);
    }
    return 0;
}

/* Counts refusals; BUSY only means later. */
static int counted(struct exh_regs *r, int err)
{
    r->refused += err == EXH_MODBUS_VALUE;
    return err;
}

int exh_regs_write(struct exh_regs *r, uint16_t at, uint16_t n, const uint8_t *from)
{
    return counted(r, write_all(r, at, n, from));
}

/* --- commands --- */

static int write_bits(struct exh_regs *r, uint16_t at, uint16_t n, const uint8_t *from)
{
    const uint32_t apply = 1u << EXH_COIL_APPLY, discard = 1u << EXH_COIL_DISCARD;
    uint32_t on = 0;
    if ((uint32_t)at + n > EXH_COILS) { return EXH_MODBUS_ADDRESS; }
    for (uint32_t k = 0; k < n; k++) {
        on |= ((uint32_t)from[k >> 3] >> (k & 7u) & 1u) << (at + k);
    }
    if ((on & ~r->may) != 0 || ((on & apply) && (on & discard))) { return EXH_MODBUS_VALUE; }
    if ((on & discard) && (r->asked & apply)) { return EXH_MODBUS_BUSY; }
    if (on & discard) {
        exh_regs_discard(r);
        exh_regs_complete(r, 0);
    }
    r->asked |= on & ~discard;
    return 0;
}

int exh_regs_write_bits(struct exh_regs *r, uint16_t at, uint16_t n, const uint8_t *from)
{
    return counted(r, write_bits(r, at, n, from));
}

/* --- execution --- */

uint32_t exh_regs_poll(struct exh_regs *r)
{
    const uint32_t asked = r->asked;
    r->asked = 0;
    return asked;
}

int exh_regs_apply(struct exh_regs *r, struct exh_params *p)
{
    const struct exh_authority who = client(r);
    int err = 0;
    for (uint32_t i = 0; err == 0 && i < r->params_n; i++) {
        if (exh_regs_is_staged(r, i)) { err = exh_params_validate_by(p, who, i, r->staged[i]); }
    }
    for (uint32_t i = 0; err == 0 && i < r->params_n; i++) {
        if (exh_regs_is_staged(r, i)) { err = exh_params_stage_by(p, who, i, r->staged[i]); }
    }
    exh_regs_discard(r);
    r->refused += err < 0;
    return err;
}

uint8_t exh_regs_command(uint32_t asked)
{
    if (asked >> EXH_COIL_OFF & 1u) { return EXH_CMD_OFF; }
    if (asked >> EXH_COIL_CLEAR & 1u) { return EXH_CMD_CLEAR; }
    return asked >> EXH_COIL_RUN & 1u ? EXH_CMD_RUN : EXH_CMD_NONE;
}

void exh_regs_complete(struct exh_regs *r, int result)
{
    r->done++;
    r->result = result;
}
