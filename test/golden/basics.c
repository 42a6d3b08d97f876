/* SPDX-License-Identifier: MIT */
/* fix, bytes, mac and record: below everything else. */
#include "modules.h"

#include "exhand/fix.h"
#include "exhand/mac.h"
#include "exhand/record.h"

static int32_t any_i32(struct golden_rng *r)
{
    return exh_from_u32((uint32_t)((uint64_t)golden_corner(r) & UINT32_MAX));
}

static int64_t as_i64(uint64_t u)
{
    return u <= INT64_MAX ? (int64_t)u : -(int64_t)(UINT64_MAX - u) - 1;
}

/* Mostly about as long or as short as they may be. */
static struct exh_period any_period(struct golden_rng *r)
{
    const int64_t most = UINT32_MAX;
    int64_t den = golden_draw(r, 1, most);
    int64_t near[3];
    int64_t num;
    den >>= golden_draw(r, 0, 31);
    near[0] = den * 1001 / 1000;
    near[1] = den / 20020;
    near[2] = golden_draw(r, 0, most);
    num = near[golden_draw(r, 0, 2)];
    num += golden_draw(r, -1, 1);
    num = num < 0 ? 0 : num > most ? most : num;
    return (struct exh_period){(uint32_t)num, (uint32_t)den};
}

static void put_gain(struct golden *g, uint64_t num, uint64_t den, int32_t x)
{
    struct exh_gain gain = {0, 0};
    uint64_t rest = 0;
    const int err = exh_gain_set(&gain, num, den);
    if (err != 0) { gain = (struct exh_gain){0, 0}; }
    golden_put(g, err);
    golden_put(g, gain.mant);
    golden_put(g, gain.shift);
    golden_put(g, exh_gain_mul(gain, x));
    golden_put(g, as_i64(exh_udiv64(num, den, &rest)));
    golden_put(g, as_i64(rest));
}

void golden_fix(struct golden *g, uint32_t rate_Hz)
{
    struct golden_rng r = golden_rng("fix", rate_Hz, 0);
    while (g->tick < GOLDEN_TICKS) {
        const int64_t v = golden_corner(&r);
        const int32_t a = any_i32(&r);
        const int32_t b = any_i32(&r);
        const int32_t lo = any_i32(&r);
        const int32_t hi = (int32_t)golden_draw(&r, lo, INT32_MAX);
        const unsigned n = (unsigned)golden_draw(&r, 1, 62);
        uint64_t num = golden_u64(&r);
        uint64_t den;
        num >>= golden_draw(&r, 0, 63);
        den = golden_u64(&r);
        den = den >> golden_draw(&r, 0, 63) | 1;
        const struct exh_period T = any_period(&r);
        golden_put(g, v);
        golden_put(g, a);
        golden_put(g, b);
        golden_put(g, T.num);
        golden_put(g, T.den);
        golden_put(g, exh_sat32(v));
        golden_put(g, exh_clamp(v, lo, hi));
        golden_put(g, exh_shr_round(v, n));
        golden_put(g, exh_mul_shr(a, b, n));
        golden_put(g, exh_mul64_q31(v, b & INT32_MAX));
        golden_put(g, exh_from_u32((uint32_t)b));
        golden_put(g, exh_wrap_diff(a, b));
        golden_put(g, exh_wrap_add(a, b));
        put_gain(g, num, den, a);
        golden_put(g, exh_period_ok(T));
        golden_tick(g);
    }
}

/* --- bytes --- */

#define ROOM_B 26

static struct fields {
    uint8_t u8;
    uint16_t u16;
    int16_t i16;
    uint32_t u32;
    int32_t i32;
    int64_t i64;
} any_fields(struct golden_rng *r)
{
    struct fields f;
    f.u8 = (uint8_t)((uint64_t)golden_corner(r) & UINT8_MAX);
    f.u16 = (uint16_t)((uint64_t)golden_corner(r) & UINT16_MAX);
    f.i16 = (int16_t)(exh_from_u32((uint32_t)any_i32(r) << 16) >> 16);
    f.u32 = (uint32_t)((uint64_t)golden_corner(r) & UINT32_MAX);
    f.i32 = any_i32(r);
    f.i64 = golden_corner(r);
    return f;
}

static void list(struct exh_bytes *c, struct fields *f)
{
    exh_bytes_u8(c, &f->u8);
    exh_bytes_u16(c, &f->u16);
    exh_bytes_i16(c, &f->i16);
    exh_bytes_u32(c, &f->u32);
    exh_bytes_i32(c, &f->i32);
    exh_bytes_i64(c, &f->i64);
}

void golden_bytes(struct golden *g, uint32_t rate_Hz)
{
    struct golden_rng r = golden_rng("bytes", rate_Hz, 0);
    uint32_t crc = 0;
    while (g->tick < GOLDEN_TICKS) {
        const uint32_t cap = (uint32_t)golden_draw(&r, 0, ROOM_B);
        struct fields f = any_fields(&r);
        uint8_t room[ROOM_B];
        struct exh_bytes c = exh_bytes_writer(room, cap);
        (void)memset(room, 0xA5, sizeof room);
        list(&c, &f);
        crc = exh_crc32(crc, room, sizeof room);
        golden_put(g, cap);
        golden_put(g, c.at);
        golden_put(g, exh_bytes_ok(&c));
        golden_put(g, crc);
        c = exh_bytes_reader(room, cap);
        list(&c, &f);
        golden_put(g, f.u8);
        golden_put(g, f.u16);
        golden_put(g, f.i16);
        golden_put(g, f.u32);
        golden_put(g, f.i32);
        golden_put(g, f.i64);
        golden_tick(g);
    }
}

