/* SPDX-License-Identifier: MIT */
#include "box/contacts.h"

#include "base/option.h"
#include "base/messages.h"

#include <time.h>

/* Pull-downs that were just switched on, and a cable's capacitance: what is read before is
 * anything. */
#define SETTLE_MS 50

int contacts_take(void *ctx, const char *text)
{
    struct contacts *c = ctx;
    char said[GPIO_SAID_B];
    if (c->given) {
        cli_complain("--gpio: given twice: all lines of one chip in one");
        return 2;
    }
    if (gpio_take(&c->spec, text, said) < 0) {
        cli_complain("--gpio: %s", said);
        return 2;
    }
    c->given = 1;
    return 0;
}

int contacts_check(const struct contacts *c, int pace)
{
    if (!c->given || pace) { return 0; }
    cli_complain(
        "--gpio: without --pace a run goes as fast as it can, and nobody's hand on a contact "
        "keeps up with that: give --pace, too");
    return 2;
}

int contacts_begin(const struct contacts *c)
{
    struct timespec left = {0, SETTLE_MS * 1000000L};
    char said[GPIO_SAID_B];
    if (!c->given) { return 0; }
    if (gpio_open(&c->spec, said) < 0) {
        cli_complain("--gpio: %s", said);
        return 3;
    }
    gpio_say(words_say);
    while (nanosleep(&left, &left) != 0) {}
    return 0;
}

/* Each is a hand's movement, or the first of a wire that breaks. */
static void say_differed(void)
{
    for (unsigned i = 0; i < GPIO_CHANNELS; i++) {
        uint32_t times;
        const double longest_s = gpio_differed_s((enum gpio_channel)i, &times);
        if (times) {
            cli_complain("--gpio: %s: its two contacts disagreed %lu times, at most for %.3g s",
                gpio_channel_name[i], (unsigned long)times, longest_s);
        }
    }
}

void contacts_end(void)
{
    gpio_close();
    say_differed();
}
