/* SPDX-License-Identifier: MIT */
/* Design values for precontact. A separate file, so that other images do not link it. */
#include "exhand/precontact.h"

#include "exhand/error.h"
#include "exhand/fix.h"

#define TIME_MAX_US 2000000
#define NS          UINT64_C(1000000000)

static uint64_t div_up(uint64_t num, uint64_t den)
{
    uint64_t rem;
    const uint64_t quot = exh_udiv64(num, den, &rem);
    return quot + (rem > 0);
}

/* Distance at speed v (q27) in time t, m q30, for v < 2^31, t < 2^32. q30 = q27 * 8. */
static uint64_t way_m_q30(int32_t v_mps_q27, uint64_t t_ns)
{
    return div_up((uint64_t)v_mps_q27 * t_ns, NS / 8);
}

static int is_need(const struct exh_precontact_need *n)
{
    return n->speed_mps_q27 >= 0 && n->lag_us >= 0 && n->lag_us <= TIME_MAX_US &&
           n->noise_m_q30 >= 0 && n->age_us >= 0 && n->age_us <= TIME_MAX_US &&
           n->object_mps_q27 >= 0 && n->slide_m_q30 >= 0 && n->radius_m_q30 >= 0;
}

int exh_precontact_advise(struct exh_precontact_advice *advice,
    const struct exh_precontact_need *need, struct exh_period T, int32_t d_lim_m_q30)
{
    const uint64_t off = (uint64_t) - (int64_t)d_lim_m_q30;
    const uint64_t noise = (uint64_t)need->noise_m_q30;
    const uint64_t age_ns = UINT64_C(1000) * (uint64_t)need->age_us;
    const uint64_t slide = (uint64_t)need->slide_m_q30;
    uint64_t tick_ns, late_ns, d, ray, error, speed;

    if (!exh_period_ok(T)) { return -EXH_E_RATE; }
    if (!is_need(need) || d_lim_m_q30 >= 0) { return -EXH_E_RANGE; }
    tick_ns = div_up(NS * T.num, T.den);
    late_ns = tick_ns + UINT64_C(1000) * (uint64_t)need->lag_us;
    d = way_m_q30(need->speed_mps_q27, late_ns) + noise;
    /* The next tick uses the message and must find d < d_lim. */
    ray = way_m_q30(need->speed_mps_q27, age_ns + tick_ns) + noise + off;
    error = way_m_q30(need->object_mps_q27, age_ns);
    if (need->radius_m_q30 > 0) {
        error += div_up(slide * slide, 2 * (uint64_t)need->radius_m_q30);
    }
    speed = off > noise ? exh_udiv64((off - noise) * (NS / 8), late_ns, NULL) : 0;
    if (d > INT32_MAX || ray > INT32_MAX || error > INT32_MAX) { return -EXH_E_RANGE; }
    advice->d_lim_m_q30 = -(int32_t)d;
    advice->ray_m_q30 = (int32_t)ray;
    advice->error_m_q30 = (int32_t)error;
    advice->speed_mps_q27 = (int32_t)(speed < INT32_MAX ? speed : INT32_MAX);
    return 0;
}
