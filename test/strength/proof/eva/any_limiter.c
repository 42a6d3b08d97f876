/* SPDX-License-Identifier: MIT */
/* PROVES: the limiter's step
 * The guard of any motor: any memory as its state, any input, each kind, any configuration of
 * set-up. No undefined behaviour, and a position stays within the measurable range.
 *
 * WP: |effort sent| <= `effort_max` for every state of memory, every command and every share that
 * heat leaves. At rest it is 0. In RELEASE it falls in every step until 0, and never changes its
 * sign.
 *
 * EVA: -eva-precision 1
 * PLANT: lib/src/safe/limiter.c: exh_wrap_add64(s->heat, e * e - cfg->heat_square) -> s->heat + e * e
 * PLANT: lib/src/safe/limiter_state.c: (s->share_q30 & (EXH_LIMITER_FULL_Q30 - 1)) + -> s->share_q30 +
 * PLANT: lib/src/safe/limiter.c: (uint32_t)(-(v + 1)) + 1u -> (uint32_t)(-v)
 * PLANT: lib/src/safe/limiter.c: exh_clamp32(s->sent, cfg->near_min, cfg->near_max) -> s->sent
 */
#include "safe/limiter.c"
#include "safe/limiter_state.c"
#include "safe/motion.c"
#include "safe/safety.c"
#include "safe/safety_open.c"

#define MAY_STOP
#include "any.h"

static struct exh_limiter_cfg cfg;
static struct exh_limiter s;
static struct exh_limiter_in in;
static struct exh_limiter_out out;

/* What every set-up leaves. */
static void any_cfg(int32_t kind)
{
    ANY(cfg);
    cfg.par.kind = kind;
    cfg.par.uses = Frama_C_interval(0, EXH_LIMITER_USE_ALL);
    cfg.par.effort_max = Frama_C_interval(1, 2000000000);
    cfg.up = Frama_C_interval(1, INT32_MAX);
    cfg.down = Frama_C_interval(1, INT32_MAX);
    cfg.ramp_q30 = Frama_C_interval(1, 1 << 30);
    cfg.par.first_max = Frama_C_interval(0, 1000000000);
    cfg.par.stall_move = Frama_C_interval(0, 1000000000);
    cfg.par.pos_min = Frama_C_interval(-500000000, 500000000);
    cfg.par.pos_max = Frama_C_interval(-500000000, 500000000);
    cfg.near_min = Frama_C_interval(-1000000000, 1000000000);
    cfg.near_max = Frama_C_interval(-1000000000, 1000000000);
    cfg.heat_top = Frama_C_interval(1, INT32_MAX);
    cfg.heat_bottom = Frama_C_interval(0, 2000000000);
    cfg.heat_square = Frama_C_interval(0, 1 << 22);
    cfg.heat_budget = Frama_C_long_long_interval(INT64_C(1) << 20, INT64_C(1) << 47);
    cfg.motion.speed_mps_q27 = Frama_C_interval(1, INT32_MAX);
    cfg.motion.stuck_cur_A_q26 = Frama_C_interval(0, 2000000000);
    cfg.wall.k_Npm_q10 = Frama_C_interval(0, INT32_MAX);
    cfg.wall.b_Nspm_q20 = Frama_C_interval(0, INT32_MAX);
    cfg.wall.f0_N_q20 = Frama_C_interval(0, 100000000);
    cfg.vel = Frama_C_interval(1, (1 << 29) - 1);
    cfg.acc = Frama_C_interval(1, (1 << 30) - 2);
}

static void step(void)
{
    ANY(s);
    ANY(in);
    exh_limiter_step(&s, &cfg, &in, &out);
    /*@ assert state: out.state < 6; */
    /*@ assert enable: out.enable <= 1; */
}

int main(void)
{
    any_cfg(EXH_LIMITER_EFFORT);
    step();
    any_cfg(EXH_LIMITER_WALL);
    step();
    any_cfg(EXH_LIMITER_POSITION);
    for (uint32_t frac = 0; frac <= 12; frac++) {
        /*@ slevel 20; */
        cfg.frac = frac;
        cfg.brake = Frama_C_interval(2, (1 << 30 >> frac) - 1);
        step();
        /*@ assert place: -1000000000 <= out.send <= 1000000000; */
    }
    END();
    return 0;
}
