/* SPDX-License-Identifier: MIT */
/* The scenes in double, in float and in long double. */
#include "pipe.h"

#include <math.h>

#define T        double
#define N(n)     pipe_##n##_double
#define N2(n, m) pipe_##n##_double_##m
#define SIN      sin
#define COS      cos
#define FLOOR    floor
#include "pipe_body.h"
#undef T
#undef N
#undef N2
#undef SIN
#undef COS
#undef FLOOR

#define T        float
#define N(n)     pipe_##n##_float
#define N2(n, m) pipe_##n##_float_##m
#define SIN      sinf
#define COS      cosf
#define FLOOR    floorf
#include "pipe_body.h"
#undef T
#undef N
#undef N2
#undef SIN
#undef COS
#undef FLOOR

#define T        long double
#define N(n)     pipe_##n##_exact
#define N2(n, m) pipe_##n##_exact_##m
#define SIN      sinl
#define COS      cosl
#define FLOOR    floorl
#include "pipe_body.h"
