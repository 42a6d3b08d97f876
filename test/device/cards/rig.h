/* SPDX-License-Identifier: MIT */
/* The box on the scripted bus, for all its tests. */
#ifndef TEST_CARDS_RIG_H
#define TEST_CARDS_RIG_H

#include "bus.h"

#include "cards/box.h"

extern struct exh_box_report report; /* of the last opened() */
extern struct exh_drive_in in;
extern struct exh_glove_in glove;

/* Configurations: all fingers, one, all with a glove; nothing unusual. */
struct exh_box_config five(void);
struct exh_box_config one(void);
struct exh_box_config gloved(unsigned when);

/* New cards, opened without a fault; the log is empty. */
void opened(struct exh_box_config c);

/* D/A codes sign * 100 (i + 1) from 0, all enabled; what exh_box_write_drive() says. */
int put(int sign);

/* err is -EXH_E_IO; card and cause are as said; outputs are safe and stay so. */
void fails(int err, unsigned card_no, unsigned what);

/* The error in words, and cut at every length. */
void says(const struct exh_box_error *e, const char *want);

#endif
