/* SPDX-License-Identifier: MIT */
#include "base/csv.h"

#include "base/columns.h"
#include "base/logfile.h"
#include "base/option.h"
#include "base/outfile.h"
#include "base/outpart.h"

#include "exhand/run/log.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

/* --- the rows of a log --- */

struct walk {
    struct logfile *log;
    unsigned what;
    uint64_t tick; /* of the row */
    struct exh_scene_in in;
    int32_t fall; /* the last mark: 0 between falls */
    uint32_t rows;
    uint32_t malformed; /* records of another length than they must have */
    uint32_t unordered; /* frames whose tick does not rise */
};

static void take_mark(struct walk *w, const struct exh_record *r)
{
    struct exh_bytes c = exh_bytes_reader(r->payload, r->len_B);
    struct exh_event e;
    exh_event_serialize(&c, &e);
    if (!exh_bytes_ok(&c) || c.at != r->len_B) {
        w->malformed++;
    } else if (e.type == EXH_EVENT_MARK) {
        w->fall = e.value;
    }
}

/* The next row, its values in the scene's signals and w->in; 0 at the end. */
static int next_row(struct walk *w)
{
    struct exh_record r;
    struct exh_drive_out out;
    while (logfile_next(w->log, &r)) {
        struct exh_bytes c = exh_bytes_reader(r.payload, r.len_B);
        if (r.type == EXH_RECORD_EVENT) { take_mark(w, &r); }
        if (r.type != EXH_RECORD_FRAME) { continue; }
        if ((w->what & CSV_FALLS) && w->fall == 0) { continue; }
        memset(&w->in, 0, sizeof w->in);
        exh_log_frame_serialize(&c, w->log->scene, &w->in, &out, w->log->scene->values);
        if (!exh_bytes_ok(&c) || c.at != r.len_B) {
            w->malformed++;
        } else if (w->rows > 0 && w->log->tick <= w->tick) {
            w->unordered++;
        } else {
            w->tick = w->log->tick;
            w->rows++;
            return 1;
        }
    }
    return 0;
}

/* --- as text --- */

static void header_line(FILE *to, const struct columns *c, int glove)
{
    fprintf(to, "t_s");
    columns_names(to, c);
    for (int i = 0; glove && i < EXH_GLOVE_SENSORS; i++) { fprintf(to, ",raw%d", i); }
    fputc('\n', to);
}

static void line(
    FILE *to, const struct columns *c, double t_s, const int32_t *v, const int16_t *raw)
{
    fprintf(to, "%.9f", t_s);
    columns_values(to, c, v);
    for (int i = 0; raw && i < EXH_GLOVE_SENSORS; i++) { fprintf(to, ",%d", raw[i]); }
    fputc('\n', to);
}

static int write_rows(struct walk *w, const struct columns *c, FILE *to)
{
    const struct exh_scene *sc = w->log->scene;
    const struct exh_period T = w->log->header.T;
    const int glove = sc->read_glove && (w->what & CSV_ALL); /* the codes, too */
    header_line(to, c, glove);
    while (next_row(w)) {
        line(to, c, (double)w->tick * T.num / T.den, sc->values, glove ? w->in.glove.raw : NULL);
    }
    return ferror(to) || fflush(to) != 0;
}

/* --- whole files --- */

/* Reads the log once for nothing but its faults: 0 when there are rows. */
static int survey(struct logfile *l, unsigned what)
{
    struct walk w = {.log = l, .what = what};
    while (next_row(&w)) {}
    logfile_rewind(l);
    if (w.malformed || w.unordered) {
        cli_complain("%s: %lu records of a wrong length and %lu frames whose tick does not rise: "
                     "left out",
            l->path, (unsigned long)w.malformed, (unsigned long)w.unordered);
    }
    if (w.rows > 0) { return w.malformed || w.unordered; }
    cli_complain("%s: holds no %s", l->path, what & CSV_FALLS ? "fall" : "frame");
    return 2;
}

static int convert(
    struct logfile *l, const char *to_path, unsigned what, const struct columns *columns)
{
    struct walk w = {.log = l, .what = what};
    FILE *to = to_path ? outfile_open("out", to_path) : stdout;
    int err;
    if (to == NULL) { return 2; }
    err = write_rows(&w, columns, to);
    if (to_path) { err = outfile_close(to); }
    return err | logfile_complain(l);
}

int csv_write(const char *log_path, const char *to_path, unsigned what, int finger)
{
    struct logfile l;
    struct columns columns;
    int err;
    if (to_path && outpart_same(log_path, to_path)) {
        cli_complain("--out: %s: is the log itself: choose another file", to_path);
        return 2;
    }
    err = logfile_open(&l, log_path);
    l.shows = to_path || !isatty(STDOUT_FILENO);
    if (err == 0) {
        err = columns_choose(
            &columns, l.scene, l.params, l.params_len, (what & CSV_ALL) != 0, finger, log_path);
    }
    if (err == 0) { err = survey(&l, what); }
    if (err < 2) {
        const int wrote = convert(&l, to_path, what, &columns);
        err = wrote > err ? wrote : err;
    }
    logfile_close(&l);
    return err;
}
