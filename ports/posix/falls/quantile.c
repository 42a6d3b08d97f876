/* SPDX-License-Identifier: MIT */
#include "falls/quantile.h"

#include <stdlib.h>

static int by_value(const void *a, const void *b)
{
    const double l = *(const double *)a, r = *(const double *)b;
    return (l > r) - (l < r);
}

double quantile(double *v, int n, int runs, double share)
{
    const double at = share * (n - 1);
    const int i = (int)at;
    if (2 * n <= runs) { return 0; }
    qsort(v, (size_t)n, sizeof v[0], by_value);
    return i + 1 < n ? v[i] + (at - i) * (v[i + 1] - v[i]) : v[n - 1];
}
