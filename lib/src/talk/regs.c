/* SPDX-License-Identifier: MIT */
/* Read access to the register map: locates an address, reads values and bits. */
#include "regs_parts.h"

#include "exhand/error.h"
#include "exhand/exhand.h"
#include "exhand/fix.h"

/* --- set-up --- */

static int table_setup(const struct exh_signal_table *t, uint32_t *n, uint32_t *crc)
{
    *n = 0;
    *crc = 0;
    if (t == NULL) { return 0; }
    for (uint16_t g = 0; g < t->groups; g++) {
        if (t->group[g].rows == 0 || t->group[g].instances == 0) { return -EXH_E_RANGE; }
        for (uint16_t k = 0; k < t->group[g].rows; k++) {
            if (t->group[g].row[k].frac > 126) { return -EXH_E_RANGE; }
        }
    }
    *n = exh_signal_count(t);
    *crc = exh_signal_crc(t);
    return *n > EXH_REGS_VALUES ? -EXH_E_RANGE : 0;
}

void exh_regs_discard(struct exh_regs *r)
{
    for (uint32_t w = 0; w < EXH_REGS_WORDS(r->params_n); w++) { r->touched[w] = 0; }
}

int exh_regs_setup(struct exh_regs *r)
{
    int err = table_setup(r->signals, &r->signals_n, &r->signals_crc);
    if (err == 0) { err = table_setup(r->params, &r->params_n, &r->params_crc); }
    if (err == 0 && r->signals != NULL && r->signal == NULL) { err = -EXH_E_ABSENT; }
    if (err == 0 && r->params != NULL &&
        (r->active == NULL || r->wanted == NULL || r->staged == NULL || r->touched == NULL)) {
        err = -EXH_E_ABSENT;
    }
    if (err < 0) { return err; }
    exh_regs_discard(r);
    r->asked = 0;
    r->done = 0;
    r->refused = 0;
    r->result = 0;
    return 0;
}

void exh_regs_update(struct exh_regs *r, const struct exh_safety *s, uint32_t din)
{
    struct exh_regs_status *b = &r->box;
    b->tick = s->tick;
    b->missed = s->missed;
    b->faults = s->faults;
    b->first = s->first;
    b->first_tick = s->first_tick;
    b->present = s->present;
    b->limits = s->limits;
    b->din = din;
    b->state = s->state;
    b->arm_step = exh_safety_arm_step(s);
}

/* --- values --- */

/* A staged value may equal the wanted one meanwhile; it then does not count. */
static uint32_t staged_count(const struct exh_regs *r)
{
    uint32_t n = 0;
    for (uint32_t w = 0; w < EXH_REGS_WORDS(r->params_n); w++) {
        uint32_t i = 32 * w;
        for (uint32_t rest = r->touched[w]; rest != 0; rest >>= 1, i++) {
            n += (rest & 1u) && r->staged[i] != r->wanted[i];
        }
    }
    return n;
}

static uint32_t name_of(const struct exh_regs *r, uint32_t part)
{
    uint32_t v = 0;
    uint32_t i = 0;
    while (r->name != NULL && i < 4 * part && r->name[i] != '\0') { i++; }
    for (uint32_t k = 0; k < 4; k++) {
        const int more = r->name != NULL && r->name[i] != '\0';
        v = v << 8 | (more ? (uint8_t)r->name[i] : 0u);
        i += more ? 1u : 0u;
    }
    return v;
}

static uint32_t head_of(const struct exh_regs *r, enum exh_regs_head h)
{
    const struct exh_regs_status *b = &r->box;
    switch (h) {
    case EXH_HEAD_MAGIC: return EXH_REGS_MAGIC;
    case EXH_HEAD_VERSION: return EXH_REGS_VERSION;
    case EXH_HEAD_TEST_INT: return 0x12345678u;
    case EXH_HEAD_TEST_FLOAT: return 0x3F800000u;
    case EXH_HEAD_TICK: return b->tick;
    case EXH_HEAD_STATE: return b->state;
    case EXH_HEAD_FAULTS: return b->faults;
    case EXH_HEAD_FIRST: return b->first;
    case EXH_HEAD_FIRST_TICK: return b->first_tick;
    case EXH_HEAD_PRESENT: return b->present;
    case EXH_HEAD_LIMITS: return b->limits;
    case EXH_HEAD_ARM_STEP: return b->arm_step;
    case EXH_HEAD_DIN: return b->din;
    case EXH_HEAD_MISSED: return b->missed;
    case EXH_HEAD_SIGNALS: return r->signals_n;
    case EXH_HEAD_PARAMS: return r->params_n;
    case EXH_HEAD_SIGNALS_CRC: return r->signals_crc;
    case EXH_HEAD_PARAMS_CRC: return r->params_crc;
    case EXH_HEAD_PERIOD_NUM: return r->T.num;
    case EXH_HEAD_PERIOD_DEN: return r->T.den;
    case EXH_HEAD_LIB_VERSION: return EXH_VERSION_NUMBER;
    case EXH_HEAD_FINGERS: return r->fingers;
    case EXH_HEAD_STAGED: return staged_count(r);
    case EXH_HEAD_PENDING: return r->asked;
    case EXH_HEAD_DONE: return r->done;
    case EXH_HEAD_RESULT: return (uint32_t)r->result;
    case EXH_HEAD_NAME_0: return name_of(r, 0);
    case EXH_HEAD_NAME_1: return name_of(r, 1);
    case EXH_HEAD_NAME_2: return name_of(r, 2);
    case EXH_HEAD_NAME_3: return name_of(r, 3);
    case EXH_HEAD_REFUSED: return r->refused;
    case EXH_HEADS: break;
    }
    return 0;
}

