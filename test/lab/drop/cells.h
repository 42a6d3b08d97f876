/* SPDX-License-Identifier: MIT */
/* Cells of the k-b plane in a file that grows as they come, so that a sweep that was
 * interrupted goes on and the files of shards make one.
 *
 * stability.csv: a line `# settings`, a header, a line a cell. A last line that was cut
 * off is dropped. Cells are judged the same wherever they are run, so the same cell
 * may come from several files. */
#ifndef CLI_CELLS_H
#define CLI_CELLS_H

#include <stdio.h>

struct cell {
    double rate_Hz;
    int ray;     /* of the plane, from k alone */
    double gain; /* along it */
    double k_Npm, b_Nspm;
    int resting, falls;
    double rho; /* of the linear test; < 0: not computed */
};

struct cells {
    struct cell *at; /* sorted by rate, ray, gain */
    int n, cap;
    const char *settings; /* what a file must have been made with */
};

/* Takes up the cells of a file; one that does not exist has none. 0, 1 after a line
 * on stderr: it can't be read; 2 after such a line: made with other settings, or no file
 * of a sweep. Files may be strung together. */
int cells_load(struct cells *c, const char *path);

/* NULL: not known. */
const struct cell *cells_find(const struct cells *c, double rate_Hz, int ray, double gain);

/* 0, or 1 after a line on stderr: out of memory. Found only after cells_sort(), which
 * also leaves each cell once. */
int cells_add(struct cells *c, const struct cell *add);
void cells_sort(struct cells *c);

/* All cells, sorted, in place of the file. 0, or 1 after a line on stderr. */
int cells_save(const struct cells *c, const char *path);

/* The same, and the file grows: other sweeps are kept away from it until outfile_abandon(). NULL
 * after a line on stderr. */
FILE *cells_grow(const struct cells *c, const char *path);

/* One line at the end of a file that grows; whole or not at all even when
 * several processes do it. 0, or 1 after a line on stderr. */
int cells_append(int fd, const char *path, const struct cell *c);

void cells_free(struct cells *c);

#endif
