/* SPDX-License-Identifier: MIT */
/* gains.h: inside or not against exact wider arithmetic, for every rule, gain and rate; and on the
 * way from any pair to any other inside in every tick. */
#include "exhand/gains.h"

#include "exhand/contact.h"
#include "exhand/error.h"

#include "check.h"
#include "wide.h"

#define K_MAX EXH_Q(1000000, 1, EXH_Q_K)
#define B_MAX EXH_Q(1000, 1, EXH_Q_B)

static struct exh_gains_par any_rule(void)
{
    struct exh_gains_par r = {0, 0, 0, {0}, {0}};
    const int32_t top = check_i32_in(16, B_MAX);
    int32_t b = check_i32_in(0, top / 8);
    r.rate_Hz_q8 = check_i32_in(256, 20000 * 256);
    r.knots = check_i32_in(2, EXH_GAINS_KNOTS);
    r.k_min_Npm_q10 = check_i32_in(0, 1) ? check_i32_in(0, K_MAX) : 0;
    for (int i = 0; i < EXH_GAINS_KNOTS; i++) {
        r.b_Nspm_q20[i] = b;
        r.k_Npm_q10[i] = check_i32_in(0, K_MAX);
        b += check_i32_in(1, (B_MAX - b) / 8 > 1 ? (B_MAX - b) / 8 : 1);
    }
    return r;
}

/* k <= k0 + (k1 - k0) (b - b0) / (b1 - b0), as products of 128 bits. */
static int below(const struct exh_gains_par *r, int i, int32_t k, int32_t b)
{
    const struct wide left =
        wide_mul((int64_t)k - r->k_Npm_q10[i], (int64_t)r->b_Nspm_q20[i + 1] - r->b_Nspm_q20[i]);
    const struct wide right =
        wide_mul((int64_t)r->k_Npm_q10[i + 1] - r->k_Npm_q10[i], (int64_t)b - r->b_Nspm_q20[i]);
    return !wide_negative(wide_sub(right, left));
}

static int want(const struct exh_gains_par *r, int32_t k, int32_t b)
{
    if (k == 0 && b == 0) { return 1; }
    if (k < r->k_min_Npm_q10) { return 0; }
    for (int i = 0; i + 1 < r->knots; i++) {
        if (b >= r->b_Nspm_q20[i] && b <= r->b_Nspm_q20[i + 1]) { return below(r, i, k, b); }
    }
    return 0;
}

/* Anything, a knot, or beside the line at some b. */
static void any_gains(const struct exh_gains_par *r, int32_t *k, int32_t *b)
{
    const int how = check_i32_in(0, 3), i = check_i32_in(0, r->knots - 2);
    const int64_t db = (int64_t)r->b_Nspm_q20[i + 1] - r->b_Nspm_q20[i];
    *k = check_i32();
    *b = check_i32();
    if (how == 0) { return; }
    *b = check_i32_in(r->b_Nspm_q20[i], r->b_Nspm_q20[i + 1]);
    *k = check_i32_in(0, K_MAX);
    if (how == 1) { return; }
    if (how == 2) { *b = r->b_Nspm_q20[i]; }
    *k = (int32_t)(r->k_Npm_q10[i] + ((int64_t)r->k_Npm_q10[i + 1] - r->k_Npm_q10[i]) *
                                         (*b - r->b_Nspm_q20[i]) / db) +
         check_i32_in(-2, 2);
}

TEST(inside_as_in_exact_arithmetic)
{
    while (check_case(1)) {
        const struct exh_gains_par r = any_rule();
        int32_t k, b;
        any_gains(&r, &k, &b);
        CHECK(exh_gains_ok(&r, k, b) == want(&r, k, b), "k %" PRId32 " b %" PRId32, k, b);
    }
}

