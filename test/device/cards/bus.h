/* SPDX-License-Identifier: MIT */
/* A scripted bus: what a driver writes is taken down, what it reads is what the script says. As
 * much of the cards as the drivers' sequences touch and no more; the emulators, which know the
 * cards and not the drivers, are elsewhere. */
#ifndef TEST_CARDS_BUS_H
#define TEST_CARDS_BUS_H

#include <stdint.h>

struct access {
    char op; /* r, w: 16 bits; i, o: 8 bits */
    uint16_t port, value;
};

struct fake_s526 {
    uint16_t base;      /* 0: no card */
    uint16_t signature; /* 0x526A */
    uint16_t isr;
    uint16_t mute; /* flags that never come */
    uint16_t late; /* so many reads of ISR before A/D's flag */
    uint16_t wait;
    uint32_t settle_us, channel_us, done_us; /* 0, 0: immediately */
    uint16_t ee[64], ee_at;
    int16_t ad[10];   /* what channels and references read */
    int16_t ad_noise; /* references alternate by it */
    uint16_t ad_select, ad_converted[10];
    uint16_t da_select, da_put[4], da_out[4];
    unsigned updates;
    uint32_t count[4], latch[4], preload[4][2];
    uint32_t count_stuck; /* bits of counters that read 0 */
    uint16_t mode[4], mode_stuck;
    uint8_t ecap[4], ecap_set[4]; /* ecap_set: set again when cleared */
    uint16_t dio;
    uint8_t pins;       /* inputs 0..3 */
    uint8_t pins_stuck; /* outputs that read 1 whatever is written */
};

struct fake_mm {
    uint16_t base; /* 0: no card */
    uint8_t reg[16];
    uint8_t misc;                  /* what register 8 reads when idle: 0x60 */
    uint8_t busy, busy_for, stuck; /* reads of register 8 that a scan lasts */
    uint8_t settle_for, settle, settle_stuck;
    uint32_t sample_us, done_us;
    int16_t in[32];
    int16_t fifo[1024];
    unsigned samples, read, drop, more; /* drop, more: samples of the next scans */
    uint8_t overflow, half;
    unsigned scans;
};

#define BUS_LOG 4096

struct bus {
    struct access log[BUS_LOG];
    unsigned n; /* accesses since bus_clear(); the log has the first BUS_LOG */
    uint32_t time_us, access_us;
    uint8_t stopped;               /* time does not advance */
    unsigned dead_card, dead_from; /* from this access on it is empty ports; 3: none */
    unsigned safe_at;              /* exh_box_safe() comes before this access; UINT_MAX: never */
    unsigned hot;                  /* accesses after it at which an output was not safe */
    struct fake_s526 s526[2];
    struct fake_mm mm;
};
extern struct bus bus;

/* Cards in order at the default bases, nominal EEPROMs, pins healthy. */
void bus_reset(void);
void bus_clear(void); /* the log alone */

/* The log from access i on as text, "w 2C6 8025, r 2D2, ": compare with what was expected. */
int bus_said(unsigned i, const char *want);

/* A double at a word of an EEPROM: sign * mantissa * 2^exponent, exactly. */
void bus_double(uint16_t *word, int negative, uint64_t mantissa, int exponent);

/* D/A at 0 A and output pins at their off level, of each board that is there and not dead. */
int bus_safe(void);

#endif
