/* SPDX-License-Identifier: MIT */
/* velocity.h against exact arithmetic: one step of each estimator from any state,
 * any count, any scale that set-up accepts; foaw against brute force. */
#include "exhand/velocity.h"

#include "check.h"
#include "wide.h"

/* A scale within the documented ranges: period 50 us … 1 s as a ratio with small
 * or large terms, step anything above 0. */
static struct exh_velocity_scale any_scale(void)
{
    struct exh_velocity_scale s;
    const uint32_t big = (uint32_t)(check_u64() & UINT32_MAX) | 0x80000000u;
    const uint32_t rate = (uint32_t)check_i32_in(1, 20000);
    const uint64_t how = check_u64() % 3;
    s.step_m_q42 = check_i32_in(1, INT32_MAX);
    s.T.num = how == 0 ? 1 : how == 1 ? big / rate : (uint32_t)check_i32_in(1, 65535);
    s.T.den = how == 0 ? rate : how == 1 ? big : s.T.num * rate; /* below 2^31 */
    return s;
}

/* got is within 1/2 LSB and a gain error of 2^-31 of num/den counts per tick, or
 * on the right rail. One count per tick is step * T.den / (T.num * 2^15) LSB; both
 * sides are multiplied by T.num * 2^15 * den; |num| < 2^51, den < 2^13. */
static int close_to(int32_t got, struct exh_velocity_scale s, int64_t num, int64_t den)
{
    const int64_t unit = (int64_t)s.T.num * 32768 * den;
    const struct wide exact = wide_mul((int64_t)s.step_m_q42 * s.T.den, num);
    const struct wide loose = wide_add(wide_shr_floor(wide_abs(exact), 31), wide_of(unit / 2 + 1));
    const struct wide err = wide_sub(wide_mul(got, unit), exact);
    if (got == INT32_MAX && wide_negative(err)) { return 1; }
    if (got == INT32_MIN && !wide_negative(err)) { return 1; }
    return wide_within(err, loose);
}

static int64_t unwrapped(int32_t a, int32_t b)
{
    const uint64_t d = ((uint64_t)(int64_t)a - (uint64_t)(int64_t)b) & UINT32_MAX;
    return d > INT32_MAX ? (int64_t)d - (INT64_C(1) << 32) : (int64_t)d;
}

TEST(window_step_is_exact)
{
    while (check_case(1)) {
        const struct exh_velocity_scale scale = any_scale();
        const struct exh_velocity_par par = {check_i32_in(0, 4)};
        const int32_t cnt = check_i32();
        struct exh_velocity_window_cfg cfg;
        struct exh_velocity_window s = {{0}, 0, 1};
        int32_t oldest, got;
        if (exh_velocity_window_setup(&cfg, scale, &par) < 0) { continue; }
        for (int32_t i = 0; i < EXH_VELOCITY_N; i++) { s.cnt[i] = (cnt & ~63) | i; }
        s.at = (uint8_t)(check_u64() % cfg.n);
        s.cnt[s.at] = check_i32();
        oldest = s.cnt[s.at];
        got = exh_velocity_window_step(&s, &cfg, cnt);
        CHECK(close_to(got, scale, unwrapped(cnt, oldest), cfg.n),
            "step %" PRId32 " T %" PRIu32 "/%" PRIu32 " n %d moved %" PRId64 ": %" PRId32,
            scale.step_m_q42, scale.T.num, scale.T.den, cfg.n, unwrapped(cnt, oldest), got);
    }
}

/* The window holds the last n counts whatever came before. */
TEST(window_keeps_its_samples)
{
    while (check_case(50)) {
        const struct exh_velocity_scale scale = {1 << 20, {1, 1000}};
        const struct exh_velocity_par par = {check_i32_in(0, 4)};
        struct exh_velocity_window_cfg cfg;
        struct exh_velocity_window s = {{0}, 0, 0};
        int32_t hist[64];
        CHECK_EQ_I64(exh_velocity_window_setup(&cfg, scale, &par), 0);
        for (int k = 0; k < 64; k++) {
            const int back = k - cfg.n < 0 ? 0 : k - cfg.n;
            hist[k] = check_i32();
            CHECK(close_to(exh_velocity_window_step(&s, &cfg, hist[k]), scale,
                      unwrapped(hist[k], hist[back]), cfg.n),
                "n %d tick %d", cfg.n, k);
        }
    }
}

