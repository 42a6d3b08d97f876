/* SPDX-License-Identifier: MIT */
/* Sensoray 526: four 24-bit quadrature counters, eight A/D and four D/A channels of 16 bits,
 * eight digital lines. Sequences and sources: docs/CARDS.md.
 *
 * Codes are nominal: D/A 32768 + 3249/V, A/D 32768 per 10 V; what the card's own calibration
 * changes is applied here. A nominal card's codes pass unchanged, all of them.
 */
#ifndef CARDS_S526_H
#define CARDS_S526_H

#include "fault.h"

#include <stdint.h>

#define EXH_S526_AXES    4 /* counters; as many D/A channels */
#define EXH_S526_AD      8
#define EXH_S526_DA_ZERO 32768
#define EXH_S526_DA_PERV 3249

/* What is not certain about the card, and how much it may take. */
struct exh_s526_par {
    uint8_t settle;      /* 1: the A/D waits for its inputs before each scan */
    uint8_t nominal;     /* 1: nominal values where the EEPROM's are garbage */
    uint8_t da_check;    /* 1: updates must be reported done */
    uint8_t line_check;  /* 1: pins of outputs must read as written */
    uint8_t quad_check;  /* 1: one counter's quadrature error is looked at a tick */
    uint8_t turns;       /* 1: what can wait takes turns (see below) */
    uint16_t quad_limit; /* so many may a counter have; more are a fault */
    uint16_t ad_wait_us; /* longest wait for a scan, 1 .. 60000 */
    uint16_t da_wait_us; /* for an update */
    uint16_t ee_wait_us; /* for a word of the EEPROM */
    uint16_t noise_raw;  /* ten conversions of a reference lie within so many codes */
};
#define EXH_S526_PAR_DEFAULT \
    { \
        .settle = 1, .nominal = 0, .da_check = 1, .line_check = 1, .quad_check = 1, .turns = 0, \
        .quad_limit = 16, .ad_wait_us = 500, .da_wait_us = 200, .ee_wait_us = 10000, \
        .noise_raw = 64 \
    }

/* With turns, a tick needs fewer accesses:
 * - A scan converts one channel of the mask, the next one at each start; the first scan converts
 *   all.
 * - Only the low words of counters are read, which latches them. The rest follows from the last
 *   count, for steps up to +-32767. A tick checks one high word or one quadrature error in turn, so
 *   each of both once in 2 * axes ticks. An unexpected high word is a fault.
 * - Lines are written when they change, and after each EXH_S526_LINES_EVERY writes. */
#define EXH_S526_LINES_EVERY 16

/* Nominal codes to this card's, and back. */
/* code = 32768 + zero + gain (nominal - 32768) */
struct exh_s526_da {
    int32_t gain_q30;
    int32_t zero_raw_q14;
};
/* nominal = gain (code - zero) */
struct exh_s526_ad {
    int32_t gain_q30;
    int32_t zero_raw_q14;
};

/* Who it is, and what its calibration said. */
struct exh_s526_id {
    uint16_t signature; /* 0x526A or 0x526B */
    uint8_t nominal;    /* bit k: D/A k has nominal values, bit 4: Vref has */
    struct exh_s526_da da[EXH_S526_AXES];
    struct exh_s526_ad ad;
    int64_t vref_V_q32;
    int32_t c0_sum, c10_sum; /* ten conversions of each reference */
};

struct exh_s526 {
    uint16_t base;
    uint32_t ad_mask;                    /* bit k: channel k is scanned */
    uint8_t live;                        /* its signature was seen: its outputs may be written */
    volatile uint8_t lines;              /* pins 4..7 as last written */
    uint8_t lines_off;                   /* what they are when all is off */
    uint8_t da_sent;                     /* updates since one was last reported done */
    uint8_t quad_next;                   /* counter to be looked at next */
    uint8_t ad_first;                    /* no scan was begun */
    uint8_t lines_kept;                  /* writes of lines left out in a row */
    uint8_t counted;                     /* bit: axis whose count is known */
    uint32_t ad_now;                     /* channels of the scan that runs */
    uint32_t count[EXH_S526_AXES];       /* 24 bits, as last read */
    uint16_t da_zero_raw[EXH_S526_AXES]; /* its codes of 0 V */
    uint32_t quad[EXH_S526_AXES];        /* illegal transitions captured */
    struct exh_s526_par par;
    struct exh_s526_id id;
};

/* Is there such a card? One read; *got: what it gave. */
int exh_s526_is_there(uint16_t base, uint16_t *got);

/* Finds, tests and calibrates the card at base; outputs off, counters 0 and counting x4.
 * ad_mask: channels of a scan; lines_off: levels of pins 4..7 when off. 0, -EXH_E_ABSENT
 * (no card, another card) or -EXH_E_IO with *f. */
int exh_s526_open(struct exh_s526 *s, uint16_t base, unsigned ad_mask, unsigned lines_off,
    const struct exh_s526_par *par, struct exh_card_fault *f);

/* --- of a tick; the number of accesses in brackets --- */

uint32_t exh_s526_count(const struct exh_s526 *s, unsigned axis); /* 24 bits (2) */
uint32_t exh_s526_follow(struct exh_s526 *s, unsigned axis);      /* the same (2; with turns 1) */

/* One counter's quadrature error, the next one's at each call, axes 0 .. axes-1 (1, and 1 if
 * there was one). With turns, in between one counter's high word, which must be that of its last
 * count. */
int exh_s526_check(struct exh_s526 *s, unsigned axes, struct exh_card_fault *f);

int exh_s526_alive(const struct exh_s526 *s, struct exh_card_fault *f); /* (1) */

/* Pins 0..7 as they are (1). */
int exh_s526_lines(const struct exh_s526 *s, uint8_t *pins, struct exh_card_fault *f);

void exh_s526_ad_start(struct exh_s526 *s); /* a scan (1) */
/* Its end, and nominal codes of its channels to code[channel], others as they were (2 + polls
 * beyond the first, then 2 a channel less 1). */
int exh_s526_ad_read(struct exh_s526 *s, int16_t *code, struct exh_card_fault *f);

void exh_s526_da_put(const struct exh_s526 *s, unsigned channel, uint16_t nominal); /* (2) */
void exh_s526_da_start(struct exh_s526 *s);                  /* all that were put (1) */
void exh_s526_lines_put(struct exh_s526 *s, unsigned lines); /* pins 4..7 (1; with turns 0) */

/* Lines off, D/A at 0 V, of those of n cards that are live, from anywhere, between any two
 * accesses of the others. */
#define EXH_S526_SAFE_ACCESSES 20 /* a card */
void exh_s526_safe(struct exh_s526 *s, unsigned n);

/* --- seen by tests --- */

/* Four words of the EEPROM, an IEEE 754 double, as fixed point with frac bits behind the point,
 * rounded half away from zero. 0, or -EXH_E_RANGE: no number, or beyond 2^62. */
int exh_s526_double(const uint16_t word[4], unsigned frac, int64_t *value);
uint16_t exh_s526_da_code(const struct exh_s526_da *da, uint16_t nominal);
int16_t exh_s526_ad_code(const struct exh_s526_ad *ad, int16_t code);

#endif
