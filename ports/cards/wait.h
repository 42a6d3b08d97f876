/* SPDX-License-Identifier: MIT */
/* A bounded wait: by time, or by polls if the clock is stopped. */
#ifndef CARDS_WAIT_H
#define CARDS_WAIT_H

#include "io.h"

/* A poll is an access to the ISA bus of at least 0.4 us. While the clock runs, time ends a wait. If
 * it is stopped, this number of polls does, after 6 to 30 times as long. */
#define EXH_WAIT_POLLS_PER_US 16u

struct exh_wait {
    uint32_t limit_us, start_us, polls;
};

static inline struct exh_wait exh_wait_us(uint32_t limit_us)
{
    const struct exh_wait w = {limit_us, 0, 0};
    return w;
}

/* Polls from one look at the time to the next, a power of two: a look costs three polls. */
#define EXH_WAIT_LOOK 8u

/* Call it after a poll without result: 1 for another poll. There is a poll between two readings of
 * the time, so a delayed caller does not blame the card. The first poll does not read the time. */
static inline int exh_wait_more(struct exh_wait *w)
{
    const uint32_t polls = w->polls++;
    if (polls >= w->limit_us * EXH_WAIT_POLLS_PER_US) { return 0; } /* or the limit is gone */
    if ((polls & (EXH_WAIT_LOOK - 1u)) == 0) {
        const uint32_t now_us = exh_io_time_us();
        if (polls == 0) { w->start_us = now_us; }
        if (now_us - w->start_us > w->limit_us) { w->limit_us = 0; } /* one more poll */
    }
    return 1;
}

#endif
