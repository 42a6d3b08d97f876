/* SPDX-License-Identifier: MIT */
/* error.h: one line of text for every code there is, and for those there is not. */
#include "exhand/error.h"

#include "check.h"

#include <limits.h>

static int length(const char *s)
{
    int n = 0;
    while (s[n] != '\0') { n++; }
    return n;
}

TEST(every_code_has_its_own_line)
{
    for (int i = 0; i < EXH_E_COUNT; i++) {
        const char *text = exh_error_text(-i);
        CHECK(text != NULL && length(text) > 0, "code %d", i);
        CHECK(check_same_text(text, exh_error_text(i)), "the sign of %d matters", i);
        for (const char *p = text; *p != '\0'; p++) {
            CHECK(*p >= ' ' && *p <= '~', "code %d: not one line of ASCII", i);
        }
        for (int k = 0; k < i; k++) {
            CHECK(!check_same_text(text, exh_error_text(k)), "%d and %d say the same", i, k);
        }
    }
}

TEST(unknown_codes_are_never_null)
{
    static const int code[] = {EXH_E_COUNT, -EXH_E_COUNT, 1000, -1000, INT_MAX, -INT_MAX, INT_MIN};
    for (size_t i = 0; i < sizeof code / sizeof code[0]; i++) {
        const char *text = exh_error_text(code[i]);
        CHECK(text != NULL && length(text) > 0, "code %d", code[i]);
        CHECK(!check_same_text(text, exh_error_text(0)), "code %d reads as success", code[i]);
    }
}

static int evaluated;

static int truth(int v)
{
    evaluated++;
    return v;
}

TEST(assert_looks_once_and_passes)
{
    evaluated = 0;
    EXH_ASSERT(truth(1));
    CHECK_EQ_I64(evaluated, 1);
}

TEST_MAIN("unit/error", every_code_has_its_own_line, assert_looks_once_and_passes,
    unknown_codes_are_never_null);
