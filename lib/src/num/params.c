/* SPDX-License-Identifier: MIT */
/* Parameters of a scene: staging, slewing, sealing, and their image. */
#include "exhand/params.h"

#include "exhand/authority.h"
#include "exhand/error.h"
#include "exhand/fix.h"

#include "params_save.h"

#define IMAGE_MAGIC  0x50485845u /* "EXHP" */
#define IMAGE_HEAD_B 12u
#define IMAGE_CRC_B  4u
#define TIME_MAX_MS  1000

const struct exh_signal exh_tune_rows[EXH_TUNE_ROWS] = {
    {0x1301, 0, EXH_WHEN_SETUP, 0, TIME_MAX_MS, 20, "tune_time", "ms",
        "least time a slewed parameter takes for 63 % of its way; 0: at once"},
};

/* --- the two arrays, and their checksum --- */

/* Distinct odd weights: any single flipped bit of either array changes the sum. */
static uint32_t term(const struct exh_params *p, const int32_t *array, uint32_t i, uint32_t value)
{
    return (4 * i + (array == p->active ? 1 : 3)) * value;
}

/* Updates the checksum by the difference, so that earlier damage is still detected. */
static void put(struct exh_params *p, int32_t *array, uint32_t i, int32_t v)
{
    const uint32_t more = term(p, array, i, (uint32_t)v - (uint32_t)array[i]);
    p->sum += more;
    p->passed += i < p->at ? more : 0;
    array[i] = v;
}

static uint32_t both(const struct exh_params *p, uint32_t i)
{
    return term(p, p->active, i, (uint32_t)p->active[i]) +
           term(p, p->staged, i, (uint32_t)p->staged[i]);
}

void exh_params_seal(struct exh_params *p)
{
    p->sum = p->passed = p->at = 0;
    for (uint32_t i = 0; i < p->count; i++) { p->sum += both(p, i); }
}

int exh_params_verify(struct exh_params *p)
{
    const uint32_t i = p->at < p->count ? p->at : 0;
    int bad;
    if (p->count == 0) { return 0; } /* an empty table, or a struct of zeros */
    bad = p->active[i] != p->staged[i] && !p->pending && !p->moving;
    p->passed += both(p, i);
    p->at = i + 1;
    if (p->at == p->count) {
        bad |= p->passed != p->sum;
        p->at = p->passed = 0;
    }
    return bad;
}

void exh_params_setup(
    struct exh_params *p, const struct exh_signal_table *table, int32_t *active, int32_t *staged)
{
    const struct exh_params none = {0};
    *p = none;
    p->table = table;
    p->active = active;
    p->staged = staged;
    p->count = exh_signal_count(table);
    for (uint32_t i = 0; i < p->count; i++) {
        active[i] = exh_signal_at(table, i, NULL)->dflt;
        staged[i] = active[i];
    }
    exh_params_seal(p);
}

/* --- staged and applied --- */

void exh_params_slew_setup(
    struct exh_params *p, const struct exh_tune_par *par, struct exh_period T)
{
    const int64_t time = (int64_t)exh_clamp(par->time_ms, 0, TIME_MAX_MS) * T.den;
    int64_t taken = (int64_t)T.num * 1000; /* ms, times den: below 2^42 */
    p->shift = 0;
    for (; taken < time && p->shift < EXH_TUNE_SHIFT_MAX; taken *= 2) { p->shift++; }
}

int exh_params_validate_by(
    const struct exh_params *p, struct exh_authority who, uint32_t i, int32_t raw)
{
    const struct exh_signal *row = exh_signal_at(p->table, i, NULL);
    if (row == NULL) { return -EXH_E_UNKNOWN; }
    if (row->when == EXH_WHEN_OUTPUT) { return -EXH_E_STATE; }
    if (raw < row->min || raw > row->max) { return -EXH_E_RANGE; }
    who.locked = p->locked;
    return exh_authority_check(who, row->when, p->staged[i], raw);
}

/* The person may change values with the gate open or closed. */
static const struct exh_authority person = {EXH_FROM_PERSON, 1, 1};

int exh_params_validate(const struct exh_params *p, uint32_t i, int32_t raw)
{
    return exh_params_validate_by(p, person, i, raw);
}

int exh_params_stage(struct exh_params *p, uint16_t id, uint16_t instance, int32_t raw)
{
    const int32_t i = exh_signal_find(p->table, id, instance);
    return i < 0 ? (int)i : exh_params_stage_at(p, (uint32_t)i, raw);
}

int exh_params_stage_by(struct exh_params *p, struct exh_authority who, uint32_t i, int32_t raw)
{
    const int err = exh_params_validate_by(p, who, i, raw);
    if (err < 0) { return err; }
    put(p, p->staged, i, raw);
    p->pending = 1;
    p->by |= (uint8_t)(1u << (who.source & 7u));
    return 0;
}

