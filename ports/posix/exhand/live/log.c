/* SPDX-License-Identifier: MIT */
/* exhand run --log: written by a thread of its own. A paced box does not wait for it. */
#include "live/live.h"

#include "base/option.h"
#include "base/outfile.h"
#include "base/outlog.h"
#include "posix.h"
#include "base/writer.h"

#include "exhand/record.h"

#include <stdio.h>
#include <string.h>

#define RING_B  (4u << 20) /* some seconds of five fingers at 2 kHz */
#define WAITS_S 2.0        /* at the end, for a file that takes nothing */

static struct {
    const char *path;
    FILE *file;
    int paced;
    uint64_t lost;
    uint32_t taken; /* records, modulo 2^32 as their numbers are */
    struct writer writer;
} file;

static uint8_t ring[RING_B];

static int open_file(void)
{
    int err;
    file.file = outfile_open("log", file.path);
    if (file.file == NULL) { return 2; }
    err = writer_start(&file.writer, fileno(file.file), ring, sizeof ring);
    if (err) { cli_complain("--log: no thread that writes: %s", strerror(err)); }
    return err ? 1 : 0;
}

int live_log_open(const char *path, int paced)
{
    memset(&file, 0, sizeof file);
    file.path = path;
    file.paced = paced;
    return path ? open_file() : 0;
}

FILE *live_log_file(void) { return file.file; }

/* Nothing ticks any more. */
static int is_last(const void *rec, size_t len_B)
{
    struct exh_record r;
    return exh_record_decode(rec, (uint32_t)len_B, &r) > 0 && r.type == EXH_RECORD_END;
}

/* In virtual time there is time to wait; behind Ctrl-C only while the file takes something. */
int live_log_put(const void *rec, size_t len_B)
{
    int taken = writer_put(&file.writer, rec, len_B, 0);
    if (taken == 0 && (!file.paced || is_last(rec, len_B))) {
        do {
            taken = writer_put(&file.writer, rec, len_B, WAITS_S);
        } while (taken == 0 && !file.paced && !posix_interrupted());
    }
    file.taken += taken == 1;
    file.lost += taken != 1;
    return taken == 1;
}

uint64_t live_log_lost(void) { return file.lost; }

int live_log_close(void)
{
    int err;
    if (file.file == NULL) { return 0; }
    err = writer_end(&file.writer, WAITS_S);
    if (err > 0 && outlog_mend(file.file, file.taken, (uint32_t)file.lost) != 0) {
        outfile_abandon(file.file);
    } else if (err >= 0 && outlog_close(file.file) != 0) {
        return 1;
    }
    if (err > 0) {
        cli_complain(
            "--log: %s: can't be written: %s: %llu records lost: make room, or give another --log",
            file.path, strerror(err), (unsigned long long)file.lost);
    } else if (err < 0) {
        cli_complain("%s: takes nothing for %.0f s: its end, and %llu records before, are lost",
            file.path, WAITS_S, (unsigned long long)file.lost);
    } else if (file.lost) {
        cli_complain(
            "%s: was written too slowly: %llu records lost: name a faster disk, or a lower rate",
            file.path, (unsigned long long)file.lost);
    }
    return err || file.lost ? 1 : 0;
}
