/* SPDX-License-Identifier: MIT */
/* Sensoray Model 526, register by register: four 24-bit quadrature counters, eight A/D inputs with
 * two references, four D/A outputs, eight digital lines, an EEPROM of calibration values. It has no
 * clock: every call passes the time, and the card first does what is due. Accesses have 16 bits at
 * even offsets; others read all ones and write nothing. Where sources are silent, emu_s526_config
 * has a field. */
#ifndef EMU_S526_H
#define EMU_S526_H

#include "pins.h"

#include <stdint.h>

#define EMU_S526_PORTS   0x40
#define EMU_S526_WORDS   64
#define EMU_S526_REF_0V  9 /* A/D channels behind the eight inputs */
#define EMU_S526_REF_10V 8

struct emu_s526_config {
    uint16_t base;
    uint16_t signature; /* 0x526A or 0x526B */
    uint8_t present;
    uint32_t settle_ns;  /* A/D: settling, if commanded, */
    uint32_t convert_ns; /* each channel, */
    uint32_t update_ns;  /* D/A update: until the flag; the output changes immediately */
    uint32_t eeprom_ns;  /* one word */
    int32_t ref_V_q16;   /* the A/D's reference */
    int32_t ad_gain_q16; /* the A/D as it is: code = gain * nominal + offset */
    int32_t ad_offset_raw;
    int32_t da_gain_q16[EMU_AXES]; /* the D/A as it is: codes per volt, and the code of 0 V */
    int32_t da_zero_q16[EMU_AXES];
    uint16_t eeprom[EMU_S526_WORDS];
};

/* A card without errors, absent; both references are exact in codes and in binary. */
struct emu_s526_config emu_s526_nominal(void);

/* Makes the EEPROM say what the card is: D/A gains and zeros, reference. */
void emu_s526_describe(struct emu_s526_config *c);

/* Faults inside the card, now. */
struct emu_s526_wrong {
    uint8_t busy;                   /* no operation ever says done */
    uint8_t lost;                   /* the next start of the A/D is not taken */
    uint8_t read;                   /* another program reads between the reads of one value */
    uint8_t line_stuck, line_noisy; /* bit n: line A of encoder n */
    uint8_t da_dead;                /* updates change nothing and are not said to be done */
    uint8_t da_mute;                /* updates are said to be done but change nothing */
    uint8_t eeprom;                 /* words are noise */
};

struct emu_s526_counter {
    uint16_t mode, high; /* high: word of a preload, until its low word */
    uint16_t held;       /* bits 6..12 of the control word */
    uint8_t flags;       /* bits 0..3 of the status word */
    uint8_t loads;
    uint32_t preload[2];
    uint32_t count, latch; /* modulo 2^24 */
    int32_t seen;          /* the lines' place when last counted, in its own steps */
    int32_t stuck_cnt;     /* the encoder's place when its line stuck */
    uint8_t was_stuck;
};

struct emu_s526 {
    struct emu_s526_config cfg;
    struct emu_s526_counter counter[EMU_AXES];
    uint16_t tcr, wdc, dac, adc, dio, ier, isr, msc, eed;
    uint16_t da_preload[EMU_AXES], da_code[EMU_AXES];
    int16_t ad_pending[10], ad_result[10];
    uint16_t ad_channels; /* bit: channel of the conversion in progress */
    uint64_t ad_done_ns, da_done_ns, eeprom_done_ns; /* 0: nothing in progress */
    uint16_t eeprom_word;
    uint32_t noise; /* state of a generator */
};

void emu_s526_reset(
    struct emu_s526 *c, const struct emu_s526_config *cfg, struct emu_pins *pins, unsigned card);

uint16_t emu_s526_in(struct emu_s526 *c, struct emu_pins *pins, unsigned card,
    struct emu_s526_wrong *w, unsigned offset, uint64_t now_ns);
void emu_s526_out(struct emu_s526 *c, struct emu_pins *pins, unsigned card,
    struct emu_s526_wrong *w, unsigned offset, uint16_t value, uint64_t now_ns);

/* Without power: no output, no line driven. */
void emu_s526_dark(struct emu_pins *pins, unsigned card);

#endif