/* Below an allowed pair, down to the rule's least, every k is allowed. */
TEST(less_stiff_is_inside_too)
{
    while (check_case(1)) {
        const struct exh_gains_par r = any_rule();
        int32_t k, b, less;
        any_gains(&r, &k, &b);
        if (!exh_gains_ok(&r, k, b) || k <= r.k_min_Npm_q10) { continue; }
        less = check_i32_in(r.k_min_Npm_q10, k);
        CHECK(exh_gains_ok(&r, less, b), "k %" PRId32 " less %" PRId32 " b %" PRId32, k, less, b);
    }
}

/* Every rate 1 .. 2000 Hz and what a timer makes of it: its own rule, and no other. */
TEST(every_rate_has_its_rule)
{
    struct exh_gains_par r = {0, 2, 0, {0, 1}, {0, 0}};
    for (uint32_t rate = 1; rate <= 2000; rate++) {
        const uint32_t ticks = (1193182 + rate / 2) / rate;
        const struct exh_period exact = {1, rate}, pit = {ticks, 1193182};
        r.rate_Hz_q8 = (int32_t)(rate * 256);
        CHECK(exh_gains_setup(&r, exact) == 0 && exh_gains_setup(&r, pit) == 0, "%" PRIu32 " Hz",
            rate);
        for (uint32_t other = 1; other <= 2000; other += 7) {
            const struct exh_period T = {1, other};
            const int near = 100 * (other > rate ? other - rate : rate - other) <= rate;
            CHECK(exh_gains_setup(&r, T) == (near ? 0 : -EXH_E_RATE), "%" PRIu32 " for %" PRIu32,
                rate, other);
        }
    }
}

/* --- on the way --- */

#define WALLS 2

static const struct exh_signal_group group[] = {{exh_contact_rows, EXH_CONTACT_ROWS, WALLS}};
static const struct exh_signal_table table = {group, 1};
static struct exh_contact_par active[WALLS], staged[WALLS];
static struct exh_params params;

/* One that set-up takes: as any, in half of the cases with its knots no lower than k_min. */
static struct exh_gains_par taken_rule(void)
{
    for (;;) {
        struct exh_gains_par r = any_rule();
        const int lift = check_i32_in(0, 1);
        for (int i = 0; lift && i < r.knots; i++) {
            if (r.k_Npm_q10[i] < r.k_min_Npm_q10) { r.k_Npm_q10[i] = r.k_min_Npm_q10; }
        }
        r.rate_Hz_q8 = 1000 * 256;
        if (exh_gains_setup(&r, (struct exh_period){1, 1000}) == 0) { return r; }
    }
}

static void inside_gains(const struct exh_gains_par *r, int32_t *k, int32_t *b)
{
    *k = *b = 0;
    if (check_i32_in(0, 7) == 0) { return; }
    for (int n = 0; n < 50; n++) {
        any_gains(r, k, b);
        if (want(r, *k, *b)) { return; }
        if (*b >= 0 && want(r, r->k_min_Npm_q10, *b)) {
            *k = r->k_min_Npm_q10;
            return;
        }
    }
    *k = *b = 0;
}

static void start_at(unsigned shift)
{
    exh_params_setup(&params, &table, (int32_t *)active, (int32_t *)staged);
    exh_gains_enable(&params, 1);
    params.locked = 1;
    params.shift = (uint8_t)shift;
    for (int w = 0; w < WALLS; w++) { /* of another wall than those a test is about: none */
        active[w].k_Npm_q10 = staged[w].k_Npm_q10 = 0;
    }
}

/* Pairs are staged every few ticks and dropped now and then. The active pair is inside in every
 * tick, and the guard never reports a change. */
