/* SPDX-License-Identifier: MIT */
/* PROVES: bytes
 * Any field through a cursor of any mode, invalid modes included, at any place of any buffer.
 * Nothing outside the buffer is touched, and no value is lost. Cursors of a buffer of any size;
 * CRC of any bytes.
 *
 * EVA: -eva-slevel 200
 * PLANT: lib/src/num/bytes.c: at <= c->cap && n <= c->cap - at -> n <= c->cap - at
 * PLANT: lib/src/num/bytes.c: at <= c->cap && n <= c->cap - at -> at <= c->cap
 * PLANT: lib/src/num/crc.c: for (; len_B >= 4; -> for (; len_B >= 3;
 * PLANT: lib/src/num/bytes.c: (int32_t)u - 0x10000 -> (int32_t)u
 * PLANT: lib/src/num/crc.c: nibble[16] -> nibble[15]
 * PLANT: lib/src/num/bytes.c: (uint32_t)B : UINT32_MAX - 1 -> (uint32_t)B : UINT32_MAX
 */
#include "num/bytes.c"
#include "num/crc.c"

#include "any.h"

#define MOST_B 9

static uint8_t buf[MOST_B];

static void field(unsigned kind, struct exh_bytes *c)
{
    uint8_t u8 = any8();
    uint16_t u16 = (uint16_t)any_u32();
    int16_t i16 = (int16_t)Frama_C_interval(INT16_MIN, INT16_MAX);
    uint32_t u32 = any_u32();
    int32_t i32 = any32();
    int64_t i64 = any64();
    int32_t i32s[2] = {any32(), any32()};
    struct exh_vec3 v = {any32(), any32(), any32()};
    c->at = any_u32();
    switch (kind) {
    case 0: exh_bytes_u8(c, &u8); break;
    case 1: exh_bytes_u16(c, &u16); break;
    case 2: exh_bytes_i16(c, &i16); break;
    case 3: exh_bytes_u32(c, &u32); break;
    case 4: exh_bytes_i32(c, &i32); break;
    case 5: exh_bytes_i64(c, &i64); break;
    case 6: exh_bytes_i32s(c, i32s, 2); break;
    default: exh_bytes_vec3(c, &v); break;
    }
    (void)exh_bytes_ok(c);
}

/* The end of the buffer is the end of buf. */
static void cursor(unsigned kind, uint32_t size_B)
{
    struct exh_bytes c = exh_bytes_writer(buf + MOST_B - size_B, size_B);
    field(kind, &c);
    c = exh_bytes_reader(buf + MOST_B - size_B, size_B);
    field(kind, &c);
    c.mode = any8();
    field(kind, &c);
    c = exh_bytes_measure();
    field(kind, &c);
}

int main(void)
{
    struct exh_bytes c = exh_bytes_writer(buf, any_u32());
    /*@ assert a_writer_ends: c.cap < 0xFFFFFFFF; */
    c = exh_bytes_reader(buf, any_u32());
    /*@ assert a_reader_ends: c.cap < 0xFFFFFFFF; */
    ANY(buf);
    for (unsigned kind = 0; kind < 8; kind++) {
        for (uint32_t B = 0; B <= MOST_B; B++) { cursor(kind, B); }
    }
    ANY(buf);
    for (uint32_t B = 0; B <= sizeof buf; B++) {
        (void)exh_crc32(any_u32(), buf + sizeof buf - B, B);
    }
    END();
    return 0;
}
