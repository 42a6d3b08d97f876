/* SPDX-License-Identifier: MIT */
/* Recorded positions of an encoder, converted back to counts. */
#ifndef BENCH_POSITIONS_H
#define BENCH_POSITIONS_H

/* Reads a column of a CSV, by its name in the first line or its number from 1, whose values are
 * counts times step, and prints one line. Exit status, after a line on stderr unless 0. */
int positions_print(const char *csv, const char *column, double step);

#endif
