/* SPDX-License-Identifier: MIT */
/* Stability: what theory says of the sampled wall, of filters at rest and of drift, against the
 * library's own code. */
#ifndef STABILITY_H
#define STABILITY_H

#include "wall.h"

#include <inttypes.h>
#include <stdint.h>
#include <stdio.h>

#define LEN(a) (sizeof(a) / sizeof((a)[0]))

enum size { SHORT, USUAL, FULL };

/* Each returns how many of its rules do not hold, and says so. */
int linear_map(enum size size);
int device_map(enum size size);
int quantized_plane(enum size size);
int filters_at_rest(enum size size);
int drifts(uint64_t ticks);

/* A CSV file in the output directory. Never NULL. */
FILE *csv_open(const char *name, const char *header);
void csv_close(FILE *f);

/* One line of the table: what must hold, what held; 1 if it does not. */
#ifdef __GNUC__
__attribute__((format(printf, 3, 4)))
#endif
int must(int holds, const char *what, const char *fmt, ...);

/* n values from low to high in equal factors. */
double spaced(double low, double high, int i, int n);

uint64_t any_u64(void);

/* rho of the mass in the wall, by ports/posix/sim/linear.c. */
double rho_of(const struct wall *w);

#endif
