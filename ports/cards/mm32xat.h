/* Diamond MM-32X-AT: the glove's voltages, 16 bits, +-10 V, one FIFO scan of all channels per
 * software start. Sequences and sources: docs/CARDS.md. */
#ifndef CARDS_MM32XAT_H
#define CARDS_MM32XAT_H

#include "fault.h"

#include <stdint.h>

/* What is not certain about the card, and how much it may take. */
struct exh_mm32xat_par {
    uint8_t channels;      /* 0 .. channels-1 are scanned, 1 .. 32               */
    uint8_t interval;      /* code of SCINT: 0 20 us, 1 15, 2 10, 3 5 (-AT) or 4 (X) a sample */
    uint8_t words;         /* 1: samples as one 16-bit read (16-bit jumper and bus) */
    uint8_t lost_limit;    /* this many scans lost in a row are a fault          */
    uint16_t reset_us;     /* after a reset of the card                          */
    uint16_t settle_us;    /* longest wait for the input after a change of channel or range */
    uint16_t scan_wait_us; /* longest scan                                       */
};
extern const struct exh_mm32xat_par exh_mm32xat_default;

/* Who it is; for the banner. */
struct exh_mm32xat_id {
    uint8_t reg[6]; /* registers 2, 3, 7, 8, 9, 11 after the reset: the detection's */
};

struct exh_mm32xat {
    uint16_t base;
    uint8_t live;    /* found                                                    */
    uint8_t running; /* a scan was started and not yet read                      */
    uint8_t lost;    /* scans lost in a row                                      */
    uint8_t timed;   /* start_us is set                                          */
    uint16_t polls;  /* asked while it ran                                       */
    uint32_t start_us;
    struct exh_mm32xat_par par;
    struct exh_mm32xat_id id;
};

#endif
