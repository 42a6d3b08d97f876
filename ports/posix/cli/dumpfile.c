#include "dumpfile.h"

#include "names.h"
#include "option.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static struct {
    char path[DUMPFILE_PATH_B];
    uint8_t *memory;
    int logged, on, dumps, failed;
} box;

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
            cli_complain("black box: none: its memory is too small at this rate, or the scene has no state");
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
                 is->cause ? "fault " : "halted", is->cause ? what : "", (unsigned long)is->tick,
                 path);
}

/* The whole dump at once: time stands still here. */
static void write_dump(void)
{
    const struct exh_blackbox_is is = exh_blackbox_is();
    char path[DUMPFILE_PATH_B + 12];
    uint8_t piece[4096];
    uint32_t n;
    FILE *f;
    if (is.state != EXH_BLACKBOX_FROZEN) { return; }
    snprintf(path, sizeof path, box.dumps ? "%s.%d" : "%s", box.path, box.dumps + 1);
    box.dumps++;
    f = fopen(path, "wb");
    while ((n = exh_blackbox_read(piece, sizeof piece)) > 0) {
        if (f != NULL && fwrite(piece, 1, n, f) != n) { box.failed = 1; }
    }
    if (f == NULL || fclose(f) != 0 || box.failed) {
        cli_complain("%s: %s: make room or name another file", path, strerror(errno));
        box.failed = 1;
        return;
    }
    told(&is, path);
}

void dumpfile_after(uint32_t tick, const struct exh_scene_in *in, const struct exh_drive_out *out)
{
    if (box.on) {
        exh_blackbox_after(tick, in, out);
        write_dump();
    } else if (box.logged) {
        exh_log_after(tick, in, out);
    }
}

int dumpfile_close(int halted)
{
    if (box.on) {
        exh_blackbox_stop(halted);
        write_dump();
    }
    exh_log_tap(NULL, 0);
    exh_blackbox_memory(NULL, 0, 0);
    free(box.memory);
    box.memory = NULL;
    box.on = 0;
    return box.failed ? -1 : box.dumps;
}
