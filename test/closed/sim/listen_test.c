/* SPDX-License-Identifier: MIT */
/* exhand listen: pieces of a log that come late, twice, from elsewhere, or never. */
#include "check.h"

#include "base/cli.h"
#include "udp.h"

#include "exhand/run/stream.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#define PIECE 4u

static struct udp from;
static char at[32], out[64];
static pid_t listener;

static int call(int n, const char *const *words)
{
    static char word[10][64];
    char *argv[11] = {word[0]};
    (void)snprintf(word[0], sizeof word[0], "listen");
    for (int i = 0; i < n; i++) {
        (void)snprintf(word[i + 1], sizeof word[0], "%s", words[i]);
        argv[i + 1] = word[i + 1];
    }
    return cli_listen(n + 1, argv);
}

/* A listener of its own process at a port that was free just now. */
static void start(void)
{
    struct udp probe;
    (void)snprintf(out, sizeof out, "/tmp/exhand-listen-%ld", (long)getpid());
    CHECK_EQ_I64(udp_open(&probe, "127.0.0.1:0", NULL), 0);
    (void)snprintf(at, sizeof at, "127.0.0.1:%u", udp_port(&probe));
    udp_close(&probe);
    CHECK_EQ_I64(udp_open(&from, "127.0.0.1:0", at), 0);
    (void)fflush(NULL);
    listener = fork();
    if (listener == 0) {
        const char *const words[] = {"--at", at, "--out", out, "--silence", "1"};
        if (freopen("/dev/null", "w", stdout) == NULL) { _exit(99); }
        _exit(call(6, words));
    }
    stream_open(77);
}

/* Piece `number` of four bytes, each the number. */
static void piece(uint32_t session, uint32_t number, unsigned n, int last)
{
    uint8_t datagram[STREAM_PIECE_B], byte[PIECE];
    size_t len;
    memset(byte, (int)(number + 1), sizeof byte);
    stream_open(session);
    for (uint32_t i = 0; i < number; i++) { stream_sent(PIECE); }
    len = stream_piece(datagram, byte, n, last);
    CHECK(udp_send(&from, datagram, len) > 0, "piece %u", (unsigned)number);
}

/* The first piece until it is there: nobody knows when the listener listens. */
static void knock(void)
{
    const struct timespec a_while = {0, 20000000};
    char part[80];
    (void)snprintf(part, sizeof part, "%s.part", out);
    for (int i = 0; i < 200 && access(part, F_OK) != 0; i++) { (void)nanosleep(&a_while, NULL); }
    CHECK(access(part, F_OK) == 0, "it does not listen");
    piece(77, 0, PIECE, 0);
}

/* Its exit status, and the file's bytes, one of each piece. */
static int end(char *got, size_t cap)
{
    int status = 0;
    size_t n = 0;
    FILE *f;
    (void)waitpid(listener, &status, 0);
    f = fopen(out, "rb");
    for (int c; f && n + 1 < cap && (c = fgetc(f)) != EOF;) {
        got[n++] = (char)(c ? '0' + c : '.');
    }
    got[n] = '\0';
    if (f) { (void)fclose(f); }
    (void)remove(out);
    udp_close(&from);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(a_whole_log_in_whatever_order)
{
    char got[64];
    start();
    knock();
    piece(77, 2, PIECE, 0);
    piece(77, 1, PIECE, 0);
    piece(77, 1, PIECE, 0);
    piece(78, 3, PIECE, 0); /* another box */
    (void)udp_send(&from, "what", 4);
    piece(77, 3, 0, 1);
    CHECK_EQ_I64(end(got, sizeof got), 0);
    CHECK(check_same_text(got, "111122223333"), "%s", got);
}

TEST(what_is_missing_is_told_and_leaves_a_hole)
{
    char got[64];
    start();
    knock();
    piece(77, 2, PIECE, 0);
    piece(77, 3, 0, 1);
    CHECK_EQ_I64(end(got, sizeof got), 1);
    CHECK(check_same_text(got, "1111....3333"), "%s", got);
}

TEST(silence_ends_it_and_is_told)
{
    char got[64];
    start();
    knock();
    CHECK_EQ_I64(end(got, sizeof got), 1);
    CHECK(check_same_text(got, "1111"), "%s", got);
}

/* Words that are no log's do not prolong it. */
TEST(nothing_in_time_is_told)
{
    const char *const words[] = {"--at", at, "--out", out, "--wait", "0.3"};
    const struct timespec a_while = {0, 20000000};
    int status = 0, n = 0;
    start();
    CHECK_EQ_I64(kill(listener, SIGTERM), 0);
    CHECK_EQ_I64(waitpid(listener, &status, 0), listener);
    listener = fork();
    if (listener == 0) { _exit(call(6, words)); }
    while (waitpid(listener, &status, WNOHANG) == 0 && ++n < 500) {
        (void)udp_send(&from, "what", 4);
        (void)nanosleep(&a_while, NULL);
    }
    CHECK(n < 500 && WIFEXITED(status) && WEXITSTATUS(status) == 1, "%d after %d", status, n);
    CHECK(n > 5, "ended after %d", n);
    CHECK(access(out, F_OK) != 0, "a file of nothing is left");
    udp_close(&from);
}

TEST(bad_usage)
{
    const char *const where[] = {"--out", "x", "--at", "here"};
    CHECK_EQ_I64(call(0, NULL), 2);
    CHECK_EQ_I64(call(4, where), 2);
}

TEST_MAIN("listen", a_whole_log_in_whatever_order, what_is_missing_is_told_and_leaves_a_hole,
    silence_ends_it_and_is_told, nothing_in_time_is_told, bad_usage);
