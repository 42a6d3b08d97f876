/* SPDX-License-Identifier: MIT */
/* One finger and a wall: minimal, drop, guarded. */
#include "scenes.h"

#include "exhand/error.h"

#include <math.h>
#include <string.h>

#define HEALTHY \
    (EXH_DIN_ESTOP | EXH_DIN_DEADMAN | EXH_DIN_WATCHDOG | EXH_DIN_CARDS | EXH_DIN_DRIVE0)
#define ROUND_S 0.6 /* out and back */
#define PI      3.14159265358979323846
#define ZERO    32768

static const struct exh_scene *scene;
static struct exh_scene_in in;
static struct exh_drive_out out;
static struct pipe_wall_par par;
static struct pipe_wall_now now;
static long double lim_m;
static struct pipe_wall_double in_double;
static struct pipe_wall_float in_float;
static struct pipe_wall_exact exact;
static double top_m;

static void feed(int32_t cnt)
{
    const int codes = out.dac_raw[0] - ZERO;
    in.drive.din = HEALTHY;
    in.drive.enc_raw[0] = (uint32_t)cnt & 0xFFFFFF;
    in.drive.mon_raw[0] = (int16_t)(codes + codes / 16); /* 1.06 for the drive's 1.05 */
}

static void tick(int32_t cnt)
{
    feed(cnt);
    if (scene->params != NULL) { exh_params_apply(scene->params); }
    scene->tick(&in, &out);
    in.command = EXH_CMD_NONE;
}

static void par_of_drop(const struct drop_par *p, const struct drop_cfg *cfg, const struct drop *s)
{
    const struct exh_knot *end = &cfg->calib.force_to_cur[cfg->calib.to_cur_n - 1];
    par.step_m = bench_q(p->quad.step_m_q42, EXH_Q_STEP);
    par.window = 1 << p->velocity.p;
    par.speed_mps = bench_q(p->watch.speed_mps_q27, EXH_Q_VEL);
    par.k_Npm = bench_q(p->contact.k_Npm_q10, EXH_Q_K);
    par.b_Nspm = bench_q(p->contact.b_Nspm_q20, EXH_Q_B);
    par.f0_N = bench_q(p->contact.f0_N_q20, EXH_Q_FORCE);
    par.band_m = bench_q(p->contact.f0_band_m_q30, EXH_Q_POS);
    par.hyst_m = bench_q(p->contact.hyst_m_q30, EXH_Q_POS);
    par.f_max_N =
        bench_q(p->drive.f_max_N_q20 < end->x ? p->drive.f_max_N_q20 : end->x, EXH_Q_FORCE);
    par.up_Nps = p->drive.slew_up_Nps;
    par.down_Nps = p->drive.slew_down_Nps;
    par.A_per_N = bench_q(end->y, EXH_Q_CUR) / bench_q(end->x, EXH_Q_FORCE);
    par.code_per_A = bench_q(p->drive.dac_rawpA_q16, EXH_Q_DAC);
    lim_m = bench_q(p->own.q_lim_m_q30, EXH_Q_POS);
    now.turn_m = bench_q(s->contact.turn_m_q30, EXH_Q_POS);
    now.inward = s->contact.inward;
    now.touching = s->contact.touching;
    now.force_N = bench_q(s->drive.force_N_q20, EXH_Q_FORCE);
}

static void begin(const char *name, uint32_t rate_Hz)
{
    const struct exh_scene_board board = {{1, rate_Hz}, 24};
    struct guarded_cfg *guarded_at;
    struct drop_cfg *drop_at;
    int32_t k, b;
    scene = strcmp(name, "minimal") == 0   ? &exh_scene_minimal
            : strcmp(name, "guarded") == 0 ? &exh_scene_guarded
                                           : &exh_scene_drop;
    scenes_gains(rate_Hz, &k, &b);
    memset(&in, 0, sizeof in);
    memset(&par, 0, sizeof par);
    memset(&now, 0, sizeof now);
    if (scene->params != NULL) {
        scene->params->locked = 0;
        scene->defaults();
        (void)exh_params_stage(scene->params, 0x0401, 0, k * 1024);
        (void)exh_params_stage(scene->params, 0x0402, 0, b * (1 << 20));
        (void)exh_params_stage(scene->params, 0x8903, 0, 1);
        if (scene == &exh_scene_guarded) { /* which wants all force gone within a tick */
            (void)exh_params_stage(scene->params, 0x0F01, 0, 1);
            (void)exh_params_stage(scene->params, 0x0502, 0, 1000000);
            (void)exh_params_stage(scene->params, 0x0503, 0, 1000000);
        }
        exh_params_apply(scene->params);
    }
    EXH_ASSERT(scene->setup(board) == 0);
    if (scene->params != NULL) { scene->params->locked = 1; }
    out.dac_raw[0] = ZERO;
    in.command = EXH_CMD_RUN;
    for (uint32_t i = 0; i < 3 * rate_Hz + 100 && !exh_safety_is_running(scene->safety); i++) {
        tick(0);
    }
    EXH_ASSERT(exh_safety_is_running(scene->safety));
    if (scene == &exh_scene_minimal) {
        minimal_par(&par, &lim_m);
        minimal_now(&now);
    } else if (scene == &exh_scene_drop) {
        const struct drop *s = drop_memory(&drop_at);
        par_of_drop((const struct drop_par *)scene->params->active, drop_at, s);
    } else {
        const struct guarded *s = guarded_memory(&guarded_at);
        par_of_drop((const struct drop_par *)scene->params->active, &guarded_at->drop, &s->drop);
        par.way_m = guarded_at->passivity.way_cnt * par.step_m;
    }
    par.period_s = 1.0L / rate_Hz;
    par.rest_ticks = -1;
    pipe_wall_double_start(&in_double, &par, &now);
    pipe_wall_float_start(&in_float, &par, &now);
    pipe_wall_exact_start(&exact, &par, &now);
    top_m = (double)(lim_m + 0.6L * (par.f_max_N < 30 ? par.f_max_N : 30) / par.k_Npm);
}

