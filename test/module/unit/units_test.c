/* SPDX-License-Identifier: MIT */
/* units.h: the format table of docs/NUMERICS.md as numbers. */
#include "exhand/units.h"

#include "check.h"

TEST(formats_are_the_documented_ones)
{
    static const struct {
        const char *what;
        int got, want;
    } row[] = {
        {"position", EXH_Q_POS, 30},
        {"velocity", EXH_Q_VEL, 27},
        {"force", EXH_Q_FORCE, 20},
        {"current", EXH_Q_CUR, 26},
        {"k", EXH_Q_K, 10},
        {"b", EXH_Q_B, 20},
        {"step", EXH_Q_STEP, 42},
        {"dac", EXH_Q_DAC, 16},
        {"mon", EXH_Q_MON, 40},
        {"angle", EXH_Q_TURN, 32},
        {"glove code", EXH_Q_RAW, 16},
        {"glove zero", EXH_Q_ZERO, 15},
        {"glove gain", EXH_Q_TPRAW, 38},
        {"supply", EXH_Q_SUPPLY, 20},
        {"supply scale", EXH_Q_VPRAW, 30},
    };
    for (size_t i = 0; i < LEN(row); i++) {
        CHECK(row[i].got == row[i].want, "%s: q%d, documented q%d", row[i].what, row[i].got,
            row[i].want);
    }
}

TEST(constants_by_hand)
{
    CHECK_EQ_I64(EXH_Q(20000, 1, EXH_Q_K), 20480000);
    CHECK_EQ_I64(EXH_Q(60, 1, EXH_Q_B), 62914560);
    CHECK_EQ_I64(EXH_Q(7, 100, EXH_Q_POS), 75161927); /* 75161927.68, towards 0 */
    CHECK_EQ_I64(EXH_Q(-7, 100, EXH_Q_POS), -75161927);
    CHECK_EQ_I64(EXH_Q(66, 10, EXH_Q_CUR), 442918502); /* 442918502.4 */
    CHECK_EQ_I64(EXH_Q(1, 1, EXH_Q_FORCE), 1048576);
    CHECK_EQ_I64(EXH_Q(-1, 1, EXH_Q_VEL), -134217728);
    CHECK_EQ_I64(EXH_Q(2, 1, 0), 2);
    CHECK_EQ_I64(EXH_Q(324900, 176, EXH_Q_DAC), 120980945); /* 3249 codes/V over 1.76 A/V */
}

/* Each row: the largest raw value, and what it must reach at least, as a ratio. */
TEST(ranges_are_reached)
{
    static const struct {
        const char *what;
        int q;
        int64_t reach_num, reach_den;
    } row[] = {
        {"position 1 m", EXH_Q_POS, 1, 1},
        {"position 1.999 m", EXH_Q_POS, 1999, 1000},
        {"velocity 10 m/s", EXH_Q_VEL, 10, 1},
        {"velocity 15.9 m/s", EXH_Q_VEL, 159, 10},
        {"force 2047 N", EXH_Q_FORCE, 2047, 1},
        {"current 31.9 A", EXH_Q_CUR, 319, 10},
        {"k 10^6 N/m", EXH_Q_K, 1000000, 1},
        {"k 2.097e6 N/m", EXH_Q_K, 2097000, 1},
        {"b 10^3 Ns/m", EXH_Q_B, 1000, 1},
        {"b 2047 Ns/m", EXH_Q_B, 2047, 1},
        {"step 488 um", EXH_Q_STEP, 488, 1000000},
        {"dac 32767 codes/A", EXH_Q_DAC, 32767, 1},
        {"monitor 1.95 mA", EXH_Q_MON, 195, 100000},
        {"angle 0.499 turn", EXH_Q_TURN, 499, 1000},
        {"glove code 32767", EXH_Q_RAW, 32767, 1},
        {"glove gain 1/129", EXH_Q_TPRAW, 1, 129},
    };
    for (size_t i = 0; i < LEN(row); i++) {
        CHECK(row[i].reach_num <= INT32_MAX * row[i].reach_den >> row[i].q, "%s does not fit q%d",
            row[i].what, row[i].q);
    }
}

/* The range column from the other side: the next larger unit does not fit. */
TEST(ranges_end_where_documented)
{
    static const struct {
        const char *what;
        int q;
        int64_t end_num, end_den; /* first value beyond the range */
    } row[] = {
        {"position 2 m", EXH_Q_POS, 2, 1},
        {"velocity 16 m/s", EXH_Q_VEL, 16, 1},
        {"force 2048 N", EXH_Q_FORCE, 2048, 1},
        {"current 32 A", EXH_Q_CUR, 32, 1},
        {"k 2.1e6 N/m", EXH_Q_K, 2100000, 1},
        {"b 2048 Ns/m", EXH_Q_B, 2048, 1},
        {"step 489 um", EXH_Q_STEP, 489, 1000000},
        {"dac 32768", EXH_Q_DAC, 32768, 1},
        {"monitor 1.96 mA", EXH_Q_MON, 196, 100000},
        {"angle 1/2 turn", EXH_Q_TURN, 1, 2},
        {"glove code 32768", EXH_Q_RAW, 32768, 1},
        {"glove gain 1/127", EXH_Q_TPRAW, 1, 127},
    };
    for (size_t i = 0; i < LEN(row); i++) {
        CHECK(row[i].end_num > INT32_MAX * row[i].end_den >> row[i].q,
            "%s fits q%d: the documented range is too small", row[i].what, row[i].q);
    }
}

TEST_MAIN("unit/units", formats_are_the_documented_ones, constants_by_hand, ranges_are_reached,
    ranges_end_where_documented);
