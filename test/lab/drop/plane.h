/* SPDX-License-Identifier: MIT */
/* Plane: the rays of a map, and what its cells say. */
#ifndef LAB_DROP_PLANE_H
#define LAB_DROP_PLANE_H

#include "lab/drop/ray.h"
#include "lab/drop/reach.h"

/* Ray j of o->rays at a rate: from k alone towards b alone, which no ray is, since without k
 * nothing holds a mass. At gain 1 it meets the line from the linear test's largest k to its largest
 * b. */
struct ray plane_ray(const struct sweep_opt *o, double rate_Hz, struct reach reach, int j);

/* A finished sweep: border.csv, rho.csv, stiffness.csv and sweep.gp in o->dir, a table on stdout.
 * 0, or 1 after a line on stderr. reach: one a rate. */
int plane_report(const struct cells *cells, const struct sweep_opt *o, const struct reach *reach);

#endif
