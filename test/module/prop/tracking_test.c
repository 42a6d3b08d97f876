/* SPDX-License-Identifier: MIT */
/* tracking.h: a current that follows any commands is never a fault. A stuck current always is, in
 * time. An oracle searches the history for both. */
#include "exhand/tracking.h"

#include "exhand/fix.h"

#include "check.h"

#define TICKS 400
#define PEAK  EXH_Q(66, 10, EXH_Q_CUR)

static struct exh_tracking_cfg any_config(void)
{
    const struct exh_tracking_par par = {
        check_i32_in(exh_tracking_rows[0].min, exh_tracking_rows[0].max), check_i32_in(1, 100)};
    const struct exh_period T = {1, (uint32_t)check_i32_in(1, 20000) >> check_i32_in(0, 12) | 1u};
    struct exh_tracking_cfg cfg = {0, 0};
    CHECK_EQ_I64(exh_tracking_setup(&cfg, &par, T), 0);
    return cfg;
}

/* Rests, steps, ramps, and whatever: the next current. */
static int32_t next(int32_t last)
{
    const uint64_t how = check_u64() % 16;
    if (how < 8) { return last; }
    if (how < 10) { return (how & 1) ? PEAK : -PEAK; }
    if (how < 13) {
        return exh_clamp((int64_t)last + check_i32_in(-(1 << 24), 1 << 24), -PEAK, PEAK);
    }
    return check_i32_in(-PEAK, PEAK);
}

/* left of a step from end to end, of a first-order lag of a/2^16 a tick, after n ticks, rounded up.
 */
static int64_t left_of(uint32_t a, uint32_t n)
{
    int64_t left = 2 * (int64_t)PEAK;
    for (uint32_t i = 0; i < n && left > 1; i++) { left -= left * a >> 16; }
    return left;
}

/* A delay, a lag and noise. While the rest of the largest step after cfg.ticks is below the
 * tolerance, no fault is reported for any command. */
TEST(what_follows_is_never_told)
{
    static int32_t coded[TICKS];
    while (check_case(2000)) {
        const struct exh_tracking_cfg cfg = any_config();
        const uint32_t late = 1 + (uint32_t)(check_u64() % (cfg.ticks < 300 ? cfg.ticks : 300));
        const uint32_t a = 1 + (uint32_t)(check_u64() % 65536);
        const int64_t noise = cfg.tol_A_q26 - left_of(a, cfg.ticks - late + 1) - 65536 / a - 4;
        struct exh_tracking s = {0, 0, 0};
        int64_t y = 0;
        if (noise < 0) { continue; }
        for (uint32_t n = 0; n < TICKS; n++) {
            const int64_t x = n < late ? 0 : coded[n - late];
            const int32_t by = check_i32_in(-(int32_t)noise, (int32_t)noise);
            y += (x - y) * a >> 16;
            CHECK(exh_tracking_step(&s, &cfg, (int32_t)(y + by)) == 0,
                "tick %" PRIu32 ", %" PRIu32 " late of %" PRIu32, n, late, cfg.ticks);
            coded[n] = next(n ? coded[n - 1] : 0);
            exh_tracking_update(&s, coded[n]);
        }
    }
}

/* By the definition, over all that was coded: since the last tick in which it was met. */
TEST(as_the_history_says)
{
    static int32_t coded[TICKS];
    while (check_case(2000)) {
        const struct exh_tracking_cfg cfg = any_config();
        struct exh_tracking s = {0, 0, 0};
        uint32_t met = 0, off = 0; /* coded[met] and later count; what is before the first is 0 */
        int none = 1;
        for (uint32_t n = 0; n < TICKS; n++) {
            const int32_t last = n ? coded[n - 1] : 0;
            const int32_t mon =
                check_u64() % 8
                    ? check_i32()
                    : exh_sat32((int64_t)last + check_i32_in(-cfg.tol_A_q26, cfg.tol_A_q26));
            int32_t lo = none ? 0 : coded[met], hi = lo;
            for (uint32_t i = met; i < n; i++) {
                lo = coded[i] < lo ? coded[i] : lo;
                hi = coded[i] > hi ? coded[i] : hi;
            }
            if (mon > (int64_t)hi + cfg.tol_A_q26 || (int64_t)mon + cfg.tol_A_q26 < lo) {
                off++;
            } else {
                off = 0;
                met = n;
                none = 0;
            }
            CHECK(exh_tracking_step(&s, &cfg, mon) == (off >= cfg.ticks), "tick %" PRIu32, n);
            coded[n] = check_u64() % 4 ? last : check_i32();
            exh_tracking_update(&s, coded[n]);
        }
    }
}

/* A constant current, while every code is farther from it than the tolerance. */
TEST(what_stands_is_told_in_time)
{
    while (check_case(2000)) {
        const struct exh_tracking_cfg cfg = any_config();
        const int32_t stands = check_i32_in(-PEAK, PEAK);
        const int up = check_u64() % 2 != 0;
        struct exh_tracking s = {stands, stands, 0};
        for (uint32_t n = 1; n <= cfg.ticks; n++) {
            const int64_t off = cfg.tol_A_q26 + (int64_t)1 + check_i32_in(0, PEAK);
            if (n == 1) { exh_tracking_update(&s, exh_sat32(stands + (up ? off : -off))); }
            CHECK(exh_tracking_step(&s, &cfg, stands) == (n == cfg.ticks), "tick %" PRIu32, n);
            exh_tracking_update(&s, exh_sat32(stands + (up ? off : -off)));
        }
    }
}

TEST_MAIN(
    "prop/tracking", what_follows_is_never_told, as_the_history_says, what_stands_is_told_in_time);
