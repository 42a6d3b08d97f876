/* SPDX-License-Identifier: MIT */
/* The bare-metal image reads decimal text as the command line's options are read here: the same
 * text, the same raw value. */
#include "check.h"

#include "../../../ports/pc104/number.c"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* As cli_param_set() does it. */
static double host(const char *text, unsigned frac)
{
    const double scaled = strtod(text, NULL) * (double)(INT64_C(1) << frac);
    return trunc(scaled + (scaled < 0 ? -0.5 : 0.5));
}

static void same(const char *text, unsigned frac)
{
    const double want = host(text, frac);
    int32_t raw = 0;
    const int err = pc104_number(text, frac, &raw);
    if (want > (double)INT32_MAX || want < (double)INT32_MIN) {
        CHECK(err == -EXH_E_RANGE, "%s q%u: %d", text, frac, err);
    } else {
        CHECK(err == 0 && (double)raw == want, "%s q%u: %d, %" PRId32 ", want %.0f", text, frac,
            err, raw, want);
    }
}

TEST(takes_what_the_host_takes)
{
    static const char *const text[] = {"0", "-0", "1", "+1", "-1", "2000", "1234.5", ".5", "5.",
        "0.07", "6.632e-5", "12.5e-3", "1E3", "3.339", "-7.25", "2147483647", "-2147483648",
        "2147483648", "1e18", "1e30", "1e-30", "0e99", "0.000000000000000001",
        "123456789.123456789"};
    for (unsigned i = 0; i < sizeof text / sizeof text[0]; i++) {
        same(text[i], 0);
        same(text[i], 10);
        same(text[i], 20);
        same(text[i], 30);
        same(text[i], 42);
    }
}

/* Numbers as people type them: up to seven digits, anywhere. Of so few no two are near enough to
 * a half for a double to round another way, which is checked by 10^5 of them. */
TEST(takes_random_numbers_alike)
{
    uint64_t x = 1;
    for (unsigned i = 0; i < 100000; i++) {
        char text[64];
        unsigned frac;
        x = x * UINT64_C(6364136223846793005) + 1442695040888963407u;
        frac = (unsigned)(x >> 33) % 43;
        snprintf(text, sizeof text, "%s%u.%ue%d", x >> 63 ? "-" : "", (unsigned)(x >> 40) % 1000u,
            (unsigned)(x >> 20) % 10000u, (int)((x >> 50) % 9) - 6);
        same(text, frac);
    }
}

/* Just above a half, with more than 18 places: exact, which a double is not. */
TEST(rounds_once_however_small)
{
    static const struct {
        const char *text;
        unsigned frac;
        int32_t raw;
    } row[] = {{"1136869e-19", 42, 1}, {"1136868e-19", 42, 0}, {"3410606e-19", 42, 2},
        {"-3410606e-19", 42, -2}, {"37257559597493e-19", 30, 4001},
        {"37257559597492e-19", 30, 4000}, {"38151741027832032e-19", 20, 4001},
        {"909608388610650e-24", 42, 4001}, {"909608388610649e-24", 42, 4000},
        {"341060513164848090e-30", 42, 2}, {"341060513164848089e-30", 42, 1},
        {"999999999999999999e-19", 31, 214748365}, {"5e-19", 0, 0}, {"1e-1000", 42, 0}};
    for (unsigned i = 0; i < sizeof row / sizeof row[0]; i++) {
        int32_t raw = -1;
        CHECK(pc104_number(row[i].text, row[i].frac, &raw) == 0 && raw == row[i].raw,
            "%s q%u: %" PRId32, row[i].text, row[i].frac, raw);
    }
}

TEST(refuses_what_is_no_number)
{
    static const char *const text[] = {"", "-", "+", ".", "e3", "1e", "1e+", "1x", "0x10", "1 2",
        "--1", "1.2.3", "nan", "inf", "1234567890123456789"};
    int32_t raw = 7;
    for (unsigned i = 0; i < sizeof text / sizeof text[0]; i++) {
        CHECK(pc104_number(text[i], 10, &raw) == -EXH_E_UNKNOWN, "%s", text[i]);
    }
    CHECK_EQ_I64(raw, 7);
}

TEST_MAIN("pc104_number", takes_what_the_host_takes, takes_random_numbers_alike,
    rounds_once_however_small, refuses_what_is_no_number);
