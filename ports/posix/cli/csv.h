/* A log as CSV: one header line, t_s first, the unit in every name. */
#ifndef CLI_CSV_H
#define CLI_CSV_H

#include <stdio.h>

/* all: the scene's further signals too, not only the paper's. Exit status. */
int csv_write(const char *log_path, FILE *to, int all);

#endif
