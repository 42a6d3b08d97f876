/* SPDX-License-Identifier: MIT */
/* Recording line: the lines of a text as fields, however they end and whatever separates. */
#ifndef CLI_RECORDING_LINE_H
#define CLI_RECORDING_LINE_H

#include <stdio.h>

#define RECORDING_COLUMNS 256 /* those behind are counted, not read */
#define RECORDING_FIELD_B 64
#define RECORDING_HEAD_B  4096
#define RECORDING_LINE_B  1048576

/* The fields of a line: how many there are, and text of those that are read, without blanks
 * around. A longer one is cut off. */
struct recording_line {
    int n;
    char field[RECORDING_COLUMNS][RECORDING_FIELD_B];
};

struct recording_text {
    FILE *f;
    int separator; /* 0: any of comma, semicolon, blank and tab */
    int ended;     /* the last field was that of its line */
    int endless;   /* a line of RECORDING_LINE_B bytes did not end: this is no text */
    size_t at, n;  /* of head */
    size_t line_B; /* of this line, so far */
    char head[RECORDING_HEAD_B];
};

/* one: a comma, semicolon or tab in the first line that is not empty separates alone, in all
 * lines. A field then may have blanks and be empty, and quotes around it go. */
void recording_text_begin(struct recording_text *t, FILE *f, int one);

/* The next line; 0 at the end of the file, and of what is endless. An empty one is one empty field.
 */
int recording_text_next(struct recording_text *t, struct recording_line *line);

#endif
