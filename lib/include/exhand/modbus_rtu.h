/* SPDX-License-Identifier: MIT */
/* Modbus RTU: assembles requests from the bytes of a serial line, and frames the responses.
 *
 *   exh_modbus_rtu_receive(&rtu, byte); // per byte
 *   if (exh_modbus_rtu_poll(&rtu, us)) { n = exh_modbus_rtu_answer(&rtu, &regs, resp, cap_B); } */
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

/* A slave on one serial line. */
struct exh_modbus_rtu {
    uint8_t address;     /* ours, 1 .. 247 */
    uint8_t ready;       /* 1: frame holds a whole request for us */
    uint16_t len_B;      /* length of the frame so far; above ADU_B: too long */
    uint32_t silence_us; /* silence that ends a frame: 3.5 characters, 1750 us above 19200 baud */
    uint32_t quiet_us;   /* time since the last byte */
    uint32_t taken;      /* requests for us since set-up */
    uint32_t others;     /* undamaged frames for other slaves */
    uint32_t damaged;    /* frames too short, too long or with a wrong CRC */
    uint8_t frame[EXH_MODBUS_ADU_B]; /* address, PDU, CRC as received */
};

/* Set-up (divides). -EXH_E_RANGE: address not 1 .. 247, or baud not 300 .. 10^7. */
int exh_modbus_rtu_setup(struct exh_modbus_rtu *u, uint32_t address, uint32_t baud);

/* Takes a received byte. Bytes are lost while a request waits for its answer. */
void exh_modbus_rtu_receive(struct exh_modbus_rtu *u, uint8_t byte);

/* Reports a byte with a parity, framing or overrun error. Its frame is dropped. */
void exh_modbus_rtu_discard(struct exh_modbus_rtu *u);

/* Reports us microseconds without a byte. Returns 1 if a whole request for us, or a broadcast, is
 * ready: call exh_modbus_rtu_answer(). */
int exh_modbus_rtu_poll(struct exh_modbus_rtu *u, uint32_t us);

/* Executes the request. Returns the bytes of the response including address and CRC. 0: no
 * response, because there is no request or it is a broadcast, of which only writes are executed.
 * -EXH_E_SHORT: cap_B is below EXH_MODBUS_ADU_B; the request still waits. */
int exh_modbus_rtu_answer(
    struct exh_modbus_rtu *u, struct exh_regs *r, uint8_t *resp, size_t cap_B);

/* CRC-16/MODBUS: reflected 0xA001, initial 0xFFFF, no final XOR. The CRC of "123456789" is 0x4B37.
 * The line carries its low byte first. */
uint16_t exh_crc16(const uint8_t *p, size_t len_B);

#ifdef __cplusplus
}
#endif
#endif
