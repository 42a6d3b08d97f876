/* SPDX-License-Identifier: MIT */
/* exhand run --log: written by a separate thread, so that a paced box does not wait for it. */
#include "live/live.h"
#include "live/log_turn.h"

#include "exhand/run/log.h"

#include "base/option.h"
#include "base/outfile.h"
#include "base/outlog.h"
#include "posix.h"
#include "base/writer.h"

#include "exhand/record.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#define RING_B  (4u << 20) /* some seconds of five fingers at 2 kHz */
#define WAITS_S 2.0        /* at the end, for a file that takes nothing */

static struct {
    const char *path;
    FILE *file;
    int paced;
    uint64_t lost;
    uint32_t taken; /* records, modulo 2^32 as their numbers are */
    struct writer writer;
    uint64_t size_B;       /* of a file; 0: without end */
    uint64_t bytes, key_B; /* of this file; of it at its last keyframe */
    uint64_t lost_before;  /* this file began */
    uint32_t header_B;
} file;

static uint8_t header[EXH_LOG_RECORD_B]; /* a record, for the next file */

static uint8_t ring[RING_B];

static int open_file(const struct live_log_size *size)
{
    static const struct writer_hooks hooks = {log_turn, log_turn_look};
    int err = log_turn_open(file.path, size->B > 0, size->keep);
    if (err) { return err; }
    file.file = outfile_open("log", file.path);
    if (file.file == NULL) { return 2; }
    err = writer_start(&file.writer, fileno(file.file), ring, sizeof ring);
    if (err == 0) { writer_hook(&file.writer, &hooks); }
    if (err) { cli_complain("--log: no thread that writes: %s", strerror(err)); }
    return err ? 1 : 0;
}

int live_log_open(const char *path, int paced, const struct live_log_size *size)
{
    memset(&file, 0, sizeof file);
    file.path = path;
    file.paced = paced;
    file.size_B = size->B;
    return path ? open_file(size) : 0;
}

FILE *live_log_file(void) { return file.file; }

/* Nothing ticks any more. */
static int is_last(const void *rec, size_t len_B)
{
    struct exh_record r;
    return exh_record_decode(rec, (uint32_t)len_B, &r) > 0 && r.type == EXH_RECORD_END;
}

/* --- the next file --- */

enum { TYPE_AT = 2, SEQ_AT = 6, TICK_AT = 10 }; /* in a record */

static uint32_t u32_at(const uint8_t *p)
{
    struct exh_bytes c = exh_bytes_reader(p, 4);
    uint32_t v = 0;
    exh_bytes_u32(&c, &v);
    return v;
}

static uint32_t end_record(uint8_t to[64], const uint8_t *key)
{
    struct exh_bytes c = exh_bytes_writer(to, 64);
    uint32_t lost = (uint32_t)(file.lost - file.lost_before);
    exh_record_begin(&c, EXH_RECORD_END, u32_at(key + SEQ_AT), u32_at(key + TICK_AT));
    exh_bytes_u32(&c, &lost);
    return exh_record_end(&c);
}

/* The newest that came, with the number before the keyframe's. */
static void number_header(const uint8_t *key)
{
    struct exh_bytes c = exh_bytes_writer(header, sizeof header);
    const uint32_t end = file.header_B - (EXH_RECORD_OVERHEAD - EXH_RECORD_HEAD_B);
    uint32_t seq = u32_at(key + SEQ_AT) - 1, crc;
    c.at = SEQ_AT;
    exh_bytes_u32(&c, &seq);
    crc = exh_crc32(0, header, end);
    c.at = end;
    exh_bytes_u32(&c, &crc);
}

/* Before a keyframe, with which the next file begins, if the frames up to the following one would
 * not fit. If the writer has no room now, the next keyframe is used. */
static void turn(const uint8_t *key, size_t len_B)
{
    uint8_t end[64];
    const uint32_t end_B = end_record(end, key);
    if (file.bytes + (file.bytes - file.key_B) + end_B <= file.size_B) { return; }
    while (!writer_takes(&file.writer, end_B + file.header_B + len_B)) {
        if (file.paced || posix_interrupted() || writer_put(&file.writer, end, 0, 0) < 0) {
            return;
        }
        (void)nanosleep(&(struct timespec){0, 1000000}, NULL);
    }
    (void)writer_put(&file.writer, end, end_B, 0);
    writer_cut(&file.writer);
    number_header(key);
    (void)writer_put(&file.writer, header, file.header_B, 0);
    file.bytes = file.header_B;
    file.lost_before = file.lost;
}

static void follow(const uint8_t *rec, size_t len_B)
{
    const int is_record = len_B >= EXH_RECORD_OVERHEAD && rec[0] == (EXH_RECORD_SYNC & 0xFF) &&
                          rec[1] == EXH_RECORD_SYNC >> 8; /* else a scene's words */
    if (is_record && rec[TYPE_AT] == EXH_RECORD_HEADER && len_B <= sizeof header) {
        memcpy(header, rec, len_B);
        file.header_B = (uint32_t)len_B;
    } else if (is_record && rec[TYPE_AT] == EXH_RECORD_KEYFRAME && file.header_B &&
               file.bytes > file.header_B) {
        turn(rec, len_B);
        file.key_B = file.bytes;
    }
    file.bytes += len_B;
}

/* In virtual time there is time to wait; behind Ctrl-C only while the file takes something. */
int live_log_put(const void *rec, size_t len_B)
{
    int taken;
    if (file.size_B) { follow(rec, len_B); }
    taken = writer_put(&file.writer, rec, len_B, 0);
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
    if (err > 0 && outlog_mend(file.file, file.taken, (uint32_t)(file.lost - file.lost_before))) {
        outfile_abandon(file.file);
    } else if (err >= 0 && file.size_B && outlog_has_frame(file.file) && log_turn_shift() != 0) {
        cli_complain(
            "--log: %s: can't be renamed: %s: the end is lost", file.path, strerror(errno));
        outfile_abandon(file.file);
        return 1;
    } else if (err >= 0 && outlog_close(file.file) != 0) {
        return 1;
    }
    if (err > 0) {
        cli_complain("--log: %s: can't be written: %s: %llu records lost, and %llu bytes that were "
                     "taken before: make room, or give another --log",
            file.path, strerror(err), (unsigned long long)file.lost,
            (unsigned long long)writer_held(&file.writer));
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
