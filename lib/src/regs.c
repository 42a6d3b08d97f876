#include "exhand/modbus.h"

#include "exhand/error.h"
#include "exhand/exhand.h"
#include "exhand/fix.h"

/* --- walking a table --- */

/* The row of one value after the other, without a search for each. */
struct walk {
    const struct exh_signal_group *group;
    uint16_t instance, row;
};

static struct walk walk_to(const struct exh_signal_table *t, uint32_t i)
{
    struct walk w = {t->group, 0, 0};
    while (i >= w.group->rows) {
        i -= w.group->rows;
        if (++w.instance == w.group->instances) {
            w.instance = 0;
            w.group++;
        }
    }
    w.row = (uint16_t)i;
    return w;
}

/* Beyond the last value it points behind the table. */
static void walk_on(struct walk *w)
{
    if (++w->row < w->group->rows) { return; }
    w->row = 0;
    if (++w->instance < w->group->instances) { return; }
    w->instance = 0;
    w->group++;
}

static const struct exh_signal *row_of(const struct walk *w)
{
    return &w->group->row[w->row];
}

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

static void stage_nothing(struct exh_regs *r)
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
    stage_nothing(r);
    r->asked = 0;
    r->done = 0;
    r->result = 0;
    return 0;
}

void exh_regs_see(struct exh_regs *r, const struct exh_safety *s, uint32_t din)
{
    struct exh_regs_box *b = &r->box;
    b->tick = s->tick;
    b->missed = s->missed;
    b->faults = s->faults;
    b->first = s->first;
    b->first_tick = s->first_tick;
    b->present = s->present;
    b->limits = s->limits;
    b->din = din;
    b->state = s->state;
    b->arm_step = exh_safety_arm(s);
}

/* --- values --- */

static int is_staged(const struct exh_regs *r, uint32_t i)
{
    return (int)(r->touched[i >> 5] >> (i & 31u) & 1u);
}

/* What a holding register shows. */
static int32_t held(const struct exh_regs *r, uint32_t i)
{
    return is_staged(r, i) ? r->staged[i] : r->wanted[i];
}

static void stage(struct exh_regs *r, uint32_t i, int32_t raw)
{
    const uint32_t bit = UINT32_C(1) << (i & 31u);
    r->staged[i] = raw;
    r->touched[i >> 5] &= ~bit;
    if (raw != r->wanted[i]) { r->touched[i >> 5] |= bit; }
}

static uint32_t staged_count(const struct exh_regs *r)
{
    uint32_t n = 0;
    for (uint32_t w = 0; w < EXH_REGS_WORDS(r->params_n); w++) {
        for (uint32_t rest = r->touched[w]; rest != 0; rest &= rest - 1) { n++; }
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
    const struct exh_regs_box *b = &r->box;
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
    case EXH_HEADS: break;
    }
    return 0;
}

/* --- blocks --- */

enum source { HEAD, SIGNAL, ACTIVE, HELD };

/* Where a request lies: registers from..end-1 of a block. */
struct span {
    enum source source;
    int is_float;
    uint32_t from, end;
};

/* 0 or exception 2. Blocks of tables are 2 EXH_REGS_VALUES registers apart. */
static int locate(const struct exh_regs *r, enum exh_regs_kind kind, uint16_t at, uint16_t n,
                  struct span *s)
{
    const uint32_t which = ((uint32_t)at - EXH_REGS_SIGNAL_AT) >> 13;
    uint32_t values;
    s->is_float = (int)(which & 1u);
    s->from = ((uint32_t)at - EXH_REGS_SIGNAL_AT) & (2 * EXH_REGS_VALUES - 1);
    if (kind == EXH_REGS_INPUT && at < EXH_REGS_TRACE_AT) {
        s->source = HEAD;
        s->is_float = 0;
        s->from = at;
        values = EXH_HEADS;
    } else if (kind == EXH_REGS_INPUT && which < 2) {
        s->source = SIGNAL;
        values = r->signals_n;
    } else if (which == 2 || which == 3) {
        s->source = kind == EXH_REGS_INPUT ? ACTIVE : HELD;
        values = r->params_n;
    } else {
        return EXH_MODBUS_ADDRESS;
    }
    s->end = s->from + n;
    return s->end <= 2 * values ? 0 : EXH_MODBUS_ADDRESS;
}

static int32_t raw_of(const struct exh_regs *r, enum source source, uint32_t i)
{
    return source == SIGNAL ? r->signal[i] : source == ACTIVE ? r->active[i] : held(r, i);
}

/* Big-endian registers of value i, as far as they are in the span. */
static uint8_t *put(uint8_t *to, const struct span *s, uint32_t i, uint32_t v)
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

static void read_floats(const struct exh_regs *r, const struct span *s, uint8_t *to)
{
    struct walk w = walk_to(s->source == SIGNAL ? r->signals : r->params, s->from >> 1);
    for (uint32_t i = s->from >> 1; 2 * i < s->end; i++) {
        to = put(to, s, i, exh_float_of(raw_of(r, s->source, i), row_of(&w)->frac));
        walk_on(&w);
    }
}

int exh_regs_read(const struct exh_regs *r, enum exh_regs_kind kind, uint16_t at, uint16_t n,
                  uint8_t *to)
{
    struct span s;
    const int err = locate(r, kind, at, n, &s);
    if (err != 0 || n == 0) { return err; }
    if (s.is_float) {
        read_floats(r, &s, to);
        return 0;
    }
    for (uint32_t i = s.from >> 1; 2 * i < s.end; i++) {
        to = put(to, &s, i,
                 s.source == HEAD ? head_of(r, (enum exh_regs_head)i)
                                  : (uint32_t)raw_of(r, s.source, i));
    }
    return 0;
}

