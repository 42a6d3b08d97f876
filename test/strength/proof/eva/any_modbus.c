/* SPDX-License-Identifier: MIT */
/* PROVES: Modbus
 * Any bytes as a request, of lengths up to 12 and of the longest; writes of many registers have
 * ten counts. The map of registers answers anything. Nothing is read outside the request or
 * written outside an answer of 253 bytes, and the map gets no request that is too long for it.
 *
 * EVA: -eva-slevel 60
 * PLANT: lib/src/talk/modbus.c: if (n < 1 || n > READ_BITS) { return -EXH_MODBUS_VALUE; } -> (void)0;
 * PLANT: lib/src/talk/modbus.c: if (n < 1 || n > READ_REGS) { return -EXH_MODBUS_VALUE; } -> (void)0;
 * PLANT: lib/src/talk/modbus.c: if (q->len_B < 10) { return -EXH_MODBUS_VALUE; } -> (void)0;
 * PLANT: lib/src/talk/modbus.c: if (q->len_B != 7) { return -EXH_MODBUS_VALUE; } -> (void)0;
 * PLANT: lib/src/talk/modbus.c: n > WRITE_BITS || q->p[5] != (n + 7) >> 3 || q->len_B != 6u + q->p[5] -> n > WRITE_BITS || q->p[5] != (n + 7) >> 3
 * PLANT: lib/src/talk/modbus.c: n > WRITE_REGS || q->p[5] != 2 * n || -> n > WRITE_REGS ||
 * PLANT: lib/src/talk/modbus.c: put > BOTH_REGS || q->p[9] != 2 * put || -> put > BOTH_REGS ||
 * PLANT: lib/src/talk/modbus.c: if (get < 1 || get > READ_REGS || put < 1 || -> if (get < 1 || put < 1 ||
 * PLANT: lib/src/talk/modbus.c: if (len_B == 0) { return 0; } -> (void)0;
 */
#include "talk/modbus.c"

#include "any.h"

static uint8_t req[260], resp[EXH_MODBUS_PDU_B];

/* The map: eva/any_regs.c. Here it reads and writes all that is requested. */
static void takes(const uint8_t *from, uint32_t B)
{
    /*@ assert to_be_read: \valid_read(from + (0 .. B - 1)); */
    (void)from;
    (void)B;
}

static int gives(uint8_t *to, uint32_t B)
{
    Frama_C_make_unknown((char *)to, B); /* what is not valid there breaks its contract */
    return Frama_C_interval(0, 6);
}

int exh_regs_read(
    const struct exh_regs *r, enum exh_regs_kind kind, uint16_t at, uint16_t n, uint8_t *to)
{
    (void)r;
    (void)kind;
    (void)at;
    return gives(to, 2u * n);
}

int exh_regs_read_bits(
    const struct exh_regs *r, enum exh_regs_kind kind, uint16_t at, uint16_t n, uint8_t *to)
{
    (void)r;
    (void)kind;
    (void)at;
    return gives(to, (n + 7u) / 8u);
}

int exh_regs_write(struct exh_regs *r, uint16_t at, uint16_t n, const uint8_t *from)
{
    (void)r;
    (void)at;
    takes(from, 2u * n);
    return Frama_C_interval(0, 6);
}

int exh_regs_write_bits(struct exh_regs *r, uint16_t at, uint16_t n, const uint8_t *from)
{
    (void)r;
    (void)at;
    takes(from, (n + 7u) / 8u);
    return Frama_C_interval(0, 6);
}

/* Its end is the end of the array. */
static void answered(uint32_t len_B, uint32_t cap_B)
{
    struct exh_regs r;
    int n;
    n = exh_modbus_answer(
        &r, req + (sizeof req - len_B), len_B, resp + (sizeof resp - cap_B), cap_B);
    /*@ assert an_answer: n <= 253; */
}

/* All functions but those that write many. */
static void ask(uint32_t len_B)
{
    static const int most[] = {14, 22, 255}, least[] = {0, 17, 24};
    for (unsigned i = 0; i < 3; i++) {
        ANY(req);
        if (len_B > 0) { req[sizeof req - len_B] = (uint8_t)Frama_C_interval(least[i], most[i]); }
        answered(len_B, EXH_MODBUS_PDU_B);
    }
}

/* A request of this function for n values. n is in the bytes from `at` on. */
static void write(uint8_t function, uint32_t at, uint16_t n, uint32_t len_B)
{
    uint8_t *q = req + (sizeof req - len_B);
    ANY(req);
    q[0] = function;
    if (len_B > at + 1) {
        q[at] = (uint8_t)(n >> 8);
        q[at + 1] = (uint8_t)(n & 0xFF);
    }
    answered(len_B, EXH_MODBUS_PDU_B);
}

static void writes(uint16_t n)
{
    for (uint32_t len_B = 1; len_B < 12; len_B++) {
        write(15, 3, n, len_B);
        write(16, 3, n, len_B);
        write(23, 7, n, len_B);
    }
    if (n <= 1968) { write(15, 3, n, 6 + (n + 7u) / 8); }
    if (n <= 123) { write(16, 3, n, 6 + 2u * n); }
    if (n <= 121) { write(23, 7, n, 10 + 2u * n); }
}

int main(void)
{
    static const uint8_t len[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 253};
    static const uint16_t n[] = {0, 1, 8, 9, 121, 122, 123, 124, 1968, 1969};
    for (unsigned i = 0; i < sizeof len; i++) { ask(len[i]); }
    for (unsigned i = 0; i < sizeof n / sizeof n[0]; i++) { writes(n[i]); }
    ANY(req);
    answered(5, EXH_MODBUS_PDU_B - 1);
    END();
    return 0;
}
