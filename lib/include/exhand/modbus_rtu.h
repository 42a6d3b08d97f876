/* SPDX-License-Identifier: MIT */
/* Modbus RTU: the bytes of a serial line into requests, and their answers into bytes. */
#ifndef EXHAND_MODBUS_RTU_H
#define EXHAND_MODBUS_RTU_H

#include "exhand/modbus.h"
#include "exhand/regs.h"

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define EXH_MODBUS_ADU_B 256 /* address, PDU, CRC */

/* A slave on a serial line, one for a line. */
struct exh_modbus_rtu {
    uint8_t address;     /* ours, 1 .. 247 */
    uint8_t ready;       /* 1: a whole request for us waits in frame */
    uint16_t len_B;      /* bytes of the frame so far; beyond ADU_B: too long */
    uint32_t silence_us; /* that ends a frame: 3.5 characters, 1750 us above 19200 baud */
    uint32_t quiet_us;   /* since the last byte */
    uint32_t taken;      /* requests for us, since set-up */
    uint32_t others;     /* undamaged frames for somebody else */
    uint32_t damaged;    /* frames too short, too long or with a wrong CRC */
    uint8_t frame[EXH_MODBUS_ADU_B]; /* address, PDU, CRC as they came */
};

/* -EXH_E_RANGE: address not 1 .. 247, or baud not 300 .. 10^7. Divides. */
int exh_modbus_rtu_setup(struct exh_modbus_rtu *u, uint32_t address, uint32_t baud);

/* A byte has come. While a request waits for its answer, bytes are lost. */
void exh_modbus_rtu_receive(struct exh_modbus_rtu *u, uint8_t byte);

/* A byte came damaged (parity, frame, overrun): the frame it is in is dropped. */
void exh_modbus_rtu_discard(struct exh_modbus_rtu *u);

/* us have passed without a byte. 1: a request for us, or for all, is whole:
 * exh_modbus_rtu_answer(). */
int exh_modbus_rtu_poll(struct exh_modbus_rtu *u, uint32_t us);

/* Carries it out. Bytes of the answer, address and CRC included; 0: it gets none, as it was for all
 * (of those, writes alone are carried out), or there is no request; -EXH_E_SHORT: cap_B below
 * EXH_MODBUS_ADU_B, and the request still waits. */
int exh_modbus_rtu_answer(
    struct exh_modbus_rtu *u, struct exh_regs *r, uint8_t *resp, size_t cap_B);

/* CRC-16/MODBUS: reflected 0xA001, start 0xFFFF, no final; of "123456789" 0x4B37. On the line its
 * low byte comes first. */
uint16_t exh_crc16(const uint8_t *p, size_t len_B);

#ifdef __cplusplus
}
#endif
#endif
