#include "exhand/bytes.h"

#include "exhand/fix.h"

/* A cursor counts to UINT32_MAX, which must stay beyond every cap. */
static uint32_t capacity(size_t B)
{
    return B < UINT32_MAX ? (uint32_t)B : UINT32_MAX - 1;
}

struct exh_bytes exh_bytes_writer(void *buf, size_t cap_B)
{
    const struct exh_bytes c = {buf, capacity(cap_B), 0, EXH_BYTES_WRITE};
    return c;
}

struct exh_bytes exh_bytes_reader(const void *buf, size_t len_B)
{
    /* The cursor has one pointer for both directions; a reader only reads. */
    union {
        const void *in;
        uint8_t *p;
    } u;
    struct exh_bytes c = {NULL, capacity(len_B), 0, EXH_BYTES_READ};
    u.in = buf;
    c.p = u.p;
    return c;
}

struct exh_bytes exh_bytes_measure(void)
{
    const struct exh_bytes c = {NULL, 0, 0, EXH_BYTES_MEASURE};
    return c;
}

/* n bytes of v, least significant first, out of or into the buffer. */
static uint64_t move(struct exh_bytes *c, uint64_t v, uint32_t n)
{
    const int fits = c->at <= c->cap && n <= c->cap - c->at;
    uint64_t r = 0;
    if (c->mode == EXH_BYTES_READ) {
        for (uint32_t i = 0; fits && i < n; i++) { r |= (uint64_t)c->p[c->at + i] << (8 * i); }
    } else {
        r = v;
        for (uint32_t i = 0; c->mode == EXH_BYTES_WRITE && fits && i < n; i++) {
            c->p[c->at + i] = (uint8_t)(v >> (8 * i) & 0xFF);
        }
    }
    /* Counting past cap tells the size needed; saturate instead of wrapping. */
    c->at = c->at > UINT32_MAX - n ? UINT32_MAX : c->at + n;
    return r;
}

void exh_bytes_u8(struct exh_bytes *c, uint8_t *v)
{
    *v = (uint8_t)move(c, *v, 1);
}

void exh_bytes_u16(struct exh_bytes *c, uint16_t *v)
{
    *v = (uint16_t)move(c, *v, 2);
}

void exh_bytes_i16(struct exh_bytes *c, int16_t *v)
{
    const uint32_t u = (uint32_t)move(c, (uint16_t)*v, 2);
    *v = (int16_t)(u < 0x8000u ? (int32_t)u : (int32_t)u - 0x10000);
}

void exh_bytes_u32(struct exh_bytes *c, uint32_t *v)
{
    *v = (uint32_t)move(c, *v, 4);
}

void exh_bytes_i32(struct exh_bytes *c, int32_t *v)
{
    *v = exh_from_u32((uint32_t)move(c, (uint32_t)*v, 4));
}

void exh_bytes_i64(struct exh_bytes *c, int64_t *v)
{
    const uint64_t u = move(c, (uint64_t)*v, 8);
    *v = u <= INT64_MAX ? (int64_t)u : -(int64_t)(UINT64_MAX - u) - 1;
}

uint32_t exh_crc32(uint32_t crc, const void *buf, size_t len_B)
{
    /* Two 4-bit steps a byte: 64 bytes of table instead of 1 KiB. */
    static const uint32_t nibble[16] = {
        0x00000000u, 0x1DB71064u, 0x3B6E20C8u, 0x26D930ACu, 0x76DC4190u, 0x6B6B51F4u,
        0x4DB26158u, 0x5005713Cu, 0xEDB88320u, 0xF00F9344u, 0xD6D6A3E8u, 0xCB61B38Cu,
        0x9B64C2B0u, 0x86D3D2D4u, 0xA00AE278u, 0xBDBDF21Cu};
    const uint8_t *p = buf;
    crc = ~crc;
    for (size_t i = 0; i < len_B; i++) {
        crc ^= p[i];
        crc = crc >> 4 ^ nibble[crc & 15];
        crc = crc >> 4 ^ nibble[crc & 15];
    }
    return ~crc;
}
