/* SPDX-License-Identifier: MIT */
#include "base/outlog.h"

#include "base/outfile.h"

#include "exhand/record.h"

#include <stdint.h>
#include <sys/stat.h>
#include <unistd.h>

#define START_B 65536 /* a frame comes before that many bytes */

int outlog_has_frame(FILE *f)
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

#define TAIL_B 262144 /* holds some records */
#define END_B  64

static uint32_t end_record(uint8_t to[END_B], const struct exh_record *last, uint32_t lost)
{
    struct exh_bytes c = exh_bytes_writer(to, END_B);
    exh_record_begin(&c, EXH_RECORD_END, last->seq + 1, last->tick + 1);
    exh_bytes_u32(&c, &lost);
    return exh_record_end(&c);
}

/* There may be no room for more: the end takes that of the last records. */
int outlog_mend(FILE *f, uint32_t taken, uint32_t lost)
{
    static uint8_t tail[TAIL_B];
    const int fd = fileno(f);
    const uint32_t end_B = EXH_RECORD_OVERHEAD + sizeof lost;
    struct stat st;
    struct exh_record r, last = {.type = 0};
    uint8_t end[END_B];
    ssize_t n, at = 0, keep = 0;
    off_t from;
    if (fstat(fd, &st) != 0 || !S_ISREG(st.st_mode)) { return -1; }
    from = st.st_size > TAIL_B ? st.st_size - TAIL_B : 0;
    n = pread(fd, tail, sizeof tail, from);
    while (at < n) {
        const int32_t len = exh_record_decode(tail + at, (uint32_t)(n - at), &r);
        at += len > 0 ? len : 1;
        if (at + (ssize_t)end_B > n) { break; }
        if (len > 0) {
            last = r;
            keep = at;
        }
    }
    if (keep == 0 || end_record(end, &last, lost + taken - (last.seq + 1)) != end_B) { return -1; }
    if (pwrite(fd, end, end_B, from + keep) != (ssize_t)end_B) { return -1; }
    return ftruncate(fd, from + keep + (off_t)end_B);
}

int outlog_close(FILE *f)
{
    if (fflush(f) == 0 && !ferror(f) && !outlog_has_frame(f)) {
        outfile_abandon(f);
        return 0;
    }
    return outfile_close(f);
}
