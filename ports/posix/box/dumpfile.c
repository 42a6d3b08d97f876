/* SPDX-License-Identifier: MIT */
#include "box/dumpfile.h"

#include "base/names.h"
#include "base/option.h"
#include "base/outfile.h"
#include "base/writer.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PIECE_B 4096u
#define RING_B  (64u * PIECE_B)
#define WAITS_S 2.0 /* at the end, for a file that takes nothing */

static struct {
    char path[DUMPFILE_PATH_B];
    uint8_t *memory;
    int logged, on, dumps, failed;
} box;

/* A dump on its way. */
static struct {
    int on; /* dumps go this way */
    enum { PACED_IDLE, PACED_READS, PACED_ENDS } state;
    struct exh_blackbox_is is;
    char path[DUMPFILE_PATH_B + 12];
    uint8_t piece[PIECE_B];
    size_t held_B; /* of the piece: the ring had no room for it */
    struct writer writer;
} paced;

static uint8_t ring[RING_B];

void dumpfile_paced(int on)
{
    paced.on = on;
    paced.state = PACED_IDLE;
    paced.held_B = 0;
}

int dumpfile_open(const char *path, int logged, size_t len_B)
{
    memset(&box, 0, sizeof box);
    box.logged = logged;
    if (path != NULL) {
        const size_t n = len_B ? len_B : DUMPFILE_B;
        if (strlen(path) + 5 > sizeof box.path) {
            cli_complain("%s: too long a path: give a shorter one", path);
            return 1;
        }
        strcpy(box.path, path);
        box.memory = malloc(n);
        if (box.memory == NULL) {
            cli_complain("out of memory: no black box");
            return 1;
        }
        exh_blackbox_memory(box.memory, n, !logged);
    }
    box.on = path != NULL;
    return 0;
}

void dumpfile_start(const struct exh_scene *sc, struct exh_scene_board board)
{
    if (box.on) {
        exh_blackbox_start(sc, board);
        if (exh_blackbox_is().state == EXH_BLACKBOX_OFF) {
            cli_complain(
                "black box: none: its memory is too small at this rate, or the scene has no state");
        }
    } else {
        exh_log_tap(NULL, 0);
        if (box.logged) { exh_log_start(sc, board); }
    }
}

void dumpfile_before(uint32_t tick, struct exh_scene_in *in)
{
    if (box.on) {
        exh_blackbox_before(tick, in);
    } else if (box.logged) {
        exh_log_before(tick, in);
    }
}

static void told(const struct exh_blackbox_is *is, const char *path)
{
    char what[NAMES_B];
    names_faults(what, sizeof what, is->cause);
    cli_complain("black box: %s%s at tick %lu: %s: exhand replay --timeline tells it",
        is->cause ? "fault " : "halted", is->cause ? what : "", (unsigned long)is->tick, path);
}

static void failed(const char *path, const char *why)
{
    cli_complain("%s: %s: make room or name another file", path, why);
    box.failed = 1;
}

/* The next dump's. */
static void name_dump(char path[DUMPFILE_PATH_B + 12])
{
    snprintf(path, DUMPFILE_PATH_B + 12, box.dumps ? "%s.%d" : "%s", box.path, box.dumps + 1);
    box.dumps++;
}

/* Writes the whole dump in one call: virtual time does not advance. */
static void write_dump(void)
{
    const struct exh_blackbox_is is = exh_blackbox_is();
    char path[DUMPFILE_PATH_B + 12];
    uint8_t piece[PIECE_B];
    uint32_t n;
    FILE *f;
    if (is.state != EXH_BLACKBOX_FROZEN) { return; }
    name_dump(path);
    f = outfile_open(NULL, path);
    while ((n = exh_blackbox_read(piece, sizeof piece)) > 0) {
        if (f != NULL) { (void)fwrite(piece, 1, n, f); }
    }
    if (f != NULL && outfile_close(f) == 0) {
        told(&is, path);
    } else {
        box.failed = 1;
    }
}

/* --- piece by piece --- */

static void paced_begin(void)
{
    int err;
    paced.is = exh_blackbox_is();
    if (paced.is.state != EXH_BLACKBOX_FROZEN) { return; }
    name_dump(paced.path);
    err = writer_start_file(&paced.writer, paced.path, ring, sizeof ring);
    if (err) {
        failed(paced.path, strerror(err));
        exh_blackbox_clear();
        return;
    }
    paced.state = PACED_READS;
}

/* 0: there was no room. */
static int paced_read(double patience_s)
{
    int taken;
    if (paced.held_B == 0) { paced.held_B = exh_blackbox_read(paced.piece, sizeof paced.piece); }
    if (paced.held_B == 0) {
        paced.state = PACED_ENDS;
        return 1;
    }
    taken = writer_put(&paced.writer, paced.piece, paced.held_B, patience_s);
    if (taken) { paced.held_B = 0; }
    if (taken < 0) {
        exh_blackbox_clear();
        paced.state = PACED_ENDS;
    }
    return taken != 0;
}

/* 0: the file takes its time. */
static int paced_end(double patience_s)
{
    const int err = writer_end(&paced.writer, patience_s);
    if (err < 0) { return 0; }
    paced.state = PACED_IDLE;
    if (err) {
        failed(paced.path, strerror(err));
    } else {
        told(&paced.is, paced.path);
    }
    return 1;
}

/* A tick's part of it, or more where there is patience. 0: nothing has moved. */
static int paced_step(double patience_s)
{
    switch (paced.state) {
    case PACED_READS: return paced_read(patience_s);
    case PACED_ENDS: return paced_end(patience_s);
    case PACED_IDLE:
    default: paced_begin(); return paced.state != PACED_IDLE;
    }
}

/* After the last tick: finishes the dump in progress, and one that froze since. */
static void paced_close(void)
{
    while (paced_step(WAITS_S)) {}
    if (paced.state == PACED_IDLE) { return; }
    cli_complain("%s: takes nothing for %.0f s: the end of this dump is lost", paced.path, WAITS_S);
    box.failed = 1;
}

void dumpfile_after(uint32_t tick, const struct exh_scene_in *in, const struct exh_drive_out *out)
{
    if (box.on) {
        exh_blackbox_after(tick, in, out);
        if (paced.on) {
            (void)paced_step(0);
        } else {
            write_dump();
        }
    } else if (box.logged) {
        exh_log_after(tick, in, out);
    }
}

int dumpfile_close(int halted)
{
    if (box.on) {
        exh_blackbox_stop(halted);
        if (paced.on) {
            paced_close();
        } else {
            write_dump();
        }
    }
    exh_log_tap(NULL, 0);
    exh_blackbox_memory(NULL, 0, 0);
    free(box.memory);
    box.memory = NULL;
    box.on = 0;
    return box.failed ? -1 : box.dumps;
}
