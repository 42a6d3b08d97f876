/* SPDX-License-Identifier: MIT */
#include "base/until.h"

#include <signal.h>
#include <string.h>
#include <time.h>

static volatile sig_atomic_t stopped;

static void stop(int sig)
{
    (void)sig;
    stopped = 1;
}

void until_catch(void)
{
    struct sigaction on;
    memset(&on, 0, sizeof on);
    on.sa_handler = stop; /* without SA_RESTART: poll() comes back */
    (void)sigaction(SIGINT, &on, NULL);
    (void)sigaction(SIGTERM, &on, NULL);
}

int until_stopped(void)
{
    return stopped;
}

double until_now_s(void)
{
    struct timespec t;
    (void)clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}
