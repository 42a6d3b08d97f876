/* SPDX-License-Identifier: MIT */
/* Eva knows a quotient's size, but not of one made bit by bit. */
#define exh_udiv64 udiv64
static uint64_t udiv64(uint64_t num, uint64_t den, uint64_t *rem)
{
    /*@ assert divisor: den != 0; */
    if (rem) { *rem = num % den; }
    return num / den;
}
