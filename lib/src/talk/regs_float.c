/* SPDX-License-Identifier: MIT */
/* Conversion between raw values and binary32, in integers, for float registers. */
#include "exhand/fix.h"
#include "exhand/error.h"
#include "exhand/regs.h"

#define FRACTION 23 /* bits of a binary32 after its leading one */
#define BIAS     127
#define HIDDEN   (UINT32_C(1) << FRACTION)
#define SIGN     (UINT32_C(1) << 31)

uint32_t exh_float_from_raw(int32_t raw, unsigned frac)
{
    const uint32_t sign = raw < 0 ? SIGN : 0u;
    const uint32_t mag = raw < 0 ? UINT32_C(0) - (uint32_t)raw : (uint32_t)raw;
    uint32_t up = mag, top = 31;
    uint32_t keep, rest;
    if (mag == 0) { return 0; }
    for (uint32_t n = 16; n > 0; n >>= 1) { /* moves the leading one to bit 31 */
        const uint32_t by = up >> (32 - n) ? 0 : n;
        up <<= by;
        top -= by;
    }
    keep = up >> 8;
    rest = up & 0xFFu;
    keep += rest > 0x80u || (rest == 0x80u && (keep & 1u)); /* 2^24 carries into the exponent */
    return sign | (((BIAS - 1u + top - frac) << FRACTION) + keep);
}

int exh_float_to_raw(uint32_t bits, unsigned frac, int32_t *raw)
{
    const uint32_t field = bits >> FRACTION & 0xFFu;
    const uint32_t mant = (bits & (HIDDEN - 1)) | (field ? HIDDEN : 0u);
    /* value = mant 2^(field - 150); subnormals and 0 as field 1: up < 0 for every frac */
    const int32_t up = (int32_t)(field ? field : 1) - (BIAS + FRACTION) + (int32_t)frac;
    uint32_t mag = 0;
    int64_t v;
    if (field == 0xFFu || up > 8) { return -EXH_E_RANGE; }
    if (up >= 0) {
        mag = mant << up;
    } else if (up >= -FRACTION - 2) {
        const uint32_t n = (uint32_t)-up;
        const uint32_t half = UINT32_C(1) << (n - 1);
        const uint32_t rest = mant & (half + (half - 1));
        mag = mant >> n;
        mag += rest > half || (rest == half && (mag & 1u));
    }
    v = bits & SIGN ? -(int64_t)mag : (int64_t)mag;
    if (v < INT32_MIN || v > INT32_MAX) { return -EXH_E_RANGE; }
    *raw = (int32_t)v;
    return 0;
}
