/* SPDX-License-Identifier: MIT */
/* Valid configurations of a box. */
#include "box.h"

const struct exh_box_config exh_box_default = {
    .s526_base = {0x2C0, 0x280},
    .mm32xat_base = 0x300,
    .fingers = EXH_FINGERS,
    .monitor = EXH_BOX_NOW,
    .supply = 1,
    .watchdog = 1,
    .glove = EXH_BOX_NEVER,
    .dac_span_raw = 12184,
    .dac_rest_raw = 1000,
    .s526 = EXH_S526_PAR_DEFAULT,
    .mm32xat = EXH_MM32XAT_PAR_DEFAULT,
};

static int overlap(uint16_t a, uint16_t b, unsigned size_b)
{
    return a < b + size_b && b < a + 0x40u;
}

static int base_ok(uint16_t base) { return (base & 0x3Fu) == 0 && base >= 0x100; }

static int glove_base_ok(uint16_t base)
{
    static const uint16_t jumpers[] = {0x100, 0x140, 0x180, 0x200, 0x280, 0x300, 0x340, 0x380};
    for (unsigned i = 0; i < sizeof jumpers / sizeof jumpers[0]; i++) {
        if (base == jumpers[i]) { return 1; }
    }
    return 0;
}

static unsigned bases(const struct exh_box_config *c, int32_t *value)
{
    const int second = c->fingers > 1 || c->full, glove = c->glove != EXH_BOX_NEVER;
    *value = c->s526_base[0];
    if (!base_ok(c->s526_base[0])) { return EXH_BOX_ROW_BASE_A; }
    if (second) {
        *value = c->s526_base[1];
        if (!base_ok(c->s526_base[1])) { return EXH_BOX_ROW_BASE_B; }
        if (overlap(c->s526_base[0], c->s526_base[1], 0x40)) { return EXH_BOX_ROW_OVERLAP; }
    }
    if (!glove) { return EXH_BOX_ROWS; }
    *value = c->mm32xat_base;
    if (!glove_base_ok(c->mm32xat_base)) { return EXH_BOX_ROW_BASE_GLOVE; }
    if (overlap(c->s526_base[0], c->mm32xat_base, 0x10) ||
        (second && overlap(c->s526_base[1], c->mm32xat_base, 0x10))) {
        return EXH_BOX_ROW_OVERLAP;
    }
    return EXH_BOX_ROWS;
}

/* A bit that turns nothing over was meant for a pin: outputs would be active when they are off. */
static int pins_ok(const struct exh_box_config *c, int32_t *value)
{
    *value = c->watchdog;
    if (c->watchdog > 1) { return 0; }
    for (unsigned i = 0; i < 2; i++) {
        *value = c->din_invert[i];
        if (c->din_invert[i] & 0xF0u) { return 0; }
        *value = c->out_invert[i];
        if (c->out_invert[i] & 0x0Fu) { return 0; }
    }
    return 1;
}

static int wait_ok(uint32_t us, int32_t *value)
{
    *value = (int32_t)us;
    return us >= 1 && us <= 60000;
}

unsigned exh_box_check(const struct exh_box_config *c, int32_t *value)
{
    const struct exh_mm32xat_par *m = &c->mm32xat;
    *value = c->fingers;
    if (c->fingers < 1 || c->fingers > EXH_FINGERS) { return EXH_BOX_ROW_FINGERS; }
    *value = c->full;
    if (c->full > 1) { return EXH_BOX_ROW_FULL; }
    if (!pins_ok(c, value)) { return EXH_BOX_ROW_PINS; }
    *value = c->monitor;
    if (c->monitor >= EXH_BOX_WHENS) { return EXH_BOX_ROW_MONITOR; }
    *value = c->glove;
    if (c->glove >= EXH_BOX_WHENS) { return EXH_BOX_ROW_GLOVE; }
    *value = c->dac_span_raw;
    if (c->dac_span_raw > INT16_MAX) { return EXH_BOX_ROW_SPAN; }
    *value = c->dac_rest_raw;
    if (c->dac_rest_raw > c->dac_span_raw) { return EXH_BOX_ROW_SPAN; }
    if (!wait_ok(c->s526.ad_wait_us, value) || !wait_ok(c->s526.da_wait_us, value) ||
        !wait_ok(c->s526.ee_wait_us, value)) {
        return EXH_BOX_ROW_WAIT;
    }
    if (c->glove != EXH_BOX_NEVER) {
        if (!wait_ok(m->scan_wait_us, value) || !wait_ok(m->settle_us, value) ||
            !wait_ok(m->reset_us, value) || !wait_ok(m->set_us, value)) {
            return EXH_BOX_ROW_WAIT;
        }
        *value = m->channels;
        if (m->channels < EXH_GLOVE_SENSORS || m->channels >= EXH_MM32XAT_CHANNELS ||
            m->interval > 3 || m->lost_limit == 0 || m->slice > EXH_MM32XAT_CHANNELS) {
            return EXH_BOX_ROW_SCAN;
        }
    }
    return bases(c, value);
}
