/* SPDX-License-Identifier: MIT */
/* Table: conversion from one unit to another, strictly rising, linear between knots. */
#ifndef EXHAND_TABLE_H
#define EXHAND_TABLE_H

#include "exhand/fix.h"

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* One knot; units and formats are the table's, any int32_t. */
struct exh_knot {
    int32_t x, y;          /* both above those of the knot before */
    struct exh_gain slope; /* to the next knot; exh_table_setup() fills it */
};
/* A table; passed by value. */
struct exh_table {
    const struct exh_knot *knot; /* n of them, the caller's; may live in ROM */
    uint8_t n;                   /* >= 2 */
};

/* Checks n knots and fills the slopes. -EXH_E_RANGE (n not 2 .. 255, x or y spans
 * more than 2^31-1, or a slope is 2^31 or more or below 2^-32), -EXH_E_MONOTONE (x or y does not
 * rise strictly). */
int exh_table_setup(struct exh_knot *knot, unsigned n);

/* The inverse table: dst may be src. Where all segments are at least (or all at most)
 * 1 steep, there and back, through the steeper first, comes within 1 LSB, 2 from
 * spans of 2^30. Errors as exh_table_setup(). */
int exh_table_invert(struct exh_knot *dst, const struct exh_knot *src, unsigned n);

/* y at x: monotone, exact at every knot, within 1.5 LSB of y between them (1 LSB
 * where a segment rises less than 2^30), and the end values outside. Cost depends
 * on n alone, not on x. */
int32_t exh_table_at(struct exh_table t, int32_t x);

#ifdef __cplusplus
}
#endif
#endif
