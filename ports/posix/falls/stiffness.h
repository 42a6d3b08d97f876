/* SPDX-License-Identifier: MIT */
/* The whole way from a log to a stiffness, and what its picture needs. */
#ifndef BASE_STIFFNESS_H
#define BASE_STIFFNESS_H

#include "falls/jackknife.h"
#include "falls/line.h"

struct fall_stiffness {
    size_t contacts;
    struct fall_pairs raw;  /* all pairs, in log order */
    struct fall_pairs band; /* in the band, sorted */
    struct fall_pairs averaged;
    struct fall_fit fit;
    struct fall_interval a, b;
};

/* The whole chain. OK also when there is no line: look at fit.status. */
enum fall_status fall_stiffness(
    const struct fall_log *log, const struct fall_opt *opt, struct fall_stiffness *out);
void fall_stiffness_free(struct fall_stiffness *s);

/* --- files for plot/force_position.gp --- */

enum fall_direction { FALL_A, FALL_B };

struct fall_plot_paths {
    const char *raw;      /* q_m,f_mon_n: all pairs, in and out of the band */
    const char *averaged; /* q_m,f_mon_n: the pairs of the regression */
    const char *line;     /* q_m,f_mon_n: two rows, the ends of the line */
};

/* The line spans the averaged data in the direction's own free variable: q for A,
 * force for B. Without a line its file holds the header only. FALL_IO: said on stderr. */
enum fall_status fall_write_plot(const struct fall_stiffness *s, enum fall_direction direction,
    const struct fall_plot_paths *paths);

#endif
