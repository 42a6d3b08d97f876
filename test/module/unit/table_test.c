/* SPDX-License-Identifier: MIT */
/* table.h: at, between and outside knots, what is refused, and the way back, on numbers
 * worked out by hand. */
#include "exhand/table.h"

#include "exhand/error.h"

#include "check.h"

#define KNOTS 5
static void some_table(struct exh_knot *k)
{
    static const int32_t xy[KNOTS][2] = {
        {-1000000, -70000}, {0, 0}, {3, 1000000}, {2000000, 1000001}, {1 << 30, 1 << 29}};
    for (size_t i = 0; i < KNOTS; i++) {
        k[i].x = xy[i][0];
        k[i].y = xy[i][1];
    }
}

TEST(table_is_exact_at_knots_and_clamps_outside)
{
    struct exh_knot k[KNOTS];
    some_table(k);
    CHECK_EQ_I64(exh_table_setup(k, KNOTS), 0);
    for (uint8_t n = 2; n <= KNOTS; n++) {
        const struct exh_table t = {k, n};
        for (size_t i = 0; i < n; i++) { CHECK_EQ_I64(exh_table_at(t, k[i].x), k[i].y); }
        CHECK_EQ_I64(exh_table_at(t, INT32_MIN), k[0].y);
        CHECK_EQ_I64(exh_table_at(t, k[0].x - 1), k[0].y);
        CHECK_EQ_I64(exh_table_at(t, k[n - 1].x + 1), k[n - 1].y);
        CHECK_EQ_I64(exh_table_at(t, INT32_MAX), k[n - 1].y);
    }
}

TEST(table_between_knots)
{
    struct exh_knot k[3] = {{-10, -100, {0, 1}}, {10, 100, {0, 1}}, {30, 110, {0, 1}}};
    const struct exh_table t = {k, 3};
    CHECK_EQ_I64(exh_table_setup(k, 3), 0);
    CHECK_EQ_I64(exh_table_at(t, 0), 0);
    CHECK_EQ_I64(exh_table_at(t, -9), -90);
    CHECK_EQ_I64(exh_table_at(t, 9), 90);
    CHECK_EQ_I64(exh_table_at(t, 12), 101);
    CHECK_EQ_I64(exh_table_at(t, 28), 109);
}

TEST(table_is_monotone_around_every_knot)
{
    struct exh_knot k[KNOTS];
    const struct exh_table t = {k, KNOTS};
    some_table(k);
    (void)exh_table_setup(k, KNOTS);
    for (size_t i = 0; i < KNOTS; i++) {
        int32_t before = exh_table_at(t, k[i].x - 2000);
        for (int32_t x = k[i].x - 1999; x <= k[i].x + 2000; x++) {
            const int32_t y = exh_table_at(t, x);
            CHECK(y >= before, "falls at %" PRId32, x);
            before = y;
        }
    }
}

TEST(table_rejections)
{
    static const struct {
        int32_t x0, y0, x1, y1, x2, y2;
        unsigned n;
        int want;
    } row[] = {
        {0, 0, 1, 1, 2, 2, 3, 0},
        {0, 0, 1, 1, 2, 2, 1, -EXH_E_RANGE},
        {0, 0, 1, 1, 2, 2, 0, -EXH_E_RANGE},
        {0, 0, 0, 1, 2, 2, 3, -EXH_E_MONOTONE},
        {0, 0, 1, 0, 2, 2, 3, -EXH_E_MONOTONE},
        {0, 0, 1, 1, 2, 1, 3, -EXH_E_MONOTONE},
        {0, 0, 1, 1, 0, 2, 3, -EXH_E_MONOTONE},
        {0, 0, -1, 1, 2, 2, 3, -EXH_E_MONOTONE},
        {-1, 0, 1, 1, INT32_MAX, 2, 3, -EXH_E_RANGE},
        {0, -1, 1, 1, 2, INT32_MAX, 3, -EXH_E_RANGE},
        {INT32_MIN, 0, 0, 1, 5, 2, 3, -EXH_E_RANGE},
        {INT32_MIN, INT32_MIN, -2, -2, -1, -1, 3, 0},        /* spans 2^31-1 */
        {0, INT32_MIN, 1, INT32_MAX, 2, 2, 2, -EXH_E_RANGE}, /* a slope beyond 2^31 */
        {0, 0, 1, 1, 2, 2, 256, -EXH_E_RANGE},
        {0, 0, INT32_MAX - 1, 1, INT32_MAX, 2, 3, 0},
    };
    for (size_t i = 0; i < LEN(row); i++) {
        struct exh_knot k[3] = {{row[i].x0, row[i].y0, {0, 1}}, {row[i].x1, row[i].y1, {0, 1}},
            {row[i].x2, row[i].y2, {0, 1}}};
        const int err = exh_table_setup(k, row[i].n);
        CHECK(err == row[i].want, "row %zu: %d, want %d", i, err, row[i].want);
    }
}

/* Spans fit and x and y rise strictly: nothing in the contract refuses this. */
TEST(steepest_table_is_accepted)
{
    struct exh_knot k[2] = {{0, 0, {0, 1}}, {1, INT32_MAX, {0, 1}}};
    const struct exh_table t = {k, 2};
    const int err = exh_table_setup(k, 2);
    CHECK(err == 0, "error %d", err);
    CHECK_EQ_I64(exh_table_at(t, 1), INT32_MAX);
}

/* There and back, through the coarser side: within 1 LSB; in place, too. */
TEST(inverse_round_trip)
{
    struct exh_knot k[3] = {
        {0, 0, {0, 1}}, {41943040, 442918502, {0, 1}}, {83886080, 469762048, {0, 1}}};
    struct exh_knot inv[3];
    const struct exh_table there = {k, 3}, back = {inv, 3};
    CHECK_EQ_I64(exh_table_setup(k, 3), 0);
    CHECK_EQ_I64(exh_table_invert(inv, k, 3), 0);
    for (int32_t x = 0; x <= 41943040; x += 4099) {
        const int64_t err = (int64_t)exh_table_at(back, exh_table_at(there, x)) - x;
        CHECK(err >= -1 && err <= 1, "steep part, %" PRId32 ": %" PRId64, x, err);
    }
    for (int32_t y = 442918502; y <= 469762048; y += 4099) {
        const int64_t err = (int64_t)exh_table_at(there, exh_table_at(back, y)) - y;
        CHECK(err >= -1 && err <= 1, "flat part, %" PRId32 ": %" PRId64, y, err);
    }
    CHECK_EQ_I64(exh_table_invert(inv, inv, 3), 0);
    for (size_t i = 0; i < 3; i++) {
        CHECK(inv[i].x == k[i].x && inv[i].y == k[i].y, "knot %zu", i);
    }
}

TEST(inverse_refuses_what_set_refuses)
{
    const struct exh_knot flat[3] = {{0, 0, {0, 1}}, {1, 5, {0, 1}}, {2, 5, {0, 1}}};
    struct exh_knot inv[3];
    CHECK_EQ_I64(exh_table_invert(inv, flat, 3), -EXH_E_MONOTONE);
    CHECK_EQ_I64(exh_table_invert(inv, flat, 1), -EXH_E_RANGE);
}

TEST_MAIN("unit/table", table_is_exact_at_knots_and_clamps_outside, table_between_knots,
    table_is_monotone_around_every_knot, table_rejections, steepest_table_is_accepted,
    inverse_round_trip, inverse_refuses_what_set_refuses);
