/* SPDX-License-Identifier: MIT */
/* A log as CSV: one header line, t_s first and rising, the unit in every name. */
#ifndef CLI_CSV_H
#define CLI_CSV_H

enum csv_what {
    CSV_ALL = 1,  /* the scene's further signals too, not only the paper's; codes */
    CSV_FALLS = 2 /* only falls under observation, by the log's marks: what the
                     experimenter's hand did between them leaves a gap in time */
};

/* Exit status, after a line on stderr unless 0. Opens the output (NULL: stdout)
 * only when the log has been read and holds something to write. What is damaged
 * in the log is left out, counted and said: 1. */
int csv_write(const char *log_path, const char *to_path, unsigned what);

#endif