static int32_t cnt_at(uint32_t i, uint32_t rate_Hz)
{
    return (int32_t)(top_m / 2 * (1 - cos(2 * PI * i / (ROUND_S * rate_Hz))) / (double)par.step_m);
}

static void compare(
    struct scenes_sum *force, struct scenes_sum *way, struct scenes_sum *energy, int32_t cnt)
{
    const int32_t *sig = exh_scene_signals(scene);
    const int32_t f_q20 = scene == &exh_scene_minimal
                              ? minimal_force_N_q20()
                              : ((const struct drop_signals *)sig)->f_des_N_q20;
    const long double f = pipe_wall_exact(&exact, cnt, lim_m);
    const double d = pipe_wall_double(&in_double, cnt, (double)lim_m);
    const float s = pipe_wall_float(&in_float, cnt, (float)lim_m);
    if (exact.touching) {
        error_add(&force->way[FIXED], bench_q(f_q20, EXH_Q_FORCE) - f);
        error_add(&force->way[DOUBLE], (long double)d - f);
        error_add(&force->way[FLOAT], (long double)s - f);
    }
    error_add(&way->way[DOUBLE], (long double)in_double.q - exact.q);
    error_add(&way->way[FLOAT], (long double)in_float.q - exact.q);
    if (sig != NULL) {
        error_add(&way->way[FIXED],
            bench_q(((const struct drop_signals *)sig)->q_m_q30, EXH_Q_POS) - exact.q);
    }
    if (scene == &exh_scene_guarded) {
        error_add(&energy->way[FIXED],
            bench_q(((const struct guarded_signals *)sig)->energy_J_q24, 24) - exact.energy);
        error_add(&energy->way[DOUBLE], (long double)in_double.energy - exact.energy);
        error_add(&energy->way[FLOAT], (long double)in_float.energy - exact.energy);
    }
}

void scenes_wall(const char *name, uint32_t rate_Hz, double seconds)
{
    static const struct scenes_sum none;
    struct scenes_sum force = none, way = none, energy = none;
    begin(name, rate_Hz);
    for (uint32_t i = 0; i < (uint32_t)(seconds * rate_Hz); i++) {
        const int32_t cnt = cnt_at(i, rate_Hz);
        tick(cnt);
        compare(&force, &way, &energy, cnt);
    }
    EXH_ASSERT(exh_safety_is_running(scene->safety));
    scenes_print(name, rate_Hz, "force", "N", &force);
    if (scene->values != NULL) { scenes_print(name, rate_Hz, "string", "m", &way); }
    if (scene == &exh_scene_guarded) { scenes_print(name, rate_Hz, "energy", "J", &energy); }
}

/* --- ops --- */

static int32_t op_cnt[BENCH_OPS];

void scenes_wall_setup(const char *name)
{
    begin(name, 2000);
    for (uint32_t i = 0; i < BENCH_OPS; i++) { op_cnt[i] = cnt_at(200 + i % 512, 2000); }
}

static void fixed_op(uint32_t i)
{
    feed(op_cnt[i]);
    scene->tick(&in, &out);
    bench_sink = out.dac_raw[0];
}

static void double_op(uint32_t i)
{
    bench_sink = pipe_wall_double(&in_double, op_cnt[i], (double)lim_m) > 1;
}

static void float_op(uint32_t i)
{
    bench_sink = pipe_wall_float(&in_float, op_cnt[i], (float)lim_m) > 1;
}

void (*const scenes_wall_op[WAYS])(uint32_t i) = {fixed_op, double_op, float_op};