/* --- pole --- */

/* v' = v + (diff - v) * a with diff the saturated difference: between the two,
 * within one rounding of the exact sum, and the output is v' rounded. */
TEST(pole_step_is_exact)
{
    const int32_t rail_hi = INT32_MAX, rail_lo = INT32_MIN;
    while (check_case(1)) {
        const struct exh_velocity_scale scale = any_scale();
        const int32_t cnt = check_i32();
        const int64_t whole = check_i32();
        const int64_t v = whole * (1 << 28) + check_i32_in(0, (1 << 28) - 1);
        struct exh_velocity_pole s = {v, check_i32(), 1};
        struct exh_velocity_pole_cfg cfg;
        const int64_t moved = unwrapped(cnt, s.cnt);
        struct wide diff, want, off;
        const uint32_t tau = (uint32_t)check_i32_in(0, 1000000);
        int32_t got;
        if (exh_velocity_pole_setup(&cfg, scale, tau) < 0) { continue; }
        got = exh_velocity_pole_step(&s, &cfg, cnt);
        diff = wide_shr_half_up(wide_mul(moved, cfg.gain.mant), cfg.gain.shift);
        if (wide_cmp(diff, wide_of(rail_hi)) > 0) { diff = wide_of(rail_hi); }
        if (wide_cmp(diff, wide_of(rail_lo)) < 0) { diff = wide_of(rail_lo); }
        off = wide_sub(wide_shl(diff, 28), wide_of(v));
        want = wide_add(wide_of(v), wide_shr_half_up(wide_mul(wide_sat64(off), cfg.a_q31), 31));
        CHECK(wide_cmp(want, wide_of(s.v_mps_q55)) == 0, "state %" PRId64, s.v_mps_q55);
        CHECK(got == wide_sat32(wide_shr_half_up(want, 28)), "output %" PRId32, got);
    }
}

/* a = T/(T+tau): |a*(num*10^6 + den*tau) - num*10^6 * 2^31| <= one LSB of a. */
TEST(pole_share_is_exact)
{
    while (check_case(4)) {
        const struct exh_velocity_scale scale = any_scale();
        const uint32_t tau = (uint32_t)check_i32_in(0, 1000000);
        struct exh_velocity_pole_cfg cfg;
        struct wide den, err;
        if (exh_velocity_pole_setup(&cfg, scale, tau) < 0) { continue; }
        den = wide_add(wide_mul(scale.T.num, 1000000), wide_mul(scale.T.den, tau));
        err = wide_sub(
            wide_mul(cfg.a_q31, wide_sat64(den)), wide_shl(wide_mul(scale.T.num, 1000000), 31));
        CHECK(wide_within(err, den), "T %" PRIu32 "/%" PRIu32 " tau %" PRIu32 ": %" PRId32,
            scale.T.num, scale.T.den, tau, cfg.a_q31);
        CHECK(cfg.a_q31 > 0, "dead filter");
    }
}

/* --- foaw --- */

/* By definition: the least-squares slope over n+1 samples from its normal equations. n = 1, 2 …
 * until a sample leaves the line through the newest by more than tol. hist[0] is the newest. Slope
 * as *num / *den. */
static void foaw_reference(
    const int64_t *hist, int have, int n_max, int tol, int64_t *num, int64_t *den)
{
    *num = 0;
    *den = 1;
    for (int n = 1; n <= n_max && n < have; n++) {
        int64_t st = 0, sy = 0, sty = 0, stt = 0, top, bottom;
        for (int j = 0; j <= n; j++) { /* time -j */
            const int64_t y = hist[j] - hist[0];
            st -= j;
            stt += j * j;
            sy += y;
            sty -= j * y;
        }
        top = (n + 1) * sty - st * sy;
        bottom = (n + 1) * stt - st * st;
        for (int j = 1; j <= n && n > 1; j++) {
            const struct wide off = wide_add(wide_mul(hist[j] - hist[0], bottom), wide_mul(top, j));
            if (!wide_within(off, wide_mul(tol, bottom))) { return; }
        }
        *num = top;
        *den = bottom;
    }
}

