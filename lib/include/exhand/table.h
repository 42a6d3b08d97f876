/* SPDX-License-Identifier: MIT */
/* Table: strictly rising conversion between two units, linear between knots.
 *
 *   struct exh_knot knot[2] = {{.x = 0}, {EXH_Q(20, 1, EXH_Q_FORCE), EXH_Q(2, 1, EXH_Q_CUR), {0}}};
 *   int err = exh_table_setup(knot, 2);
 *   int32_t cur_A_q26 = exh_table_at((struct exh_table){knot, 2}, force_N_q20); */
#ifndef EXHAND_TABLE_H
#define EXHAND_TABLE_H

#include "exhand/fix.h"

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* One knot. The table's owner documents units and formats; any int32_t. */
struct exh_knot {
    int32_t x, y;          /* both above those of the previous knot */
    struct exh_gain slope; /* to the next knot; set by exh_table_setup() */
};
/* A table; passed by value. */
struct exh_table {
    const struct exh_knot *knot; /* array of length n, the caller's; may be in ROM */
    uint8_t n;                   /* >= 2 */
};

/* Checks knot[n] and computes the slopes. -EXH_E_RANGE: n not 2 .. 255, x or y spans more than
 * 2^31-1, or a slope is 2^31 or more or below 2^-32. -EXH_E_MONOTONE: x or y repeats or falls. */
int exh_table_setup(struct exh_knot *knot, unsigned n);

/* Writes the inverse of table src[n] to dst[n]; dst may be src. If all slopes are >= 1, or
 * all <= 1, a conversion and back, the steeper table first, is within 1 LSB, or 2 LSB for spans
 * from 2^30. Errors as exh_table_setup(). */
int exh_table_invert(struct exh_knot *dst, const struct exh_knot *src, unsigned n);

/* y at x: monotone and exact at every knot; outside the knots, the value at the end. Between them
 * the error is at most 1.5 LSB of y, or 1 LSB where a segment rises by less than 2^30. The cost
 * depends on n alone. */
int32_t exh_table_at(struct exh_table t, int32_t x);

#ifdef __cplusplus
}
#endif
#endif
