/* SPDX-License-Identifier: MIT */
/* The kernels in double and in float, in a source apart from their callers. */
#include "plain.h"

#if __STDC_HOSTED__ /* else there is no C library, and no sine */
#include <math.h>
#endif

#define T      double
#define N(n)   plain_##n##_double
#define SIN(x) sin(x)
#define COS(x) cos(x)
#include "plain_body.h"
#undef T
#undef N
#undef SIN
#undef COS

#define T      float
#define N(n)   plain_##n##_float
#define SIN(x) sinf(x)
#define COS(x) cosf(x)
#include "plain_body.h"
