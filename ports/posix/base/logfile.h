/* SPDX-License-Identifier: MIT */
/* A log file, record by record, of any length, in constant memory. */
#ifndef CLI_LOGFILE_H
#define CLI_LOGFILE_H

#include "exhand/run/scene.h"

#include "exhand/record.h"

#include <stddef.h>

/* Where a reader is, between two records. */
struct logfile_place {
    uint64_t at, tick, damaged;
    uint32_t next_seq, gaps, lost;
    int started;
};

struct logfile {
    const char *path;
    int fd, error; /* error: errno of the read that ended it early */
    uint64_t len;  /* of the file, as it was opened */
    uint64_t at;   /* of the next record in it */
    uint8_t *bytes;
    uint32_t taken, filled; /* of the buffer: the next record begins at taken */
    uint64_t damaged;       /* bytes skipped because no record could be read there */
    uint32_t gaps;          /* records missing by their sequence numbers */
    uint32_t lost;          /* records the writer said it lost */
    int ended;              /* the end record was seen */
    uint32_t next_seq;
    uint64_t tick; /* of the last record: unlike a record's own it does not wrap */
    int started;   /* `tick` is known */
    struct logfile_place begin;
    struct exh_record_header header;
    const struct exh_scene *scene;
    uint8_t *head;         /* payload of the header */
    const uint8_t *params; /* in it: the parameter image, and the rest of the header */
    uint32_t params_len;
    int shows;      /* not 0: how far it is, in percent, on a terminal, once that takes long */
    double shown_s; /* when next */
};

/* Opens the file, reads its header, finds the scene, and checks versions and tables. Text may
 * precede the header and may be between records, as on a serial line. Returns 0, 2 after a line on
 * stderr with the reason, or 3: no such file. */
int logfile_open(struct logfile *l, const char *path);
void logfile_close(struct logfile *l);

/* Passes its calibrations of fingers, after the parameters, to the scene; they remain the log's
 * bytes. 0, or 2 after a line on stderr: invalid calibration. */
int logfile_calibrations(const struct logfile *l);

/* Where it is; back to there; back to just behind the header. */
void logfile_place(const struct logfile *l, struct logfile_place *p);
void logfile_go(struct logfile *l, const struct logfile_place *p);
void logfile_rewind(struct logfile *l);

/* The next good record, there until the next call; 0 at the end. */
int logfile_next(struct logfile *l, struct exh_record *r);

/* A line on stderr about what is damaged or missing, if anything; 1 if so. */
int logfile_complain(const struct logfile *l);

#endif
