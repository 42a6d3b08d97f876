/* SPDX-License-Identifier: MIT */
/* Emu: the cards of the device on a bus, two Sensoray 526 and a Diamond MM-32X-AT, and their
 * possible faults. Written from facts about the cards (docs/CARDS.md), not from the drivers.
 * Integers only, no allocation, no globals, nothing but mem*() from outside. The same code runs in
 * the host program, inside a test image and in an emulator of the machine.
 *
 * Each access takes a stated time on the bus and acts at its end. D/A outputs change at the write
 * that starts the update. A/D inputs of an S526 are held at the write that starts the conversion,
 * counters at the read of the low word. Inputs of the DMM are held as emu_mm32xat_config.latch
 * says. */
#ifndef EMU_H
#define EMU_H

#include "mm32xat.h"
#include "pins.h"
#include "s526.h"

#include <stdint.h>

enum emu_card { EMU_S526_A, EMU_S526_B, EMU_MM32XAT, EMU_CARDS };

/* of a driver: who runs it says which */
enum emu_phase {
    EMU_PHASE_DETECT,
    EMU_PHASE_SELF_TEST,
    EMU_PHASE_CALIBRATE,
    EMU_PHASE_READ,  /* of a tick */
    EMU_PHASE_WRITE, /* of a tick */
    EMU_PHASE_SAFE,
    EMU_PHASES
};

enum emu_kind {
    EMU_WELL,
    EMU_ABSENT,     /* reads all ones, takes nothing, drives nothing */
    EMU_BUSY,       /* whatever is started never ends */
    EMU_LOST,       /* a conversion is lost */
    EMU_OVERFLOW,   /* the FIFO runs over */
    EMU_READ_ORDER, /* another program reads between the reads of one value: wrong data */
    EMU_LINE_STUCK, /* encoder line A */
    EMU_LINE_NOISY, /* encoder line A */
    EMU_DA_DEAD,    /* D/A never updates, and never says that it has */
    EMU_DA_MUTE,    /* D/A never updates, but says that it has */
    EMU_EEPROM,     /* noise instead of words */
    EMU_KINDS
};

struct emu_fault {
    uint8_t kind;   /* enum emu_kind */
    uint8_t card;   /* enum emu_card */
    uint8_t axis;   /* encoder */
    uint8_t phase;  /* enum emu_phase: it begins with an access of this card in such a phase, */
    uint32_t after; /* after so many of them; it then stays */
    uint32_t times; /* EMU_LOST of an S526: so many conversions; 0: all */
};

struct emu_config {
    struct emu_s526_config s526[EMU_S526S];
    struct emu_mm32xat_config mm;
    uint32_t access8_ns, access16_ns; /* on the bus */
    struct emu_fault fault;
};

/* The box as it is wired: S526 at 0x2C0 and 0x280, DMM at 0x300, all nominal, nothing wrong,
 * an access 1 us. */
struct emu_config emu_box_config(void);

struct emu_box {
    struct emu_s526 s526[EMU_S526S];
    struct emu_mm32xat mm;
    struct emu_pins pins;
    uint64_t time_ns;
    uint32_t accesses;
    uint32_t in_phase[EMU_PHASES]; /* of these, of the card with the fault */
    uint32_t access8_ns, access16_ns;
    struct emu_fault fault;
    uint8_t phase, wrong; /* wrong: the fault has begun */
    uint32_t lost;        /* conversions */
};

/* Power on at 1 ms, all pins at 0. */
void emu_box_open(struct emu_box *b, const struct emu_config *c);

/* An access of 1 or 2 bytes. Where no card is: all ones. */
uint32_t emu_in(struct emu_box *b, uint16_t port, unsigned width_B);
void emu_out(struct emu_box *b, uint16_t port, unsigned width_B, uint32_t value);

void emu_advance_ns(struct emu_box *b, uint64_t ns);

/* From now on nothing takes time: a simulation in which a tick is an instant gives the same bits
 * with the cards and without. */
void emu_hasten(struct emu_box *b);

/* What the driver does now. */
void emu_enter(struct emu_box *b, enum emu_phase phase);

/* "absent", "detect", "S526 A"; never NULL. */
const char *emu_kind_text(unsigned kind);
const char *emu_phase_text(unsigned phase);

#endif
