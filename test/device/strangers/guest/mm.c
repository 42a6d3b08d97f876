/* SPDX-License-Identifier: MIT */
/* The MM-32X-AT through Linux. */
#include "check.h"
#include "linux.h"
#include "pin.h"
#include "table.h"

#include <stdio.h>

/* Ranges in the driver's order, found by asking it: width in uV of 65536 codes, and where code 0
 * is. */
struct range {
    int32_t lo_uV, span_uV;
};
static const struct range range[] = {
    {0, 10000000}, {0, 5000000}, {-10000000, 20000000}, {-5000000, 10000000}};

static int64_t code_of(const struct range *r, int32_t v_uV)
{
    const int64_t n = ((int64_t)v_uV - r->lo_uV) * 65536 * 2 + r->span_uV;
    const int64_t code = n < 0 ? 0 : n / (2 * (int64_t)r->span_uV);
    return code > 65535 ? 65535 : code;
}

static void check_channel(unsigned ch, unsigned k)
{
    const struct range *r = &range[k];
    const int32_t step = r->span_uV / 61 + 12345;
    for (int32_t v_uV = r->lo_uV - 100000; v_uV < r->lo_uV + r->span_uV + 100000; v_uV += step) {
        set_pin(PIN_GLOVE + ch, v_uV + 37 * (int32_t)ch);
        table_value(pin(PIN_GLOVE + ch), code_of(r, pin(PIN_GLOVE + ch)), get(MM, MM_AI, ch, k));
    }
}

void check_mm_ad(void)
{
    static const char *const name[] = {"0..10 V", "0..5 V", "+-10 V", "+-5 V"};
    table_head(
        "A/D: driver dmm32at, all 32 inputs in all of its ranges", "input, uV", "comedi, 0..65535");
    for (unsigned ch = 0; ch < 32; ch++) {
        set_pin(PIN_GLOVE + ch, 250000 * (int32_t)ch - 4000000);
    }
    for (unsigned k = 0; k < sizeof range / sizeof range[0]; k++) {
        for (unsigned ch = 0; ch < 32; ch++) {
            if (ch % 8 == 0) { table_row("A/D %u..%u, %s", ch, ch + 7, name[k]); }
            check_channel(ch, k);
            if (ch % 8 == 7) { table_end_row(); }
        }
    }
    table_row("A/D 0..31 in turn, +-10 V");
    for (unsigned i = 0; i < 320; i++) {
        const unsigned ch = i * 7 % 32;
        table_value(
            pin(PIN_GLOVE + ch), code_of(&range[2], pin(PIN_GLOVE + ch)), get(MM, MM_AI, ch, 2));
    }
    table_end_row();
}

void check_mm_da(void)
{
    table_head("D/A: driver dmm32at, 12 bit (here the card's output is what is checked)",
        "comedi, 0..4095", "output, codes");
    for (unsigned ch = 0; ch < 4; ch++) {
        table_row("D/A %u", ch);
        for (uint32_t code = 0; code < 4096; code += 13) {
            put(MM, MM_AO, ch, code);
            table_value(code, code, pin(PIN_MM_DA + ch));
        }
        put(MM, MM_AO, ch, 4095 - ch);
        for (unsigned other = 0; other <= ch; other++) {
            table_value(4095 - other, 4095 - other, pin(PIN_MM_DA + other));
        }
        table_end_row();
    }
}

void check_mm_lines(void)
{
    table_head(
        "Lines: driver dmm32at, its 8255, three ports as outputs", "ports A, B, C", "comedi");
    for (unsigned ch = 0; ch < 24; ch += 4) {
        config(MM, MM_DIO, ch, 1, INSN_CONFIG_DIO_OUTPUT, 0, 0);
    }
    table_row("24 lines");
    for (uint32_t i = 0; i < 256; i++) {
        const uint32_t v = i * 65793u * 3u & 0xFFFFFF;
        const uint32_t got = lines(MM, MM_DIO, 0xFFFFFF, v);
        const uint32_t at =
            (uint32_t)(pin(PIN_MM_PORT) | pin(PIN_MM_PORT + 1) << 8 | pin(PIN_MM_PORT + 2) << 16);
        table_value(at, v, got);
        table_value(at, v, at);
    }
    table_end_row();
}
