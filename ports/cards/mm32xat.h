/* SPDX-License-Identifier: MIT */
/* Diamond MM-32X-AT: the glove's voltages, 16 bits, +-10 V, one scan of all channels through the
 * FIFO per software start. Sequences and sources: docs/CARDS.md. */
#ifndef CARDS_MM32XAT_H
#define CARDS_MM32XAT_H

#include "fault.h"

#include <stdint.h>

#define EXH_MM32XAT_CHANNELS 32

/* What is not certain about the card, and how much it may take. */
struct exh_mm32xat_par {
    uint8_t channels;   /* 0 .. channels-1 are scanned, 1 .. 31 */
    uint8_t interval;   /* SCINT: 0 20 us, 1 15, 2 10, 3 5 (-AT) or 4 (X) a sample */
    uint8_t words;      /* 1: a sample is one 16-bit read */
    uint8_t slice;      /* samples taken a call of exh_mm32xat_some(), 1 .. 32; 0: not in parts, by
                           exh_mm32xat_read() */
    uint8_t lost_limit; /* so many scans lost in a row are a fault, 1 .. 255 */
    uint16_t reset_us;  /* after a reset of the card */
    uint16_t set_us;    /* after its registers were set */
    uint16_t settle_us; /* longest wait for the input after a change of channel */
    uint16_t scan_wait_us; /* longest scan, 1 .. 60000 */
};
#define EXH_MM32XAT_PAR_DEFAULT \
    { \
        .channels = 22, .interval = 2, .words = 0, .slice = 0, .lost_limit = 3, .reset_us = 1000, \
        .set_us = 100, .settle_us = 100, .scan_wait_us = 2000 \
    }

struct exh_mm32xat {
    uint16_t base;
    uint8_t live;                      /* found */
    uint8_t running;                   /* a scan was started and its samples not yet read */
    uint8_t taken;                     /* of its samples */
    uint8_t lost;                      /* scans lost in a row */
    uint16_t asked;                    /* while it ran */
    uint32_t since_us;                 /* when it was first found running */
    uint32_t shorts, longs, overflows; /* scans lost, by cause */
    struct exh_mm32xat_par par;
    int16_t part[EXH_MM32XAT_CHANNELS]; /* those samples */
};

/* Finds and tests the card at base. 0, -EXH_E_ABSENT (no card, another card) or -EXH_E_IO
 * with *f. */
int exh_mm32xat_open(struct exh_mm32xat *m, uint16_t base, const struct exh_mm32xat_par *par,
    struct exh_card_fault *f);

/* Starts a scan (1 access). */
void exh_mm32xat_start(struct exh_mm32xat *m);

/* Has it ended? 1, 0: not yet, or -EXH_E_IO with *f: it takes too long (1). */
int exh_mm32xat_done(struct exh_mm32xat *m, struct exh_card_fault *f);
/* The same, waiting. 0 or -EXH_E_IO (1 + polls beyond the first). */
int exh_mm32xat_wait(struct exh_mm32xat *m, struct exh_card_fault *f);

/* Reads the samples of the scan. Returns 1, or 0 if samples are missing: the FIFO was reset and the
 * frame is unchanged. Returns -EXH_E_IO with *f if too many scans were lost in a row. It makes 3
 * accesses and 2 a channel, or 1 a channel where words are read. */
int exh_mm32xat_read(struct exh_mm32xat *m, int16_t *code, struct exh_card_fault *f);

/* Does both in parts. A call does nothing while no scan runs, polls once while one runs, and then
 * reads at most par.slice samples. Returns 1 if code has all samples, 0 if not yet or if the scan
 * is lost, -EXH_E_IO with *f. It makes at most 2 accesses and 2 a sample, or 1 a sample where words
 * are read. */
int exh_mm32xat_some(struct exh_mm32xat *m, int16_t *code, struct exh_card_fault *f);

#endif
