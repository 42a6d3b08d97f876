/* SPDX-License-Identifier: MIT */
/* Whole ticks: from raw encoder count to D/A code, against the same chain in long
 * double. The error is in codes, where half a code is the converter's own. */
#include "path.h"

#define TICKS     300000u
#define ARM_TICKS 5000u /* 50 ms and 500 ms at 2 kHz take 1103 */

static struct drop state;
static struct drop_signals signals;
static struct exh_scene_in in;
static struct exh_drive_out out;

/* What the monitor says of that code: 1.06 for the drive's 1.05. */
static int16_t monitor_of(uint16_t dac_raw)
{
    const int n = dac_raw - 32768;
    return (int16_t)(n + n / 16);
}

static void input(uint32_t i, int32_t noise)
{
    in = (struct exh_scene_in){.command = EXH_CMD_NONE};
    in.drive.din = PATH_HEALTHY;
    in.drive.enc_raw[0] = (uint32_t)(path_cnt(i) + noise) & 0xFFFFFF;
    in.drive.mon_raw[0] = monitor_of(out.dac_raw[0]);
}

/* Arming needs a small force and the ramp needs time. The string stays at the start of the
 * movement, outside the wall, until the box runs with its whole force limit. */
static void arm(const struct exh_safety *safety, void (*tick)(void))
{
    out.dac_raw[0] = 32768;
    input(0, 0);
    in.command = EXH_CMD_RUN;
    for (uint32_t i = 0; i < ARM_TICKS && !exh_safety_is_running(safety); i++) {
        tick();
        input(0, 0);
    }
    EXH_ASSERT(exh_safety_is_running(safety));
}

static void drop_once(void) { drop_tick(&state, &path_cfg, &in, &out, &signals); }

static void drop_start(void)
{
    path_setup();
    state = (struct drop){.quad = {0, 0, 0, 0}};
    arm(&state.safety, drop_once);
}

static void drop_op(uint32_t i)
{
    in.drive.enc_raw[0] = (uint32_t)path_cnt(i);
    in.drive.mon_raw[0] = monitor_of(out.dac_raw[0]);
    in.command = EXH_CMD_NONE;
    drop_tick(&state, &path_cfg, &in, &out, &signals);
    bench_sink = out.dac_raw[0];
}

static void minimal_once(void) { exh_scene_minimal.tick(&in, &out); }

static void minimal_start(void)
{
    const struct exh_scene_board board = {{1, MINIMAL_RATE_HZ}, 24};
    path_setup();
    EXH_ASSERT(exh_scene_minimal.setup(board) == 0);
    arm(exh_scene_minimal.safety, minimal_once);
}

static void minimal_op(uint32_t i)
{
    in.drive.enc_raw[0] = (uint32_t)path_cnt(i);
    in.drive.mon_raw[0] = monitor_of(out.dac_raw[0]);
    in.command = EXH_CMD_NONE;
    exh_scene_minimal.tick(&in, &out);
    bench_sink = out.dac_raw[0];
}

/* The D/A code that would be right, of what both scenes do. */
static long double exact_code(struct exact *x, int32_t cnt, long double pullback_N)
{
    const long double q_m = cnt * x->step_m, v_mps = (cnt - x->cnt[1]) * x->step_m / (2 * x->T_s);
    const long double slew_N = x->slew_Nps * x->T_s;
    long double f = pullback_N;
    x->cnt[1] = x->cnt[0];
    x->cnt[0] = cnt;
    if (q_m >= x->lim_m) { f += x->k_Npm * (q_m - x->lim_m) + x->b_Nspm * v_mps; }
    f = bench_clamp(f, 0, x->f_max_N);
    x->force_N = bench_clamp(f, x->force_N - slew_N, x->force_N + slew_N);
    return x->code_zero + bench_clamp(x->force_N * x->A_per_N, 0, x->peak_A) * x->code_per_A;
}

static void drop_error(struct error *e)
{
    const struct drop_par *p = &path_par;
    struct exact x;
    drop_start();
    x = (struct exact){.step_m = bench_q(p->quad.step_m_q42, EXH_Q_STEP),
        .T_s = 1 / 2000.0L,
        .k_Npm = bench_q(p->contact.k_Npm_q10, EXH_Q_K),
        .b_Nspm = bench_q(p->contact.b_Nspm_q20, EXH_Q_B),
        .lim_m = bench_q(p->own.q_lim_m_q30, EXH_Q_POS),
        .f_max_N = bench_q(p->drive.f_max_N_q20, EXH_Q_FORCE),
        .slew_Nps = p->drive.slew_up_Nps,
        .A_per_N = 1 / bench_q(p->own.kf_NpA_q20, EXH_Q_FORCE),
        .peak_A = bench_q(p->drive.i_peak_A_q26, EXH_Q_CUR),
        .code_per_A = bench_q(p->drive.dac_rawpA_q16, EXH_Q_DAC),
        .code_zero = p->drive.dac_zero_raw};
    for (uint32_t i = 1; i < TICKS; i++) {
        const int32_t noise = bench_in(-1, 1);
        long double want;
        input(i, noise);
        drop_tick(&state, &path_cfg, &in, &out, &signals);
        want = exact_code(&x, path_cnt(i) + noise,
            state.contact.inward ? bench_q(p->contact.f0_N_q20, EXH_Q_FORCE) : 0);
        error_add(e, (long double)out.dac_raw[0] - want);
    }
}

static void minimal_error(struct error *e)
{
    struct exact x = minimal_exact();
    minimal_start();
    for (uint32_t i = 1; i < TICKS; i++) {
        const int32_t noise = bench_in(-1, 1);
        input(i, noise);
        exh_scene_minimal.tick(&in, &out);
        error_add(e, (long double)out.dac_raw[0] - exact_code(&x, path_cnt(i) + noise, 0));
    }
}

static const struct kernel kernels[] = {
    {"drop_tick", "code", 1, 0.501, 1, drop_start, drop_op, drop_error,
        "half a code + all before it; 150 s at 2 kHz, k = 1997.3, b = 6.17", 0, NULL},
    {"minimal_tick", "code", 1, 0.501, 1, minimal_start, minimal_op, minimal_error,
        "half a code + all before it; 300 s at 1 kHz, force and slew limits act", 0, NULL},
};
const struct kernel_group scene_group = {kernels, sizeof kernels / sizeof kernels[0]};
