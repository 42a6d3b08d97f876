/* SPDX-License-Identifier: MIT */
/* What the set-ups of all low-passes begin with. Not part of the library's interface. */
#ifndef EXH_FILTER_SETUP_H
#define EXH_FILTER_SETUP_H

#include "exhand/filter.h"

#include <stdint.h>

/* fc over the rate, a fraction within 0 .. 1/2; or filter.h's refusal. */
int exh_filter_ratio(
    uint64_t *fc, uint64_t *rate, const struct exh_filter_par *par, struct exh_period T);

#endif
