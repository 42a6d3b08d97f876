/* SPDX-License-Identifier: MIT */
/* Measured over modelled, for pictures. */
#ifndef IDENTIFY_TRACE_H
#define IDENTIFY_TRACE_H

#include "identify/data.h"
#include "identify/model.h"

#include <stdio.h>

/* One round as CSV: time, part, current, and the string measured and modelled, mm; the model begins
 * each part where the string was. 0; -1: out of memory. */
int identify_trace(FILE *f, const struct identify_data *d, const struct model *m, unsigned round);

#endif
