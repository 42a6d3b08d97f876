/* SPDX-License-Identifier: MIT */
/* Modbus: answers one request PDU with one response PDU.
 *
 * regs.h defines the registers; modbus_rtu.h assembles requests from the bytes of a serial line. A
 * port with its own Modbus library needs only regs.h. Source: Modbus protocol V1.1b3. */
#ifndef EXHAND_MODBUS_H
#define EXHAND_MODBUS_H

#include "exhand/regs.h"

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define EXH_MODBUS_PDU_B 253 /* longest request or response */

/* Answers one request: functions 1 2 3 4 5 6 15 16 22 23 and 43/14 (device identification). Returns
 * the bytes of the response, which may be an exception. 0: len_B is 0. -EXH_E_SHORT: cap_B is below
 * EXH_MODBUS_PDU_B, and it did nothing. req and resp must not overlap. */
int exh_modbus_answer(
    struct exh_regs *r, const uint8_t *req, size_t len_B, uint8_t *resp, size_t cap_B);

#ifdef __cplusplus
}
#endif
#endif
