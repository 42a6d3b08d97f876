/* SPDX-License-Identifier: MIT */
/* The Sensoray 526 through Linux. What a pin's voltage is in codes is worked out here anew, by
 * division of 64-bit integers, not with the emulator's functions. */
#include "check.h"
#include "linux.h"
#include "pin.h"
#include "table.h"

#include <stdio.h>

#define X1 0x0080u
#define X2 0x0280u
#define X4 0x0480u

static const char board[] = "AB";

static uint32_t state = 1;

static int32_t random_in(int32_t lo, int32_t hi)
{
    state = state * 1664525u + 1013904223u;
    return lo + (int32_t)((uint64_t)(state >> 4) * ((uint32_t)(hi - lo) + 1u) >> 28);
}

static int64_t floor_div(int64_t n, int64_t d) { return n / d - (n % d < 0); }

/* 10 V / 32768 a code, nearest, limited; then as comedi has it, from 0. */
static int64_t ad_code(int32_t v_uV)
{
    const int64_t code = floor_div(v_uV * INT64_C(2) * 32768 + 10000000, 2 * 10000000);
    return (code < -32768 ? -32768 : code > 32767 ? 32767 : code) + 32768;
}

static void start_counter(unsigned card, unsigned axis, uint32_t mode)
{
    config(card, GPCT, axis, 3, INSN_CONFIG_GPCT_QUADRATURE_ENCODER, mode, 0);
}

/* Steps of a mode since the encoder stood at `from`, modulo 2^24. */
static uint32_t steps(int32_t enc_cnt, int32_t from_cnt, int32_t cnt_per_step)
{
    return (uint32_t)(floor_div(enc_cnt, cnt_per_step) - floor_div(from_cnt, cnt_per_step)) &
           0xFFFFFF;
}

static void check_counter(unsigned card, unsigned axis, uint32_t mode, int32_t cnt_per_step)
{
    static const int32_t far_cnt[] = {0, 1, -1, 3, -5, 65535, 65536, -65537, 0x7FFFFF, 0x800000,
        -0x800000, 0xFFFFFF, 0x1000000, -0x1000001, 200000000, 512};
    const uint32_t n = PIN_ENC + 4 * card + axis;
    const int32_t from_cnt = 1000 * (int32_t)axis - 777;
    int32_t at = from_cnt;
    set_pin(n, from_cnt);
    start_counter(card, axis, mode);
    table_row("%c counter %u, x%d", board[card], axis, 4 / cnt_per_step);
    for (unsigned i = 0; i < sizeof far_cnt / sizeof far_cnt[0]; i++) {
        set_pin(n, from_cnt + far_cnt[i]);
        table_value(pin(n), steps(pin(n), from_cnt, cnt_per_step), get(card, GPCT, axis, 0));
    }
    for (int i = 0; i < 250; i++) {
        at += random_in(-5000, 5000);
        set_pin(n, at);
        table_value(pin(n), steps(pin(n), from_cnt, cnt_per_step), get(card, GPCT, axis, 0));
    }
    table_end_row();
}

void check_counters(void)
{
    table_head("Counters: driver s526, counts since INSN_CONFIG_GPCT_QUADRATURE_ENCODER",
        "encoder, counts x4", "comedi, modulo 2^24");
    for (unsigned card = A; card <= B; card++) {
        for (unsigned axis = 0; axis < 4; axis++) { check_counter(card, axis, X4, 1); }
    }
    check_counter(A, 0, X2, 2);
    check_counter(A, 0, X1, 4);
}

void check_s526_ad(void)
{
    table_head(
        "A/D: driver s526, channels 0 and 1 and the references", "input, uV", "comedi, 0..65535");
    for (unsigned card = A; card <= B; card++) {
        for (unsigned ch = 0; ch < 2; ch++) {
            const uint32_t n = PIN_AD + 8 * card + ch;
            table_row("%c A/D %u", board[card], ch);
            for (int32_t v_uV = -10100000; v_uV <= 10100000; v_uV += 50101) {
                set_pin(n, v_uV + random_in(0, 999));
                table_value(pin(n), ad_code(pin(n)), get(card, S526_AI, ch, 0));
            }
            table_end_row();
        }
        table_row("%c A/D 8, reference", board[card]); /* 9.921875 V is what the EEPROM says */
        table_value(9921875, ad_code(9921875), get(card, S526_AI, 8, 0));
        table_end_row();
        table_row("%c A/D 9, 0 V", board[card]);
        table_value(0, ad_code(0), get(card, S526_AI, 9, 0));
        table_end_row();
    }
}

/* 3249 codes a volt from 32768. */
static int64_t da_uV(uint32_t code)
{
    return floor_div(((int64_t)code - 32768) * 2000000 + 3249, 2 * 3249);
}

void check_s526_da(void)
{
    table_head(
        "D/A: driver s526 (here the pin is what is checked)", "comedi, 0..65535", "output, uV");
    for (unsigned card = A; card <= B; card++) {
        for (unsigned ch = 0; ch < 4; ch++) {
            table_row("%c D/A %u", board[card], ch);
            for (uint32_t code = 0; code <= 65535; code += code == 65520 ? 15 : 240) {
                put(card, S526_AO, ch, code);
                table_value(code, da_uV(code), pin(PIN_DA + 4 * card + ch));
            }
            put(card, S526_AO, ch, 32768 + 1000 * ch);
            for (unsigned other = 0; other <= ch; other++) { /* the others kept theirs */
                table_value(32768 + 1000 * other, da_uV(32768 + 1000 * other),
                    pin(PIN_DA + 4 * card + other));
            }
            table_end_row();
        }
    }
}

/* Lines 0..3 are inputs, 4..7 outputs, as in the box; then all inputs. */
void check_s526_lines(void)
{
    table_head("Lines: driver s526, 0..3 inputs, 4..7 outputs", "pins", "comedi");
    for (unsigned card = A; card <= B; card++) {
        config(card, S526_DIO, 0, 1, INSN_CONFIG_DIO_INPUT, 0, 0);
        config(card, S526_DIO, 4, 1, INSN_CONFIG_DIO_OUTPUT, 0, 0);
        table_row("%c lines, read", board[card]);
        for (int32_t v = 0; v < 256; v++) {
            set_pin(PIN_DIN + card, v);
            (void)lines(card, S526_DIO, 0xF0, (uint32_t)v * 7u & 0xF0u);
            table_value((v & 0x0F) | pin(PIN_DOUT + card), (v & 0x0F) | (v * 7 & 0xF0),
                lines(card, S526_DIO, 0, 0));
        }
        table_end_row();
        table_row("%c lines, written", board[card]);
        for (uint32_t v = 0; v < 256; v++) {
            (void)lines(card, S526_DIO, 0xFF, v);
            table_value(v & 0xF0, v & 0xF0, pin(PIN_DOUT + card));
        }
        table_end_row();
        config(card, S526_DIO, 4, 1, INSN_CONFIG_DIO_INPUT, 0, 0);
        table_row("%c lines, all inputs", board[card]);
        for (int32_t v = 0; v < 256; v++) {
            set_pin(PIN_DIN + card, v);
            table_value(v, v, lines(card, S526_DIO, 0, 0));
        }
        table_end_row();
    }
}
