/* SPDX-License-Identifier: MIT */
/* Records of the log: framing, header and events as bytes. */
#include "exhand/record.h"

#include "exhand/error.h"

#define HEAD_B ((uint32_t)EXH_RECORD_HEAD_B)
#define LEN_AT 4u

void exh_record_begin(struct exh_bytes *c, uint8_t type, uint32_t seq, uint32_t tick)
{
    uint16_t sync = EXH_RECORD_SYNC;
    uint16_t len = 0; /* exh_record_end() knows it */
    uint8_t version = EXH_RECORD_VERSION;
    c->at = 0;
    exh_bytes_u16(c, &sync);
    exh_bytes_u8(c, &type);
    exh_bytes_u8(c, &version);
    exh_bytes_u16(c, &len);
    exh_bytes_u32(c, &seq);
    exh_bytes_u32(c, &tick);
}

uint32_t exh_record_end(struct exh_bytes *c)
{
    const uint32_t end = c->at;
    uint16_t len;
    uint32_t crc;
    if (!exh_bytes_ok(c) || end < HEAD_B || end - HEAD_B > UINT16_MAX) { return 0; }
    len = (uint16_t)(end - HEAD_B);
    c->at = LEN_AT;
    exh_bytes_u16(c, &len);
    c->at = end;
    crc = c->mode == EXH_BYTES_WRITE ? exh_crc32(0, c->p, end) : 0;
    exh_bytes_u32(c, &crc);
    return exh_bytes_ok(c) ? c->at : 0;
}

int32_t exh_record_decode(const void *buf, uint32_t len_B, struct exh_record *r)
{
    const uint8_t *p = (const uint8_t *)buf;
    struct exh_bytes c = exh_bytes_reader(buf, len_B);
    struct exh_bytes tail;
    uint16_t sync = 0;
    uint32_t crc = 0;
    uint32_t end;

    exh_bytes_u16(&c, &sync);
    if (!exh_bytes_ok(&c)) { return -EXH_E_SHORT; }
    if (sync != EXH_RECORD_SYNC) { return -EXH_E_UNKNOWN; }
    exh_bytes_u8(&c, &r->type);
    exh_bytes_u8(&c, &r->version);
    exh_bytes_u16(&c, &r->len_B);
    exh_bytes_u32(&c, &r->seq);
    exh_bytes_u32(&c, &r->tick);
    end = HEAD_B + r->len_B;
    if (!exh_bytes_ok(&c) || len_B < end + 4) { return -EXH_E_SHORT; }
    tail = exh_bytes_reader(p + end, 4);
    exh_bytes_u32(&tail, &crc);
    if (crc != exh_crc32(0, p, end)) { return -EXH_E_CRC; }
    if (r->version != EXH_RECORD_VERSION) { return -EXH_E_VERSION; }
    r->payload = p + HEAD_B;
    return (int32_t)(end + 4);
}

static void text_bytes(struct exh_bytes *c, char text[16])
{
    for (int i = 0; i < 16; i++) {
        uint8_t u = (uint8_t)text[i];
        exh_bytes_u8(c, &u);
        text[i] =
            (char)(u < 0x80u ? (int)u
                             : (int)u - 0x100); /* fits a signed char, wraps in an unsigned one */
    }
}

void exh_record_header_serialize(struct exh_bytes *c, struct exh_record_header *h)
{
    text_bytes(c, h->scene);
    text_bytes(c, h->board);
    exh_bytes_u32(c, &h->lib_version);
    exh_bytes_u32(c, &h->signal_crc);
    exh_bytes_u32(c, &h->T.num);
    exh_bytes_u32(c, &h->T.den);
    exh_bytes_u16(c, &h->fingers);
    exh_bytes_u16(c, &h->enc_bits);
    exh_bytes_u16(c, &h->signals);
}

void exh_event_serialize(struct exh_bytes *c, struct exh_event *e)
{
    exh_bytes_u16(c, &e->type);
    exh_bytes_u16(c, &e->id);
    exh_bytes_u16(c, &e->instance);
    exh_bytes_i32(c, &e->value);
    exh_bytes_u16(c, &e->source);
}
