/* SPDX-License-Identifier: MIT */
/* Slewed parameters, for any values and shifts. They are monotone, never beyond the goal, and at
 * the goal in at most the ticks that the header gives. The rest is that of exact division. The
 * guard's sum is right after anything that is staged and applied. */
#include "exhand/fix.h"
#include "exhand/params.h"
#include "exhand/signal.h"

#include "check.h"

static int64_t distance(int32_t a, int32_t b) { return a < b ? (int64_t)b - a : (int64_t)a - b; }

/* Against division with the sign taken off. */
static void check_step(int32_t now, int32_t goal, unsigned shift)
{
    const int64_t d = distance(now, goal), whole = INT64_C(1) << shift;
    const int64_t part = (d + whole - 1) / whole;
    const int32_t next = exh_params_slew_step(now, goal, shift);
    const int64_t want = goal < now ? now - part : now + part;
    CHECK(next == want, "%" PRId32 " to %" PRId32 " by 2^-%u: %" PRId32 ", want %" PRId64, now,
        goal, shift, next, want);
    CHECK(distance(next, goal) == d - part && (d == 0 || part > 0), "rest");
}

TEST(a_step_is_the_share_rounded_up)
{
    for (unsigned a = 0; a < CHECK_CORNERS; a++) {
        for (unsigned b = 0; b < CHECK_CORNERS; b++) {
            for (unsigned s = 0; s < 32; s++) { check_step(check_corner[a], check_corner[b], s); }
        }
    }
    while (check_case(1)) {
        const int32_t a = check_i32(), b = check_i32();
        check_step(a, b, (unsigned)check_i32_in(0, 31));
        check_step(
            a, exh_sat32((int64_t)a + check_i32_in(-70000, 70000)), (unsigned)check_i32_in(0, 31));
    }
}

/* The whole way, at the bound of the header in tenths: 2^s * (10 + 7 * (32 - s)) + 10. */
TEST(it_ends_in_time)
{
    while (check_case(20000)) {
        const unsigned shift = (unsigned)check_i32_in(0, EXH_TUNE_SHIFT_MAX);
        const int64_t most = ((INT64_C(1) << shift) * (10 + 7 * (32 - (int64_t)shift)) + 10) / 10;
        const int32_t goal = check_i32();
        int32_t now = check_i32();
        int64_t n = 0;
        for (; now != goal && n <= most; n++) { now = exh_params_slew_step(now, goal, shift); }
        CHECK(now == goal && n <= most, "shift %u: %" PRId64 " ticks, at most %" PRId64, shift, n,
            most);
    }
    for (unsigned shift = 0; shift <= EXH_TUNE_SHIFT_MAX; shift++) {
        const int64_t most = ((INT64_C(1) << shift) * (10 + 7 * (32 - (int64_t)shift)) + 10) / 10;
        int32_t now = INT32_MIN;
        int64_t n = 0;
        for (; now != INT32_MAX && n <= most; n++) {
            now = exh_params_slew_step(now, INT32_MAX, shift);
        }
        CHECK(n <= most, "shift %u: %" PRId64 " ticks, at most %" PRId64, shift, n, most);
        if (shift == 6 || shift == EXH_TUNE_SHIFT_MAX) {
            check_note("over the whole range at shift %u: %" PRId64 " ticks, at most %" PRId64,
                shift, n, most);
        }
    }
}

static const struct exh_signal rows[] = {
    {0x7101, 0, EXH_WHEN_SLEWED, INT32_MIN, INT32_MAX, 0, "a", "", "a"},
    {0x7102, 0, EXH_WHEN_ANY, INT32_MIN, INT32_MAX, 0, "b", "", "b"},
    {0x7103, 0, EXH_WHEN_SLEWED, INT32_MIN, INT32_MAX, 0, "c", "", "c"},
};
static const struct exh_signal_group groups[] = {{rows, 3, 3}};
static const struct exh_signal_table table = {groups, 1};

/* No sequence of staging, applying, dropping and looking is reported. */
TEST(legal_changes_are_never_told)
{
    while (check_case(1000)) {
        int32_t active[9], staged[9];
        struct exh_params p;
        exh_params_setup(&p, &table, active, staged);
        p.locked = 1;
        p.shift = (uint8_t)check_i32_in(0, 15);
        for (int k = 0; k < 200; k++) {
            const int32_t how = check_i32_in(0, 9);
            if (how < 4) {
                CHECK_EQ_I64(exh_params_stage_at(&p, (uint32_t)check_i32_in(0, 8), check_i32()), 0);
            }
            if (how < 8) { (void)exh_params_apply(&p); }
            if (how == 9 && k % 16 == 0) { exh_params_discard(&p); }
            for (int32_t n = check_i32_in(0, 4); n > 0; n--) {
                CHECK(!exh_params_verify(&p), "told in tick %d", k);
            }
        }
    }
}

TEST_MAIN(
    "prop/params", a_step_is_the_share_rounded_up, it_ends_in_time, legal_changes_are_never_told);
