/* SPDX-License-Identifier: MIT */
/* angle.h: worked examples. */
#include "exhand/angle.h"

#include "exhand/fix.h"

#include "check.h"

#define ONE_Q30 (INT32_C(1) << 30)

TEST(quarters_are_exact)
{
    static const struct {
        int32_t x, sin, cos;
    } row[] = {{0, 0, ONE_Q30}, {1 << 30, ONE_Q30, 0}, {INT32_MIN, 0, -ONE_Q30},
        {-(1 << 30), -ONE_Q30, 0}};
    for (size_t i = 0; i < LEN(row); i++) {
        struct exh_sincos y;
        exh_sincos(row[i].x, &y);
        CHECK_EQ_I64(y.sin_q30, row[i].sin);
        CHECK_EQ_I64(y.cos_q30, row[i].cos);
    }
}

/* Nearest q30, by hand: sin 30 = 1/2, sin 45 = sqrt 1/2, ... */
TEST(known_angles)
{
    static const struct {
        int32_t x, sin, cos;
    } row[] = {{EXH_DEG(30, 1), 536870912, 929887697}, {EXH_DEG(45, 1), 759250125, 759250125},
        {EXH_DEG(60, 1), 929887697, 536870912}, {EXH_DEG(-135, 1), -759250125, -759250125},
        {EXH_DEG(-180, 1), 0, -1073741824}, {EXH_URAD(1000000), 903522589, 580145183},
        {EXH_URAD(-1000000), -903522589, 580145183}};
    for (size_t i = 0; i < LEN(row); i++) {
        struct exh_sincos y;
        exh_sincos(row[i].x, &y);
        CHECK(y.sin_q30 - row[i].sin <= 3 && row[i].sin - y.sin_q30 <= 3, "row %zu: %" PRId32, i,
            y.sin_q30);
        CHECK(y.cos_q30 - row[i].cos <= 3 && row[i].cos - y.cos_q30 <= 3, "row %zu: %" PRId32, i,
            y.cos_q30);
    }
}

TEST(degrees_and_radians)
{
    CHECK_EQ_I64(EXH_DEG(90, 1), 1 << 30);
    CHECK_EQ_I64(EXH_DEG(-180, 1), INT32_MIN);
    CHECK_EQ_I64(EXH_DEG(360, 720), 5965232); /* half a degree: 5965232.36 */
    CHECK_EQ_I64(EXH_DEG(-1, 2), -5965232);
    CHECK_EQ_I64(EXH_URAD(0), 0);
    CHECK_EQ_I64(EXH_URAD(1), 683);
    CHECK_EQ_I64(EXH_URAD(3141592), INT64_C(2147483201)); /* pi is 0.654 urad more */
    CHECK_EQ_I64(EXH_URAD(-3141592), INT64_C(-2147483201));
}

/* Where sine and cosine change places they are 2 LSB apart: a quarter on is exact, -x is not. */
TEST(odd_eighths_change_places)
{
    static const struct {
        int32_t x, sin, cos;
    } row[] = {{1 << 29, 759250125, 759250123}, {3 * (1 << 29), 759250123, -759250125},
        {-3 * (1 << 29), -759250125, -759250123}, {-(1 << 29), -759250123, 759250125}};
    for (size_t i = 0; i < LEN(row); i++) {
        struct exh_sincos y;
        exh_sincos(row[i].x, &y);
        CHECK_EQ_I64(y.sin_q30, row[i].sin);
        CHECK_EQ_I64(y.cos_q30, row[i].cos);
    }
}

TEST_MAIN(
    "unit/angle", quarters_are_exact, odd_eighths_change_places, known_angles, degrees_and_radians);