/* Counts that make windows of every length: ramps with noise, steps, reversals,
 * jumps anywhere. */
static int64_t foaw_move(uint64_t how, int64_t ramp)
{
    const uint64_t u = check_u64();
    if (how % 4 == 0) { return ramp; }
    if (how % 4 == 1) { return ramp + (int64_t)(u % 3) - 1; }
    if (how % 4 == 2) { return u % 8 == 0 ? check_i32_in(-1000, 1000) : ramp; }
    return u % 16 == 0 ? check_i32() : ramp;
}

static void foaw_run(struct exh_velocity_scale scale, int64_t ramp_max)
{
    const uint64_t how = check_u64();
    const int n = check_i32_in(1, EXH_VELOCITY_N), tol = how & 64 ? check_i32_in(1, 255) : 1;
    const int64_t ramp = check_i32_in((int32_t)-ramp_max, (int32_t)ramp_max);
    struct exh_velocity_foaw_cfg cfg;
    struct exh_velocity_foaw s = {{0}, 0, 0};
    int64_t hist[EXH_VELOCITY_N + 1] = {0}, pos = check_i32(), num, den;
    if (exh_velocity_foaw_setup(&cfg, scale, (unsigned)n, (unsigned)tol) < 0) { return; }
    for (int k = 0; k < 25; k++) {
        const int32_t cnt = (int32_t)unwrapped(
            (int32_t)(pos & INT32_MAX), (int32_t)(pos & (INT64_C(1) << 31) ? INT32_MIN : 0));
        int32_t got;
        for (int j = EXH_VELOCITY_N; j > 0; j--) { hist[j] = hist[j - 1]; }
        hist[0] = pos;
        for (int j = 1; j <= EXH_VELOCITY_N; j++) { /* differences are modulo 2^32 */
            const int64_t d = (int64_t)((uint64_t)(hist[j] - pos) & UINT32_MAX);
            hist[j] = pos + (d > INT32_MAX ? d - (INT64_C(1) << 32) : d);
        }
        foaw_reference(hist, k + 1, n, tol, &num, &den);
        got = exh_velocity_foaw_step(&s, &cfg, cnt);
        CHECK(close_to(got, scale, num, den),
            "step %" PRId32 " T %" PRIu32 "/%" PRIu32 " n %d tol %d tick %d: %" PRId32
            ", slope %" PRId64 "/%" PRId64,
            scale.step_m_q42, scale.T.num, scale.T.den, n, tol, k, got, num, den);
        pos += foaw_move(how, ramp);
    }
}

TEST(foaw_equals_brute_force)
{
    static const struct exh_velocity_scale real[] = {{69049330, {1, 2000}}, {69049330, {1, 20000}},
        {7000001, {65, 1193182}}, {4398046, {1, 90}}};
    while (check_case(50)) { foaw_run(real[check_u64() % 4], 5000); }
}

/* Any scale: with small steps and long periods, counts by the million a tick. */
TEST(foaw_equals_brute_force_at_any_scale)
{
    while (check_case(50)) { foaw_run(any_scale(), 1 << 26); }
}

/* --- track --- */

static struct wide limited(struct wide v)
{
    const struct wide top = wide_of(INT64_C(1) << 60);
    if (wide_cmp(v, top) > 0) { return top; }
    return wide_cmp(v, wide_neg(top)) < 0 ? wide_neg(top) : v;
}

static struct wide share(struct wide a, int32_t b_q31)
{
    return wide_shr_half_up(wide_mul(wide_sat64(a), b_q31), 31);
}

