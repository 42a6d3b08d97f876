/* SPDX-License-Identifier: MIT */
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
    CHECK(
        check_saturations - before == !fits, "step %" PRId32 " cnt %" PRId32 ": audit", step, cnt);
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
        const int32_t cnt = exh_quad_step(&s, &cfg, raw);
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
        CHECK(
            bits == 32 || moved + half < 2 * half, "bits %" PRId32 ": moved %" PRIu32, bits, moved);
        CHECK(cnt == s.cnt && s.started, "state");
    }
}

/* The definition, line by line: where a sample is in the sequence 00 01 11 10, how far
 * from the one before, and which edges the mode counts. */
static void by_definition(struct exh_quad_ab *s, int x, unsigned ab)
{
    const unsigned a = ab >> 1 & 1, b = ab & 1, was_a = s->ab >> 1, was_b = s->ab & 1u;
    const unsigned at = 2 * a + (a ^ b), was = 2 * was_a + (was_a ^ was_b);
    const unsigned moved = (at - was) & 3;
    if (s->started && moved == 2) { s->illegal++; }
    if (s->started && (moved & 1)) {
        const int counted = x == 4 || (a != was_a && (x == 2 || b));
        s->edges++;
        if (counted) { s->cnt = exh_wrap_add(s->cnt, moved == 1 ? 1 : -1); }
    }
    s->ab = (uint8_t)(ab & 3);
    s->started = 1;
}

static int same(const struct exh_quad_ab *s, const struct exh_quad_ab *t)
{
    return s->cnt == t->cnt && s->edges == t->edges && s->illegal == t->illegal && s->ab == t->ab &&
           s->started == t->started;
}

/* A walk that mostly goes one way and rests, with reversals, steps of both lines, and
 * stretches of nothing but noise. Bits above the sample are garbage. */
static void walk(uint8_t *ab, size_t n)
{
    static const uint8_t gray[4] = {0, 1, 3, 2};
    const int noise = check_i32_in(0, 3) == 0;
    unsigned at = (unsigned)check_u64();
    unsigned way = 1;
    for (size_t i = 0; i < n; i++) {
        const uint64_t r = check_u64();
        if ((r & 0x3F) == 0) { way = 0u - way; }
        at += noise ? (unsigned)(r >> 8) : (r >> 8 & 0x3F) == 0 ? 2 : (r >> 16 & 3) ? way : 0;
        ab[i] = (uint8_t)(gray[at & 3] | (r >> 24 & 0xFC));
    }
}

/* Steps, runs cut anywhere, and words: all are the definition. */
TEST(steps_runs_and_words_are_the_definition)
{
    static const struct {
        const struct exh_quad_mode *mode;
        int x;
    } row[] = {{&exh_quad_x1, 1}, {&exh_quad_x2, 2}, {&exh_quad_x4, 4}};
    while (check_case(1000)) {
        uint8_t ab[1024];
        const size_t k = (size_t)check_i32_in(0, 2);
        const struct exh_quad_ab start = {check_i32(), (uint32_t)check_i32(), (uint32_t)check_i32(),
            (uint8_t)check_i32_in(0, 3), (uint8_t)check_i32_in(0, 1)};
        struct exh_quad_ab want = start, step = start, run = start;
        size_t done = 0;
        walk(ab, sizeof ab);
        while (done < sizeof ab) {
            const size_t left = sizeof ab - done;
            const size_t n = (size_t)check_i32_in(0, left < 600 ? (int32_t)left : 600);
            for (size_t i = done; i < done + n; i++) {
                by_definition(&want, row[k].x, ab[i]);
                exh_quad_ab_step(&step, row[k].mode, ab[i]);
                CHECK(same(&step, &want), "x%d sample %zu: step", row[k].x, i);
            }
            exh_quad_ab_run(&run, row[k].mode, ab + done, n);
            done += n;
            CHECK(same(&run, &want), "x%d up to sample %zu: run", row[k].x, done);
        }
    }
}

TEST(words_are_the_definition)
{
    while (check_case(200)) {
        uint8_t ab[4 * 64];
        const struct exh_quad_ab start = {check_i32(), (uint32_t)check_i32(), (uint32_t)check_i32(),
            (uint8_t)check_i32_in(0, 3), (uint8_t)check_i32_in(0, 1)};
        struct exh_quad_ab want = start, word = start;
        walk(ab, sizeof ab);
        for (size_t w = 0; w < sizeof ab; w += 64) {
            uint64_t a = 0, b = 0;
            for (size_t i = 0; i < 64; i++) {
                a |= (uint64_t)(ab[w + i] >> 1 & 1) << i;
                b |= (uint64_t)(ab[w + i] & 1) << i;
                by_definition(&want, 4, ab[w + i]);
            }
            exh_quad_ab_word(&word, a, b);
            CHECK(same(&word, &want), "word %zu", w / 64);
        }
    }
}

TEST_MAIN("prop/quad", position_is_within_half_an_lsb, extension_is_congruent_and_shortest,
    steps_runs_and_words_are_the_definition, words_are_the_definition);
