/* SPDX-License-Identifier: MIT */
/* Plane: which cells of the k-b plane a sweep still wants, and what they say. */
#ifndef CLI_PLANE_H
#define CLI_PLANE_H

#include "lab/drop/cells.h"
#include "lab/drop/study.h"

struct plane_want {
    double rate_Hz, k_Npm, b_Nspm;
};

/* Cells to be run before more can be said (a shard's: of octaves and rows), each once, into a list
 * that the caller frees. How many: 0 when the sweep is done; -1 after a line on stderr. Once
 * interrupted it returns early, with any number. */
int plane_wants(const struct cells *cells, const struct sweep_opt *o, struct plane_want **want);

/* A finished sweep: border.csv, rho.csv and sweep.gp in o->dir, a table on stdout. 0, or
 * 1 after a line on stderr. */
int plane_report(const struct cells *cells, const struct sweep_opt *o);

#endif