int exh_params_stage_at(struct exh_params *p, uint32_t i, int32_t raw)
{
    return exh_params_stage_by(p, person, i, raw);
}

int32_t exh_params_slew_step(int32_t now, int32_t goal, unsigned shift)
{
    const uint32_t up = (uint32_t)goal - (uint32_t)now;
    const uint32_t left = goal < now ? 0u - up : up;
    const uint32_t part = (left >> shift) + ((left & ((UINT32_C(1) << shift) - 1)) != 0);
    return exh_from_u32((uint32_t)now + (goal < now ? 0u - part : part));
}

/* One slew step; none for values that another module moves. */
static void slew(struct exh_params *p, const struct exh_signal *row, uint32_t i)
{
    const int falls = row->when == EXH_WHEN_LIMIT && p->staged[i] < p->active[i];
    const unsigned shift = falls ? 0 : p->shift & 31u;
    if (row->id != p->led[0] && row->id != p->led[1]) {
        put(p, p->active, i, exh_params_slew_step(p->active[i], p->staged[i], shift));
    }
    p->moving |= p->active[i] != p->staged[i];
}

/* Applies a value whose two copies differ. all: a value was staged. */
static void apply_value(struct exh_params *p, const struct exh_signal *row, uint32_t i, int all)
{
    if (p->locked && exh_signal_is_slewed(row)) {
        slew(p, row, i);
    } else if (all || exh_signal_is_slewed(row)) {
        put(p, p->active, i, p->staged[i]);
    }
}

void exh_params_set_active(struct exh_params *p, uint32_t i, int32_t raw)
{
    put(p, p->active, i, raw);
    p->moving |= raw != p->staged[i];
}

/* The index of the first value from i whose two copies differ, or end. */
static uint32_t next_other(const struct exh_params *p, uint32_t i, uint32_t end)
{
    const int32_t *const active = p->active, *const staged = p->staged;
    while (i < end && active[i] == staged[i]) { i++; }
    return i;
}

/* Applies values of one group from first on. Few differ, and the others need no work. */
static void apply_group(
    struct exh_params *p, const struct exh_signal_group *g, uint32_t first, int all)
{
    const uint32_t end = first + (uint32_t)g->rows * g->instances;
    for (uint32_t i = next_other(p, first, end); i < end; i = next_other(p, i + 1, end)) {
        while (i - first >= g->rows) { first += g->rows; } /* to the start of its instance */
        apply_value(p, &g->row[i - first], i, all);
    }
}

int exh_params_apply(struct exh_params *p)
{
    const int all = p->pending;
    uint32_t first = 0;
    if (!p->pending && !p->moving) { return 0; }
    p->pending = p->moving = p->by = 0;
    for (uint16_t n = 0; n < p->table->groups; n++) {
        const struct exh_signal_group *g = &p->table->group[n];
        apply_group(p, g, first, all);
        first += (uint32_t)g->rows * g->instances;
    }
    return 1;
}

void exh_params_discard(struct exh_params *p)
{
    for (uint32_t i = 0; i < p->count; i++) { put(p, p->staged, i, p->active[i]); }
    p->pending = p->moving = p->by = 0;
}

void exh_params_rollback(struct exh_params *p, const int32_t *was, uint8_t pending)
{
    for (uint32_t i = 0; i < p->count; i++) { put(p, p->staged, i, was[i]); }
    p->pending = pending;
    if (!pending) { p->by = 0; }
}

/* --- keyframe --- */

/* Reads or writes one value. 1 if a read value is allowed; it is stored only if take is set. */
static int value_bytes(
    struct exh_bytes *c, struct exh_params *p, const struct exh_signal *row, uint32_t i, int take)
{
    const int slewed = exh_signal_is_slewed(row);
    int32_t is = p->active[i], wanted = p->staged[i];
    exh_bytes_i32(c, &is);
    if (slewed) { exh_bytes_i32(c, &wanted); }
    if (c->mode != EXH_BYTES_READ) { return 1; }
    if (!slewed) { wanted = is; }
    if (take) {
        put(p, p->active, i, is);
        put(p, p->staged, i, wanted);
        p->moving |= is != wanted;
    }
    return exh_params_validate(p, i, is) == 0 && exh_params_validate(p, i, wanted) == 0;
}

/* Row by row in the order of the table. Look-ups would take nine tenths of the time. */
static int values_bytes(struct exh_bytes *c, struct exh_params *p, int take)
{
    uint32_t i = 0;
    int ok = 1;
    for (uint16_t n = 0; n < p->table->groups; n++) {
        const struct exh_signal_group *g = &p->table->group[n];
        for (uint16_t k = 0; k < g->instances; k++) {
            for (uint16_t r = 0; r < g->rows; r++) {
                ok &= value_bytes(c, p, &g->row[r], i++, take);
            }
        }
    }
    return ok;
}

