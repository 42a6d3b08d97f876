/* SPDX-License-Identifier: MIT */
/* quantizer.h: no flip at a constant input, the error's bound, small formats in full. */
#include "exhand/quantizer.h"

#include "check.h"

static struct exh_quantizer_cfg set(int32_t bits, int32_t hyst)
{
    const struct exh_quantizer_par par = {bits, hyst};
    struct exh_quantizer_cfg cfg = {0, 0};
    CHECK(exh_quantizer_setup(&cfg, &par) == 0, "bits %" PRId32 " hyst %" PRId32, bits, hyst);
    return cfg;
}

static int64_t error_of(int32_t x, int32_t y) { return x > y ? (int64_t)x - y : (int64_t)y - x; }

static int32_t hyst_max(int32_t bits) { return bits == 1 ? INT32_MAX : INT32_C(1) << (32 - bits); }

/* Any path of the input: the error keeps its bound, the value is a multiple of Q. */
TEST(error_keeps_its_bound)
{
    while (check_case(10)) {
        const int32_t bits = check_i32_in(1, 24);
        const int32_t hyst = check_i32_in(0, hyst_max(bits));
        const struct exh_quantizer_cfg cfg = set(bits, hyst);
        const int64_t q = INT64_C(1) << (32 - bits);
        struct exh_quantizer s = {0, 0};
        for (int t = 0; t < 20; t++) {
            const int32_t x = check_i32();
            const int32_t y = exh_quantizer_step(&s, &cfg, x);
            const int64_t bound = x > (INT64_C(1) << 31) - q ? q - 1 : 0;
            CHECK(y % q == 0, "%" PRId32 " is no multiple of 2^%" PRId32, y, 32 - bits);
            CHECK(2 * error_of(x, y) <= q + hyst || error_of(x, y) <= bound,
                "bits %" PRId32 " hyst %" PRId32 ": %" PRId32 " for %" PRId32, bits, hyst, y, x);
        }
    }
}

/* Noise of the hysteresis' size around any level: after the first change none. */
TEST(a_constant_input_does_not_flip)
{
    while (check_case(10)) {
        const int32_t bits = check_i32_in(1, 24);
        const int32_t hyst = check_i32_in(0, hyst_max(bits));
        const struct exh_quantizer_cfg cfg = set(bits, hyst);
        const int32_t level = check_i32_in(INT32_MIN, INT32_MAX - hyst);
        struct exh_quantizer s = {0, 0};
        int32_t last = exh_quantizer_step(&s, &cfg, check_i32_in(level, level + hyst));
        int changes = 0;
        for (int t = 0; t < 30; t++) {
            const int32_t y = exh_quantizer_step(&s, &cfg, check_i32_in(level, level + hyst));
            changes += y != last;
            last = y;
        }
        CHECK(changes <= 1, "bits %" PRId32 " hyst %" PRId32 " level %" PRId32 ": %d changes", bits,
            hyst, level, changes);
    }
}

/* Small codes in full: every level and every value kept, against the definition. */
TEST(small_formats_in_full)
{
    for (int32_t hyst = 0; hyst <= 256; hyst += hyst < 4 ? 1 : 36) {
        const struct exh_quantizer_cfg cfg = set(24, hyst);
        for (int32_t value = -512; value <= 512; value += 256) {
            for (int32_t x = -2000; x <= 2000; x++) {
                struct exh_quantizer s = {value, 1};
                const int32_t y = exh_quantizer_step(&s, &cfg, x);
                const int32_t near = ((x + 128 + 256 * 100) / 256 - 100) * 256;
                const int32_t want = 2 * error_of(x, value) <= 256 + hyst ? value : near;
                CHECK(y == want, "hyst %" PRId32 " x %" PRId32 ": %" PRId32, hyst, x, y);
            }
        }
    }
}

TEST_MAIN(
    "prop/quantizer", error_keeps_its_bound, a_constant_input_does_not_flip, small_formats_in_full);
