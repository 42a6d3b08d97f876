/* SPDX-License-Identifier: MIT */
/* PROVES: state of the box
 * The state of the box: any bit pattern, any input.
 *
 * PLANT: lib/src/safe/safety.c: if (!sane(s)) { -> if (0) {
 */
#include "act/gate.c"
#include "safe/safety.c"
#include "safe/safety_open.c"

#define MAY_STOP /* a number of fingers that there is not */
#include "any.h"

static struct exh_safety s;
static struct exh_safety_cfg cfg;

static void step(uint8_t from, uint8_t to)
{
    struct exh_safety_in in;
    struct exh_permit p;
    ANY(s);
    ANY(cfg);
    ANY(in);
    s.state = (uint8_t)Frama_C_unsigned_int_interval(from, to);
    p = exh_safety_step(&s, &cfg, in);
    /*@ assert a_state: s.state < 6; */
    /*@ assert a_mode: p.mode <= 2; */
    /*@ assert ticks: p.ticks >= 1; */
    if (from > 5) { /*@ assert shut: p.mode == 0; */
    }
}

int main(void)
{
    step(0, 5);
    step(6, 255); /* no valid state: reported, and shut */
    END();
    return 0;
}
