/* SPDX-License-Identifier: MIT */
/* Loops: exhand's own experiments on the simulated device. In this host program Linux's drivers are
 * between device and controller (cards.c). Their logs leave the machine byte by byte. run.mjs
 * compares them with those of the host program without cards. */
#include "check.h"
#include "linux.h"
#include "pin.h"
#include "table.h"

#include <stdio.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

static int run(const char *command)
{
    char text[200], *word[16] = {"/exhand"};
    int n = 1, status = -1;
    pid_t child;
    snprintf(text, sizeof text, "%s", command);
    for (char *at = text; *at && n < 15;) {
        word[n++] = at;
        while (*at && *at != ' ') { at++; }
        if (*at) { *at++ = '\0'; }
    }
    child = fork();
    if (child == 0) {
        if (freopen("/log", "a", stdout) == NULL) { _exit(9); }
        execv(word[0], word);
        _exit(9);
    }
    return waitpid(child, &status, 0) == child && WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

static long send(unsigned n, const char *path)
{
    FILE *f = fopen(path, "rb");
    long bytes = 0;
    int c;
    if (f == NULL) { return -1; }
    outl(n, FILE_PORT);
    while ((c = getc(f)) != EOF) {
        outb((unsigned char)c, FILE_PORT + 4);
        bytes++;
    }
    outl(0, FILE_PORT);
    fclose(f);
    return bytes;
}

void check_loop(unsigned n, const char *command, const char *log)
{
    struct timespec from, to;
    char with_cards[200];
    int status;
    long bytes;
    (void)mkdir("/out", 0755);
    snprintf(with_cards, sizeof with_cards, "%s --cards --jobs 1 --out /out", command);
    clock_gettime(CLOCK_MONOTONIC, &from);
    status = run(with_cards);
    clock_gettime(CLOCK_MONOTONIC, &to);
    bytes = send(n, log);
    say(status == 0 && bytes > 0, "exhand %s: exit %d, log of %ld bytes, %ld s", with_cards, status,
        bytes, (long)(to.tv_sec - from.tv_sec));
    say(inl(FILE_PORT) == 1, "the log is, byte for byte, that of the host program without cards");
}
