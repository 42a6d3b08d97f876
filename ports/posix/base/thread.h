/* SPDX-License-Identifier: MIT */
/* A thread beside the loop. */
#ifndef CLI_THREAD_H
#define CLI_THREAD_H

#include <pthread.h>

/* Starts a thread that receives no signals, except those of a crash of this thread. The loop
 * handles signals. Handled here, they could end the program without setting the outputs low
 * (gpio.h). 0 or an errno. */
int thread_start(pthread_t *thread, void *(*run)(void *), void *ctx);

#endif
