/* SPDX-License-Identifier: MIT */
/* Decimal text to raw values and back, in integers. An image and a host program get the same bits
 * from the same text. */
#include "pc104.h"

#include "exhand/error.h"
#include "exhand/fix.h"

#define DIGITS_MAX   18
#define EXPONENT_MAX 18

static int is_digit(char c) { return c >= '0' && c <= '9'; }

/* A decimal number: digits * 10^exponent. 0, or -EXH_E_UNKNOWN. */
static int parse(const char *text, uint64_t *digits, int *exponent)
{
    int n = 0, seen = 0, point = 0, e = 0, negative = 0;
    *digits = 0;
    *exponent = 0;
    for (; is_digit(*text) || (*text == '.' && !point); text++) {
        if (*text == '.') {
            point = 1;
            continue;
        }
        seen = 1;
        if (*digits != 0 || *text != '0') { n++; }
        if (n > DIGITS_MAX) { return -EXH_E_UNKNOWN; }
        *digits = *digits * 10 + (uint64_t)(*text - '0');
        *exponent -= point;
    }
    if (!seen) { return -EXH_E_UNKNOWN; }
    if (*text == 'e' || *text == 'E') {
        text++;
        negative = *text == '-';
        if (*text == '-' || *text == '+') { text++; }
        if (!is_digit(*text)) { return -EXH_E_UNKNOWN; }
        for (; is_digit(*text) && e < 1000; text++) { e = e * 10 + (*text - '0'); }
    }
    *exponent += negative ? -e : e;
    return *text == '\0' ? 0 : -EXH_E_UNKNOWN;
}

/* digits * 10^exponent * 2^frac, rounded half up; larger values give 2^62. */
static uint64_t scaled(uint64_t digits, int exponent, unsigned frac)
{
    const uint64_t too_large = UINT64_C(1) << 62;
    uint64_t den = 1, rest, whole;
    int behind = 0; /* places beyond those of den */

    if (digits == 0) { return 0; }
    for (; exponent > 0; exponent--) {
        if (digits > UINT32_MAX) { return too_large; }
        digits *= 10;
    }
    for (; exponent < -EXPONENT_MAX; exponent++) { behind++; }
    for (; exponent < 0; exponent++) { den *= 10; }
    whole = exh_udiv64(digits, den, &rest);
    for (; frac > 0; frac--) { /* long division, a bit at a time: rest < 10^18 */
        if (whole >= too_large) { return too_large; }
        rest *= 2;
        whole = 2 * whole + (rest >= den);
        if (rest >= den) { rest -= den; }
    }
    if (behind == 0) { return whole + (2 * rest >= den); }
    /* Half a unit of the last of them is a whole number: what is cut before it decides nothing. */
    for (; behind > 1; behind--) { whole = exh_udiv64(whole, 10, NULL); }
    return exh_udiv64(whole + 5, 10, NULL);
}

int pc104_number(const char *text, unsigned frac, int32_t *raw)
{
    const int negative = *text == '-';
    uint64_t digits, magnitude;
    int exponent;
    const int err = parse(text + (negative || *text == '+'), &digits, &exponent);
    if (err < 0) { return err; }
    magnitude = scaled(digits, exponent, frac);
    if (magnitude > (uint64_t)INT32_MAX + (negative ? 1u : 0u)) { return -EXH_E_RANGE; }
    *raw = negative ? (int32_t) - (int64_t)magnitude : (int32_t)magnitude;
    return 0;
}
