/* SPDX-License-Identifier: MIT */
/* exp(-x), x >= 0, for closed forms: Taylor up to 1/2, then squaring. The relative error is below
 * 1e-15 up to 700: 2^11 times some half LSBs of a long double with 64 bits. */
#ifndef TEST_SIM_EXP_NEG_H
#define TEST_SIM_EXP_NEG_H

static inline long double exp_neg(long double x)
{
    long double term = 1, sum = 1;
    int n = 0;
    for (; x > 0.5L; x /= 2) { n++; }
    for (int i = 1; i < 24; i++) {
        term *= -x / i;
        sum += term;
    }
    while (n-- > 0) { sum *= sum; }
    return sum;
}

#endif
