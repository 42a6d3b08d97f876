/* SPDX-License-Identifier: MIT */
#include "base/progress.h"

#include "base/lines.h"

#include <stddef.h>
#include <stdio.h>
#include <unistd.h>

void progress_show(const char *label, int done, int n, int over)
{
    char of[16] = "";
    if (label == NULL || !lines_terminal(STDERR_FILENO)) { return; }
    if (n > 0) { (void)snprintf(of, sizeof of, "/%d", n); }
    fprintf(stderr, "\r%s: %d%s%s", label, done, of, over ? "\n" : "");
    fflush(stderr);
}
