/* SPDX-License-Identifier: MIT */
/* Lines of a Linux GPIO chip: the contacts of a person, a watchdog relay and the enable of a drive.
 * docs/GPIO.md describes the wiring and the limits of use. */
#ifndef POSIX_GPIO_H
#define POSIX_GPIO_H

#include "exhand/frame.h"
#include "exhand/units.h"

#include <stdint.h>

enum gpio_channel { GPIO_ESTOP, GPIO_DEADMAN, GPIO_CHANNELS };
extern const char *const gpio_channel_name[GPIO_CHANNELS];
enum gpio_output { GPIO_ENABLE, GPIO_ALIVE, GPIO_OUTPUTS };

#define GPIO_PATH_B   64
#define GPIO_SAID_B   256
#define GPIO_LINE_TOP 1023 /* the highest number taken for a line's */
#define GPIO_DIFFER_S 0.5  /* two contacts of a channel may disagree for so long */

struct gpio_spec {
    char path[GPIO_PATH_B];           /* /dev/gpiochip0 */
    unsigned contacts[GPIO_CHANNELS]; /* 0: not wired, closed as simulated; 1; 2 */
    unsigned contact[GPIO_CHANNELS][2];
    int wired[GPIO_OUTPUTS];
    unsigned output[GPIO_OUTPUTS];
};

/* "gpiochip0:estop=4,deadman=5+9,enable=6,alive=7": a chip's name or path, and at least one of the
 * four, each line once. 0, or -1 with what is wrong and what to do in said. */
int gpio_take(struct gpio_spec *s, const char *text, char said[GPIO_SAID_B]);

/* Requests the lines, outputs low. 0, or -1 with what is wrong and what to do in said. From here on
 * outputs go low when the process ends or stops, also by a signal; but SIGKILL and SIGSTOP. */
int gpio_open(const struct gpio_spec *s, char said[GPIO_SAID_B]);
void gpio_close(void);

/* Sets the receiver of messages from ticks, each without a line end. NULL, the default: written to
 * stderr, and the tick waits for that. */
void gpio_say(void (*say)(const char *line));

/* 1: a chip is open, and this contact is a real one. */
int gpio_has(enum gpio_channel channel);

/* How often two contacts of a channel began to disagree since gpio_start(), and the longest in s;
 * of all channels. */
uint32_t gpio_differed(void);
double gpio_differed_s(enum gpio_channel channel, uint32_t *times);

/* The board's: nothing without an open chip. A loop of this period begins, outputs low. */
void gpio_start(struct exh_period T);

/* Once a tick: takes the bits of channels that are not believed closed out of din. 0, or -EXH_E_IO
 * after a line on stderr, and then no channel is. */
int gpio_read(uint32_t *din);

/* Once a tick: enable is high while any drive is enabled; alive turns over when out->alive has
 * changed. 0, or -EXH_E_IO after a line on stderr. */
int gpio_write(const struct exh_drive_out *out);

/* Both low; any time, any context, repeatable. */
void gpio_safe(void);

#endif
