/* SPDX-License-Identifier: MIT */
#define _FILE_OFFSET_BITS 64 /* where long has 32 bits, too */
#include "base/logfile.h"

#include "base/option.h"
#include "base/progress.h"
#include "base/scenes.h"
#include "base/until.h"

#include "exhand/calibrate.h"
#include "exhand/error.h"
#include "exhand/exhand.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define RECORD_MAX_B (EXH_RECORD_OVERHEAD + 65535u)
#define BUFFER_B     (4u * RECORD_MAX_B)
#define LONG_S       2.0
#define SHOWS_S      0.5

static int complain(const struct logfile *l, const char *what)
{
    cli_complain("%s: %s", l->path, what);
    return 2;
}

static int open_file(struct logfile *l)
{
    struct stat st;
    l->fd = open(l->path, O_RDONLY | O_NONBLOCK | O_CLOEXEC); /* no FIFO is waited for */
    if (l->fd < 0) {
        (void)complain(l, strerror(errno));
        return 3;
    }
    if (fstat(l->fd, &st) != 0 || !S_ISREG(st.st_mode)) {
        return complain(l, "not a log that can be read twice: give a regular file, no pipe, device "
                           "or directory");
    }
    l->len = (uint64_t)st.st_size; /* what a box still adds is not read */
    l->bytes = malloc(BUFFER_B);
    return l->bytes != NULL ? 0 : complain(l, strerror(ENOMEM));
}

/* A line that was begun is ended. */
static void show(struct logfile *l)
{
    const double now_s = until_now_s();
    const uint64_t to = l->at + l->filled;
    const int over = to >= l->len, due = now_s >= l->shown_s || (over && l->shows == 2);
    if (!l->shows || !due) { return; }
    progress_show(l->path, (int)(100 * (double)to / (double)l->len), 100, over);
    l->shows = over ? 1 : 2;
    l->shown_s = now_s + SHOWS_S;
}

/* Bytes at the place of the next record: all that are left of the log, or a record's at least. */
static uint32_t fill(struct logfile *l)
{
    const uint32_t have = l->filled - l->taken;
    if (have >= RECORD_MAX_B || l->at + have >= l->len) { return have; }
    memmove(l->bytes, l->bytes + l->taken, have);
    l->taken = 0;
    l->filled = have;
    while (l->filled < BUFFER_B && l->at + l->filled < l->len) {
        const uint64_t left = l->len - l->at - l->filled;
        const size_t most = left < BUFFER_B - l->filled ? (size_t)left : BUFFER_B - l->filled;
        const ssize_t n = pread(l->fd, l->bytes + l->filled, most, (off_t)(l->at + l->filled));
        if (n < 0 && errno == EINTR) { continue; }
        if (n <= 0) { /* the disk failed, or the file was truncated */
            l->error = n < 0 ? errno : 0;
            l->len = l->at + l->filled;
            break;
        }
        l->filled += (uint32_t)n;
    }
    show(l);
    return l->filled;
}

static void take(struct logfile *l, uint32_t n)
{
    l->taken += n;
    l->at += n;
}

/* The header's payload has to outlive the buffer. */
static int keep_header(struct logfile *l, const struct exh_record *r, uint32_t head_B)
{
    l->head = malloc((size_t)r->len_B + 1);
    if (l->head == NULL) { return complain(l, strerror(ENOMEM)); }
    memcpy(l->head, r->payload, r->len_B);
    l->params = l->head + head_B;
    l->params_len = r->len_B - head_B;
    return 0;
}

static int read_header(struct logfile *l)
{
    struct exh_record r;
    struct exh_bytes c;
    if (exh_record_decode(l->bytes, fill(l), &r) == -EXH_E_VERSION) {
        cli_complain("%s: a log of record version %u, this program's is %d: read it with the "
                     "program that made it",
            l->path, r.version, EXH_RECORD_VERSION);
        return 2;
    }
    if (!logfile_next(l, &r) || r.type != EXH_RECORD_HEADER) {
        return complain(l, "not a log: it does not start with a header: give a file made by "
                           "`exhand drop --out DIR` or `exhand glove --record FILE`");
    }
    c = exh_bytes_reader(r.payload, r.len_B);
    exh_record_header_serialize(&c, &l->header);
    if (!exh_bytes_ok(&c)) { return complain(l, "its header is too short"); }
    if (keep_header(l, &r, c.at)) { return 2; }
    l->next_seq = r.seq + 1; /* one that begins in mid-run goes on with its numbers */
    l->gaps = 0;
    logfile_place(l, &l->begin);
    l->begin.damaged = 0;
    l->scene = cli_scene_find(l->header.scene);
    if (l->scene == NULL) { return complain(l, "made by a scene this program does not have"); }
    if (l->header.lib_version != EXH_VERSION_NUMBER) {
        cli_complain("%s: library version %lx, this program has %lx: results may differ", l->path,
            (unsigned long)l->header.lib_version, (unsigned long)EXH_VERSION_NUMBER);
    }
    if (l->header.signal_crc != exh_signal_crc(l->scene->signals) ||
        l->header.signals != exh_signal_count(l->scene->signals) ||
        l->header.fingers != l->scene->fingers) {
        return complain(l, "its signal table is another than this program's");
    }
    if (l->header.enc_bits > 32) { return complain(l, "its counters are wider than 32 bits"); }
    return exh_period_ok(l->header.T) ? 0 : complain(l, "its period is outside 1/20000..1 s");
}

