/* SPDX-License-Identifier: MIT */
/* Modbus: one request PDU in, one answer PDU out.
 *
 * What a register means is in regs.h; modbus_rtu.h makes requests of the bytes of a serial line. A
 * port that has its own Modbus library needs regs.h alone.
 */
#ifndef EXHAND_MODBUS_H
#define EXHAND_MODBUS_H

#include "exhand/regs.h"

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define EXH_MODBUS_PDU_B 253 /* the longest request or answer */

/* Answers one request: functions 1 2 3 4 5 6 15 16 22 23 and 43/14 (device identification). Bytes
 * of the answer, an exception included; 0: no request at all (len_B 0); -EXH_E_SHORT: cap_B below
 * EXH_MODBUS_PDU_B, and nothing was done. req and resp must not overlap. */
int exh_modbus_answer(
    struct exh_regs *r, const uint8_t *req, size_t len_B, uint8_t *resp, size_t cap_B);

#ifdef __cplusplus
}
#endif
#endif
