/* SPDX-License-Identifier: MIT */
#include "base/ends.h"

#include "base/outpart.h"

#include <signal.h>
#include <stddef.h>
#include <string.h>
#include <unistd.h>

static const int ends[] = {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE};
#define ENDS (sizeof ends / sizeof ends[0])

static volatile sig_atomic_t noted;

static void at_once(int sig)
{
    outpart_remove_all();
    if (sig == SIGINT || sig == SIGTERM) { _exit(128 + sig); }
    (void)raise(sig); /* blocked until the handler returns, which is reset already */
}

static void install(void)
{
    struct sigaction a, was;
    memset(&a, 0, sizeof a);
    a.sa_handler = at_once;
    a.sa_flags = (int)SA_RESETHAND;
    sigfillset(&a.sa_mask);
    for (size_t i = 0; i < ENDS; i++) {
        if (sigaction(ends[i], NULL, &was) == 0 && was.sa_handler != SIG_IGN) {
            (void)sigaction(ends[i], &a, NULL);
        }
    }
}

void ends_begin(void)
{
    sigset_t set;
    install();
    (void)signal(SIGXFSZ, SIG_IGN);
    (void)sigemptyset(&set);
    for (size_t i = 0; i < ENDS; i++) { (void)sigaddset(&set, ends[i]); }
    (void)sigprocmask(SIG_UNBLOCK, &set, NULL); /* a parent process may have blocked them */
}

void ends_note(int sig) { noted = sig; }

int ends_status(int status)
{
    install();
    return noted ? 128 + noted : status;
}
