/* gains.h: inside or not against exact wider arithmetic, for every rule, gain and rate. */
#include "exhand/gains.h"

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

TEST_MAIN("gains", inside_as_in_exact_arithmetic, less_stiff_is_inside_too,
          every_rate_has_its_rule);
