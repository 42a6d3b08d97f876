/* SPDX-License-Identifier: MIT */
/* Modbus on a serial line: frames by silence, CRC-16, address. */
#include "exhand/modbus_rtu.h"

#include "exhand/error.h"
#include "exhand/fix.h"

#define LEAST_B 4u /* address, function, CRC */

uint16_t exh_crc16(const uint8_t *p, size_t len_B)
{
    /* Two 4-bit steps per byte, as in exh_crc32(). */
    static const uint16_t nibble[16] = {0x0000, 0xCC01, 0xD801, 0x1400, 0xF001, 0x3C00, 0x2800,
        0xE401, 0xA001, 0x6C00, 0x7800, 0xB401, 0x5000, 0x9C01, 0x8801, 0x4400};
    uint32_t crc = 0xFFFFu;
    for (size_t i = 0; i < len_B; i++) {
        crc ^= p[i];
        crc = crc >> 4 ^ nibble[crc & 15u];
        crc = crc >> 4 ^ nibble[crc & 15u];
    }
    return (uint16_t)crc;
}

int exh_modbus_rtu_setup(struct exh_modbus_rtu *u, uint32_t address, uint32_t baud)
{
    static const struct exh_modbus_rtu none = {0};
    if (address < 1 || address > 247 || baud < 300 || baud > 10000000) { return -EXH_E_RANGE; }
    *u = none;
    u->address = (uint8_t)address;
    /* 3.5 characters of 11 bits, rounded up */
    u->silence_us =
        baud > 19200 ? 1750 : (uint32_t)exh_udiv64(UINT64_C(38500000) + baud - 1, baud, NULL);
    return 0;
}

void exh_modbus_rtu_receive(struct exh_modbus_rtu *u, uint8_t byte)
{
    u->quiet_us = 0;
    if (u->ready) { return; }
    if (u->len_B < EXH_MODBUS_ADU_B) { u->frame[u->len_B] = byte; }
    if (u->len_B <= EXH_MODBUS_ADU_B) { u->len_B++; }
}

void exh_modbus_rtu_discard(struct exh_modbus_rtu *u)
{
    u->quiet_us = 0;
    if (!u->ready) { u->len_B = EXH_MODBUS_ADU_B + 1; }
}

/* Processes a frame after the silence that ends it. */
static void ended(struct exh_modbus_rtu *u)
{
    const uint32_t n = u->len_B;
    const int whole =
        n >= LEAST_B && n <= EXH_MODBUS_ADU_B &&
        exh_crc16(u->frame, n - 2) == (u->frame[n - 2] | (uint32_t)u->frame[n - 1] << 8);
    if (!whole) {
        u->damaged++;
    } else if (u->frame[0] != u->address && u->frame[0] != 0) {
        u->others++;
    } else {
        u->taken++;
        u->ready = 1;
        return;
    }
    u->len_B = 0;
}

int exh_modbus_rtu_poll(struct exh_modbus_rtu *u, uint32_t us)
{
    if (u->ready) { return 1; }
    u->quiet_us = us < UINT32_MAX - u->quiet_us ? u->quiet_us + us : UINT32_MAX;
    if (u->len_B > 0 && u->quiet_us >= u->silence_us) { ended(u); }
    return u->ready;
}

/* 1 for functions allowed in a broadcast. */
static int is_write(uint32_t function)
{
    return function == 5 || function == 6 || function == 15 || function == 16 || function == 22;
}

int exh_modbus_rtu_answer(struct exh_modbus_rtu *u, struct exh_regs *r, uint8_t *resp, size_t cap_B)
{
    const int to_all = u->frame[0] == 0;
    uint32_t crc;
    int n = 0;
    if (cap_B < EXH_MODBUS_ADU_B) { return -EXH_E_SHORT; }
    if (!u->ready) { return 0; }
    if (!to_all || is_write(u->frame[1])) {
        n = exh_modbus_answer(r, &u->frame[1], u->len_B - 3u, &resp[1], cap_B - 3);
    }
    u->ready = 0;
    u->len_B = 0;
    if (to_all) { return 0; }
    resp[0] = u->address;
    crc = exh_crc16(resp, (size_t)n + 1);
    resp[n + 1] = (uint8_t)(crc & 0xFFu);
    resp[n + 2] = (uint8_t)(crc >> 8);
    return n + 3;
}
