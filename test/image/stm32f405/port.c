/* SPDX-License-Identifier: MIT */
/* Pins (RM0090 chapter 8). A pin that is no output shows the level from outside. */
#include "stm.h"

enum { MODER = 0, IDR = 4, ODR = 5, BSRR = 6, AFRL = 8 };

unsigned stm_pin_mode(const struct stm *s, unsigned port, unsigned pin)
{
    return s->port[port].r[MODER] >> 2 * pin & 3;
}

unsigned stm_pin_function(const struct stm *s, unsigned port, unsigned pin)
{
    return s->port[port].r[AFRL + pin / 8] >> 4 * (pin % 8) & 15;
}

static uint16_t outputs(const struct stm *s, unsigned port)
{
    uint16_t mask = 0;
    for (unsigned i = 0; i < 16; i++) {
        if (stm_pin_mode(s, port, i) == 1) { mask = (uint16_t)(mask | 1u << i); }
    }
    return mask;
}

uint16_t stm_port_out(const struct stm *s, unsigned port)
{
    return (uint16_t)(s->port[port].r[ODR] & outputs(s, port));
}

uint32_t stm_port_read(struct stm *s, unsigned port, uint32_t off)
{
    const struct stm_port *p = &s->port[port];
    if (off >> 2 == IDR) {
        const uint16_t mask = outputs(s, port);
        return (p->r[ODR] & mask) | (p->in & ~(uint32_t)mask);
    }
    return off < 40 && off >> 2 != BSRR ? p->r[off >> 2] : 0;
}

void stm_port_write(struct stm *s, unsigned port, uint32_t off, unsigned size, uint32_t v)
{
    struct stm_port *p = &s->port[port];
    const uint16_t was = stm_port_out(s, port);
    uint16_t is;
    if (off >> 2 == BSRR) { /* halves may be written alone; to set wins */
        const uint32_t bits = size == 2 && off & 2 ? v << 16 : v;
        p->r[ODR] = (p->r[ODR] & ~(bits >> 16)) | (bits & 0xFFFFu);
    } else if (off >> 2 != IDR && off < 40) {
        p->r[off >> 2] = off >> 2 == ODR ? v & 0xFFFFu : v;
    }
    is = stm_port_out(s, port);
    if (is != was && stm_outside.pins) { stm_outside.pins(stm_outside.ctx, port, was, is); }
}
