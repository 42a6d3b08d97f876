/* SPDX-License-Identifier: MIT */
/* One request, from the bytes that libmodbus received to the answer that it sends. */
#include "slave/libmodbus.h"

#include "slave/slave.h"

static modbus_mapping_t *map; /* has every address, and values for the requested ones */

int request_open(void)
{
    map = modbus_mapping_new_start_address(0, 65536, 0, 65536, 0, 65536, 0, 65536);
    return map ? 0 : -1;
}

void request_close(void)
{
    if (map) { modbus_mapping_free(map); }
    map = NULL;
}

unsigned request_be16(const uint8_t *p) { return (unsigned)p[0] << 8 | p[1]; }

static int function_known(uint8_t function)
{
    return (function >= 1 && function <= 6) || function == 15 || function == 16 || function == 22 ||
           function == 23;
}

/* Bytes that a request of this function has; got: how many there are. */
static unsigned length_of(const uint8_t *pdu, unsigned got)
{
    switch (pdu[0]) {
    case 15:
    case 16: return got > 5 ? 6u + pdu[5] : 6;
    case 22: return 7;
    case 23: return got > 9 ? 10u + pdu[9] : 10;
    default: return 5;
    }
}

static int between(unsigned v, unsigned most) { return v >= 1 && v <= most; }

int request_shape(const uint8_t *pdu, unsigned len)
{
    const unsigned n = len >= 5 ? request_be16(pdu + 3) : 0;
    int good = 1;
    if (!function_known(pdu[0])) { return EXH_MODBUS_FUNCTION; }
    if (len != length_of(pdu, len)) { return EXH_MODBUS_VALUE; }
    switch (pdu[0]) {
    case 1:
    case 2: good = between(n, MODBUS_MAX_READ_BITS); break;
    case 3:
    case 4: good = between(n, MODBUS_MAX_READ_REGISTERS); break;
    case 5: good = n == 0 || n == 0xFF00; break;
    case 15: good = between(n, MODBUS_MAX_WRITE_BITS) && pdu[5] == (n + 7) / 8; break;
    case 16: good = between(n, MODBUS_MAX_WRITE_REGISTERS) && pdu[5] == 2 * n; break;
    case 23:
        good = between(n, MODBUS_MAX_WR_READ_REGISTERS) &&
               between(request_be16(pdu + 7), MODBUS_MAX_WR_WRITE_REGISTERS) &&
               pdu[9] == 2 * request_be16(pdu + 7);
        break;
    default: break;
    }
    return good ? 0 : EXH_MODBUS_VALUE;
}

/* Registers of the box into the mapping's, where modbus_reply() takes them from. */
static int fill(const struct exh_regs *r, enum exh_regs_kind kind, unsigned at, unsigned n)
{
    uint16_t *to = kind == EXH_REGS_INPUT ? map->tab_input_registers : map->tab_registers;
    uint8_t bytes[2 * MODBUS_MAX_READ_REGISTERS];
    const int err = exh_regs_read(r, kind, (uint16_t)at, (uint16_t)n, bytes);
    for (unsigned i = 0; err == 0 && i < n; i++) {
        to[at + i] = (uint16_t)request_be16(bytes + 2 * i);
    }
    return err;
}

static int fill_bits(const struct exh_regs *r, enum exh_regs_kind kind, unsigned at, unsigned n)
{
    uint8_t *to = kind == EXH_REGS_COIL ? map->tab_bits : map->tab_input_bits;
    uint8_t bytes[(MODBUS_MAX_READ_BITS + 7) / 8];
    const int err = exh_regs_read_bits(r, kind, (uint16_t)at, (uint16_t)n, bytes);
    for (unsigned i = 0; err == 0 && i < n; i++) {
        to[at + i] = (uint8_t)((unsigned)bytes[i / 8] >> i % 8 & 1u);
    }
    return err;
}

static int mask(struct exh_regs *r, const uint8_t *pdu)
{
    const unsigned at = request_be16(pdu + 1), and = request_be16(pdu + 3),
                   or = request_be16(pdu + 5);
    uint8_t bytes[2];
    unsigned v;
    const int err = fill(r, EXH_REGS_HOLDING, at, 1);
    if (err) { return err; }
    v = (map->tab_registers[at] & and) | (or &~and);
    bytes[0] = (uint8_t)(v >> 8 & 0xFFu);
    bytes[1] = (uint8_t)(v & 0xFFu);
    return exh_regs_write(r, (uint16_t)at, 1, bytes);
}

/* libmodbus writes the request into its mapping and answers from it. So replaces the written values
 * by the stored ones, where a register took the nearest possible value. */
static int write_and_read(struct exh_regs *r, uint8_t *pdu)
{
    const unsigned at = request_be16(pdu + 1), n = request_be16(pdu + 3),
                   put_at = request_be16(pdu + 5), put = request_be16(pdu + 7);
    int err = fill(r, EXH_REGS_HOLDING, at, n);
    if (err == 0) { err = exh_regs_write(r, (uint16_t)put_at, (uint16_t)put, pdu + 10); }
    if (err == 0) {
        err = exh_regs_read(r, EXH_REGS_HOLDING, (uint16_t)put_at, (uint16_t)put, pdu + 10);
    }
    return err ? err : fill(r, EXH_REGS_HOLDING, at, n);
}

/* Carries it out on the registers, for modbus_reply() to answer: 0, or an exception. */
static int carry_out(struct exh_regs *r, uint8_t *pdu)
{
    const unsigned at = request_be16(pdu + 1), n = request_be16(pdu + 3);
    const uint8_t on = pdu[3] != 0;
    switch (pdu[0]) {
    case 1: return fill_bits(r, EXH_REGS_COIL, at, n);
    case 2: return fill_bits(r, EXH_REGS_DISCRETE, at, n);
    case 3: return fill(r, EXH_REGS_HOLDING, at, n);
    case 4: return fill(r, EXH_REGS_INPUT, at, n);
    case 5: return exh_regs_write_bits(r, (uint16_t)at, 1, &on);
    case 6: return exh_regs_write(r, (uint16_t)at, 1, pdu + 3);
    case 15: return exh_regs_write_bits(r, (uint16_t)at, (uint16_t)n, pdu + 6);
    case 16: return exh_regs_write(r, (uint16_t)at, (uint16_t)n, pdu + 6);
    case 22: return mask(r, pdu);
    default: return write_and_read(r, pdu);
    }
}

int request_answer(struct request *q)
{
    uint8_t *pdu = q->adu + q->head_B;
    int err = request_shape(pdu, (unsigned)(q->len_B - q->head_B));
    if (err == 0) {
        struct exh_regs *r = mail_take();
        err = carry_out(r, pdu);
        mail_give();
    }
    if (q->silent) { return 0; }
    err = err ? modbus_reply_exception(q->ctx, q->adu, (unsigned)err)
              : modbus_reply(q->ctx, q->adu, q->len_B + q->tail_B, map);
    return err < 0 ? -1 : 0;
}
