/* SPDX-License-Identifier: MIT */
#include "base/messages.h"

#include "base/option.h"
#include "base/writer.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define ROOM_B  (32u * WORDS_LINE_B)
#define WAITS_S 2.0
#define ENDS_S  1.0

static struct {
    int on, paced;
    int shown; /* a status line is shown */
    uint32_t lost;
} words;

static struct writer out;
static uint8_t room[ROOM_B];
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;

static int put(const char *text, size_t n)
{
    return writer_put(&out, text, n, words.paced ? 0 : WAITS_S) == 1;
}

void words_begin(int paced)
{
    static int at_exit;
    words_end();
    memset(&words, 0, sizeof words);
    words.paced = paced;
    words.on = writer_start(&out, STDERR_FILENO, room, sizeof room) == 0;
    cli_complain_by = words_say;
    if (!at_exit) { at_exit = atexit(words_end) == 0; }
}

void words_say(const char *line)
{
    char text[2 * WORDS_LINE_B];
    int on, n;
    pthread_mutex_lock(&lock);
    on = words.on;
    if (on) {
        n = snprintf(text, sizeof text - 1, "%s%s", words.shown ? "\r\033[K" : "", line);
        if (n > (int)sizeof text - 2) { n = (int)sizeof text - 2; }
        text[n] = '\n';
        if (put(text, (size_t)n + 1)) {
            words.shown = 0;
        } else {
            words.lost++;
        }
    }
    pthread_mutex_unlock(&lock);
    if (!on) { fprintf(stderr, "%s\n", line); }
}

void words_show(const char *line)
{
    char text[WORDS_LINE_B];
    const int n = snprintf(text, sizeof text, "\r%s\033[K", line);
    pthread_mutex_lock(&lock);
    if (words.on && n < WORDS_LINE_B && writer_held(&out) < ROOM_B / 2) {
        words.shown |= writer_put(&out, text, (size_t)n, 0) == 1;
    }
    pthread_mutex_unlock(&lock);
}

uint32_t words_lost(void) { return words.lost; }

void words_end(void)
{
    pthread_mutex_lock(&lock);
    if (words.on) {
        if (words.shown) { (void)writer_put(&out, "\n", 1, ENDS_S); }
        words.on = 0;
        (void)writer_end(&out, ENDS_S);
    }
    pthread_mutex_unlock(&lock);
}
