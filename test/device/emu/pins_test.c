/* SPDX-License-Identifier: MIT */
/* Codes and voltages: both ways, every code. */
#include "rig.h"

/* "Code: two's complement, nominal 10 V/32768 = 305.2 uV per LSB" */
TEST(every_ad_code_comes_back_from_its_voltage)
{
    for (int32_t code = -32768; code <= 32767; code++) {
        CHECK_EQ_I64(emu_ad_code(emu_ad_uV((int16_t)code)), code);
    }
}

TEST(an_ad_code_is_the_nearest)
{
    for (int32_t v_uV = -10000000; v_uV < 10000000; v_uV += 97) {
        /* 2 |v - code 10 V/32768| <= 10 V/32768, times 256 to be whole */
        const int64_t off = (int64_t)v_uV * 256 - (int64_t)emu_ad_code(v_uV) * 78125;
        const int rail = emu_ad_code(v_uV) == 32767;
        CHECK(2 * off <= 78125 || rail, "%" PRId32 " uV", v_uV);
        CHECK(-2 * off <= 78125, "%" PRId32 " uV", v_uV);
    }
    CHECK_EQ_I64(emu_ad_code(INT32_MAX), 32767);
    CHECK_EQ_I64(emu_ad_code(INT32_MIN), -32768);
    CHECK_EQ_I64(emu_ad_code(10000000), 32767);
    CHECK_EQ_I64(emu_ad_code(-10000000), -32768);
    CHECK_EQ_I64(emu_ad_uV(-32768), -10000000);
}

/* "typical a = 3249 LSB/V, b = 32768 (full scale about +-10.08 V)" */
TEST(every_da_code_comes_back_from_its_voltage)
{
    for (int32_t code = 0; code <= 65535; code++) {
        CHECK_EQ_I64(emu_da_code(emu_da_uV((uint16_t)code)), code);
    }
    CHECK_EQ_I64(emu_da_uV(32768), 0);
    CHECK_EQ_I64(emu_da_uV(32768 + 3249), 1000000);
    CHECK_EQ_I64(emu_da_uV(32768 - 3249), -1000000);
    CHECK_EQ_I64(emu_da_uV(0), -10085565); /* 32768 / 3249 V */
    CHECK_EQ_I64(emu_da_code(INT32_MAX), 65535);
    CHECK_EQ_I64(emu_da_code(INT32_MIN), 0);
    CHECK_EQ_I64(emu_da_code(3750000), 32768 + 12184); /* "code 32768 +- 12184" */
}

/* "Bipolar V = code*FS/32768; unipolar V = (code+32768)*FS/65536"; the range codes of both. */
TEST(gains_and_unipolar_ranges)
{
    for (unsigned g = 0; g <= 4; g++) {
        const int32_t fs_uV = 10000000 >> g;
        CHECK_EQ_I64(emu_ad_code_gain(fs_uV / 2, g, 0), 16384);
        CHECK_EQ_I64(emu_ad_code_gain(-fs_uV / 2, g, 0), -16384);
        CHECK_EQ_I64(emu_ad_code_gain(fs_uV / 4, g, 1), -16384);
        CHECK_EQ_I64(emu_ad_code_gain(fs_uV / 2, g, 1), 0);
        CHECK_EQ_I64(emu_ad_code_gain(0, g, 1), -32768);
        CHECK_EQ_I64(emu_ad_code_gain(-1000000, g, 1), -32768);
        CHECK_EQ_I64(emu_ad_code_gain(fs_uV, g, 1), 32767);
        CHECK_EQ_I64(emu_ad_code_gain(2 * fs_uV, g, 0), 32767);
    }
    for (int32_t v_uV = 0; v_uV < 10000000; v_uV += 101) {
        const int64_t code = emu_ad_code_gain(v_uV, 0, 1) + 32768;
        const int64_t off = (int64_t)v_uV * 512 - code * 78125;
        CHECK((2 * off <= 78125 || code == 65535) && -2 * off <= 78125, "%" PRId32 " uV", v_uV);
    }
}

TEST_MAIN("emu/pins", every_ad_code_comes_back_from_its_voltage, an_ad_code_is_the_nearest,
    every_da_code_comes_back_from_its_voltage, gains_and_unipolar_ranges);
