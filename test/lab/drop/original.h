/* SPDX-License-Identifier: MIT */
/* exhand-lab drop --preset original. */
#ifndef CLI_DROP_ORIGINAL_H
#define CLI_DROP_ORIGINAL_H

#include "box/run.h"

/* original: a run at 90 Hz; box: at 2 kHz. The exit status. */
int drop_original(const struct run_cfg *original, const struct run_cfg *box, const char *dir);

#endif
