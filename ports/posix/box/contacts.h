/* SPDX-License-Identifier: MIT */
/* --gpio: real contacts and outputs (docs/GPIO.md), for any command that follows the wall clock.
 *
 *     static struct contacts gpio;
 *     const struct cli_call call = {contacts_take, &gpio};
 *     {"gpio", CLI_CALL, ..., CONTACTS_ARG, CONTACTS_HELP}
 *     err = contacts_check(&gpio, pace);            before anything is made
 *     err = contacts_begin(&gpio);                  before the loop, with board.gpio = gpio.given
 *     contacts_end();                               behind it
 */
#ifndef CLI_CONTACTS_H
#define CLI_CONTACTS_H

#include "gpio.h"

struct contacts {
    int given;
    struct gpio_spec spec;
};

#define CONTACTS_ARG "CHIP:LINES"
#define CONTACTS_HELP \
    "gpiochip0:estop=4,deadman=5,enable=6,alive=7: real lines, with --pace (docs/GPIO.md)"

/* Of a cli_call; ctx: struct contacts. */
int contacts_take(void *ctx, const char *text);

/* 0, or 2 after a line on stderr: lines and a clock that is none. */
int contacts_check(const struct contacts *c, int pace);

/* The lines, if any were given, are requested, outputs low. 0, or 3 after a line on stderr. */
int contacts_begin(const struct contacts *c);
void contacts_end(void);

#endif
