/* SPDX-License-Identifier: MIT */
/* PROVES: ring of records
 * Set-up of any size. Memory of the least size and of a size that is no power of two, in any state
 * that a put leaves. A put of one or two records of any type and of some lengths, the longest that
 * fits and one more included. Reads from the oldest or from any place, with any memory content, in
 * pieces of any size.
 *
 * EVA: -eva-slevel 100 -eva-slevel-function main:3000
 * PLANT: lib/src/talk/ring.c: return at < SLOTS ? at : at - SLOTS; -> return at;
 * PLANT: lib/src/talk/ring.c: const uint32_t first = least(n, r->cap_B - at); -> const uint32_t first = n;
 * PLANT: lib/src/talk/ring.c: copy_in(r, at, (const uint8_t *)payload, len_B); -> at + len_B;
 * PLANT: lib/src/talk/ring.c: if (begins && parts(r) == SLOTS) { drop_oldest(r); } -> (void)0;
 * PLANT: lib/src/talk/ring.c: payload.at = payload.at + 1 < r->cap_B ? payload.at + 1 : 0; -> payload.at = payload.at + 1;
 * PLANT: lib/src/talk/ring.c: if (payload.len_B > p->left_B - EXH_RING_HEAD_B) { return 0; } -> (void)0;
 * PLANT: lib/src/talk/ring.c: n = least(n, o->cap_B - o->at); -> (void)o;
 */
#include <stddef.h>
#include <stdint.h>
#include "__fc_builtin.h"
#include <string.h> /* the contract of memcpy */
#define volatile    /* for interrupted readers; the ring has one writer */
#include "num/bytes.c"
#define exh_crc32 crc32 /* its proof is any_bytes.c */
static uint32_t crc32(uint32_t crc, const void *buf, size_t len_B)
{
    const uint8_t *p = buf;
    return len_B > 0 ? crc ^ p[0] ^ p[len_B - 1] : crc;
}
#include "talk/record.c"
#include "talk/ring.c"
#undef volatile

#include "any.h"

#define MAX_B      90
#define ROOM_MAX_B 30

static uint8_t mem[MAX_B], payload[MAX_B];
static struct exh_ring r;
static struct exh_record_out o;

static void any_ring(uint32_t cap_B, uint32_t head, uint32_t oldest_n, uint32_t parts_n)
{
    (void)exh_ring_setup(&r, mem + (MAX_B - cap_B), cap_B);
    ANY(mem);
    for (unsigned i = 0; i < SLOTS; i++) {
        r.start[i] = Frama_C_unsigned_int_interval(0, cap_B - 1);
    }
    r.live = oldest_n << 8 | parts_n;
    r.head = head;
    r.lost = any_u32();
}

static void left(void)
{
    /*@ assert oldest: r.live >> 8 < 10; */
    /*@ assert parts: (r.live & 255) <= 10; */
    /*@ assert head: r.head < r.cap_B; */
}

static void put(uint32_t cap_B, uint32_t head, uint32_t oldest_n, uint32_t parts_n, uint32_t len_B)
{
    int done;
    any_ring(cap_B, head, oldest_n, parts_n);
    (void)exh_ring_due(&r);
    ANY(payload);
    done =
        exh_ring_put(&r, any8(), any_u32(), len_B > 0 ? payload + (MAX_B - len_B) : payload, len_B);
    /*@ assert told: done == 0 || done == 1; */
    left();
}

/* What is left to read is one number: that a record of it leaves no less than nothing is its difference. */
static void reads(uint32_t left_B)
{
    struct exh_ring_place p;
    any_ring(EXH_RING_MIN_B, 0, 9, 1);
    p = exh_ring_first(&r);
    p.at = Frama_C_unsigned_int_interval(0, EXH_RING_MIN_B - 1);
    p.left_B = left_B;
    if (exh_ring_next(&r, &p, any_u32(), &o)) {
        /*@ assert place: p.at < r.cap_B && p.left_B < r.cap_B; */
        /*@ assert within: o.at < o.cap_B && o.len_B <= o.cap_B; */
    }
}

/* Into the end of an array, done_B bytes after it began with a payload at `at`. */
static void goes_out(struct exh_record_place from, uint32_t done_B, uint32_t room_B)
{
    static uint8_t to[ROOM_MAX_B];
    uint32_t n;
    exh_record_out_begin(&o, any8(), any_u32(), any_u32(), from);
    o.done_B = done_B;
    o.crc = any_u32();
    n = exh_record_out(&o, to + (ROOM_MAX_B - room_B), room_B);
    /*@ assert room: n <= room_B; */
    /*@ assert whole: n == room_B || o.done_B == 18 + (uint32_t)from.len_B || n == 0; */
    /*@ assert where: o.at < o.cap_B; */
}

static void pieces(uint16_t len_B, uint32_t room_B)
{
    static const uint32_t at[] = {0, 50, 63};
    const uint32_t done_B[] = {0, 13, 14, 13u + len_B, 17u + len_B, 18u + len_B};
    for (unsigned i = 0; i < sizeof at / sizeof at[0]; i++) {
        const struct exh_record_place from = {
            mem + (MAX_B - EXH_RING_MIN_B), EXH_RING_MIN_B, at[i], len_B};
        for (unsigned k = 0; k < sizeof done_B / sizeof done_B[0]; k++) {
            goes_out(from, done_B[k], room_B);
        }
    }
}

int main(void)
{
    static const uint32_t len_B[] = {0, 20, 56}, head[] = {0, 50, 63};
    (void)exh_ring_setup(&r, mem, any_u32());
    for (unsigned h = 0; h < sizeof head / sizeof head[0]; h++) {
        for (uint32_t n = 0; n <= SLOTS; n += n == 1 ? 8 : 1) {
            for (unsigned k = 0; k < sizeof len_B / sizeof len_B[0]; k++) {
                put(EXH_RING_MIN_B, head[h], n == 9 ? 9 : 4, n, len_B[k]);
            }
        }
    }
    put(MAX_B, 89, 3, 9, 57);
    put(EXH_RING_MIN_B, 3, 3, 9, 57);
    put(EXH_RING_MIN_B, 3, 3, 9, MAX_B);
    for (uint32_t left_B = 0; left_B < EXH_RING_MIN_B; left_B += 14) { reads(left_B); }
    pieces(1, 3);
    pieces(20, ROOM_MAX_B);
    pieces(64, 17);
    END();
    return 0;
}
