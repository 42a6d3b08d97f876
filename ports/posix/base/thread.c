/* SPDX-License-Identifier: MIT */
#include "base/thread.h"

#include <signal.h>
#include <stddef.h>

int thread_start(pthread_t *thread, void *(*run)(void *), void *ctx)
{
    static const int crash[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGTRAP, SIGSYS};
    sigset_t others, was;
    int err;
    sigfillset(&others);
    for (size_t i = 0; i < sizeof crash / sizeof crash[0]; i++) { sigdelset(&others, crash[i]); }
    pthread_sigmask(SIG_SETMASK, &others, &was);
    err = pthread_create(thread, NULL, run, ctx);
    pthread_sigmask(SIG_SETMASK, &was, NULL);
    return err;
}
