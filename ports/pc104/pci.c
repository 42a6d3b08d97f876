/* SPDX-License-Identifier: MIT */
#include "pci.h"

#include "io.h"

enum { ADDRESS = 0xCF8, DATA = 0xCFC };
enum { STATUS_HAS_LIST = 1u << 20, LIST = 0x34, HEADER = 0x0C };
#define ENABLE       0x80000000u
#define NOBODY       0xFFFFFFFFu
#define SEVERAL      (1u << 23) /* functions, in HEADER */
#define CAPABILITIES 48u        /* the list has no room for more: a longer one is a loop */

static uint32_t address(struct pc104_pci at, unsigned reg)
{
    return ENABLE | (uint32_t)at.bus << 16 | (uint32_t)at.dev << 11 | (uint32_t)at.fn << 8 |
           (reg & 0xFCu);
}

uint32_t pc104_pci_get(struct pc104_pci at, unsigned reg)
{
    pc104_out32(ADDRESS, address(at, reg));
    return pc104_in32(DATA);
}

void pc104_pci_put(struct pc104_pci at, unsigned reg, uint32_t value)
{
    pc104_out32(ADDRESS, address(at, reg));
    pc104_out32(DATA, value);
}

int pc104_pci_there(void)
{
    pc104_out32(ADDRESS, ENABLE);
    return pc104_in32(ADDRESS) == ENABLE;
}

/* The next place where something may be; 0 behind the last. */
static int step(struct pc104_pci *at)
{
    struct pc104_pci first = *at;
    first.fn = 0;
    if (at->fn < 7 && pc104_pci_get(first, PC104_PCI_ID) != NOBODY &&
        (pc104_pci_get(first, HEADER) & SEVERAL)) {
        at->fn++;
        return 1;
    }
    at->fn = 0;
    at->dev = (uint8_t)((at->dev + 1) % 32);
    if (at->dev == 0) { at->bus++; }
    return at->dev != 0 || at->bus != 0;
}

int pc104_pci_next(struct pc104_pci *at)
{
    for (;;) {
        if (at->begun && !step(at)) { return 0; }
        at->begun = 1;
        if (pc104_pci_get(*at, PC104_PCI_ID) != NOBODY) { return 1; }
    }
}

unsigned pc104_pci_capability(struct pc104_pci at, unsigned number)
{
    unsigned reg;
    if (!(pc104_pci_get(at, PC104_PCI_COMMAND) & STATUS_HAS_LIST)) { return 0; }
    reg = pc104_pci_get(at, LIST) & 0xFCu;
    for (unsigned n = 0; n < CAPABILITIES && reg >= 0x40; n++) {
        const uint32_t head = pc104_pci_get(at, reg);
        if ((head & 0xFFu) == number) { return reg; }
        reg = head >> 8 & 0xFCu;
    }
    return 0;
}
