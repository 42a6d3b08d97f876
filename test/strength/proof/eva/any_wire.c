/* SPDX-License-Identifier: MIT */
/* PROVES: wire
 * Any bytes of any length as a datagram, into a receiver in any state read from bytes. Time that
 * passes. Any packet into buffers of any size. Received planes, and received parameters of any
 * table of ten values.
 *
 * EVA: -eva-slevel 20
 * PLANT: lib/src/talk/wire.c: if (len_B != whole_B && len_B != whole_B + EXH_WIRE_SEAL_B) -> if (len_B < HEAD_B)
 * PLANT: lib/src/talk/wire.c: if (whole) { -> if (1) {
 * PLANT: lib/src/talk/wire.c: if (late >= WINDOW) { -> if (late > WINDOW) {
 * PLANT: lib/src/talk/wire.c: ahead < WINDOW ? rx->seen -> ahead <= WINDOW ? rx->seen
 * PLANT: lib/src/talk/wire.c: i < t->frames && i < EXH_WIRE_FRAMES -> i < t->frames
 * PLANT: lib/src/talk/wire.c: if (cap_B < end + CRC_B) { return -EXH_E_SHORT; } -> (void)0;
 */
#include <stdint.h>
/* Eva judges each byte. */
static void copy(void *to, const void *from, uint32_t n)
{
    for (uint32_t i = 0; i < n; i++) { ((uint8_t *)to)[i] = ((const uint8_t *)from)[i]; }
}
#define __builtin_memcpy copy
#include "num/bytes.c"
#include "num/crc.c"
#include "num/fix.c"
#include "num/authority.c"
#include "num/params.c"
#include "num/signal.c"      /* not that of Frama-C */
#define head       wire_head /* params.c has its own */
#define head_bytes wire_head_bytes
#include "talk/wire.c"

#include "table.h"

static struct exh_wire_rx rx;
static struct exh_wire_tx tx;
static struct exh_wire_packet p;
static uint8_t buf[EXH_WIRE_MAX_B + 17]; /* a TRACE with a frame too many */

static void receive(uint32_t least_B, uint32_t most_B)
{
    const uint32_t len_B = Frama_C_unsigned_int_interval(least_B, most_B);
    FROM_BYTES(rx, exh_wire_rx_serialize);
    /*@ assert open: rx.open <= 1; */
    ANY(buf);
    (void)exh_wire_decode(&rx, &p, buf + (sizeof buf - most_B), len_B);
    (void)exh_wire_poll(&rx, any_u32(), any_u32());
    /*@ assert open_after: rx.open <= 1; */
}

static void send(uint8_t type, uint32_t least_B, uint32_t most_B)
{
    const uint32_t cap_B = Frama_C_unsigned_int_interval(least_B, most_B);
    int32_t n;
    FROM_BYTES(tx, exh_wire_tx_serialize);
    ANY(p);
    p.type = type;
    n = exh_wire_encode(&tx, &p, any_u32(), buf + (sizeof buf - most_B), cap_B);
    /*@ assert no_more_than_fits: n <= 256; */
}

static void use(void)
{
    static struct exh_params params;
    static int32_t active[TABLE_VALUES], staged[TABLE_VALUES];
    struct exh_wire_hello ours, theirs;
    any_rows();
    exh_params_setup(&params, &table, active, staged);
    ANY(p);
    (void)exh_wire_stage(&params, &p, any8() & 1);
    (void)exh_wire_plane_of(&p.u.planes, Frama_C_unsigned_int_interval(0, EXH_FINGERS - 1));
    ANY(ours);
    ANY(theirs);
    (void)exh_wire_compare(&ours, &theirs);
    (void)exh_wire_round_trip_us(any_u32(), &p.u.planes);
    (void)exh_wire_trace_missed(any_u32(), &p.u.trace);
}

int main(void)
{
    receive(0, sizeof buf);
    receive(22, 22);
    receive(35, 35);
    for (unsigned type = 0; type <= 8; type++) { send((uint8_t)type, 0, EXH_WIRE_MAX_B); }
    send(EXH_WIRE_PLANES, 0, 40);
    use();
    END();
    return 0;
}
