/* SPDX-License-Identifier: MIT */
/* The box: the card half of the functions of exhand/board.h, the same on every port that has the
 * cards, over the port accesses of io.h.
 *
 * Two Sensoray 526 (A: fingers 0..3, B: finger 4) and one Diamond MM-32X-AT (glove). What a
 * configuration does not use is not touched: one finger needs board A alone, and B is read once,
 * to see that it is not there. Codes are those of exhand/drive.h and exhand/glove.h, nominal: what
 * the calibration of a card changes is applied here. docs/CARDS.md has every access with the fact
 * it rests on, the wiring, and how many accesses a tick takes.
 *
 * One box in a program; its functions are called from one thread, exh_box_safe() from anywhere.
 */
#ifndef CARDS_BOX_H
#define CARDS_BOX_H

#include "mm32xat.h"
#include "s526.h"

#include "exhand/frame.h"
#include "exhand/glove.h"

#include <stddef.h>
#include <stdint.h>

enum exh_box_card { EXH_BOX_A, EXH_BOX_B, EXH_BOX_GLOVE, EXH_BOX_CARDS };

/* When what a tick hands over was converted. */
enum exh_box_when {
    EXH_BOX_NEVER, /* not at all: monitors and supply are 0, the glove is absent */
    EXH_BOX_NOW,   /* in the tick that reads it, which waits for the converter */
    EXH_BOX_LAST,  /* begun when the previous one was read, the first when the box was opened. There
                    * is no wait while a tick is longer than a conversion. A glove's scan that is
                    * read in parts (mm32xat.slice) begins at the request: the first request has no
                    * frame */
    EXH_BOX_WHENS
};

struct exh_box_config {
    uint16_t s526_base[2]; /* multiples of 0x40, 0x100 .. 0xFFC0 */
    uint16_t mm32xat_base; /* a place its jumpers have */
    uint8_t fingers;       /* in use */
    uint8_t full;          /* 1: wired for five fingers, A and B, also where one is in use.
                            * 0: one finger is board A alone, wired otherwise; refused where
                            * B answers, since A's lines then mean something else */
    uint8_t monitor;       /* current monitors, enum exh_box_when */
    uint8_t supply;        /* 1: the supply is converted with them */
    uint8_t watchdog;      /* 1: the watchdog's contact is wired to an input; 0: what it says is
                            * not known here, and passed as healthy */
    uint8_t glove;         /* enum exh_box_when; EXH_BOX_NEVER: its card is not touched */
    uint8_t din_invert[2]; /* of A, B: input pins 0..3 whose healthy level is 0 */
    uint8_t out_invert[2]; /* output pins 4..7 whose active level is 0, bits 0xF0 */
    uint16_t dac_span_raw; /* codes either side of 0 A that ever go out */
    uint16_t dac_rest_raw; /* codes on either side of zero that a disabled drive may get, to correct
                            * its input offset; more is a fault */
    struct exh_s526_par s526;
    struct exh_mm32xat_par mm32xat;
};

/* Bases 0x2C0, 0x280, 0x300; five fingers, monitors and supply in their own tick, no glove;
 * +-12184 codes: +-3.75 V, the drive's whole range. */
extern const struct exh_box_config exh_box_default;

/* What is looked at in a configuration: fault.at of a configuration that is refused. */
enum exh_box_row {
    EXH_BOX_ROW_BASE_A,
    EXH_BOX_ROW_BASE_B,
    EXH_BOX_ROW_BASE_GLOVE,
    EXH_BOX_ROW_OVERLAP, /* of their register blocks */
    EXH_BOX_ROW_FINGERS,
    EXH_BOX_ROW_MONITOR,
    EXH_BOX_ROW_GLOVE,
    EXH_BOX_ROW_SPAN, /* dac_span_raw, dac_rest_raw */
    EXH_BOX_ROW_WAIT, /* a limit of 0, or above 60000 us */
    EXH_BOX_ROW_SCAN, /* channels, interval, slice, lost_limit */
    EXH_BOX_ROW_PINS, /* another bit than those in din_invert, out_invert; watchdog not 0 or 1 */
    EXH_BOX_ROW_FULL, /* not 0 or 1; or 0 with one finger, and board B answers */
    EXH_BOX_ROWS
};

/* The row that is refused, with its value, or EXH_BOX_ROWS; touches no port. */
unsigned exh_box_check(const struct exh_box_config *config, int32_t *value);

/* What went wrong, and where. */
struct exh_box_error {
    int16_t code;  /* 0: nothing; else -EXH_E_ABSENT, -EXH_E_IO, -EXH_E_RANGE */
    uint8_t card;  /* enum exh_box_card; EXH_BOX_CARDS: the configuration */
    uint16_t base; /* of that card */
    struct exh_card_fault fault;
};

struct exh_box_report {
    uint8_t used[EXH_BOX_CARDS]; /* 0: not touched */
    uint16_t base[EXH_BOX_CARDS];
    struct exh_box_error error[EXH_BOX_CARDS]; /* code 0: passed */
    struct exh_s526_id s526[2];                /* of those that passed */
};

/* Events that were handled. None of them alone is an error. */
struct exh_box_counts {
    uint32_t reads;             /* exh_box_read_drive() that ended well */
    uint32_t clamped;           /* D/A codes beyond dac_span_raw */
    uint32_t overtaken;         /* writes that exh_box_safe() interrupted */
    uint32_t quad[EXH_FINGERS]; /* illegal transitions an encoder input captured */
    uint32_t glove_frames;      /* scans handed over */
    uint32_t glove_waits;       /* requests while the scan ran: they got the last scan */
    uint32_t glove_short;       /* scans with samples missing, */
    uint32_t glove_long;        /* with too many, */
    uint32_t glove_overflow;    /* from a FIFO that overflowed: dropped, FIFO reset */
};

/* Finds, tests and calibrates all cards that the configuration uses, so that the report names
 * all that is wrong; outputs at zero, drives off. 0 or the first card's -EXH_E_ABSENT,
 * -EXH_E_IO; -EXH_E_RANGE: the configuration. May be called again. report may be NULL. */
int exh_box_open(const struct exh_box_config *config, struct exh_box_report *report);

/* As exh_board_read_drive(), exh_board_write_drive() and exh_board_read_glove(). On an error the
 * outputs become safe before the function returns -EXH_E_IO. They stay so until the box is opened
 * again, whatever is written; exh_box_error() gives the cause. -EXH_E_ABSENT: not open, or a glove
 * that is not used. */
int exh_box_read_drive(struct exh_drive_in *in);
int exh_box_write_drive(const struct exh_drive_out *out);
int exh_box_read_glove(struct exh_glove_in *in);

/* Disables the drives, by the first access to each board, then sets the D/A to 0 V. It may be
 * called at any time, from any context, repeatedly, and between any two accesses of the other
 * functions. It makes EXH_S526_SAFE_ACCESSES port accesses to a board and does not wait. It does
 * not write to boards whose signature was never seen. */
void exh_box_safe(void);

/* The first since it was opened; code 0: none. */
const struct exh_box_error *exh_box_error(void);

/* Up to now. */
void exh_box_counts(struct exh_box_counts *counts);

/* "S526 A", …; never NULL. */
const char *exh_box_card_text(unsigned card);

/* "S526 B at 0x0280: detect: no answer, all ones" and the like into text, always terminated where
 * cap_B > 0; its length without the end. */
size_t exh_box_error_text(char *text, size_t cap_B, const struct exh_box_error *e);

#endif
