/* SPDX-License-Identifier: MIT */
/* PROVES: quadrature
 * Lines, index and counter in any state read from bytes, with any sample. Any count to metres.
 * Set-up with any parameters, period and width accepts a jump of at most a quarter of the counter.
 *
 * EVA: -eva-auto-loop-unroll 300 -eva-slevel 800
 * PLANT: lib/src/sense/quad.c: s->ab &= 3; -> (void)0;
 * PLANT: lib/src/sense/quad.c: jump >= INT64_C(1) << (bits - 2) -> 0
 * PLANT: lib/src/sense/quad.c: (32u - bits) -> (33u - bits)
 * PLANT: lib/src/sense/quad.c: exh_sat32(exh_mul_shr(cnt, -> (int32_t)(exh_mul_shr(cnt,
 * PLANT: lib/src/sense/quad.c: mode->adds[past & 15u] -> mode->adds[past & 31u]
 */
#include "num/bytes.c"
#include "num/fix.c"
#include "sense/quad.c"

#include "any.h"

/* Each block of a run ends where its own n says: a block and a short one show all there is. What a mode adds: anything. */
#define SAMPLES (RUN_MAX + 2)

static struct exh_quad_mode mode;
static uint8_t ab[SAMPLES];

static void run(size_t n)
{
    static struct exh_quad_ab s;
    FROM_BYTES(s, exh_quad_ab_serialize);
    exh_quad_ab_run(&s, &mode, ab, n);
    /*@ assert place_after_run: s.ab <= 3; */
}

static void lines(void)
{
    static struct exh_quad_ab s;
    ANY(mode);
    ANY(ab);
    FROM_BYTES(s, exh_quad_ab_serialize);
    exh_quad_ab_step(&s, &mode, any_u32());
    /*@ assert place_after_step: s.ab <= 3; */
    exh_quad_ab_word(&s, any_u64(), any_u64());
    /*@ assert place_after_word: s.ab <= 3; */
    run(0);
    run(1);
    run(SAMPLES);
}

static void mark(void)
{
    static struct exh_quad_index s;
    FROM_BYTES(s, exh_quad_index_serialize);
    exh_quad_index_step(&s, any32(), any_u32());
    /*@ assert level: s.level <= 1; */
}

static void counter(void)
{
    static struct exh_quad s;
    static struct exh_quad_par par;
    static struct exh_quad_cfg cfg;
    const struct exh_period T = {any_u32(), any_u32()};
    ANY(par);
    if (exh_quad_setup(&cfg, &par, T, any_u32()) < 0) { return; }
    /*@ assert no_more_than_a_quarter: cfg.jump_cnt < 1 << 30; */
    /*@ assert width: cfg.unused <= 16; */
    FROM_BYTES(s, exh_quad_serialize);
    (void)exh_quad_step(&s, &cfg, any_u32());
    par.step_m_q42 = any32();
    (void)exh_quad_pos_m_q30(&par, any32());
}

int main(void)
{
    lines();
    mark();
    counter();
    END();
    return 0;
}
