/* SPDX-License-Identifier: MIT */
/* Common start of the set-ups of all low-passes. Not part of the library's interface. */
#ifndef EXH_FILTER_SETUP_H
#define EXH_FILTER_SETUP_H

#include "exhand/filter.h"

#include <stdint.h>

/* fc over the sample rate, a fraction within 0 .. 1/2. Returns 0 or an error as in filter.h. */
int exh_filter_ratio(
    uint64_t *fc, uint64_t *rate, const struct exh_filter_par *par, struct exh_period T);

#endif
