/* SPDX-License-Identifier: MIT */
/* One device of a certificate: identified, advised, and compared with its behaviour. */
#ifndef CERTIFICATE_ONE_H
#define CERTIFICATE_ONE_H

#include "identify/model.h"

#include <stdint.h>

#define ONE_LIGHTER 3 /* so often the known mass may be halved if the box cannot lift it */

/* A pair of gains is stable if every fall rests at so many places of the wall between two counts;
 * at how many is asked decides what is called stable. */
enum { ONE_FOUR, ONE_EIGHT, ONE_SIXTEEN, ONE_PLACES };

/* Where in the rule a run is. */
enum { ONE_INSIDE, ONE_LINE, ONE_WHERES };

/* What is held against the truth: the model's values, and the sum of both frictions. */
enum { ONE_MU_BOTH = MODEL_PARS, ONE_VALUES };

struct one_opt {
    int64_t seed, rate_Hz, repeats;
    int told; /* 1: no identification: the advisor gets the device's values */
    int map;  /* 1: what rests and what is allowed, as characters, to stdout */
    int grid; /* nodes along k and along b, over which the stable area is summed; 0: no advice */
};

struct one {
    int32_t done, failed; /* enum identify_result of the last try, 0: it ran to its end */
    int32_t fits, advised;
    double mass_kg, device_s, residual; /* the known mass at last; device time of all tries */
    double truth[ONE_VALUES], value[ONE_VALUES], low[ONE_VALUES], high[ONE_VALUES];
    /* Runs of ten falls; those with one fall that does not come to rest, and with more of them. */
    int32_t runs[ONE_WHERES], single[ONE_WHERES], unstable[ONE_WHERES];
    int32_t stable[ONE_PLACES], covered[ONE_PLACES]; /* nodes, and of them inside the rule */
};

/* Device i of a draw. */
void one_run(struct one *r, const struct one_opt *o, int i);

#endif
