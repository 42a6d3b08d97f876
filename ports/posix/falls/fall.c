/* SPDX-License-Identifier: MIT */
/* What the steps of the analysis share. */
#include "falls/fall.h"

#include <stdlib.h>

const struct fall_opt fall_opt_default = {
    .min_samples = 1,
    .lag = 1,
    .band_lo_N = 0.8,
    .band_hi_N = 4.5,
    .force = FALL_FORCE_CENTRE,
    .scope = FALL_SCOPE_ALL,
};

const char *fall_status_text(enum fall_status status)
{
    switch (status) {
    case FALL_OK: return "ok";
    case FALL_NO_MEMORY: return "out of memory";
    case FALL_BAD_LOG: return "log damaged: times or starts do not rise, or a value is no number";
    case FALL_BAD_OPT: return "an option is out of range";
    case FALL_TOO_FEW: return "too few pairs in the force band";
    case FALL_FLAT: return "position or force does not vary";
    case FALL_NO_RISE: return "force does not rise with position";
    case FALL_UNBOUNDED: return "no upper end";
    case FALL_FEW_FALLS: return "too few falls with a line";
    case FALL_IO: return "cannot write the file";
    }
    return "unknown status";
}

/* Never a null pointer for an empty list, and none of a product that wraps. */
void *fall_alloc(size_t n, size_t size_B)
{
    return n <= SIZE_MAX / size_B ? malloc(n ? n * size_B : 1) : NULL;
}
