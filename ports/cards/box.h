/* The box: the card half of the functions of exhand/board.h, the same on every port that has the
 * cards, over the port accesses of io.h.
 *
 * Two Sensoray 526 (A: fingers 0..3, B: finger 4) and one Diamond MM-32X-AT (glove). What a
 * configuration does not use is never touched: one finger needs board A alone. Codes are those
 * of exhand/drive.h and exhand/glove.h, nominal: what the calibration of a card changes is
 * applied here. docs/CARDS.md has every access with the fact it rests on, the wiring, and how
 * many accesses a tick takes.
 *
 * One box in a program; its functions are called from one thread, exh_box_safe() from anywhere.
 */
#ifndef CARDS_BOX_H
#define CARDS_BOX_H

#include "mm32xat.h"
#include "s526.h"

#include "exhand/drive.h"
#include "exhand/glove.h"

#include <stddef.h>
#include <stdint.h>

enum exh_box_card { EXH_BOX_A, EXH_BOX_B, EXH_BOX_GLOVE, EXH_BOX_CARDS };

/* When what a tick hands over was converted. */
enum exh_box_when {
    EXH_BOX_NEVER, /* not at all; its codes are 0                              */
    EXH_BOX_NOW,   /* in the tick that reads it: the tick waits for the converter */
    EXH_BOX_LAST   /* begun when the one before was read, while that tick computed: no wait.
                    * The first of all is read twice                           */
};

struct exh_box_config {
    uint16_t s526_base[2];
    uint16_t mm32xat_base;
    uint8_t fingers;       /* 1: board A alone; 2..5: A and B                  */
    uint8_t monitor;       /* current monitors, enum exh_box_when              */
    uint8_t supply;        /* 1: the supply is converted with them             */
    uint8_t glove;         /* enum exh_box_when; EXH_BOX_NEVER: no glove card   */
    uint8_t din_invert[2]; /* pins of A, B whose healthy level is 0, bits 0..3 */
    uint8_t out_invert[2]; /* pins of A, B whose active level is 0, bits 4..7  */
    uint16_t dac_span_raw; /* codes either side of 0 A that ever go out: the drive ends there */
    struct exh_s526_par s526;
    struct exh_mm32xat_par mm32xat;
};

/* Bases 0x2C0, 0x280, 0x300; five fingers, monitors in their own tick, supply, no glove. */
extern const struct exh_box_config exh_box_default;

/* What went wrong, where: "S526 A at 0x02C0: A/D reference 10 V implausible: got …". */
struct exh_box_error {
    int16_t code;        /* 0: nothing; else -EXH_E_ABSENT, -EXH_E_IO, -EXH_E_RANGE */
    uint8_t card;        /* enum exh_box_card; EXH_BOX_CARDS: the configuration */
    uint8_t open;        /* 1: while opening, 0: in a tick                      */
    uint16_t base;       /* of that card                                       */
    struct exh_card_fault fault;
};

/* What happened and was dealt with; nothing of it is an error alone. */
struct exh_box_counts {
    uint32_t ticks;             /* exh_box_read_drive() done                    */
    uint32_t clamped;           /* D/A codes beyond dac_span_raw                */
    uint32_t quad[EXH_FINGERS]; /* illegal transitions an encoder input captured */
    uint32_t glove_frames;      /* scans handed over                            */
    uint32_t glove_waits;       /* asked for while the scan still ran: the last again */
    uint32_t glove_short;       /* scans with samples missing,                  */
    uint32_t glove_long;        /* with too many,                               */
    uint32_t glove_overflow;    /* and FIFOs that overflowed: thrown away, FIFO reset */
    uint32_t safe;              /* calls of exh_box_safe()                      */
};

struct exh_box_report {
    struct exh_box_error error[EXH_BOX_CARDS]; /* of each card; code 0: it passed */
    uint8_t used[EXH_BOX_CARDS];               /* 0: not touched               */
    struct exh_s526_id s526[2];
    struct exh_mm32xat_id mm32xat;
};

/* Finds, tests and calibrates the cards that the configuration uses, all of them, so that the
 * report names all that is wrong; outputs zero, drives off. 0 or the first card's
 * -EXH_E_ABSENT, -EXH_E_IO; -EXH_E_RANGE: the configuration. May be called again. report may be
 * NULL. */
int exh_box_open(const struct exh_box_config *config, struct exh_box_report *report);

/* As exh_board_read_drive(), …write_drive(), …read_glove(). On an error outputs are safe before
 * they return -EXH_E_IO, and stay so, whatever is written, until the box is opened anew;
 * exh_box_error() has the cause. -EXH_E_ABSENT: not opened, or a glove without its card. */
int exh_box_read_drive(struct exh_drive_in *in);
int exh_box_write_drive(const struct exh_drive_out *out);
int exh_box_read_glove(struct exh_glove_in *in);

/* Drives disabled, D/A at 0 A: any time, from any context, any number of times, also between
 * any two accesses of the others. EXH_BOX_SAFE_ACCESSES port accesses a board, no wait. Touches
 * no port before exh_box_open() has found the board's signature there. */
void exh_box_safe(void);

const struct exh_box_error *exh_box_error(void); /* the first since opened; code 0: none */
const struct exh_box_counts *exh_box_counts(void);

/* "S526 A" and the like; never NULL. */
const char *exh_box_card_text(unsigned card);

/* One line without its end into text, always terminated; characters without it. */
size_t exh_box_error_text(char *text, size_t cap_B, const struct exh_box_error *e);

#endif
