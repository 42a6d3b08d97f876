/* SPDX-License-Identifier: MIT */
#include "pins.h"

#define AD_MAX_UV  10500000 /* beyond it a converter of 10 V sees a rail anyway */
#define AD_UV      78125u   /* 10 V / 32768 is 78125 / 256 uV */
#define DA_UV      307      /* 1 V / 3249 is 307 + 2557 / 3249 uV */
#define DA_UV_REST 2557
#define DA_CODES   3249

static int32_t limit(int32_t v, int32_t lo, int32_t hi) { return v < lo ? lo : v > hi ? hi : v; }

/* Division of what may be negative, rounded down; d > 0. */
static int32_t floor_div(int32_t n, int32_t d)
{
    const int32_t q = n / d;
    return n % d < 0 ? q - 1 : q;
}

/* |v| <= 10.5 V in halves of a code: down to the next whole half. */
static uint32_t halves(uint32_t v_uV)
{
    const uint32_t n = v_uV << 8; /* up to 2.7e9 */
    const uint32_t rest = n % AD_UV;
    return 2 * (n / AD_UV) + (2 * rest >= AD_UV);
}

int16_t emu_ad_code_gain(int32_t v_uV, unsigned gain, int unipolar)
{
    const int32_t most = AD_MAX_UV >> gain;
    const int32_t v = limit(v_uV, unipolar ? 0 : -most, most) * (1 << gain);
    const uint32_t mag = (uint32_t)(v < 0 ? -v : v);
    int32_t code;
    if (unipolar) { /* a code is half as wide: one more bit, then nearest */
        const uint32_t n = mag << 8, rest = 2 * (n % AD_UV);
        code = (int32_t)(2 * (n / AD_UV) + rest / AD_UV + (2 * (rest % AD_UV) >= AD_UV)) - 32768;
    } else {
        code = (int32_t)((halves(mag) + 1) >> 1);
        if (v < 0) { code = -code; }
    }
    return (int16_t)limit(code, -32768, 32767);
}

int16_t emu_ad_code(int32_t v_uV) { return emu_ad_code_gain(v_uV, 0, 0); }

int32_t emu_ad_uV(int16_t code)
{
    const uint32_t mag = (uint32_t)(code < 0 ? -(int32_t)code : code);
    const int32_t v = (int32_t)((mag * AD_UV + 128) >> 8);
    return code < 0 ? -v : v;
}

int32_t emu_da_uV(uint16_t code)
{
    const int32_t c = (int32_t)code - 32768;
    return c * DA_UV + floor_div(2 * c * DA_UV_REST + DA_CODES, 2 * DA_CODES);
}

uint16_t emu_da_code(int32_t v_uV)
{
    /* In two steps, since 3249 times 10 V in microvolts does not fit. */
    const int32_t v = limit(v_uV, -11000000, 11000000);
    const int32_t whole = floor_div(v, 1000), rest = v - whole * 1000;
    const int32_t n = whole * DA_CODES; /* thousandths of a code, up to 3.6e7 */
    const int32_t k = floor_div(n, 1000);
    const int32_t part = (n - k * 1000) * 1000 + rest * DA_CODES; /* millionths, below 4.3e6 */
    return (uint16_t)limit(k + (part + 500000) / 1000000 + 32768, 0, 65535);
}
