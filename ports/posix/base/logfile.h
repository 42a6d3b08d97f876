/* SPDX-License-Identifier: MIT */
/* A log file in memory, record by record. */
#ifndef CLI_LOGFILE_H
#define CLI_LOGFILE_H

#include "exhand/run/scene.h"

#include "exhand/record.h"

#include <stddef.h>

struct logfile {
    const char *path;
    uint8_t *bytes;
    uint32_t len, at;
    uint32_t damaged; /* bytes skipped because no record could be read there */
    uint32_t gaps;    /* records missing by their sequence numbers */
    uint32_t lost;    /* records the writer said it lost */
    int ended;        /* the end record was seen */
    uint32_t next_seq;
    uint64_t tick; /* of the last record: unlike a record's own it does not wrap */
    int started;   /* `tick` is known */
    struct exh_record_header header;
    const struct exh_scene *scene;
    const uint8_t *params; /* the parameter image of the header */
    uint32_t params_len;
};

/* Reads the file and its header, which words may stand between
 * records of (a serial line's), finds the scene and checks versions and tables.
 * 0; 2 after a line on stderr that says what is wrong with it. */
int logfile_open(struct logfile *l, const char *path);
void logfile_close(struct logfile *l);

/* Its calibrations of fingers, behind the parameters, into the scene; they stay the log's bytes. 0,
 * or 2 after a line on stderr: what is there is none. */
int logfile_calibrations(const struct logfile *l);

/* Back to just behind the header, where `at` was after opening. */
void logfile_rewind(struct logfile *l, uint32_t at);

/* The next good record; 0 at the end. */
int logfile_next(struct logfile *l, struct exh_record *r);

/* A line on stderr about what is damaged or missing, if anything; 1 if so. */
int logfile_complain(const struct logfile *l);

#endif
