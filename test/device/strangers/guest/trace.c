/* SPDX-License-Identifier: MIT */
/* The short sequences of golden traces: one thing each, with pins that are set here. */
#include "check.h"
#include "linux.h"
#include "pin.h"

void mark(unsigned n) { outl(n, MARK_PORT); }

/* test/device/emu/linux_test.c sets the same pins. */
static void set_pins(void)
{
    set_pin(PIN_ENC + 1, 0);
    set_pin(PIN_AD, 1234567);
    set_pin(PIN_AD + 1, -7654321);
    for (unsigned ch = 0; ch < 22; ch++) {
        set_pin(PIN_GLOVE + ch, 370000 * (int32_t)ch - 4000000);
    }
    set_pin(PIN_GLOVE + 5, 2500000);
    set_pin(PIN_GLOVE + 21, -3000000);
    set_pin(PIN_DIN, 0xA5);
}

static void s526_traces(void)
{
    mark(3);
    config(A, GPCT, 1, 3, INSN_CONFIG_GPCT_QUADRATURE_ENCODER, 0x0480, 0);
    mark(0);
    set_pin(PIN_ENC + 1, -1234567);
    mark(4);
    (void)get(A, GPCT, 1, 0);
    mark(5);
    (void)get(A, S526_AI, 0, 0);
    (void)get(A, S526_AI, 0, 0);
    (void)get(A, S526_AI, 1, 0);
    (void)get(A, S526_AI, 3, 0);
    mark(6);
    put(A, S526_AO, 2, 0x9ABC);
    mark(7);
    config(A, S526_DIO, 4, 1, INSN_CONFIG_DIO_OUTPUT, 0, 0);
    (void)lines(A, S526_DIO, 0xF0, 0x60);
    (void)lines(A, S526_DIO, 0, 0);
    mark(0);
}

static void mm_traces(void)
{
    mark(8);
    (void)get(MM, MM_AI, 5, 2);
    (void)get(MM, MM_AI, 21, 3);
    mark(11);
    (void)mm_scan(1);
    mark(12);
    (void)mm_scan(2);
    mark(9);
    put(MM, MM_AO, 3, 0xABC);
    mark(10);
    config(MM, MM_DIO, 0, 1, INSN_CONFIG_DIO_OUTPUT, 0, 0);
    (void)lines(MM, MM_DIO, 0xFF, 0x5A);
    mark(0);
}

void traces(void)
{
    set_pins();
    s526_traces();
    mm_traces();
}
