/* SPDX-License-Identifier: MIT */
/* Pins as wiring.tsv has them: their level first, then their direction. */
#include "stm.h"

enum { IN = 0, OUT = 1, AF = 2, ANALOG = 3 };
enum { NONE = 0, UP = 1, DOWN = 2 };

#define ROW(net, port, pin, mode, function, pull, high) {port, pin, mode, function, pull, high},
static const struct {
    uint8_t port, pin, mode, function, pull, high;
} row[] = {WIRING(ROW)};

static void put(uint32_t address, unsigned at, unsigned bits, uint32_t value)
{
    const uint32_t mask = (1u << bits) - 1u;
    REG(address, 0) = (REG(address, 0) & ~(mask << at)) | value << at;
}

void stm_pins_open(void)
{
    REG(BASE_RCC, RCC_AHB1ENR) |=
        RCC_AHB1ENR_GPIOAEN | RCC_AHB1ENR_GPIOBEN | RCC_AHB1ENR_GPIOCEN | RCC_AHB1ENR_GPIODEN;
    (void)REG(BASE_RCC, RCC_AHB1ENR); /* a clock takes two cycles to come */
    for (unsigned i = 0; i < sizeof row / sizeof row[0]; i++) {
        const uint32_t base = GPIO_BASE(row[i].port), pin = row[i].pin;
        REG(base, GPIO_BSRR) = (row[i].high ? 1u : 0x10000u) << pin;
        put(base + GPIO_PUPDR, 2 * pin, 2, row[i].pull);
        put(base + GPIO_OSPEEDR, 2 * pin, 2, row[i].mode == AF ? 2u : 0u);
        put(base + (pin < 8 ? GPIO_AFRL : GPIO_AFRH), 4 * (pin & 7u), 4, row[i].function);
        put(base + GPIO_MODER, 2 * pin, 2, row[i].mode);
    }
}
