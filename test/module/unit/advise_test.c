/* SPDX-License-Identifier: MIT */
/* precontact.h, the advice: how far before contact to freeze and how far to look. */
#include "exhand/precontact.h"

#include "exhand/error.h"

#include "check.h"

#define MM(x) EXH_Q(x, 1000, EXH_Q_POS)

/* um, rounded. */
static int64_t um(int32_t m_q30) { return ((int64_t)m_q30 * 1000000 + (1 << 29)) >> 30; }

TEST(advice)
{
    struct exh_precontact_need n = {EXH_Q(87, 100, EXH_Q_VEL), 0, 0, 16000, 0, 0, 0};
    struct exh_precontact_advice a;
    const struct exh_period slow = {1, 90}, fast = {1, 2000};
    CHECK_EQ_I64(exh_precontact_advise(&a, &n, fast, -MM(5)), 0);
    CHECK_EQ_I64(um(a.d_lim_m_q30), -435);             /* one sample at 0.87 m/s and 2 kHz */
    CHECK_EQ_I64(um(a.ray_m_q30), 5000 + 13920 + 435); /* 100 frames a second, 1 + 5 ms */
    CHECK_EQ_I64(um(a.error_m_q30), 0);
    CHECK_EQ_I64(a.speed_mps_q27, INT64_C(250) * MM(5)); /* 5 mm in 0.5 ms */
    CHECK_EQ_I64(exh_precontact_advise(&a, &n, slow, -MM(5)), 0);
    CHECK_EQ_I64(um(a.d_lim_m_q30), -9667);
    n.lag_us = 4000;
    n.noise_m_q30 = MM(1);
    n.object_mps_q27 = EXH_Q(1, 2, EXH_Q_VEL);
    n.slide_m_q30 = MM(10);
    n.radius_m_q30 = MM(20);
    CHECK_EQ_I64(exh_precontact_advise(&a, &n, fast, -MM(1) / 2), 0);
    CHECK_EQ_I64(um(a.d_lim_m_q30), -4915); /* 0.87 m/s in 4.5 ms, and 1 mm */
    CHECK_EQ_I64(um(a.error_m_q30), 8000 + 2500);
    CHECK_EQ_I64(a.speed_mps_q27, 0);
    n.noise_m_q30 = 0;
    n.lag_us = 0;
    CHECK_EQ_I64(exh_precontact_advise(&a, &n, fast, INT32_MIN + 1), -EXH_E_RANGE); /* ray */
    CHECK_EQ_I64(exh_precontact_advise(&a, &n, fast, -EXH_Q(1, 1, EXH_Q_POS)), 0);
    CHECK_EQ_I64(a.speed_mps_q27, INT32_MAX);
    CHECK_EQ_I64(exh_precontact_advise(&a, &n, fast, 0), -EXH_E_RANGE);
    n = (struct exh_precontact_need){1, 0, 0, 1, 1, 1, MM(20)};
    CHECK_EQ_I64(exh_precontact_advise(&a, &n, fast, -MM(5)), 0);
    CHECK(a.d_lim_m_q30 == -1 && a.ray_m_q30 == MM(5) + 1 && a.error_m_q30 == 2, "rounded up");
    n.speed_mps_q27 = INT32_MAX;
    n.lag_us = 2000000;
    CHECK_EQ_I64(exh_precontact_advise(&a, &n, fast, -MM(5)), -EXH_E_RANGE);
    n.speed_mps_q27 = -1;
    CHECK_EQ_I64(exh_precontact_advise(&a, &n, fast, -MM(5)), -EXH_E_RANGE);
    n = (struct exh_precontact_need){1, 0, 0, 1, 1, 1, MM(20)};
    CHECK_EQ_I64(exh_precontact_advise(&a, &n, (struct exh_period){0, 1000}, -MM(5)), -EXH_E_RATE);
    CHECK_EQ_I64(exh_precontact_advise(&a, &n, (struct exh_period){1, 0}, -MM(5)), -EXH_E_RATE);
}

/* Each figure in turn reaches 2^31 - 1 while the others stay small. */
TEST(the_greatest_advice)
{
    struct exh_precontact_need n = {
        125, 2000000, INT32_MAX - 2001, 0, 0, 0, 0}; /* 1 um/s for 2.001 s: 2001 LSB */
    struct exh_precontact_advice a;
    const struct exh_period T = {1, 1000};
    CHECK_EQ_I64(exh_precontact_advise(&a, &n, T, -5), 0);
    CHECK(a.d_lim_m_q30 == -INT32_MAX && a.ray_m_q30 == INT32_MAX - 2001 + 1 + 5, "d_lim");
    n.noise_m_q30++;
    CHECK_EQ_I64(exh_precontact_advise(&a, &n, T, -5), -EXH_E_RANGE);
    n = (struct exh_precontact_need){0, 0, INT32_MAX - 5, 0, 0, 0, 0};
    CHECK_EQ_I64(exh_precontact_advise(&a, &n, T, -5), 0);
    CHECK_EQ_I64(a.ray_m_q30, INT32_MAX);
    CHECK_EQ_I64(exh_precontact_advise(&a, &n, T, -6), -EXH_E_RANGE);
    n = (struct exh_precontact_need){0, 0, 0, 125000, 65534, 65535, 1}; /* 65534 and 65535^2 / 2 */
    CHECK_EQ_I64(exh_precontact_advise(&a, &n, T, -5), 0);
    CHECK_EQ_I64(a.error_m_q30, INT32_MAX);
    n.object_mps_q27++;
    CHECK_EQ_I64(exh_precontact_advise(&a, &n, T, -5), -EXH_E_RANGE);
}

TEST_MAIN("unit/advise", advice, the_greatest_advice);
