/* Sensoray 526: four 24-bit quadrature counters, eight A/D and four D/A channels of 16 bits,
 * eight digital lines. Sequences and sources: docs/CARDS.md. */
#ifndef CARDS_S526_H
#define CARDS_S526_H

#include "fault.h"

#include <stdint.h>

#define EXH_S526_AXES 4 /* counters; as many D/A channels */
#define EXH_S526_AD   8

/* What is not certain about the card, and how much it may take. */
struct exh_s526_par {
    uint8_t settle;        /* 1: the A/D waits for its input before each scan    */
    uint8_t nominal;       /* 1: nominal values where the EEPROM's are garbage   */
    uint8_t da_check;      /* 1: the flag of a done update is looked at each tick */
    uint8_t quad_check;    /* 1: one counter's captured quadrature error a tick  */
    uint16_t quad_limit;   /* illegal transitions a counter may have, then it is a fault */
    uint16_t ad_wait_us;   /* longest wait for a scan                            */
    uint16_t da_wait_us;   /* for an update                                      */
    uint16_t ee_wait_us;   /* for a word of the EEPROM                           */
    uint16_t noise_raw;    /* ten conversions of a reference may differ by this  */
};
extern const struct exh_s526_par exh_s526_default;

/* Nominal codes to this card's and back. */
struct exh_s526_da { /* code = 32768 + zero + gain (nominal - 32768) */
    int32_t gain_q30;
    int32_t zero_raw_q14;
};
struct exh_s526_ad { /* nominal = gain (code - zero) */
    int32_t gain_q30;
    int32_t zero_raw_q14;
};

/* Who it is; for the banner. */
struct exh_s526_id {
    uint16_t signature;                   /* 0x526A or 0x526B                   */
    uint8_t nominal;                      /* bit k: nominal D/A k, bit 4: Vref  */
    struct exh_s526_da da[EXH_S526_AXES];
    struct exh_s526_ad ad;
    int32_t vref_V_q24;
};

struct exh_s526 {
    uint16_t base;
    uint8_t live;    /* signature seen: its outputs may be written              */
    uint8_t ad_busy; /* a scan was started and its end not yet seen             */
    uint8_t da_sent; /* ticks whose update has not yet been seen done           */
    uint8_t next;    /* counter whose quadrature error is looked at next        */
    uint8_t dio;     /* output pins as last written                             */
    uint16_t ad_mask; /* channels of a scan                                     */
    struct exh_s526_par par;
    struct exh_s526_id id;
};

#endif
