/* SPDX-License-Identifier: MIT */
/* Winners: those of a search, by more falls from places that they never saw. */
#ifndef FIT_WINNERS_H
#define FIT_WINNERS_H

#include "lab/fit/search.h"

/* The best plants of each velocity by `falls` falls a row: a table, and plants.csv in the folder.
 * Prints the most robust one, or why none is inside both gates. 0, or as jobs_run(). */
int winners_judge(const struct search *s, int falls, int jobs, const char *out);

#endif
