/* SPDX-License-Identifier: MIT */
#include "base/logfile.h"

#include "base/option.h"
#include "base/scenes.h"

#include "exhand/calibrate.h"
#include "exhand/error.h"
#include "exhand/exhand.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int complain(const struct logfile *l, const char *what)
{
    cli_complain("%s: %s", l->path, what);
    return 2;
}

static int read_file(struct logfile *l)
{
    FILE *f = fopen(l->path, "rb");
    long len = -1;
    if (f == NULL) {
        (void)complain(l, strerror(errno));
        return 3;
    }
    if (fseek(f, 0, SEEK_END) == 0) { len = ftell(f); }
    rewind(f);
    if (len >= 0 && len < 0x7FFFFFFF) { l->bytes = malloc((size_t)len + 1); }
    if (l->bytes != NULL) { l->len = (uint32_t)fread(l->bytes, 1, (size_t)len, f); }
    fclose(f);
    return l->bytes != NULL && l->len == (uint32_t)len ? 0 : complain(l, "can't be read whole");
}

static int read_header(struct logfile *l)
{
    struct exh_record r;
    struct exh_bytes c;
    if (exh_record_decode(l->bytes, l->len, &r) == -EXH_E_VERSION) {
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
    l->params = r.payload + c.at;
    l->params_len = r.len_B - c.at;
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
    err = read_file(l);
    return err ? err : read_header(l);
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
    free(l->bytes);
    l->bytes = NULL;
}

void logfile_rewind(struct logfile *l, uint32_t at)
{
    l->at = at;
    l->next_seq = 1;
    l->damaged = l->gaps = l->lost = 0;
    l->ended = l->started = 0;
}

/* Forward or back by less than half a wrap. */
static void follow_tick(struct logfile *l, const struct exh_record *r)
{
    const uint32_t step = r->tick - (uint32_t)l->tick;
    if (r->type == EXH_RECORD_HEADER) { return; } /* it stands before all ticks */
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

int logfile_next(struct logfile *l, struct exh_record *r)
{
    while (l->at < l->len && !l->ended) { /* what comes behind the end is not the log's, either */
        const int32_t n = exh_record_decode(l->bytes + l->at, l->len - l->at, r);
        if (n < 0) {
            l->damaged++;
            l->at++;
            continue;
        }
        l->at += (uint32_t)n;
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
    /* Bytes between records of which none is missing are a box's words on the same line. */
    if (l->gaps == 0 && l->ended) { return 0; }
    cli_complain("%s: %lu damaged bytes, %lu records missing (%lu reported lost by the writer), %s",
        l->path, (unsigned long)l->damaged, (unsigned long)l->gaps, (unsigned long)l->lost,
        l->ended ? "end reached" : "cut off before its end");
    return 1;
}
