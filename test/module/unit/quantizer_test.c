/* SPDX-License-Identifier: MIT */
/* quantizer.h: refusals, worked examples, both ends. */
#include "exhand/quantizer.h"

#include "exhand/error.h"

#include "check.h"

TEST(refusals)
{
    static const struct {
        int32_t bits, hyst;
        int want;
    } row[] = {
        {0, 0, -EXH_E_RANGE},
        {1, 0, 0},
        {24, 0, 0},
        {25, 0, -EXH_E_RANGE},
        {14, -1, -EXH_E_RANGE},
        {14, 1 << 18, 0},
        {14, (1 << 18) + 1, -EXH_E_RANGE},
        {1, INT32_MAX, 0},
        {24, 256, 0},
        {24, 257, -EXH_E_RANGE},
    };
    for (size_t i = 0; i < LEN(row); i++) {
        const struct exh_quantizer_par par = {row[i].bits, row[i].hyst};
        struct exh_quantizer_cfg cfg;
        CHECK(exh_quantizer_setup(&cfg, &par) == row[i].want, "row %zu", i);
    }
}

TEST(by_hand)
{
    /* 24 bits: Q = 256; hysteresis 64: kept within 160 */
    static const int32_t row[][2] = {
        {100, 0},
        {160, 0},
        {-160, 0},
        {161, 256},
        {96, 256},
        {95, 0},
        {-161, -256},
        {-96, -256},
        {-95, 0},
        {1000000, 999936},
        {-128, 0},
        {INT32_MAX, INT32_MAX - 255},
        {INT32_MIN, INT32_MIN},
        {INT32_MIN + 160, INT32_MIN},
        {INT32_MIN + 161, INT32_MIN + 256},
        {INT32_MAX - 255 + 128, INT32_MAX - 255},
    };
    const struct exh_quantizer_par par = {24, 64};
    struct exh_quantizer_cfg cfg;
    struct exh_quantizer s = {0, 0};
    CHECK_EQ_I64(exh_quantizer_setup(&cfg, &par), 0);
    for (size_t i = 0; i < LEN(row); i++) {
        const int32_t y = exh_quantizer_step(&s, &cfg, row[i][0]);
        CHECK(y == row[i][1], "row %zu: %" PRId32, i, y);
    }
}

TEST(the_first_value_is_rounded)
{
    static const int32_t row[][2] = {{127, 0}, {128, 256}, {-128, 0}, {-129, -256}, {300, 256}};
    const struct exh_quantizer_par par = {24, 256};
    struct exh_quantizer_cfg cfg;
    CHECK_EQ_I64(exh_quantizer_setup(&cfg, &par), 0);
    for (size_t i = 0; i < LEN(row); i++) {
        struct exh_quantizer s = {0, 0};
        CHECK_EQ_I64(exh_quantizer_step(&s, &cfg, row[i][0]), row[i][1]);
    }
}

TEST(state_round_trip)
{
    struct exh_quantizer s = {-123456789, 1}, back = {0, 0};
    uint8_t buf[8];
    struct exh_bytes c = exh_bytes_writer(buf, sizeof buf);
    exh_quantizer_serialize(&c, &s);
    CHECK_EQ_I64(c.at, 5);
    c = exh_bytes_reader(buf, c.at);
    exh_quantizer_serialize(&c, &back);
    CHECK(exh_bytes_ok(&c) && back.value == s.value && back.started == s.started, "state differs");
}

TEST_MAIN("unit/quantizer", refusals, by_hand, the_first_value_is_rounded, state_round_trip);
