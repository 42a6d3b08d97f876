/* SPDX-License-Identifier: MIT */
/* exhand run --modbus: requests that are wrong get the standard exceptions. */
#define _XOPEN_SOURCE 700

#include "modbus_rig.h"

#ifdef EXH_MODBUS

/* The exception that this request gets; 0: none. */
static int exception_of(struct rig *r, const uint8_t *pdu, int len)
{
    uint8_t raw[MODBUS_MAX_ADU_LENGTH] = {1}, answer[MODBUS_MAX_ADU_LENGTH];
    memcpy(raw + 1, pdu, (size_t)len);
    CHECK(modbus_send_raw_request(r->c, raw, len + 1) > 0, "not sent");
    return modbus_receive_confirmation(r->c, answer) >= 9 && answer[7] == (pdu[0] | 0x80)
               ? answer[8]
               : 0;
}

TEST(bad_requests_get_the_standard_exceptions)
{
    static const struct {
        uint8_t pdu[12];
        int len, exception;
    } row[] = {
        {{7}, 1, 1}, /* functions that are not here */
        {{8, 0, 0, 0, 0}, 5, 1}, {{17}, 1, 1}, {{20, 7, 6, 0, 4, 0, 1, 0, 2}, 9, 1},
        {{100, 1, 2, 3}, 4, 1}, {{1, 0, 6, 0, 1}, 5, 2}, /* addresses that are not */
        {{1, 0, 0, 0, 7}, 5, 2}, {{2, 0, 192, 0, 1}, 5, 2}, {{3, 0, 0, 0, 1}, 5, 2},
        {{3, 0x10, 0, 0, 1}, 5, 2}, {{4, 0x0F, 0xFF, 0, 2}, 5, 2}, {{4, 0x04, 0x30, 0, 1}, 5, 2},
        {{4, 0xFF, 0xFF, 0, 2}, 5, 2}, {{5, 0, 6, 0xFF, 0}, 5, 2}, {{6, 0x10, 0, 0, 0}, 5, 2},
        {{22, 0, 0, 0, 0, 0, 0}, 7, 2}, {{1, 0, 0, 0, 0}, 5, 3}, /* counts and values */
        {{3, 0x50, 0, 0, 126}, 5, 3}, {{4, 0, 0, 0xFF, 0xFF}, 5, 3}, {{5, 0, 0, 0x12, 0x34}, 5, 3},
        {{16, 0x50, 0, 0, 1, 4, 0, 0, 0, 0}, 10, 3},
        {{5, 0, 2, 0xFF, 0}, 5, 3},                                 /* SAVE: no place */
        {{5, 0, 4, 0xFF, 0}, 5, 3},                                 /* RUN: not allowed */
        {{5, 0, 5, 0xFF, 0}, 5, 3}, {{15, 0, 0, 0, 2, 1, 3}, 7, 3}, /* APPLY with DISCARD */
        {{3, 0x50, 0}, 3, 3}, /* cut short; and longer than it says */
        {{3, 0x50, 0, 0, 1, 0}, 6, 3},
        {{4, 0, 0, 0, 2}, 5, 0}, /* and behind all these a good one */
    };
    struct rig r;
    rig_start(&r, WORDS("run", "--pace", "--modbus", "tcp:127.0.0.1:0", "--modbus-write"));
    for (size_t i = 0; i < sizeof row / sizeof row[0]; i++) {
        const int got = exception_of(&r, row[i].pdu, row[i].len);
        CHECK(got == row[i].exception, "row %zu, function %u: %d", i, row[i].pdu[0], got);
    }
    rig_end(&r, 130);
    said_clean(r.dir);
}

TEST_MAIN("modbus_exceptions", bad_requests_get_the_standard_exceptions);
#else
RIG_NONE("modbus_exceptions");
#endif