/* --- mac --- */

#define TEXT_B    32
#define PUBLISHED 64u /* ticks: tags of the paper's key and texts, of so many bytes */

static void put_word(uint8_t *to, uint64_t v)
{
    for (unsigned i = 0; i < 8; i++) { to[i] = (uint8_t)(v >> 8 * i & UINT8_MAX); }
}

void golden_mac(struct golden *g, uint32_t rate_Hz)
{
    struct golden_rng r = golden_rng("mac", rate_Hz, 0);
    while (g->tick < GOLDEN_TICKS) {
        const int any = g->tick >= PUBLISHED;
        const uint32_t n = any ? (uint32_t)golden_draw(&r, 0, TEXT_B) : g->tick;
        uint8_t byte[EXH_MAC_KEY_B], text[PUBLISHED];
        struct exh_mac_key key;
        for (unsigned i = 0; i < PUBLISHED; i++) { text[i] = (uint8_t)i; }
        (void)memcpy(byte, text, sizeof byte);
        for (unsigned i = 0; any && i < sizeof byte; i += 8) { put_word(byte + i, golden_u64(&r)); }
        for (unsigned i = 0; any && i < TEXT_B; i += 8) { put_word(text + i, golden_u64(&r)); }
        key = exh_mac_key(byte);
        golden_put(g, n);
        golden_put(g, as_i64(exh_mac(&key, text, n)));
        golden_tick(g);
    }
}

/* --- record --- */

#define PAYLOAD_B 40

/* Writes a record; its size, 0 if it did not fit. */
static uint32_t write(uint8_t *buf, uint32_t cap, uint8_t type, uint32_t seq, uint32_t tick,
    uint8_t *payload, uint32_t n)
{
    struct exh_bytes c = exh_bytes_writer(buf, cap);
    exh_record_begin(&c, type, seq, tick);
    for (uint32_t i = 0; i < n; i++) { exh_bytes_u8(&c, &payload[i]); }
    return exh_record_end(&c);
}

/* Another version with a CRC that is right. */
static void other_version(uint8_t *buf, uint32_t size)
{
    struct exh_bytes c = exh_bytes_writer(buf + size - 4, 4);
    uint32_t crc;
    buf[3] = EXH_RECORD_VERSION + 1;
    crc = exh_crc32(0, buf, size - 4);
    exh_bytes_u32(&c, &crc);
}

static void put_read(struct golden *g, const uint8_t *buf, uint32_t len)
{
    struct exh_record rec;
    const int32_t got = exh_record_decode(buf, len, &rec);
    if (got < 0) { (void)memset(&rec, 0, sizeof rec); }
    golden_put(g, got);
    golden_put(g, rec.type);
    golden_put(g, rec.version);
    golden_put(g, rec.len_B);
    golden_put(g, rec.seq);
    golden_put(g, rec.tick);
}

void golden_record(struct golden *g, uint32_t rate_Hz)
{
    struct golden_rng r = golden_rng("record", rate_Hz, 0);
    while (g->tick < GOLDEN_TICKS) {
        const uint8_t type = (uint8_t)golden_draw(&r, 0, 255);
        const uint32_t seq = (uint32_t)(golden_u64(&r) & UINT32_MAX);
        const uint32_t n = (uint32_t)golden_draw(&r, 0, PAYLOAD_B);
        const uint32_t whole = n + EXH_RECORD_OVERHEAD;
        const uint32_t cap = golden_draw(&r, 0, 7) == 0 ? (uint32_t)golden_draw(&r, 0, 63) : 64;
        uint8_t payload[PAYLOAD_B];
        uint8_t buf[64];
        uint32_t size;
        uint32_t how;
        uint32_t where;
        uint32_t len = whole;
        for (uint32_t i = 0; i < n; i++) { payload[i] = (uint8_t)golden_draw(&r, 0, 255); }
        size = write(buf, cap, type, seq, g->tick, payload, n);
        golden_put(g, size);
        /* Over all but the last byte: over a whole record the CRC is the same for all. */
        golden_put(g, size > 0 ? exh_crc32(0, buf, size - 1) : 0);
        how = (uint32_t)golden_draw(&r, 0, 3);
        where = (uint32_t)golden_draw(&r, 0, 8 * (int64_t)whole - 1);
        (void)write(buf, sizeof buf, type, seq, g->tick, payload, n);
        if (golden_draw(&r, 0, 9) == 0) { other_version(buf, whole); }
        if (how & 1) {
            const uint32_t at = how == 1 ? where : where & 15;
            buf[at >> 3] ^= (uint8_t)(UINT32_C(1) << (at & 7));
        }
        if (how & 2) { len = where >> 3; }
        golden_put(g, how);
        golden_put(g, len);
        put_read(g, buf, len);
        golden_tick(g);
    }
}
