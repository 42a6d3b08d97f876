/* SPDX-License-Identifier: MIT */
/* Conversion tables: set-up, inverse and interpolation. */
#include "exhand/table.h"

#include "exhand/error.h"

int exh_table_setup(struct exh_knot *knot, unsigned n)
{
    if (n < 2 || n > 255) { return -EXH_E_RANGE; }
    for (unsigned i = 0; i + 1 < n; i++) {
        const int64_t dx = (int64_t)knot[i + 1].x - knot[i].x;
        const int64_t dy = (int64_t)knot[i + 1].y - knot[i].y;
        if (dx <= 0 || dy <= 0) { return -EXH_E_MONOTONE; }
        if (exh_gain_set(&knot[i].slope, (uint64_t)dy, (uint64_t)dx) < 0) { return -EXH_E_RANGE; }
    }
    if ((int64_t)knot[n - 1].x - knot[0].x > INT32_MAX ||
        (int64_t)knot[n - 1].y - knot[0].y > INT32_MAX) {
        return -EXH_E_RANGE;
    }
    knot[n - 1].slope = knot[n - 2].slope; /* at the end it multiplies 0 */
    return 0;
}

int exh_table_invert(struct exh_knot *dst, const struct exh_knot *src, unsigned n)
{
    for (unsigned i = 0; i < n; i++) {
        const int32_t x = src[i].x;
        dst[i].x = src[i].y;
        dst[i].y = x;
    }
    return exh_table_setup(dst, n);
}

int32_t exh_table_at(struct exh_table t, int32_t x)
{
    const unsigned n = (uint8_t)(t.n - 1u) + 1u; /* stays in range for a damaged n */
    const struct exh_knot *const last = t.knot + n - 1u;
    const struct exh_knot *k = t.knot;
    const int32_t in = exh_clamp32(x, k->x, last->x);
    /* Bisection with a fixed number of steps: the cost must not depend on the force. */
    for (unsigned left = n; left > 1;) {
        const unsigned half = left / 2;
        k += half & (0u - (unsigned)(in >= k[half].x));
        left -= half;
    }
    return exh_clamp(
        k->y + exh_gain_mul(k->slope, exh_wrap_diff(in, k->x)), k->y, k < last ? k[1].y : k->y);
}
