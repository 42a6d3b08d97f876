/* SPDX-License-Identifier: MIT */
#include "base/until.h"

#include "base/ends.h"
#include "posix.h"

#include <signal.h>
#include <stddef.h>
#include <time.h>

static void stop(int sig)
{
    ends_note(sig);
    posix_interrupt();
}

void until_catch(enum until_wait wait)
{
    struct sigaction on = {.sa_handler = stop};
    on.sa_flags = wait == UNTIL_RESTARTS ? SA_RESTART : 0;
    (void)sigaction(SIGINT, &on, NULL);
    (void)sigaction(SIGTERM, &on, NULL);
}

double until_now_s(void)
{
    struct timespec t;
    (void)clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}
