/* SPDX-License-Identifier: MIT */
/* The wiring of the chip: D/A, analog inputs with the glove's multiplexers, encoders, contacts,
 * drives, lines. It is a separate table, so that it judges the port's wiring.tsv. */
#ifndef BOARD_H
#define BOARD_H

#include "da.h"
#include "stm.h"

#include "exhand/frame.h"
#include "exhand/glove.h"

struct board {
    struct da da;
    int16_t mon[EXH_FINGERS], supply;
    int16_t glove[EXH_GLOVE_SENSORS];
    uint32_t enc[EXH_FINGERS]; /* their counts; 0 at power-on */
    uint8_t stuck, miswired;   /* bits of encoders: no count comes; lines exchanged; */
    uint8_t half;              /* line B stays low */
    uint8_t welded;            /* bits of drives: the line that enables them is high for good */
    int32_t jump[EXH_FINGERS]; /* counts that come once, without a movement */
    uint32_t misread;          /* counts by which encoders at fault have deviated, in all */
};

void board_open(struct board *b, struct stm *s);
void board_put(struct board *b, struct stm *s, const struct exh_drive_in *in);
void board_get(const struct board *b, const struct stm *s, struct exh_drive_out *out);
/* Drives that are enabled, as bits. */
unsigned board_enables(const struct stm *s);
extern void (*board_sent)(unsigned usart, uint8_t byte);
extern void (*board_changed)(void); /* a pin has moved, and its device acted */

#endif
