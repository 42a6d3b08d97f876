/* SPDX-License-Identifier: MIT */
/* Check: through the Linux drivers, every kind of value beside what the pins have. */
#ifndef GUEST_CHECK_H
#define GUEST_CHECK_H

enum { A, B, MM, SPARE }; /* minors of comedi, which are also the cards' numbers */
enum {
    BASE_A = 0x2C0,
    BASE_B = 0x280,
    BASE_MM = 0x300,
    BASE_EMPTY = 0x340,
    BASE_EMPTY_526 = 0x240
};
enum { IRQ_MM = 5 };

void check_counters(void);
void check_s526_ad(void);
void check_s526_da(void);
void check_s526_lines(void);
void check_mm_ad(void);
void check_mm_scans(void);
void check_mm_da(void);
void check_mm_lines(void);

/* Channels 2..7 of the S526's A/D. bug: 1 if the driver's mask is 9, as in the mainline kernel. */
void check_mask(int bug);

/* An experiment of exhand through the cards; its log is the n-th. */
void check_loop(unsigned n, const char *command, const char *log);

/* One scan of 22 channels, or two by the card's timer, of the voltages on the pins. */
int mm_scan(unsigned scans);

/* The short sequences that are compared with test/device/emu/linux_trace.inc. */
void traces(void);
void mark(unsigned n);

#endif