/* --- blocks --- */

/* Blocks of tables are 2 EXH_REGS_VALUES registers apart. */
int exh_regs_locate(const struct exh_regs *r, enum exh_regs_kind kind, uint16_t at, uint16_t n,
    struct exh_regs_span *s)
{
    const uint32_t which = ((uint32_t)at - EXH_REGS_SIGNAL_AT) >> 13;
    uint32_t values;
    if (at >= EXH_REGS_TRACE_AT && at < EXH_REGS_SIGNAL_AT) {
        return exh_regs_trace_locate(r, kind, at, n, s);
    }
    s->is_float = (int)(which & 1u);
    s->from = ((uint32_t)at - EXH_REGS_SIGNAL_AT) & (2 * EXH_REGS_VALUES - 1);
    if (kind == EXH_REGS_INPUT && at < EXH_REGS_TRACE_AT) {
        s->source = EXH_REGS_HEAD;
        s->is_float = 0;
        s->from = at;
        values = EXH_HEADS;
    } else if (kind == EXH_REGS_INPUT && which < 2) {
        s->source = EXH_REGS_SIGNAL;
        values = r->signals_n;
    } else if (which == 2 || which == 3) {
        s->source = kind == EXH_REGS_INPUT ? EXH_REGS_ACTIVE : EXH_REGS_HELD;
        values = r->params_n;
    } else {
        return EXH_MODBUS_ADDRESS;
    }
    s->end = s->from + n;
    return s->end <= 2 * values ? 0 : EXH_MODBUS_ADDRESS;
}

static int32_t raw_of(const struct exh_regs *r, enum exh_regs_source source, uint32_t i)
{
    return source == EXH_REGS_SIGNAL   ? r->signal[i]
           : source == EXH_REGS_ACTIVE ? r->active[i]
                                       : exh_regs_held(r, i);
}

static uint32_t word_of(const struct exh_regs *r, enum exh_regs_source source, uint32_t i)
{
    if (source == EXH_REGS_HEAD) { return head_of(r, (enum exh_regs_head)i); }
    if (source >= EXH_REGS_TRACE) { return exh_regs_trace_value(r, source, i); }
    return (uint32_t)raw_of(r, source, i);
}

/* Writes the registers of value i that are in the span, big-endian. */
static uint8_t *put(uint8_t *to, const struct exh_regs_span *s, uint32_t i, uint32_t v)
{
    if (2 * i >= s->from) {
        *to++ = (uint8_t)(v >> 24);
        *to++ = (uint8_t)(v >> 16 & 0xFFu);
    }
    if (2 * i + 1 < s->end) {
        *to++ = (uint8_t)(v >> 8 & 0xFFu);
        *to++ = (uint8_t)(v & 0xFFu);
    }
    return to;
}

static void read_floats(const struct exh_regs *r, const struct exh_regs_span *s, uint8_t *to)
{
    struct exh_regs_walk w =
        exh_regs_walk_to(s->source == EXH_REGS_SIGNAL ? r->signals : r->params, s->from >> 1);
    for (uint32_t i = s->from >> 1; 2 * i < s->end; i++) {
        to = put(to, s, i, exh_float_from_raw(raw_of(r, s->source, i), exh_regs_row_of(&w)->frac));
        exh_regs_walk_on(&w);
    }
}

int exh_regs_read(
    const struct exh_regs *r, enum exh_regs_kind kind, uint16_t at, uint16_t n, uint8_t *to)
{
    struct exh_regs_span s;
    const int err = exh_regs_locate(r, kind, at, n, &s);
    if (err != 0 || n == 0) { return err; }
    if (s.is_float) {
        read_floats(r, &s, to);
        return 0;
    }
    for (uint32_t i = s.from >> 1; 2 * i < s.end; i++) {
        to = put(to, &s, i, word_of(r, s.source, i));
    }
    return 0;
}

/* --- bits --- */

static uint32_t bits_of(const struct exh_regs *r, enum exh_regs_bits b)
{
    switch (b) {
    case EXH_BITS_FAULTS: return r->box.faults;
    case EXH_BITS_PRESENT: return r->box.present;
    case EXH_BITS_DIN: return r->box.din;
    case EXH_BITS_STATE: return r->box.state < 32 ? UINT32_C(1) << r->box.state : 0;
    case EXH_BITS_LIMITS: return r->box.limits;
    case EXH_BITS_ARM: return r->box.arm_step;
    case EXH_BITS: break;
    }
    return 0;
}

int exh_regs_read_bits(
    const struct exh_regs *r, enum exh_regs_kind kind, uint16_t at, uint16_t n, uint8_t *to)
{
    const uint32_t all = kind == EXH_REGS_COIL ? EXH_COILS : 32u * EXH_BITS;
    if ((uint32_t)at + n > all) { return EXH_MODBUS_ADDRESS; }
    for (uint32_t k = 0; k < n; k++) {
        const uint32_t i = at + k;
        const uint32_t word32 =
            kind == EXH_REGS_COIL ? r->asked : bits_of(r, (enum exh_regs_bits)(i >> 5));
        if ((k & 7u) == 0) { to[k >> 3] = 0; }
        to[k >> 3] = (uint8_t)(to[k >> 3] | (word32 >> (i & 31u) & 1u) << (k & 7u));
    }
    return 0;
}
