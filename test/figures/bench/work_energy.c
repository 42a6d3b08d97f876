/* SPDX-License-Identifier: MIT */
/* The energy that one contact of an hour has taken up: what a passivity controller judges by. */
#include "plain.h"
#include "path.h"
#include "work.h"

#include "exhand/passivity.h"

static struct exh_passivity_par par = {1};
static struct exh_passivity_cfg cfg;
static struct exh_passivity state;
static struct exh_force_ledger ledger;
static struct exh_knot held[2];
static struct plain_energy_double in_double;
static struct plain_energy_float in_float;
int32_t energy_cnt[BENCH_OPS];
static int64_t exact_Ncnt_q20; /* of a force held that is q20 */
static int32_t last_cnt, held_q20;

void energy_seed(void)
{
    struct exh_velocity_scale scale = {0, {1, 2000}};
    path_setup();
    scale.step_m_q42 = path_par.quad.step_m_q42;
    state = (struct exh_passivity){0, 0, 0, 0, 0, 0};
    EXH_ASSERT(exh_table_invert(held, path_cfg.calib.force_to_cur, 2) == 0);
    EXH_ASSERT(exh_passivity_setup(&cfg, &par, &path_cfg.drive, (struct exh_table){held, 2}, scale,
                   EXH_Q(3, 1, EXH_Q_VEL)) == 0);
    wall_seed();
    for (uint32_t i = 0; i < BENCH_OPS; i++) { energy_cnt[i] = wall_cnt(); }
    wall_seed();
    in_double = (struct plain_energy_double){
        .step = energy_step_m(), .f_most = ENERGY_F_MOST_N, .way = ENERGY_WAY_M};
    in_float = (struct plain_energy_float){
        .step = (float)in_double.step, .f_most = ENERGY_F_MOST_N, .way = (float)in_double.way};
    exact_Ncnt_q20 = last_cnt = held_q20 = 0;
}

double energy_step_m(void) { return cfg.step_m_q42 * 0x1p-42; }

static long double joules(long double Ncnt) { return Ncnt * energy_step_m(); }

/* Exact: what was held, times the counts; and what is held next: the spring, and more on the way
 * in. */
long double energy_next(int32_t *cnt, int32_t *asked_q20)
{
    *cnt = wall_cnt();
    exact_Ncnt_q20 += (int64_t)held_q20 * (*cnt - last_cnt);
    *asked_q20 = *cnt * 150000 + (*cnt - last_cnt) * 70001;
    if (*asked_q20 < 1) { *asked_q20 = 1; }
    last_cnt = *cnt;
    return joules((long double)exact_Ncnt_q20 * 0x1p-20L);
}

void energy_hold(int32_t force_q20) { held_q20 = force_q20; }

/* --- ours --- */

static void ours_op(uint32_t i)
{
    ledger.spring_N_q20 = energy_cnt[i] * 150000;
    ledger.passivity_N_q20 = 0;
    bench_sink =
        exh_passivity_step(&state, &cfg, energy_cnt[i], 1, &ledger) + ledger.passivity_N_q20;
    ledger.force_N_q20 = 5 << EXH_Q_FORCE;
    exh_passivity_update(&state, &cfg, &ledger, 3 << (EXH_Q_CUR - 1));
}

static long double ours_off(uint32_t i)
{
    int32_t cnt, asked;
    const long double want = energy_next(&cnt, &asked);
    (void)i;
    ledger = (struct exh_force_ledger){.spring_N_q20 = asked};
    (void)exh_passivity_step(&state, &cfg, cnt, 1, &ledger);
    held_q20 = state.held_N_q20 = state.late_N_q20 = asked;
    return joules((long double)state.energy_Ncnt_q20 * 0x1p-20L) - want;
}

/* --- plain --- */

static volatile double sink_double;
static volatile float sink_float;

static void double_op(uint32_t i)
{
    sink_double = in_double.held =
        plain_energy_double(&in_double, energy_cnt[i], 1, energy_cnt[i] * 0.14);
}

static void float_op(uint32_t i)
{
    sink_float = in_float.held =
        plain_energy_float(&in_float, energy_cnt[i], 1, (float)energy_cnt[i] * 0.14f);
}

static long double double_off(uint32_t i)
{
    int32_t cnt, asked;
    const long double want = energy_next(&cnt, &asked);
    (void)i;
    (void)plain_energy_double(&in_double, cnt, 1, 0);
    in_double.held = asked * 0x1p-20;
    held_q20 = asked;
    return in_double.energy - want;
}

static long double float_off(uint32_t i)
{
    int32_t cnt, asked;
    const long double want = energy_next(&cnt, &asked);
    (void)i;
    (void)plain_energy_float(&in_float, cnt, 1, 0);
    held_q20 = (int32_t)(in_float.held = (float)asked); /* what it can hold */
    in_float.held *= 0x1p-20f;
    return in_float.energy - want;
}

static const struct work works[] = {
    {"passivity", "exhand passivity", "ours", "J", WORK_HOUR, energy_seed, ours_op, ours_off},
    {"passivity", "plain double observer", "float", "J", WORK_HOUR, energy_seed, double_op,
        double_off},
    {"passivity", "plain float observer", "float", "J", WORK_HOUR, energy_seed, float_op,
        float_off},
};
const struct work_group passivity_works = {works, sizeof works / sizeof works[0]};
