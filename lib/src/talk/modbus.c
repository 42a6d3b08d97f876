/* SPDX-License-Identifier: MIT */
/* One request in, one response out. Checks in the order of the specification: function, counts and
 * lengths, addresses, values. */
#include "exhand/modbus.h"

#include "exhand/error.h"
#include "exhand/exhand.h"

#define READ_BITS  2000u
#define WRITE_BITS 1968u
#define READ_REGS  125u
#define WRITE_REGS 123u
#define BOTH_REGS  121u /* most registers that function 23 writes */

struct request {
    const uint8_t *p; /* starts with the function code */
    uint32_t len_B;
};

static uint16_t be16(const struct request *q, uint32_t at)
{
    return (uint16_t)((uint32_t)q->p[at] << 8 | q->p[at + 1]);
}

/* Each of the next functions returns the bytes of its response, or minus an exception. */

static int read_bits(const struct exh_regs *r, const struct request *q, uint8_t *resp)
{
    const enum exh_regs_kind kind = q->p[0] == 1 ? EXH_REGS_COIL : EXH_REGS_DISCRETE;
    uint32_t n, bytes;
    int err;
    if (q->len_B != 5) { return -EXH_MODBUS_VALUE; }
    n = be16(q, 3);
    if (n < 1 || n > READ_BITS) { return -EXH_MODBUS_VALUE; }
    bytes = (n + 7) >> 3;
    err = exh_regs_read_bits(r, kind, be16(q, 1), (uint16_t)n, &resp[2]);
    resp[1] = (uint8_t)bytes;
    return err != 0 ? -err : (int)(2 + bytes);
}

static int read_regs(const struct exh_regs *r, const struct request *q, uint8_t *resp)
{
    const enum exh_regs_kind kind = q->p[0] == 3 ? EXH_REGS_HOLDING : EXH_REGS_INPUT;
    uint32_t n;
    int err;
    if (q->len_B != 5) { return -EXH_MODBUS_VALUE; }
    n = be16(q, 3);
    if (n < 1 || n > READ_REGS) { return -EXH_MODBUS_VALUE; }
    err = exh_regs_read(r, kind, be16(q, 1), (uint16_t)n, &resp[2]);
    resp[1] = (uint8_t)(2 * n);
    return err != 0 ? -err : (int)(2 + 2 * n);
}

/* A response that repeats the first n bytes of the request. */
static int echo(const struct request *q, uint32_t n, uint8_t *resp)
{
    for (uint32_t i = 1; i < n; i++) { resp[i] = q->p[i]; }
    return (int)n;
}

static int write_coil(struct exh_regs *r, const struct request *q, uint8_t *resp)
{
    uint8_t bit;
    int err;
    if (q->len_B != 5 || (be16(q, 3) != 0 && be16(q, 3) != 0xFF00u)) { return -EXH_MODBUS_VALUE; }
    bit = q->p[3] & 1u;
    err = exh_regs_write_bits(r, be16(q, 1), 1, &bit);
    return err != 0 ? -err : echo(q, 5, resp);
}

static int write_reg(struct exh_regs *r, const struct request *q, uint8_t *resp)
{
    int err;
    if (q->len_B != 5) { return -EXH_MODBUS_VALUE; }
    err = exh_regs_write(r, be16(q, 1), 1, &q->p[3]);
    return err != 0 ? -err : echo(q, 5, resp);
}

static int write_coils(struct exh_regs *r, const struct request *q, uint8_t *resp)
{
    uint32_t n;
    int err;
    if (q->len_B < 6) { return -EXH_MODBUS_VALUE; }
    n = be16(q, 3);
    if (n < 1 || n > WRITE_BITS || q->p[5] != (n + 7) >> 3 || q->len_B != 6u + q->p[5]) {
        return -EXH_MODBUS_VALUE;
    }
    err = exh_regs_write_bits(r, be16(q, 1), (uint16_t)n, &q->p[6]);
    return err != 0 ? -err : echo(q, 5, resp);
}

static int write_regs(struct exh_regs *r, const struct request *q, uint8_t *resp)
{
    uint32_t n;
    int err;
    if (q->len_B < 6) { return -EXH_MODBUS_VALUE; }
    n = be16(q, 3);
    if (n < 1 || n > WRITE_REGS || q->p[5] != 2 * n || q->len_B != 6u + q->p[5]) {
        return -EXH_MODBUS_VALUE;
    }
    err = exh_regs_write(r, be16(q, 1), (uint16_t)n, &q->p[6]);
    return err != 0 ? -err : echo(q, 5, resp);
}

