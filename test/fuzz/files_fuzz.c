/* SPDX-License-Identifier: MIT */
/* Any bytes as any file that the host reads, as datagrams of a log and as a stock glove's line. The
 * first byte of an input selects the kind, and the rest is the file. Files of 'l', 'p', 'i', 'c'
 * and 'u' get correct CRCs first, because a mutation would fail there. A parser may take the file
 * or refuse it. It must end, and touch nothing that is not its own. Links with driver.c, or with
 * libFuzzer.
 */
#define _GNU_SOURCE
#include "base/logfile.h"
#include "base/params_file.h"
#include "base/scenes.h"
#include "bench/positions.h"
#include "bench/samples.h"
#include "box/glove_image.h"
#include "box/hand_record.h"
#include "box/images.h"
#include "box/pieces.h"
#include "box/recording.h"
#include "glove/poses.h"
#include "identify/result.h"
#include "world/mesh.h"
#include "world/scene_text.h"
#include "world/world.h"

#include "cyberglove.h"
#include "sim/trace.h"

#include "exhand/bytes.h"
#include "exhand/record.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

struct bytes {
    const uint8_t *byte;
    size_t n;
    const char *path; /* a file of the same */
};

static void log_file(const struct bytes *b)
{
    struct logfile l;
    struct logfile_place place;
    struct exh_record r;
    memset(&l, 0, sizeof l);
    if (logfile_open(&l, b->path)) { return; }
    l.scene->defaults();
    (void)logfile_calibrations(&l);
    logfile_place(&l, &place);
    while (logfile_next(&l, &r)) {}
    logfile_go(&l, &place);
    (void)logfile_next(&l, &r);
    (void)logfile_complain(&l);
    logfile_close(&l);
}

static void parameters(const struct bytes *b)
{
    for (int i = 0; i < CLI_SCENES; i++) {
        cli_scenes[i]->defaults();
        (void)params_load_file(b->path, cli_scenes[i]->params);
    }
}

static void device(const struct bytes *b)
{
    struct result_file r;
    (void)result_read(&r, b->path);
}

static void poses(const struct bytes *b)
{
    static struct glove_taken t;
    memset(&t, 0, sizeof t);
    (void)glove_poses_read(&t, b->path);
    (void)glove_poses_read_columns(&t, b->path, "label=1,2-23", "2,-1");
}

static void glove_image(const struct bytes *b)
{
    static struct exh_glove_cal cal;
    (void)glove_image_read(&cal, "--glove", b->path);
}

static void finger_images(const struct bytes *b)
{
    static struct images im;
    memset(&im, 0, sizeof im);
    exh_scene_drop.defaults();
    if (images_take(&im, b->path) == 0) { (void)images_give(&im, &exh_scene_drop); }
}

static void one_recording(const struct bytes *b, const char *columns, const char *scale)
{
    const struct recording_ask ask = {RECORDING_GUESS, columns, scale};
    struct recording r;
    memset(&r, 0, sizeof r);
    if (recording_read(&r, b->path, &ask)) { return; }
    recording_hold(&r);
    (void)recording_row_hz(&r);
    (void)recording_gaps(&r);
    recording_free(&r);
}

static void recordings(const struct bytes *b)
{
    one_recording(b, NULL, NULL);
    one_recording(b, "time=1,2-23", "0.5,3");
}

static void hand(const struct bytes *b)
{
    const struct sim_exo_par exo = sim_exo_default();
    struct hand_record h;
    memset(&h, 0, sizeof h);
    if (hand_record_read(&h, b->path, NULL, 60, &exo)) { return; }
    (void)hand_record_again(&h);
    hand_record_free(&h);
}

static void delays(const struct bytes *b)
{
    for (int kind = SIM_TRACE_MS; kind <= SIM_TRACE_ROUND; kind++) {
        struct sim_trace t = {NULL, 0};
        char why[200];
        if (sim_trace_read(&t, b->path, (enum sim_trace_kind)kind, why, sizeof why) == 0) {
            sim_trace_free(&t);
        }
    }
}

static void scene(const struct bytes *b)
{
    char error[300], *text = malloc(b->n + 1);
    struct scene *s;
    if (text == NULL) { return; }
    memcpy(text, b->byte, b->n);
    text[b->n] = 0;
    s = scene_read("/nowhere/fuzz.world", text, error, sizeof error);
    if (s) { scene_free(s); }
    free(text);
}

static void mesh(const struct bytes *b)
{
    char error[300];
    struct mesh *m = mesh_read(b->path, 0.001, error, sizeof error);
    if (m) { mesh_free(m); }
}

static void lines_of_an_encoder(const struct bytes *b)
{
    static const double rate_Hz[] = {0, 1e6};
    static struct samples_chunk c;
    for (int i = 0; i < 2; i++) {
        const struct samples_opt opt = {b->path, rate_Hz[i], 0, 1, i ? 2 : -1, 1};
        struct samples s;
        memset(&s, 0, sizeof s);
        if (samples_open(&s, &opt)) { continue; }
        while (samples_next(&s, &c) == 0 && c.n > 0) {}
        samples_close(&s);
    }
}

