/* SPDX-License-Identifier: MIT */
/* The chips of a PC that an image may touch, as far as it may: 8259 pair, 8254, HPET, 16550. Each
 * keeps its own time only as a number that its caller passes. */
#ifndef HIL_CHIPS_H
#define HIL_CHIPS_H

#include <stdint.h>

#define CHIP_NEVER   UINT64_MAX
#define PIT_HZ       1193182u
#define UART_CHAR_PS UINT64_C(86805556) /* ten bits at 115200 baud */

/* one of the pair */
struct pic {
    uint8_t irr, isr, mask, base, words_left, word, read_isr, auto_eoi;
};

struct pit {
    uint32_t divisor; /* 1..65536 */
    uint64_t from_ps; /* the count was loaded then */
    uint64_t done;    /* interrupts since */
    uint8_t low, have_low, latched, read_high;
    uint16_t latch;
    uint64_t loads;
    /* channel 2, by which a processor's clock may be measured */
    uint32_t div2;
    uint64_t from2_ps;
    uint8_t low2, have_low2, gate2;
};

struct hpet {
    uint32_t period_fs; /* of its counter; 0: there is no HPET */
    uint64_t config, status;
    uint64_t held;    /* the counter while stopped */
    uint64_t from_ps; /* and it was that at this time, when it runs */
    struct {
        uint64_t config, compare, period;
    } timer[3];
    uint64_t loads;
};

struct uart {
    uint8_t divisor_low, divisor_high, line, fifo, scratch, ier, modem;
    uint64_t busy_ps; /* all that it took has left by then */
    uint64_t lost;    /* written while it could take none */
};

struct chips {
    struct pic pic[2];
    struct pit pit;
    struct hpet hpet;
    struct uart uart;
    uint64_t char_ps; /* of the serial line; 0: it takes them immediately */
};

void chips_open(struct chips *c, uint32_t hpet_fs);

/* What happened up to now_ps; 1: an interrupt of the timer was requested. */
int chips_advance(struct chips *c, uint64_t now_ps);
/* When something will happen. */
uint64_t chips_next_ps(const struct chips *c);
/* How often the timer was set. */
uint64_t chips_timer_loads(const struct chips *c);
/* What the timer is set to, s: 0 when none is. */
double chips_period_s(const struct chips *c);

int pic_wants(const struct chips *c); /* an interrupt is requested and not masked */
int pic_accept(struct chips *c);      /* its vector; 0: spurious line 7 */

/* 1 and *value, or 0: not one of its ports. */
int chips_in8(struct chips *c, uint64_t now_ps, uint16_t port, uint8_t *value);
/* 1, or 0: not one of its ports. *sent: a character for the line, or -1. */
int chips_out8(struct chips *c, uint64_t now_ps, uint16_t port, uint8_t value, int *sent);

/* --- hpet.c --- */

int hpet_advance(struct hpet *t, uint64_t now_ps); /* 1: its interrupt was requested */
uint64_t hpet_next_ps(const struct hpet *t);
int hpet_is_legacy(const struct hpet *t); /* it replaces the 8254 */
uint32_t hpet_read(const struct chips *c, uint64_t now_ps, uint32_t offset);
void hpet_write(struct chips *c, uint64_t now_ps, uint32_t offset, uint32_t value);

#endif
