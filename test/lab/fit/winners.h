/* SPDX-License-Identifier: MIT */
/* Winners: those of a search, by the whole experiment and seeds they never saw. */
#ifndef FIT_WINNERS_H
#define FIT_WINNERS_H

#include "lab/fit/search.h"

/* Prints a table and writes fit.csv and plants.csv to the folder. 0, or as jobs_run(). */
int winners_judge(const struct search *s, int runs, int further, int jobs, const char *out);

#endif
