/* quad.h against exact arithmetic: metres of a count, and the extension. */
#include "exhand/quad.h"

#include "exhand/fix.h"
#include "exhand/units.h"

#include "check.h"
#include "wide.h"

static void pos_case(int32_t step, int32_t cnt)
{
    const struct exh_quad_par par = {step, INT32_MAX};
    const uint32_t before = check_saturations;
    const int32_t got = exh_quad_pos_m_q30(&par, cnt);
    const struct wide exact = wide_mul(step, cnt); /* q42 */
    const struct wide q30 = wide_shr_half_up(exact, EXH_Q_STEP - EXH_Q_POS);
    const int fits = wide_cmp(q30, wide_of(got)) == 0;
    CHECK(got == wide_sat32(q30), "step %" PRId32 " cnt %" PRId32 ": %" PRId32, step, cnt, got);
    CHECK(check_saturations - before == !fits, "step %" PRId32 " cnt %" PRId32 ": audit", step,
          cnt);
    CHECK(!fits || wide_within(wide_sub(wide_shl(wide_of(got), 12), exact), wide_of(1 << 11)),
          "step %" PRId32 " cnt %" PRId32 ": error beyond half an LSB", step, cnt);
}

TEST(position_is_within_half_an_lsb)
{
    static const int32_t edge[] = {1, 2, 2047, 2048, 2049, 4096, 65535, 69049330, INT32_MAX};
    for (size_t s = 0; s < sizeof edge / sizeof edge[0]; s++) {
        for (size_t i = 0; i < CHECK_CORNERS; i++) { pos_case(edge[s], check_corner[i]); }
    }
    while (check_case(1)) {
        const int32_t step = check_i32_in(1, INT32_MAX);
        pos_case(step, check_i32());
    }
}

/* Any width 1..32, any garbage above it: the count moves by the one number that is
 * congruent to the raw difference and lies within half the width. */
TEST(extension_is_congruent_and_shortest)
{
    while (check_case(1)) {
        const int32_t bits = check_i32_in(1, 32);
        const struct exh_quad_cfg cfg = {NULL, check_i32_in(0, INT32_MAX), (uint8_t)(32 - bits)};
        struct exh_quad s = {(uint32_t)check_i32(), check_i32(), 1, 0};
        const struct exh_quad old = s;
        const uint32_t raw = (uint32_t)check_i32();
        const int32_t cnt = exh_quad_extend(&s, &cfg, raw);
        const int32_t step = exh_from_u32((raw - old.raw) << (32 - bits)) >> (32 - bits);
        const int jump = step > cfg.jump_cnt || step < -cfg.jump_cnt;
        const uint32_t moved = (uint32_t)cnt - (uint32_t)old.cnt;
        const uint32_t half = 1u << (bits - 1);
        CHECK(s.lost == jump, "jump of %" PRId32, step);
        if (jump) {
            CHECK(cnt == old.cnt, "a jump was counted");
            continue;
        }
        CHECK(((moved ^ (raw - old.raw)) << (32 - bits)) == 0, "bits %" PRId32 ": not congruent",
              bits);
        CHECK(bits == 32 || moved + half < 2 * half, "bits %" PRId32 ": moved %" PRIu32,
              bits, moved);
        CHECK(cnt == s.cnt && s.started, "state");
    }
}

TEST_MAIN("prop/quad", position_is_within_half_an_lsb, extension_is_congruent_and_shortest);