TEST(inside_in_every_tick)
{
    uint64_t ticks = 0;
    while (check_case(500)) {
        const struct exh_gains_par r = taken_rule();
        const int anew = check_i32_in(1, 150);
        start_at((unsigned)check_i32_in(0, 7));
        for (int w = 0; w < WALLS; w++) {
            inside_gains(&r, &active[w].k_Npm_q10, &active[w].b_Nspm_q20);
            staged[w] = active[w];
        }
        exh_params_seal(&params);
        for (int t = 0; t < 400; t++, ticks++) {
            for (uint16_t w = 0; w < WALLS && t % anew == 0; w++) {
                int32_t k, b;
                inside_gains(&r, &k, &b);
                CHECK_EQ_I64(exh_params_stage(&params, 0x0401, w, k), 0);
                CHECK_EQ_I64(exh_params_stage(&params, 0x0402, w, b), 0);
            }
            if (check_i32_in(0, 99) == 0) { exh_params_discard(&params); }
            (void)exh_params_apply(&params);
            exh_gains_step(&params, &r);
            CHECK(!exh_params_verify(&params), "told in tick %d", t);
            for (int w = 0; w < WALLS; w++) {
                CHECK(want(&r, active[w].k_Npm_q10, active[w].b_Nspm_q20),
                    "tick %d k %" PRId32 " b %" PRId32, t, active[w].k_Npm_q10,
                    active[w].b_Nspm_q20);
            }
        }
    }
    check_note("%" PRIu64 " ticks of two walls, every one inside", ticks);
}

/* To the end, in time; k falls first and rises behind, but for a jump from no wall. */
TEST(the_way_ends)
{
    while (check_case(500)) {
        const struct exh_gains_par r = taken_rule();
        const unsigned shift = (unsigned)check_i32_in(0, 7);
        const int64_t one = ((INT64_C(1) << shift) * (10 + 7 * (32 - (int64_t)shift)) + 10) / 10;
        int64_t n = 0;
        int rising = 0;
        start_at(shift);
        inside_gains(&r, &active[0].k_Npm_q10, &active[0].b_Nspm_q20);
        inside_gains(&r, &staged[0].k_Npm_q10, &staged[0].b_Nspm_q20);
        exh_params_seal(&params);
        for (params.pending = 1; exh_params_apply(&params) && n <= 3 * one + 2; n++) {
            const int32_t k = active[0].k_Npm_q10;
            const int was = want(&r, k, active[0].b_Nspm_q20);
            exh_gains_step(&params, &r);
            CHECK(was, "tick %d", (int)n);
            CHECK(!rising || active[0].k_Npm_q10 >= k || staged[0].k_Npm_q10 <= k,
                "shift %u tick %d: k %" PRId32 " to %" PRId32 ", wanted %" PRId32, shift, (int)n, k,
                active[0].k_Npm_q10, staged[0].k_Npm_q10);
            rising = active[0].k_Npm_q10 > k;
        }
        CHECK(active[0].k_Npm_q10 == staged[0].k_Npm_q10 &&
                  active[0].b_Nspm_q20 == staged[0].b_Nspm_q20 && n <= 3 * one + 2,
            "shift %u: %" PRId64 " ticks, at most %" PRId64, shift, n, 3 * one + 2);
    }
}

/* Any values in both arrays, as a damaged keyframe may have them. The pair is inside after one
 * step, and from then on. */
TEST(inside_from_anywhere)
{
    while (check_case(20)) {
        const struct exh_gains_par r = taken_rule();
        start_at((unsigned)check_i32_in(0, 15));
        any_gains(&r, &active[0].k_Npm_q10, &active[0].b_Nspm_q20);
        any_gains(&r, &staged[0].k_Npm_q10, &staged[0].b_Nspm_q20);
        exh_params_seal(&params);
        params.pending = 1;
        for (int t = 0; t < 20; t++) {
            (void)exh_params_apply(&params);
            exh_gains_step(&params, &r);
            CHECK(want(&r, active[0].k_Npm_q10, active[0].b_Nspm_q20),
                "tick %d k %" PRId32 " b %" PRId32, t, active[0].k_Npm_q10, active[0].b_Nspm_q20);
        }
    }
}

TEST_MAIN("gains", inside_as_in_exact_arithmetic, less_stiff_is_inside_too, every_rate_has_its_rule,
    inside_in_every_tick, the_way_ends, inside_from_anywhere);
