/* SPDX-License-Identifier: MIT */
/* A subcommand of the host program in a separate process, and its output. */
#ifndef TEST_SIM_SAID_H
#define TEST_SIM_SAID_H

#include "check.h"

#include "base/cli.h"
#include "base/option.h"

#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#define SAID_B 32768

struct said {
    int status; /* -1: ended by a signal */
    char out[SAID_B], err[SAID_B];
};

static inline void said_read(char to[SAID_B], const char *path)
{
    FILE *f = fopen(path, "r");
    size_t n = 0;
    if (f != NULL) {
        n = fread(to, 1, SAID_B - 1, f);
        fclose(f);
    }
    to[n] = '\0';
}

/* Starts it, as leader of a new process group, with its output in DIR. */
static inline pid_t said_start(
    const char *dir, int (*command)(int, char **), const char *const *word)
{
    const pid_t pid = fork();
    char path[2][512];
    char *argv[32];
    int argc = 0;
    CHECK(pid >= 0, "no process");
    if (pid != 0) { return pid; }
    setpgid(0, 0);
    alarm(3000);             /* a hang fails its test before run.sh ends all of them */
    signal(SIGINT, SIG_DFL); /* a background process inherits it ignored */
    snprintf(path[0], sizeof path[0], "%s/said.out", dir);
    snprintf(path[1], sizeof path[1], "%s/said.err", dir);
    if (!freopen(path[0], "w", stdout) || !freopen(path[1], "w", stderr)) { _exit(99); }
    setvbuf(stderr, NULL, _IONBF, 0); /* as it is, so that a grandchild's words are not lost */
    for (; word[argc] != NULL && argc < 31; argc++) { argv[argc] = strdup(word[argc]); }
    argv[argc] = NULL;
    argc = cli_finish(command(argc, argv));
    fflush(NULL);
    _exit(argc);
}

static inline void said_end(struct said *s, const char *dir, pid_t pid)
{
    char path[256];
    int status = 0;
    CHECK(waitpid(pid, &status, 0) == pid, "lost it");
    s->status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    snprintf(path, sizeof path, "%s/said.out", dir);
    said_read(s->out, path);
    snprintf(path, sizeof path, "%s/said.err", dir);
    said_read(s->err, path);
}

static inline void said(
    struct said *s, const char *dir, int (*command)(int, char **), const char *const *word)
{
    said_end(s, dir, said_start(dir, command, word));
}

/* The words after the directory are the command line, its name first. */
#define WORDS(...) ((const char *const[]){__VA_ARGS__, NULL})

/* A directory of the test's own, gone with said_clean(). */
static inline char *said_dir(void)
{
    static char dir[64];
    strcpy(dir, "/tmp/exhand-cli-XXXXXX");
    CHECK(mkdtemp(dir) != NULL, "no temporary directory");
    return dir;
}

static inline void said_clean(const char *dir)
{
    char command[300];
    snprintf(command, sizeof command, "rm -rf '%s'", dir);
    CHECK_EQ_I64(system(command), 0);
}

/* DIR/NAME; the last four different answers stay good. */
static inline const char *said_path(const char *dir, const char *name)
{
    static char path[4][512];
    static unsigned used[4], now;
    char text[512];
    int at = 0; /* who asks again and again takes no other's place, else that of the oldest */
    (void)snprintf(text, sizeof text, "%s/%s", dir, name);
    for (int i = 1; i < 4; i++) {
        if (used[i] < used[at]) { at = i; }
    }
    for (int i = 0; i < 4; i++) {
        if (strcmp(path[i], text) == 0) { at = i; }
    }
    used[at] = ++now;
    return memcpy(path[at], text, sizeof text);
}

static inline long said_size(const char *path)
{
    struct stat st;
    return stat(path, &st) == 0 ? (long)st.st_size : -1;
}

/* What DOC (a path from the project's root) has between the lines <!-- BEGINS --> and <!-- end -->
 * is what was said on standard output. */
static inline void said_as_document(const struct said *s, const char *doc, const char *begins)
{
    static char text[262144];
    char mark[80], *from, *to;
    FILE *f = fopen(doc, "r");
    CHECK(f != NULL, "%s: not there", doc);
    text[fread(text, 1, sizeof text - 1, f)] = '\0';
    fclose(f);
    snprintf(mark, sizeof mark, "<!-- %s -->\n", begins);
    from = strstr(text, mark);
    CHECK(from != NULL, "%s: no %s", doc, mark);
    from += strlen(mark);
    to = strstr(from, "<!-- end -->\n");
    CHECK(to != NULL, "%s: no end", doc);
    *to = '\0';
    CHECK(strcmp(from, s->out) == 0, "%s is stale:\n%s", doc, s->out);
}

#endif