/* --- staging --- */

/* The raw value that a binary32 stands for at value i. 0 or exception 3. */
static int from_float(const struct exh_regs *r, const struct exh_signal *row, uint32_t i,
                      uint32_t bits, int32_t *raw)
{
    const int32_t now = held(r, i);
    if (bits == exh_float_of(now, row->frac)) {
        *raw = now;
    } else if (bits == exh_float_of(row->min, row->frac)) {
        *raw = row->min;
    } else if (bits == exh_float_of(row->max, row->frac)) {
        *raw = row->max;
    } else if (exh_float_raw(bits, row->frac, raw) < 0) {
        return EXH_MODBUS_VALUE;
    }
    return 0;
}

/* May value i be staged as raw? 0 or exception 3. */
static int judge(const struct exh_regs *r, const struct exh_signal *row, uint32_t i, int32_t raw)
{
    const int fixed = row->when == EXH_WHEN_OUTPUT || (r->locked && row->when == EXH_WHEN_SETUP);
    if (raw < row->min || raw > row->max) { return EXH_MODBUS_VALUE; }
    return fixed && raw != r->wanted[i] ? EXH_MODBUS_VALUE : 0;
}

static uint32_t word(const uint8_t *p)
{
    return (uint32_t)p[0] << 8 | p[1];
}

/* What value i becomes by the bytes of a request. 0 or exception 3. */
static int written(const struct exh_regs *r, const struct span *s, const struct exh_signal *row,
                   uint32_t i, const uint8_t *from, int32_t *raw)
{
    const int high = 2 * i >= s->from, low = 2 * i + 1 < s->end;
    const uint32_t at_B =
        2 * (2 * i - s->from); /* of the high register; wraps if it is not there */
    uint32_t v = s->is_float ? 0 : (uint32_t)held(r, i);
    if (s->is_float && !(high && low)) { return EXH_MODBUS_VALUE; }
    if (high) { v = word(&from[at_B]) << 16 | (v & 0xFFFFu); }
    if (low) { v = (v & 0xFFFF0000u) | word(&from[at_B + 2]); }
    if (s->is_float) {
        if (from_float(r, row, i, v, raw) != 0) { return EXH_MODBUS_VALUE; }
    } else {
        *raw = exh_from_u32(v);
    }
    return judge(r, row, i, *raw);
}

int exh_regs_judge(const struct exh_regs *r, uint16_t at, uint16_t n, const uint8_t *from)
{
    struct span s;
    struct walk w;
    int err = locate(r, EXH_REGS_HOLDING, at, n, &s);
    if (err != 0 || n == 0) { return err; }
    if (r->asked >> EXH_COIL_APPLY & 1u) { return EXH_MODBUS_BUSY; }
    w = walk_to(r->params, s.from >> 1);
    for (uint32_t i = s.from >> 1; err == 0 && 2 * i < s.end; i++) {
        int32_t raw;
        err = written(r, &s, row_of(&w), i, from, &raw);
        walk_on(&w);
    }
    return err;
}

int exh_regs_write(struct exh_regs *r, uint16_t at, uint16_t n, const uint8_t *from)
{
    struct span s;
    struct walk w;
    int err = exh_regs_judge(r, at, n, from);
    if (err == 0) { err = locate(r, EXH_REGS_HOLDING, at, n, &s); }
    if (err != 0 || n == 0) { return err; }
    w = walk_to(r->params, s.from >> 1);
    for (uint32_t i = s.from >> 1; 2 * i < s.end; i++) {
        int32_t raw = 0;
        if (written(r, &s, row_of(&w), i, from, &raw) == 0) { stage(r, i, raw); }
        walk_on(&w);
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

int exh_regs_read_bits(const struct exh_regs *r, enum exh_regs_kind kind, uint16_t at, uint16_t n,
                       uint8_t *to)
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

int exh_regs_write_bits(struct exh_regs *r, uint16_t at, uint16_t n, const uint8_t *from)
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
        stage_nothing(r);
        exh_regs_did(r, 0);
    }
    r->asked |= on & ~discard;
    return 0;
}

/* --- carrying out --- */

uint32_t exh_regs_take(struct exh_regs *r)
{
    const uint32_t asked = r->asked;
    r->asked = 0;
    return asked;
}

int exh_regs_apply(struct exh_regs *r, struct exh_params *p)
{
    int err = 0;
    for (uint32_t i = 0; err == 0 && i < r->params_n; i++) {
        if (is_staged(r, i)) { err = exh_params_may(p, i, r->staged[i]); }
    }
    for (uint32_t i = 0; err == 0 && i < r->params_n; i++) {
        if (is_staged(r, i)) { err = exh_params_stage_at(p, i, r->staged[i]); }
    }
    stage_nothing(r);
    return err;
}

uint8_t exh_regs_command(uint32_t asked)
{
    if (asked >> EXH_COIL_OFF & 1u) { return EXH_CMD_OFF; }
    if (asked >> EXH_COIL_CLEAR & 1u) { return EXH_CMD_CLEAR; }
    return asked >> EXH_COIL_RUN & 1u ? EXH_CMD_RUN : EXH_CMD_NONE;
}

void exh_regs_did(struct exh_regs *r, int result)
{
    r->done++;
    r->result = result;
}
