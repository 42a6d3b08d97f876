/* SPDX-License-Identifier: MIT */
/* The exact flow in 113 bits, or as many as a long double has: the reference. */
#ifdef __SIZEOF_FLOAT128__
#define REAL real_wide
#else
#define REAL long double
#endif
#define FLOW_ADVANCE wide_advance
#include "flow_body.h"
