/* SPDX-License-Identifier: MIT */
/* ring: the newest records in memory of the caller's, and out of it in pieces. */
#include "modules.h"

#include "exhand/record.h"
#include "exhand/ring.h"

#define MOST_B  512u
#define ROOM_B  (65536u + EXH_RECORD_OVERHEAD)
#define TABLE_B (MOST_B + 256u)

struct box {
    struct exh_ring ring;
    uint8_t mem[MOST_B + 64u];
    uint32_t cap_B;
    uint8_t table[TABLE_B]; /* what payloads are cut from */
};

/* What set-up says of the first size, which may be too small. */
static int any_ring(struct box *b, struct golden_rng *r)
{
    int err;
    const int64_t small = golden_draw(r, 63, 64);
    const int64_t any = golden_draw(r, 64, 64 << golden_draw(r, 0, 3));
    b->cap_B = (uint32_t)(golden_draw(r, 0, 1) == 0 ? small : any);
    (void)memset(b->mem, 0, sizeof b->mem);
    err = exh_ring_setup(&b->ring, b->mem, b->cap_B);
    if (err != 0) {
        b->cap_B += 64;
        CHECK_EQ_I64(exh_ring_setup(&b->ring, b->mem, b->cap_B), 0);
    }
    for (uint32_t i = 0; i < TABLE_B; i++) { b->table[i] = (uint8_t)(37 * i); }
    return err;
}

/* A keyframe mostly where one is due; lengths up to what never fits, or to the end of memory. */
static void any_put(struct golden *g, struct box *b, struct golden_rng *r)
{
    const int due = exh_ring_due(&b->ring);
    const int64_t any = golden_draw(r, 1, 7);
    const int key = golden_draw(r, 0, 3) != 0;
    const int64_t how = golden_draw(r, 0, 23);
    const int64_t some = golden_draw(r, 0, b->cap_B >> golden_draw(r, 2, 5));
    const int64_t near = (int64_t)b->cap_B - golden_draw(r, 5, 9);
    const int64_t half = golden_draw(r, b->cap_B >> 1, b->cap_B - 8);
    const int64_t far = golden_draw(r, 65530, 65540);
    const int64_t left = (int64_t)b->cap_B - b->ring.head - (int64_t)EXH_RING_HEAD_B;
    const int64_t len_B = how == 0               ? near
                          : how == 1             ? far
                          : how == 2             ? half
                          : how < 6 && left >= 0 ? left
                                                 : some;
    const uint32_t len = (uint32_t)len_B;
    const uint32_t tick = (uint32_t)(golden_u64(r) & UINT32_MAX);
    const uint8_t *from = b->table + golden_draw(r, 0, 255);
    const uint8_t type = due && key ? EXH_RECORD_KEYFRAME : (uint8_t)any;
    golden_put(g, type);
    golden_put(g, len);
    golden_put(g, due);
    golden_put(g, exh_ring_put(&b->ring, type, tick, from, len));
    golden_put(g, b->ring.lost);
}

static uint32_t read_out(struct exh_record_out *o, uint8_t *to, uint32_t piece_B)
{
    uint32_t n = 0;
    uint32_t k;
    while ((k = exh_record_out(o, to + n, n + piece_B < ROOM_B ? piece_B : ROOM_B - n)) > 0) {
        n += k;
    }
    return n;
}

/* All of it, with a bit of memory damaged now and then. The CRC of a whole record with its own is
 * the same for all of a length, so the last byte is left out of it. */
static void put_read(struct golden *g, struct box *b, struct golden_rng *r)
{
    static uint8_t room[ROOM_B];
    const int damaged = golden_draw(r, 0, 3) == 0;
    const int64_t bit = golden_draw(r, 0, 8 * (int64_t)b->cap_B - 1);
    const uint32_t piece_B = (uint32_t)golden_draw(r, 1, 40);
    uint32_t seq = (uint32_t)(golden_u64(r) & UINT32_MAX);
    const uint8_t flip = (uint8_t)(damaged << (bit & 7));
    struct exh_ring_place p = exh_ring_first(&b->ring);
    struct exh_record_out o;
    uint32_t records = 0, crc = 0;
    int64_t sum = 0;
    golden_put(g, p.left_B);
    golden_put(g, p.left_B > 0 ? p.at : 0);
    b->mem[bit >> 3] ^= flip;
    while (exh_ring_next(&b->ring, &p, seq++, &o)) {
        const uint32_t n = read_out(&o, room, piece_B);
        crc = exh_crc32(crc, room, n - 1);
        for (uint32_t i = 0; i < n; i++) { sum += room[i]; }
        records++;
    }
    b->mem[bit >> 3] ^= flip;
    golden_put(g, records);
    golden_put(g, crc);
    golden_put(g, sum);
}

static void memory_bytes(struct exh_bytes *c, struct box *b)
{
    for (uint32_t i = 0; i < b->cap_B; i++) { exh_bytes_u8(c, &b->mem[i]); }
}

void golden_ring(struct golden *g, uint32_t rate_Hz)
{
    static struct box b;
    struct golden_rng r = golden_rng("ring", rate_Hz, 0);
    while (g->tick < GOLDEN_TICKS) {
        struct exh_bytes c;
        int err = 0;
        if (g->tick % 32 == 0) { err = any_ring(&b, &r); }
        golden_put(g, err);
        golden_put(g, b.cap_B);
        any_put(g, &b, &r);
        if (golden_draw(&r, 0, 3) == 0) {
            put_read(g, &b, &r);
        } else {
            for (unsigned i = 0; i < 5; i++) { golden_put(g, 0); }
        }
        c = golden_state(g);
        memory_bytes(&c, &b);
        golden_state_end(g, &c);
        golden_tick(g);
    }
}
