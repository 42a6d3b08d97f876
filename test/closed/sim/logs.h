/* SPDX-License-Identifier: MIT */
/* For tests of logs: a new path for each, and the host program's replay of it. */
#ifndef TEST_SIM_LOGS_H
#define TEST_SIM_LOGS_H

#include "check.h"

#include "base/cli.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* A new file for each log; the caller removes it. */
static inline const char *log_path(void)
{
    static char path[64];
    int fd;
    strcpy(path, "/tmp/exhand-loop-XXXXXX");
    fd = mkstemp(path);
    CHECK(fd >= 0, "no temporary file");
    close(fd);
    return path;
}

/* The host program's own replay of a log: its exit status. */
static inline int replay(const char *path, const char *from)
{
    char copy[4][64] = {"replay", "", "--from", ""};
    char *argv[5] = {copy[0], copy[1], copy[2], copy[3], NULL};
    snprintf(copy[1], sizeof copy[1], "%s", path);
    snprintf(copy[3], sizeof copy[3], "%s", from ? from : "");
    if (from == NULL) { argv[2] = NULL; }
    return cli_replay(from ? 4 : 2, argv);
}

#endif
