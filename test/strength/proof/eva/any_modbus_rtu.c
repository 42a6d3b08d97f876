/* SPDX-License-Identifier: MIT */
/* PROVES: serial line of Modbus
 * Any byte and any silence, in any state of a line whose frame is not too long. Set-up with any
 * address and rate. An answer to any complete request, with any answer of the map.
 *
 * EVA: -eva-slevel 40
 * PLANT: lib/src/talk/modbus_rtu.c: if (u->len_B < EXH_MODBUS_ADU_B) { -> {
 * PLANT: lib/src/talk/modbus_rtu.c: if (u->len_B <= EXH_MODBUS_ADU_B) { u->len_B++; } -> u->len_B++;
 * PLANT: lib/src/talk/modbus_rtu.c: n >= LEAST_B && n <= EXH_MODBUS_ADU_B && -> n >= LEAST_B &&
 * PLANT: lib/src/talk/modbus_rtu.c: baud < 300 || -> baud < 0 ||
 * PLANT: lib/src/talk/modbus_rtu.c: nibble[16] -> nibble[15]
 * PLANT: lib/src/talk/modbus_rtu.c: if (cap_B < EXH_MODBUS_ADU_B) { return -EXH_E_SHORT; } -> (void)0;
 */
#include "num/fix.c"
#include "talk/modbus_rtu.c"

#include "any.h"

/* Its own proof is eva/any_modbus.c. */
int exh_modbus_answer(
    struct exh_regs *r, const uint8_t *req, size_t len_B, uint8_t *resp, size_t cap_B)
{
    const uint8_t last = req[len_B - 1];
    (void)r;
    (void)last;
    (void)cap_B;
    for (unsigned i = 0; i < EXH_MODBUS_PDU_B; i++) { resp[i] = any8(); }
    return Frama_C_interval(2, EXH_MODBUS_PDU_B);
}

static struct exh_modbus_rtu u;
static uint8_t resp[EXH_MODBUS_ADU_B];

static void any_line(uint8_t ready, uint32_t least_B)
{
    ANY(u);
    u.ready = ready;
    u.len_B = (uint16_t)Frama_C_unsigned_int_interval(least_B, EXH_MODBUS_ADU_B + !ready);
}

int main(void)
{
    (void)exh_modbus_rtu_setup(&u, any_u32(), any_u32());
    any_line(0, 0);
    exh_modbus_rtu_receive(&u, any8());
    /*@ assert length: u.len_B <= 257; */
    (void)exh_modbus_rtu_poll(&u, any_u32());
    any_line(0, 0);
    exh_modbus_rtu_discard(&u);
    /*@ assert length_of_bad: u.len_B <= 257; */
    (void)exh_modbus_rtu_poll(&u, any_u32());
    any_line(0, 0);
    (void)exh_modbus_rtu_answer(&u, (struct exh_regs *)0, resp, sizeof resp);
    any_line(1, LEAST_B);
    (void)exh_modbus_rtu_answer(&u, (struct exh_regs *)0, resp, sizeof resp);
    any_line(1, LEAST_B);
    (void)exh_modbus_rtu_answer(&u, (struct exh_regs *)0, resp + 200, sizeof resp - 200);
    END();
    return 0;
}