/* (present and AND mask) or (OR mask and not AND mask), function 22. */
static int mask_reg(struct exh_regs *r, const struct request *q, uint8_t *resp)
{
    uint8_t now[2];
    int err;
    if (q->len_B != 7) { return -EXH_MODBUS_VALUE; }
    err = exh_regs_read(r, EXH_REGS_HOLDING, be16(q, 1), 1, now);
    if (err != 0) { return -err; }
    for (uint32_t i = 0; i < 2; i++) {
        now[i] = (uint8_t)((now[i] & q->p[3 + i]) | (q->p[5 + i] & ~(uint32_t)q->p[3 + i] & 0xFFu));
    }
    err = exh_regs_write(r, be16(q, 1), 1, now);
    return err != 0 ? -err : echo(q, 7, resp);
}

/* Writes, then reads. Writes nothing unless both are possible. */
static int write_and_read(struct exh_regs *r, const struct request *q, uint8_t *resp)
{
    uint32_t get, put;
    int err;
    if (q->len_B < 10) { return -EXH_MODBUS_VALUE; }
    get = be16(q, 3);
    put = be16(q, 7);
    if (get < 1 || get > READ_REGS || put < 1 || put > BOTH_REGS || q->p[9] != 2 * put ||
        q->len_B != 10u + q->p[9]) {
        return -EXH_MODBUS_VALUE;
    }
    err = exh_regs_read(r, EXH_REGS_HOLDING, be16(q, 1), (uint16_t)get, &resp[2]);
    if (err == 0) { err = exh_regs_write(r, be16(q, 5), (uint16_t)put, &q->p[10]); }
    if (err == 0) { err = exh_regs_read(r, EXH_REGS_HOLDING, be16(q, 1), (uint16_t)get, &resp[2]); }
    resp[1] = (uint8_t)(2 * get);
    return err != 0 ? -err : (int)(2 + 2 * get);
}

/* --- device identification, 43/14: the three mandatory objects --- */

#define OBJECTS 3u
/* The version as text, made by the preprocessor for numbers of any length. */
#define TEXT_OF(v) #v
#define TEXT(v)    TEXT_OF(v)
#define VERSION    TEXT(EXH_VERSION_MAJOR) "." TEXT(EXH_VERSION_MINOR) "." TEXT(EXH_VERSION_PATCH)
#define CONFORMS   0x81u /* these objects, as a stream or one by one */

static uint8_t *object(uint8_t *to, uint32_t id)
{
    static const char text[OBJECTS][sizeof VERSION > 7 ? sizeof VERSION : 7] = {
        "exhand", "exhand", VERSION};
    uint8_t *len = to + 1;
    to[0] = (uint8_t)id;
    to += 2;
    for (uint32_t i = 0; text[id][i] != '\0'; i++) { *to++ = (uint8_t)text[id][i]; }
    *len = (uint8_t)(to - len - 1);
    return to;
}

static int identify(const struct request *q, uint8_t *resp)
{
    uint32_t how, first, n;
    uint8_t *to = &resp[7];
    if (q->len_B < 2 || q->p[1] != 14) { return -EXH_MODBUS_FUNCTION; }
    if (q->len_B != 4) { return -EXH_MODBUS_VALUE; }
    how = q->p[2];
    first = q->p[3];
    if (how < 1 || how > 4) { return -EXH_MODBUS_VALUE; }
    if (how == 4 && first >= OBJECTS) { return -EXH_MODBUS_ADDRESS; }
    if (first >= OBJECTS) { first = 0; } /* an unknown object restarts the stream */
    n = how == 4 ? 1 : OBJECTS - first;
    resp[1] = 14;
    resp[2] = (uint8_t)how;
    resp[3] = CONFORMS;
    resp[4] = 0; /* no more follows */
    resp[5] = 0;
    resp[6] = (uint8_t)n;
    for (uint32_t i = 0; i < n; i++) { to = object(to, first + i); }
    return (int)(to - resp);
}

static int answer(struct exh_regs *r, const struct request *q, uint8_t *resp)
{
    switch (q->p[0]) {
    case 1:
    case 2: return read_bits(r, q, resp);
    case 3:
    case 4: return read_regs(r, q, resp);
    case 5: return write_coil(r, q, resp);
    case 6: return write_reg(r, q, resp);
    case 15: return write_coils(r, q, resp);
    case 16: return write_regs(r, q, resp);
    case 22: return mask_reg(r, q, resp);
    case 23: return write_and_read(r, q, resp);
    case 43: return identify(q, resp);
    default: return -EXH_MODBUS_FUNCTION;
    }
}

int exh_modbus_answer(
    struct exh_regs *r, const uint8_t *req, size_t len_B, uint8_t *resp, size_t cap_B)
{
    /* Limited to a length above any request, so that it is refused. */
    const struct request q = {req, len_B < 0xFFFFu ? (uint32_t)len_B : 0xFFFFu};
    int n;
    if (cap_B < EXH_MODBUS_PDU_B) { return -EXH_E_SHORT; }
    if (len_B == 0) { return 0; }
    n = answer(r, &q, resp);
    resp[0] = req[0];
    if (n > 0) { return n; }
    resp[0] = (uint8_t)(req[0] | 0x80u);
    resp[1] = (uint8_t)-n;
    return 2;
}
