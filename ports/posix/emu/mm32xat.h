/* SPDX-License-Identifier: MIT */
/* Diamond MM-32X-AT, register by register: 32 A/D inputs with a scan into a FIFO, four 12-bit D/A
 * outputs, digital lines, and a counter/timer that may pace the scans. It has no clock: every call
 * passes the time, and the card first does what is due. Registers have 8 bits; a 16-bit access is
 * two of them, lower port first. Where sources are silent or disagree, emu_mm32xat_config has a
 * field. */
#ifndef EMU_MM32XAT_H
#define EMU_MM32XAT_H

#include "pins.h"

#include <stdint.h>

#define EMU_MM_PORTS 16
#define EMU_MM_FIFO  1024

enum emu_latch {
    EMU_LATCH_READ,   /* a sample is the pin's voltage when read, whenever converted */
    EMU_LATCH_CONVERT /* a sample is what stood on the pin when it was converted */
};

struct emu_mm32xat_config {
    uint16_t base;
    uint8_t present;
    uint8_t latch;        /* enum emu_latch */
    uint8_t intrst_page0; /* 1: a write of INTRST selects page 0; 0: leaves the page */
    uint8_t empty_last;   /* 1: an empty FIFO reads as its last sample; 0: as 0xFF */
    uint8_t din;          /* DIN3..0 and the user jumper */
    uint8_t revision;     /* of the FPGA */
    uint32_t scan_ns[4];  /* SCINT 0..3: from channel to channel */
    uint32_t convert_ns;  /* a single conversion */
    uint32_t wait_ns;     /* WAIT, after a change of channel or range */
    uint32_t dac_ns;      /* DACBUSY */
    uint32_t reset_ns;    /* after RESETA or RESETD nothing is taken */
    uint8_t eeprom[128];
};

/* A card as delivered, absent. */
struct emu_mm32xat_config emu_mm32xat_nominal(void);

struct emu_mm32xat_wrong {
    uint8_t busy;     /* STS, WAIT and DACBUSY stay 1, no scan ends */
    uint8_t lost;     /* of every scan one conversion is lost */
    uint8_t overflow; /* conversions of another program fill the FIFO at every scan */
    uint8_t read;     /* another program reads between the reads of one value */
    uint8_t da_dead;  /* transfers never end up in an output */
    uint8_t eeprom;   /* bytes are noise */
};

struct emu_mm32xat {
    struct emu_mm32xat_config cfg;
    uint8_t reg[12]; /* as last written: low, high, D/A low byte, threshold, ... */
    uint8_t page, enhanced, channel, port[4], counter_low[3], counter_half, flags;
    uint8_t ee_address, ee_data;
    uint16_t counter[3];
    uint8_t counter_rw[3];
    int16_t code[EMU_MM_FIFO];
    uint8_t from[EMU_MM_FIFO]; /* channel */
    uint16_t head, depth;
    uint8_t overflow;
    int16_t popped;          /* the sample whose high byte is at base + 1 */
    uint8_t settled_channel; /* what the input shows while it has not settled */
    uint16_t scan_left;      /* conversions of the scan in progress */
    uint8_t lost_of_scan;
    uint64_t next_ns;                            /* its next conversion */
    uint64_t wait_ns, dac_ns, reset_ns, pace_ns; /* until; pace: next trigger, 0: none */
    uint16_t da_moved[4], da_out[4];
    uint32_t noise;
};

void emu_mm32xat_reset(struct emu_mm32xat *c, const struct emu_mm32xat_config *cfg);

/* Everything due up to now_ns. */
void emu_mm32xat_advance(struct emu_mm32xat *c, const struct emu_pins *pins,
    const struct emu_mm32xat_wrong *w, uint64_t now_ns);

uint8_t emu_mm32xat_in(struct emu_mm32xat *c, const struct emu_pins *pins,
    const struct emu_mm32xat_wrong *w, unsigned offset, uint64_t now_ns);
void emu_mm32xat_out(struct emu_mm32xat *c, const struct emu_pins *pins,
    const struct emu_mm32xat_wrong *w, unsigned offset, uint8_t value, uint64_t now_ns);

#endif