void exh_params_serialize(struct exh_bytes *c, struct exh_params *p)
{
    struct exh_bytes ahead = *c;
    const int ok = values_bytes(&ahead, p, 0);
    if (c->mode == EXH_BYTES_READ && (!ok || !exh_bytes_ok(&ahead))) {
        exh_bytes_fail(c);
        return;
    }
    if (c->mode == EXH_BYTES_READ) {
        p->pending = p->moving = p->by = 0;
        (void)values_bytes(c, p, 1);
    }
    *c = ahead;
}

/* --- image --- */

/* The fixed head of an image. */
struct head {
    uint32_t magic, table_crc;
    uint16_t version, count;
};

static void head_bytes(struct exh_bytes *c, struct head *h)
{
    exh_bytes_u32(c, &h->magic);
    exh_bytes_u16(c, &h->version);
    exh_bytes_u16(c, &h->count);
    exh_bytes_u32(c, &h->table_crc);
}

int32_t exh_params_save_by(const struct exh_params *p, uint32_t table_crc, void *buf, size_t cap_B)
{
    struct head h = {IMAGE_MAGIC, table_crc, EXH_PARAMS_VERSION, 0};
    struct exh_bytes c = exh_bytes_writer(buf, cap_B);
    uint32_t crc;
    EXH_ASSERT(p->count <= UINT16_MAX);
    h.count = (uint16_t)p->count;
    head_bytes(&c, &h);
    exh_bytes_i32s(&c, p->staged, h.count);
    crc = exh_bytes_ok(&c) ? exh_crc32(0, buf, c.at) : 0;
    exh_bytes_u32(&c, &crc);
    return exh_bytes_ok(&c) ? (int32_t)c.at : -EXH_E_SHORT;
}

int32_t exh_params_save(const struct exh_params *p, void *buf, size_t cap_B)
{
    return exh_params_save_by(p, exh_signal_crc(p->table), buf, cap_B);
}

/* Checks head, length and CRC: 0, or the error. */
static int whole(const struct exh_params *p, const void *buf, size_t len_B)
{
    const size_t body_B = IMAGE_HEAD_B + 4 * (size_t)p->count;
    struct exh_bytes c = exh_bytes_reader(buf, len_B);
    struct exh_bytes tail;
    struct head h = {0, 0, 0, 0};
    uint32_t crc = 0;

    if (len_B < IMAGE_HEAD_B) { return -EXH_E_SHORT; }
    head_bytes(&c, &h);
    if (h.magic != IMAGE_MAGIC || h.version != EXH_PARAMS_VERSION || h.count != p->count ||
        h.table_crc != exh_signal_crc(p->table)) {
        return -EXH_E_VERSION;
    }
    if (len_B < body_B + IMAGE_CRC_B) { return -EXH_E_SHORT; }
    tail = exh_bytes_reader((const uint8_t *)buf + body_B, IMAGE_CRC_B);
    exh_bytes_u32(&tail, &crc);
    return crc == exh_crc32(0, buf, body_B) ? 0 : -EXH_E_CRC;
}

/* source EXH_FROM_PERSON includes the person's values. Two passes, so that an image is loaded whole
 * or not at all. */
static int load(struct exh_params *p, const void *buf, size_t len_B, uint32_t *bad, uint8_t source)
{
    const struct exh_authority who = {source, 1, 1};
    const int all = source == EXH_FROM_PERSON;
    int err = whole(p, buf, len_B);
    if (err < 0) { return err; }
    for (int pass = 0; pass < 2; pass++) {
        struct exh_bytes c =
            exh_bytes_reader((const uint8_t *)buf + IMAGE_HEAD_B, 4 * (size_t)p->count);
        for (uint32_t i = 0; i < p->count; i++) {
            int32_t v = 0;
            exh_bytes_i32(&c, &v);
            if (!all && exh_signal_at(p->table, i, NULL)->when == EXH_WHEN_PERSON) { continue; }
            err = pass == 0 ? exh_params_validate_by(p, who, i, v) : 0;
            if (err < 0) {
                if (bad != NULL) { *bad = i; }
                return err;
            }
            if (pass == 1) { put(p, p->staged, i, v); }
        }
    }
    p->pending = 1;
    p->by |= (uint8_t)(1u << source);
    return 0;
}

int exh_params_load(struct exh_params *p, const void *buf, size_t len_B, uint32_t *bad)
{
    return load(p, buf, len_B, bad, EXH_FROM_IMAGE);
}

int exh_params_restore(struct exh_params *p, const void *buf, size_t len_B, uint32_t *bad)
{
    return load(p, buf, len_B, bad, EXH_FROM_PERSON);
}
