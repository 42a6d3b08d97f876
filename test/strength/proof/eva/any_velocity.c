/* SPDX-License-Identifier: MIT */
/* PROVES: velocity, all but foaw
 * Difference and window, pole, track: set-up with any parameters. A tick with a step > 0, tables
 * and shares that set-up leaves, in any state read from bytes, with any count. The tick leaves
 * such a state again.
 *
 * PLANT: lib/src/sense/velocity.c: (cfg->n - 1u) & (EXH_VELOCITY_N - 1u)); -> (cfg->n - 1u));
 * PLANT: lib/src/sense/velocity.c: s->at %= EXH_VELOCITY_N; -> (void)0;
 * PLANT: lib/src/sense/velocity.c: s->v_mps_q55 = exh_clamp64(s->v_mps_q55, POLE_MAX_MPS_Q55); -> (void)0;
 * PLANT: lib/src/sense/velocity.c: s->vel_cnt_q32 = exh_clamp64(s->vel_cnt_q32, TRACK_MAX_CNT_Q32); -> (void)0;
 * PLANT: lib/src/sense/velocity.c: exh_clamp64(s->err_cnt_q32 + s->vel_cnt_q32 - moved_q32, TRACK_MAX_CNT_Q32) -> 4 * (s->err_cnt_q32 + s->vel_cnt_q32 - moved_q32)
 */
#include "num/bytes.c"
#include "num/fix.c"
#include "sense/velocity.c"

#include "any.h"

static struct exh_velocity_scale any_scale(void)
{
    struct exh_velocity_scale s;
    s.step_m_q42 = any32();
    s.T.num = any_u32();
    s.T.den = any_u32();
    return s;
}

static void window(void)
{
    static struct exh_velocity_window s;
    static struct exh_velocity_window_cfg cfg;
    const struct exh_velocity_par par = {any32()};
    if (exh_velocity_window_setup(&cfg, any_scale(), &par) < 0) { return; }
    cfg.n = any8(); /* damaged: no index leaves the window */
    FROM_BYTES(s, exh_velocity_window_serialize);
    (void)exh_velocity_window_step(&s, &cfg, any32());
    /*@ assert window_at: s.at < 16; */
}

static void pole(void)
{
    static struct exh_velocity_pole s;
    static struct exh_velocity_pole_cfg cfg;
    if (exh_velocity_pole_setup(&cfg, any_scale(), any_u32()) < 0) { return; }
    /*@ assert pole_share: 1 <= cfg.a_q31; */
    FROM_BYTES(s, exh_velocity_pole_serialize);
    /*@ assert pole_read: -(16 << 27) * (1 << 28) <= s.v_mps_q55 <= (16 << 27) * (1 << 28); */
    (void)exh_velocity_pole_step(&s, &cfg, any32());
    s.v_mps_q55 = any64();
    (void)exh_velocity_pole_step(&s, &cfg, any32());
}

static void track(void)
{
    static struct exh_velocity_track s;
    static struct exh_velocity_track_cfg cfg;
    if (exh_velocity_track_setup(&cfg, any_scale(), any_u32()) < 0) { return; }
    /*@ assert track_shares: 0 <= cfg.beta_q31 && 1 <= cfg.alpha_q31; */
    FROM_BYTES(s, exh_velocity_track_serialize);
    (void)exh_velocity_track_step(&s, &cfg, any32());
    /* And from four times as far off as bytes leave, which a tick does not leave again. */
    s.err_cnt_q32 = Frama_C_long_long_interval(-4 * TRACK_MAX_CNT_Q32, 4 * TRACK_MAX_CNT_Q32);
    (void)exh_velocity_track_step(&s, &cfg, any32());
    /*@ assert track_err: -(1 << 60) * 4 <= s.err_cnt_q32 <= (1 << 60) * 4; */
    /*@ assert track_vel: -(1 << 60) <= s.vel_cnt_q32 <= 1 << 60; */
}

int main(void)
{
    window();
    pole();
    track();
    END();
    return 0;
}
