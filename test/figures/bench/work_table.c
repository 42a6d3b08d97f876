/* SPDX-License-Identifier: MIT */
/* A conversion table of 16 knots, as force to current: linear between them. */
#include "plain.h"
#include "work.h"

#include "exhand/error.h"
#include "exhand/table.h"

#define CASES 300000u
#define SPAN  (INT32_C(1) << 26) /* between two knots: a grid that all can have */

int32_t curve_x[CURVE_KNOTS], curve_y[CURVE_KNOTS], curve_at[BENCH_OPS];
static struct exh_knot knot[CURVE_KNOTS];
static const struct exh_table table = {knot, CURVE_KNOTS};
static struct plain_table_double in_double;
static struct plain_table_float in_float;

void curve_seed(void)
{
    bench_seed();
    for (uint32_t k = 0; k < CURVE_KNOTS; k++) {
        curve_x[k] = (int32_t)k * SPAN;
        curve_y[k] = k == 0 ? 0 : curve_y[k - 1] + SPAN / 2 + bench_in(0, SPAN);
    }
    for (uint32_t i = 0; i < BENCH_OPS; i++) { curve_at[i] = bench_in(0, 15 * SPAN - 1); }
}

long double curve_exact(int32_t x)
{
    const uint32_t k = (uint32_t)x / (uint32_t)SPAN;
    if (k + 1 >= CURVE_KNOTS) { return curve_y[CURVE_KNOTS - 1]; }
    return curve_y[k] + (long double)(x - curve_x[k]) * (curve_y[k + 1] - curve_y[k]) / SPAN;
}

/* Full scale is 2^30 of x. */
static void setup(void)
{
    curve_seed();
    for (uint32_t k = 0; k < CURVE_KNOTS; k++) {
        knot[k].x = curve_x[k];
        knot[k].y = curve_y[k];
        in_float.x[k] = (float)(in_double.x[k] = curve_x[k] / 1073741824.0);
        in_float.y[k] = (float)(in_double.y[k] = curve_y[k] / 1073741824.0);
    }
    for (uint32_t k = 0; k + 1 < CURVE_KNOTS; k++) {
        in_double.slope[k] =
            (in_double.y[k + 1] - in_double.y[k]) / (in_double.x[k + 1] - in_double.x[k]);
        in_float.slope[k] = (float)in_double.slope[k];
    }
    EXH_ASSERT(exh_table_setup(knot, CURVE_KNOTS) == 0);
}

static void ours_op(uint32_t i) { bench_sink = exh_table_at(table, curve_at[i]); }

static volatile double sink_double;
static volatile float sink_float;

static void double_op(uint32_t i)
{
    sink_double = plain_table_double(&in_double, curve_at[i] * (1 / 1073741824.0));
}

static void float_op(uint32_t i)
{
    sink_float = plain_table_float(&in_float, (float)curve_at[i] * (1 / 1073741824.0f));
}

/* ppm of full scale */
static long double ours_off(uint32_t i)
{
    const int32_t x = bench_in(0, 15 * SPAN - 1);
    (void)i;
    return 1e6L * (exh_table_at(table, x) - curve_exact(x)) / 1073741824;
}

static long double double_off(uint32_t i)
{
    const int32_t x = bench_in(0, 15 * SPAN - 1);
    (void)i;
    return 1e6L * (plain_table_double(&in_double, x / 1073741824.0) - curve_exact(x) / 1073741824);
}

static long double float_off(uint32_t i)
{
    const int32_t x = bench_in(0, 15 * SPAN - 1);
    (void)i;
    return 1e6L * (plain_table_float(&in_float, (float)x * (1 / 1073741824.0f)) -
                      curve_exact(x) / 1073741824);
}

static const struct work works[] = {
    {"table", "exhand table", "ours", "ppm", CASES, setup, ours_op, ours_off},
    {"table", "plain double table", "float", "ppm", CASES, setup, double_op, double_off},
    {"table", "plain float table", "float", "ppm", CASES, setup, float_op, float_off},
};
const struct work_group table_works = {works, sizeof works / sizeof works[0]};
