/* SPDX-License-Identifier: MIT */
#include "base/outlog.h"

#include "base/outfile.h"

#include "exhand/record.h"

#include <stdint.h>
#include <sys/stat.h>
#include <unistd.h>

#define START_B 65536 /* a frame comes before that many bytes */

/* What was written in place can't be read again, and stays as it is. */
static int has_frame(FILE *f)
{
    static uint8_t start[START_B];
    struct stat st;
    struct exh_record r;
    ssize_t n, at = 0;
    int32_t len;
    if (fstat(fileno(f), &st) != 0 || !S_ISREG(st.st_mode)) { return 1; }
    n = pread(fileno(f), start, sizeof start, 0);
    if (n < 0) { return 1; }
    while ((len = exh_record_decode(start + at, (uint32_t)(n - at), &r)) > 0) {
        if (at == 0 && r.type != EXH_RECORD_HEADER) { return 0; }
        if (r.type == EXH_RECORD_FRAME) { return 1; }
        at += len;
    }
    return 0;
}

int outlog_close(FILE *f)
{
    if (fflush(f) == 0 && !ferror(f) && !has_frame(f)) {
        outfile_abandon(f);
        return 0;
    }
    return outfile_close(f);
}