static void positions(const struct bytes *b) { (void)positions_print(b->path, "2", 0.001); }

/* Two bytes of length, then a datagram, of one of two senders. */
static void datagrams(const struct bytes *b)
{
    static struct pieces p;
    struct pieces_part part;
    pieces_open(&p, NULL, NULL);
    for (size_t at = 0; at + 2 <= b->n;) {
        const size_t asked = (size_t)b->byte[at] | (size_t)(b->byte[at + 1] & 0x7F) << 8;
        const size_t left = b->n - at - 2, n = asked < left ? asked : left;
        struct sockaddr_in from;
        memset(&from, 0, sizeof from);
        from.sin_port = b->byte[at + 1] >> 7;
        if (pieces_take(&p, &from, &b->byte[at + 2], n, &part)) {
            static volatile uint8_t sum; /* all of it is there */
            for (uint32_t i = 0; i < part.n; i++) { sum ^= part.byte[i]; }
            for (uint32_t i = 0; i < part.more_n; i++) { sum ^= part.more[i]; }
        }
        at += 2 + n;
    }
    pieces_complain(&p, 0);
}

static void glove_line(const struct bytes *b)
{
    struct cyberglove g;
    memset(&g, 0, sizeof g);
    for (size_t i = 0; i < b->n; i++) {
        if (!cyberglove_take(&g, b->byte[i])) { continue; }
        for (int k = 0; k < CYBERGLOVE_SENSORS; k++) {
            if (g.sample[k] == 0) { abort(); }
        }
    }
}

/* --- CRCs --- */

/* Of the n bytes, in the four behind them. */
static void put_crc(uint8_t *byte, size_t n)
{
    struct exh_bytes c = exh_bytes_writer(byte + n, 4);
    uint32_t crc = exh_crc32(0, byte, n);
    exh_bytes_u32(&c, &crc);
}

static void mend_image(uint8_t *byte, size_t n)
{
    if (n >= 4) { put_crc(byte, n - 4); }
}

static size_t u16(const uint8_t *byte) { return (size_t)byte[0] | (size_t)byte[1] << 8; }

static void mend_log(uint8_t *byte, size_t n)
{
    for (size_t at = 0; at + 18 <= n;) {
        const size_t end = at + 14 + u16(&byte[at + 4]);
        if (u16(&byte[at]) != EXH_RECORD_SYNC) {
            at++;
        } else if (end + 4 > n) {
            return;
        } else {
            put_crc(&byte[at], end - at);
            at = end + 4;
        }
    }
}

static void mend_pieces(uint8_t *byte, size_t n)
{
    for (size_t at = 0; at + 2 <= n;) {
        const size_t len = u16(&byte[at]) & 0x7FFF, left = n - at - 2;
        if (len <= left) { mend_image(&byte[at + 2], len); }
        at += 2 + len;
    }
}

static const struct parser {
    char name, mended;
    void (*run)(const struct bytes *b);
    void (*mend)(uint8_t *byte, size_t n);
} parser[] = {{'L', 'l', log_file, mend_log}, {'P', 'p', parameters, mend_image},
    {'I', 'i', glove_image, mend_image}, {'C', 'c', finger_images, mend_image},
    {'U', 'u', datagrams, mend_pieces}, {'D', 0, device, NULL}, {'G', 0, poses, NULL},
    {'R', 0, recordings, NULL}, {'H', 0, hand, NULL}, {'T', 0, delays, NULL}, {'S', 0, scene, NULL},
    {'M', 0, mesh, NULL}, {'E', 0, lines_of_an_encoder, NULL}, {'X', 0, positions, NULL},
    {'Y', 0, glove_line, NULL}};

/* As a separate file. */
static void run(const struct parser *p, const uint8_t *byte, size_t n)
{
    char path[40];
    const struct bytes b = {byte, n, path};
    const int fd = memfd_create("fuzz", 0);
    if (fd >= 0 && (n == 0 || write(fd, byte, n) == (ssize_t)n)) {
        snprintf(path, sizeof path, "/proc/self/fd/%d", fd);
        p->run(&b);
    }
    if (fd >= 0) { close(fd); }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    /* Of the file's length, for the sanitizer. */
    uint8_t *byte = size > 0 ? malloc(size > 1 ? size - 1 : 1) : NULL;
    if (byte == NULL) { return 0; }
    memcpy(byte, data + 1, size - 1);
    for (size_t i = 0; i < sizeof parser / sizeof parser[0]; i++) {
        const int mended = parser[i].mend && (char)data[0] == parser[i].mended;
        if (mended) { parser[i].mend(byte, size - 1); }
        if (mended || (char)data[0] == parser[i].name) { run(&parser[i], byte, size - 1); }
    }
    free(byte);
    return 0;
}