int logfile_open(struct logfile *l, const char *path)
{
    int err;
    memset(l, 0, sizeof *l);
    l->path = path;
    l->shown_s = until_now_s() + LONG_S;
    err = open_file(l);
    if (err == 0) { err = read_header(l); }
    if (err) { logfile_close(l); }
    return err;
}

/* Of an image that begins there: what its number of points makes of it; 0: it is cut off. */
static uint32_t calibration_B(const uint8_t *at, uint32_t left_B)
{
    struct exh_calib_point point[EXH_CALIB_POINTS_MAX];
    struct exh_calib c = {.point = point, .cap = EXH_CALIB_POINTS_MAX};
    if (exh_calib_load(&c, at, left_B, NULL) < 0) { return 0; }
    return EXH_CALIB_IMAGE_B - 16u * (EXH_CALIB_POINTS_MAX - (uint32_t)c.points);
}

int logfile_calibrations(const struct logfile *l)
{
    struct exh_scene_calib *k = l->scene->calib;
    const uint32_t n = l->scene->params ? exh_signal_count(l->scene->params->table) : 0;
    uint32_t at = 12 + 4 * n + 4; /* behind exh_params_save() */
    if (k == NULL) { return 0; }
    k->images = 0;
    while (at < l->params_len) {
        const uint32_t len_B = calibration_B(l->params + at, l->params_len - at);
        if (len_B == 0 || k->images == EXH_FINGERS) {
            return complain(l, "calibration image of its header: damaged");
        }
        k->image[k->images].byte = l->params + at;
        k->image[k->images++].len_B = len_B;
        at += len_B;
    }
    return 0;
}

void logfile_close(struct logfile *l)
{
    if (l->path != NULL && l->fd >= 0) { (void)close(l->fd); }
    free(l->bytes);
    free(l->head);
    l->bytes = l->head = NULL;
    l->fd = -1;
}

void logfile_place(const struct logfile *l, struct logfile_place *p)
{
    *p = (struct logfile_place){
        l->at, l->tick, l->damaged, l->next_seq, l->gaps, l->lost, l->started};
}

void logfile_go(struct logfile *l, const struct logfile_place *p)
{
    l->at = p->at;
    l->taken = l->filled = 0;
    l->tick = p->tick;
    l->damaged = p->damaged;
    l->next_seq = p->next_seq;
    l->gaps = p->gaps;
    l->lost = p->lost;
    l->started = p->started;
    l->ended = 0;
}

void logfile_rewind(struct logfile *l) { logfile_go(l, &l->begin); }

/* Forward or back by less than half a wrap. */
static void follow_tick(struct logfile *l, const struct exh_record *r)
{
    const uint32_t step = r->tick - (uint32_t)l->tick;
    if (r->type == EXH_RECORD_HEADER) { return; } /* it precedes all ticks */
    if (!l->started) {
        l->tick = r->tick;
    } else if (step < UINT32_C(0x80000000)) {
        l->tick += step;
    } else {
        const uint64_t back = UINT64_C(0x100000000) - step;
        l->tick -= back < l->tick ? back : l->tick;
    }
    l->started = 1;
}

/* No record begins here: on to the next byte that one may begin with. */
static void skip(struct logfile *l, uint32_t have)
{
    const uint8_t *const here = l->bytes + l->taken;
    const uint8_t *const next = memchr(here + 1, EXH_RECORD_SYNC & 0xFF, have - 1);
    const uint32_t n = next ? (uint32_t)(next - here) : have;
    l->damaged += n;
    take(l, n);
}

int logfile_next(struct logfile *l, struct exh_record *r)
{
    uint32_t have;
    while (
        !l->ended && (have = fill(l)) > 0) { /* what is behind the end is not the log's, either */
        const int32_t n = exh_record_decode(l->bytes + l->taken, have, r);
        if (n < 0) {
            skip(l, have);
            continue;
        }
        take(l, (uint32_t)n);
        l->gaps += r->seq - l->next_seq;
        l->next_seq = r->seq + 1;
        follow_tick(l, r);
        if (r->type == EXH_RECORD_END) { l->ended = 1; }
        if (r->type == EXH_RECORD_DROPPED) {
            struct exh_bytes c = exh_bytes_reader(r->payload, r->len_B);
            uint32_t lost = 0;
            exh_bytes_u32(&c, &lost);
            l->lost += lost;
        }
        return 1;
    }
    return 0;
}

int logfile_complain(const struct logfile *l)
{
    char end[96] = "end reached";
    /* Bytes between records of which none is missing are a box's words on the same line. */
    if (l->gaps == 0 && l->ended) { return 0; }
    if (!l->ended) {
        snprintf(end, sizeof end,
            "cut off before its end: read to its last whole record, tick %" PRIu64, l->tick);
    }
    if (l->error) { cli_complain("%s: can't be read on: %s", l->path, strerror(l->error)); }
    cli_complain("%s: %" PRIu64 " damaged bytes, %lu records missing (%lu reported lost by the "
                 "writer), %s",
        l->path, l->damaged, (unsigned long)l->gaps, (unsigned long)l->lost, end);
    return 1;
}
