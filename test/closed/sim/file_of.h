/* SPDX-License-Identifier: MIT */
/* A new file with this text. The caller removes it before the next. */
#ifndef TEST_SIM_FILE_OF_H
#define TEST_SIM_FILE_OF_H

#include "check.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static inline const char *file_of(const char *text)
{
    static char name[64];
    FILE *f;
    int fd;
    strcpy(name, "/tmp/exhand-text-XXXXXX");
    fd = mkstemp(name);
    f = fd < 0 ? NULL : fdopen(fd, "w");
    CHECK(f != NULL, "%s", name);
    fputs(text, f);
    fclose(f);
    return name;
}

#endif
