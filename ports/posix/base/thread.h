/* SPDX-License-Identifier: MIT */
/* A thread beside the loop. */
#ifndef CLI_THREAD_H
#define CLI_THREAD_H

#include <pthread.h>

/* Signals are the loop's: this thread gets none but those of its own crash. Blocked, they would end
 * the program without their handlers, and so without its outputs low (gpio.h). 0 or an errno. */
int thread_start(pthread_t *thread, void *(*run)(void *), void *ctx);

#endif
