/* SPDX-License-Identifier: MIT */
/* A log as CSV: one header line, t_s first and rising, the unit in every name. */
#ifndef CLI_CSV_H
#define CLI_CSV_H

enum csv_what {
    CSV_ALL = 1,  /* the scene's further signals too, not only the paper's; codes */
    CSV_FALLS = 2 /* only falls under observation, by the log's marks: what the
                     experimenter's hand did between them leaves a gap in time */
};

#define CSV_IN_USE (-1) /* for a finger: those in use */

/* Exit status, after a line on stderr unless 0. Opens the output (NULL: stdout)
 * only when the log has been read and holds something to write. What is damaged
 * in the log is left out, counted and said: 1. Of finger (0 the thumb), or of those in use: one has
 * the signals' names, several have the finger's behind them, as all have with CSV_ALL. */
int csv_write(const char *log_path, const char *to_path, unsigned what, int finger);

#endif
