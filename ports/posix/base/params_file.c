/* SPDX-License-Identifier: MIT */
#include "base/params_file.h"

#include "base/names.h"
#include "base/option.h"
#include "base/outfile.h"
#include "base/outpart.h"
#include "base/param.h"

#include "exhand/bytes.h"
#include "exhand/error.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define HEAD_B 12u

/* --- out --- */

int params_write(const char *path, const void *image, size_t len_B)
{
    struct outpart p;
    const unsigned char *b = image;
    int failed = outpart_open(&p, path);
    while (!failed && len_B > 0) {
        const ssize_t done = write(p.fd, b, len_B);
        if (done > 0) {
            b += done;
            len_B -= (size_t)done;
        } else if (done == 0 || errno != EINTR) {
            failed = done < 0 ? errno : EIO;
        }
    }
    if (!failed) { failed = outpart_commit(&p); }
    outpart_abandon(&p);
    return failed;
}

int params_save_file(const char *path, const struct exh_params *p)
{
    unsigned char image[PARAMS_FILE_B];
    const int32_t n = exh_params_save(p, image, sizeof image);
    const int why = n < 0 ? EFBIG : params_write(path, image, (size_t)n);
    if (why == 0) { return 0; }
    cli_complain("--save-params: %s: can't be written: %s: make room, or give another file", path,
        strerror(why));
    return 1;
}

/* --- in --- */

/* Another version, or the values of another scene. */
static void tell_head(const char *name, const struct exh_params *p, const void *image, size_t len_B)
{
    struct exh_bytes c = exh_bytes_reader(image, len_B);
    uint32_t magic, table;
    uint16_t version, count;
    exh_bytes_u32(&c, &magic);
    exh_bytes_u16(&c, &version);
    exh_bytes_u16(&c, &count);
    exh_bytes_u32(&c, &table);
    if (memcmp(image, "EXHP", 4) != 0) {
        cli_complain("%s: no image of parameters: give one that was saved", name);
    } else if (version != EXH_PARAMS_VERSION) {
        cli_complain("%s: an image of version %u, this program's is %d: save it anew", name,
            version, EXH_PARAMS_VERSION);
    } else {
        cli_complain("%s: %u values of table %08" PRIx32 ", this scene has %" PRIu32
                     " of table %08" PRIx32 ": give an image of this scene, of this version",
            name, count, table, p->count, exh_signal_crc(p->table));
    }
}

static int32_t value_of(const void *image, size_t len_B, uint32_t i)
{
    struct exh_bytes c = exh_bytes_reader(image, len_B);
    int32_t v;
    c.at = HEAD_B + 4 * i;
    exh_bytes_i32(&c, &v);
    return v;
}

static void tell_value(
    const char *name, const struct exh_params *p, uint32_t i, int32_t raw, int err)
{
    uint16_t instance = 0;
    const struct exh_signal *r = exh_signal_at(p->table, i, &instance);
    if (err == -EXH_E_STATE) {
        cli_complain("%s: %s (instance %u): %.12g: only before it runs: start with it", name,
            r->name, instance, cli_signal_value(r, raw));
    } else {
        cli_complain(
            "%s: %s (instance %u): %.12g (allowed %.12g..%.12g%s%s): nothing of it is taken", name,
            r->name, instance, cli_signal_value(r, raw), cli_signal_value(r, r->min),
            cli_signal_value(r, r->max), r->unit[0] ? " " : "", names_unit(r->unit));
    }
}

int params_take(const char *name, struct exh_params *p, const void *image, size_t len_B)
{
    const size_t whole_B = HEAD_B + 4 * (size_t)p->count + 4;
    uint32_t bad = 0;
    const int err = exh_params_load(p, image, len_B, &bad);
    if (err == -EXH_E_VERSION) {
        tell_head(name, p, image, len_B);
    } else if (err == -EXH_E_SHORT) {
        cli_complain("%s: cut off, %zu bytes of %zu: nothing of it is taken", name, len_B, whole_B);
    } else if (err == -EXH_E_CRC) {
        cli_complain("%s: damaged, its CRC is another: nothing of it is taken", name);
    } else if (err < 0) {
        tell_value(name, p, bad, value_of(image, len_B, bad), err);
    }
    return err;
}

/* 1: value i is the person's, and the image has another one. */
static int is_left(const struct exh_params *p, const void *image, size_t len_B, uint32_t i)
{
    const struct exh_signal *row = exh_signal_at(p->table, i, NULL);
    return row->when == EXH_WHEN_PERSON && value_of(image, len_B, i) != p->staged[i];
}

void params_tell_left(const char *name, const struct exh_params *p, const void *image, size_t len_B)
{
    static int told;
    char line[1024];
    int at = 0;
    for (uint32_t i = 0; i < p->count && !told; i++) {
        uint16_t instance = 0;
        const struct exh_signal *r = exh_signal_at(p->table, i, &instance);
        int again = !is_left(p, image, len_B, i);
        for (uint16_t k = 0; k < instance && !again; k++) {
            again = is_left(p, image, len_B, (uint32_t)exh_signal_find(p->table, r->id, k));
        }
        if (again || at >= (int)sizeof line - 100) { continue; }
        at += snprintf(line + at, sizeof line - (size_t)at, "%s%s %.8g (stays %.8g%s%s)",
            at ? ", " : "", r->name, cli_signal_value(r, value_of(image, len_B, i)),
            cli_signal_value(r, p->staged[i]), r->unit[0] ? " " : "", names_unit(r->unit));
    }
    if (at) { cli_complain("%s: left alone, since only --set sets them: %s", name, line); }
    told = 1;
}

int params_file_read(struct params_file *f)
{
    long len;
    f->len_B = 0;
    if (f->load == NULL) { return 0; }
    len = outfile_read("load-params", f->load, "image of parameters", f->image, sizeof f->image);
    if (len < 0) { return (int)-len; }
    f->len_B = (size_t)len;
    return 0;
}

int params_load_file(const char *path, struct exh_params *p)
{
    static struct params_file f;
    int err;
    f.load = path;
    err = params_file_read(&f);
    return err ? err : params_take(path, p, f.image, f.len_B) < 0 ? 2 : 0;
}
