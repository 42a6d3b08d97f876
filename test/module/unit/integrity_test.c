/* SPDX-License-Identifier: MIT */
/* guard.h: a change of any byte or parameter is reported in time. The self-test passes. */
#include "exhand/integrity.h"

#include "check.h"

static const struct exh_signal rows[] = {
    {0x8001, 0, EXH_WHEN_ANY, -100, 100, 1, "a", "", "a"},
    {0x8002, 0, EXH_WHEN_ANY, -100, 100, 2, "b", "", "b"},
    {0x8003, 0, EXH_WHEN_SETUP, -100, 100, 3, "c", "", "c"},
};
static const struct exh_signal_group groups[] = {{rows, LEN(rows), 1}};
static const struct exh_signal_table table = {groups, 1};

TEST(unsealed_is_quiet)
{
    struct exh_integrity g;
    memset(&g, 0, sizeof g);
    for (int k = 0; k < 100; k++) { CHECK_EQ_I64(exh_integrity_step(&g), 0); }
}

/* Areas of any length, every bit of them, at every place that the round may have come to. */
TEST(every_bit_of_the_area)
{
    uint8_t area[37];
    for (unsigned len = 1; len <= LEN(area); len++) {
        const unsigned round = (len + EXH_INTEGRITY_B - 1) / EXH_INTEGRITY_B;
        for (unsigned bit = 0; bit < 8 * len; bit++) {
            for (unsigned done = 0; done < round; done++) {
                struct exh_integrity g;
                unsigned n = 0;
                memset(area, 0x5A, sizeof area);
                exh_integrity_seal(&g, area, len, NULL);
                for (unsigned k = 0; k < 3 * round + done; k++) {
                    CHECK_EQ_I64(exh_integrity_step(&g), 0);
                }
                area[bit / 8] ^= (uint8_t)(1u << bit % 8);
                while (!exh_integrity_step(&g) && n < 1000) { n++; }
                CHECK(n < 2 * round, "%u bytes, bit %u: %u ticks", len, bit, n);
                area[bit / 8] ^= (uint8_t)(1u << bit % 8);
                for (unsigned k = 0; k < 3 * round; k++) {
                    CHECK(exh_integrity_step(&g), "forgiven"); /* only a seal clears it */
                }
                exh_integrity_seal(&g, area, len, NULL);
                CHECK_EQ_I64(exh_integrity_step(&g), 0);
            }
        }
    }
}

/* Staging and applying is no change. A bit flip in either copy is one. */
TEST(parameters)
{
    int32_t active[3], staged[3];
    struct exh_params p;
    struct exh_integrity g;
    uint8_t area[4] = {0};
    exh_params_setup(&p, &table, active, staged);
    exh_integrity_seal(&g, area, sizeof area, &p);
    for (int k = 0; k < 30; k++) {
        if (k % 5 == 0) { CHECK_EQ_I64(exh_params_stage(&p, 0x8001, 0, k), 0); }
        CHECK_EQ_I64(exh_integrity_step(&g), 0);
        if (k % 5 == 3) { (void)exh_params_apply(&p); }
    }
    for (unsigned i = 0; i < 6; i++) {
        int32_t *at = i < 3 ? &active[i] : &staged[i - 3];
        unsigned n = 0;
        *at ^= 1 << (5 * i);
        while (!exh_integrity_step(&g) && n < 100) { n++; }
        CHECK(n < 2, "value %u: %u ticks", i, n);
        *at ^= 1 << (5 * i);
        exh_integrity_seal(&g, area, sizeof area, &p);
    }
}

TEST(selftest_passes)
{
    CHECK_EQ_I64(exh_selftest(), EXH_SELFTEST_OK);
    CHECK_EQ_I64(exh_selftest_glove(), EXH_SELFTEST_OK);
}

TEST_MAIN("unit/integrity", unsealed_is_quiet, every_bit_of_the_area, parameters, selftest_passes);