TEST(track_step_is_exact)
{
    const int64_t most = INT64_C(1) << 60;
    while (check_case(1)) {
        const struct exh_velocity_scale scale = any_scale();
        const int32_t cnt = check_i32();
        struct exh_velocity_track s = {
            check_i64() % (most + 1), check_i64() % (most + 1), check_i32(), 1};
        struct exh_velocity_track_cfg cfg;
        struct wide off, err, vel, out;
        int64_t moved = unwrapped(cnt, s.cnt);
        const uint32_t tf = (uint32_t)check_i32_in(0, 1000000);
        int32_t got;
        if (exh_velocity_track_setup(&cfg, scale, tf) < 0) { continue; }
        moved = moved > 1 << 28 ? 1 << 28 : moved < -(1 << 28) ? -(1 << 28) : moved;
        off = wide_add(wide_of(s.err_cnt_q32), wide_of(s.vel_cnt_q32));
        off = limited(wide_sub(off, wide_shl(wide_of(moved), 32)));
        err = wide_sub(off, share(off, cfg.alpha_q31));
        vel = limited(wide_sub(wide_of(s.vel_cnt_q32), share(off, cfg.beta_q31)));
        got = exh_velocity_track_step(&s, &cfg, cnt);
        CHECK(wide_cmp(err, wide_of(s.err_cnt_q32)) == 0, "error state %" PRId64, s.err_cnt_q32);
        CHECK(wide_cmp(vel, wide_of(s.vel_cnt_q32)) == 0, "velocity state %" PRId64, s.vel_cnt_q32);
        out = wide_shr_floor(wide_mul(wide_sat64(vel), cfg.gain.mant), cfg.gain.shift);
        out = wide_sub(out, wide_shl(wide_of(got), 32)); /* within 1 LSB, or on the right rail */
        CHECK(wide_within(out, wide_of(INT64_C(1) << 32)) ||
                  (got == INT32_MAX && !wide_negative(out)) ||
                  (got == INT32_MIN && wide_negative(out)),
            "output %" PRId32, got);
    }
}

/* alpha = 1-theta^2, beta = (1-theta)^2 of one theta: alpha = 2 sqrt(beta) - beta. */
TEST(track_poles_are_double)
{
    while (check_case(4)) {
        const struct exh_velocity_scale scale = any_scale();
        const uint32_t tf = (uint32_t)check_i32_in(0, 1000000);
        struct exh_velocity_track_cfg cfg;
        struct exh_velocity_pole_cfg same;
        int64_t a, b_err;
        if (exh_velocity_track_setup(&cfg, scale, tf) < 0) { continue; }
        (void)exh_velocity_pole_setup(&same, scale, tf); /* its share is 1 - theta */
        a = same.a_q31;
        b_err = wide_sat64(wide_sub(wide_mul(a, a), wide_shl(wide_of(cfg.beta_q31), 31)));
        CHECK(b_err >= -(INT64_C(1) << 30) && b_err <= INT64_C(1) << 30, "beta %" PRId32,
            cfg.beta_q31);
        CHECK(cfg.beta_q31 > 0, "velocity never corrected: T_f %" PRIu32 " us", tf);
        a = 2 * a - cfg.beta_q31;
        CHECK(cfg.alpha_q31 >= a - 1 && cfg.alpha_q31 <= a + 1, "alpha %" PRId32, cfg.alpha_q31);
    }
}

/* Every count at every tick may be anything: nothing wraps. A constant count brings each estimator
 * back to 0. */
TEST(any_counts_then_rest)
{
    while (check_case(2000)) {
        const struct exh_velocity_scale scale = {69049330, {1, 2000}};
        struct exh_velocity_pole_cfg pole_cfg;
        struct exh_velocity_pole pole = {0, 0, 0};
        struct exh_velocity_track_cfg track_cfg;
        struct exh_velocity_track track = {0, 0, 0, 0};
        int32_t p = 1, t = 1, cnt = 0;
        (void)exh_velocity_pole_setup(&pole_cfg, scale, 2000);
        (void)exh_velocity_track_setup(&track_cfg, scale, 2000);
        for (int k = 0; k < 700; k++) {
            if (k < 300) { cnt = check_i32(); }
            p = exh_velocity_pole_step(&pole, &pole_cfg, cnt);
            t = exh_velocity_track_step(&track, &track_cfg, cnt);
        }
        CHECK(p == 0 && t == 0, "at rest: pole %" PRId32 " track %" PRId32, p, t);
    }
}

TEST_MAIN("prop/velocity", window_step_is_exact, window_keeps_its_samples, pole_step_is_exact,
    pole_share_is_exact, foaw_equals_brute_force, foaw_equals_brute_force_at_any_scale,
    track_step_is_exact, track_poles_are_double, any_counts_then_rest);
