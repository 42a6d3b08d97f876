/* SPDX-License-Identifier: MIT */
/* PCI configuration space, by the two ports of every PC. */
#ifndef PC104_PCI_H
#define PC104_PCI_H

#include <stdint.h>

struct pc104_pci {
    uint8_t bus, dev, fn;
    uint8_t begun;
};

/* registers, in bytes */
enum {
    PC104_PCI_ID = 0x00,
    PC104_PCI_COMMAND = 0x04,
    PC104_PCI_CLASS = 0x08,
    PC104_PCI_BAR0 = 0x10,
    PC104_PCI_BAR1 = 0x14
};

int pc104_pci_there(void); /* 1: the ports answer */
/* All functions there are, one after the other; *at starts as zeros. 0 at the end. */
int pc104_pci_next(struct pc104_pci *at);
uint32_t pc104_pci_get(struct pc104_pci at, unsigned reg);
void pc104_pci_put(struct pc104_pci at, unsigned reg, uint32_t value);
/* The offset of the capability with this number; 0: none. */
unsigned pc104_pci_capability(struct pc104_pci at, unsigned number);

#endif
