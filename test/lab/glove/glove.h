/* SPDX-License-Identifier: MIT */
/* exhand-lab glove: the paper's Table I, and the scan's skew. */
#ifndef LAB_GLOVE_GLOVE_H
#define LAB_GLOVE_GLOVE_H

#include "glove/modes.h"

struct rest_options {
    const char *log;
    double from_s, to_s;
    double travel_m, span_A, span_V;
};

/* What was taken at rest. */
struct glove_rest {
    struct glove_frames frames;
    uint32_t *enc; /* and mon: ticks of them; NULL: no motor in the recording */
    int16_t *mon;
    long ticks, cap;
};

/* From the board, from a log, from a recording; what of a recording lies between --from and --to.
 * 0, or an exit status after a line on stderr. Free the three arrays. */
int glove_rest_board(struct glove_rest *r, const struct glove_options *o);
int glove_rest_log(struct glove_rest *r, const char *path);
int glove_rest_csv(struct glove_rest *r, const struct glove_options *o);
int glove_rest_cut(struct glove_frames *f, const struct rest_options *o);

/* The modes: exit status. */
int glove_table1(const struct glove_options *o, const struct rest_options *is);
int glove_skew(const struct glove_options *o);

#endif
