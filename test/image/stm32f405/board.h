/* SPDX-License-Identifier: MIT */
/* What is wired to the chip: D/A, analog inputs with the glove's multiplexers, encoders, contacts,
 * drives, lines. A table of its own, so that the port's wiring.tsv is judged by it. */
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
    uint32_t enc[EXH_FINGERS]; /* where they stand; at power-on at 0 */
    uint8_t stuck, miswired;   /* bits of encoders: no count comes; lines exchanged; */
    uint8_t half;              /* line B stays low */
    uint8_t welded;            /* bits of drives: the line that enables them is high for good */
    int32_t jump[EXH_FINGERS]; /* counts that come once, by themselves */
    uint32_t misread;          /* counts by which encoders at fault have deviated, in all */
};

void board_open(struct board *b, struct stm *s);
void board_put(struct board *b, struct stm *s, const struct exh_drive_in *in);
void board_get(const struct board *b, const struct stm *s, struct exh_drive_out *out);
/* Drives that are enabled, as bits. */
unsigned board_enables(const struct stm *s);
extern void (*board_sent)(unsigned usart, uint8_t byte);
extern void (*board_changed)(void); /* a pin has moved, and what hangs on it acted */

#endif
