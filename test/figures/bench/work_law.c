/* SPDX-License-Identifier: MIT */
/* The contact law: an hour inside a wall. CMSIS's controllers have no contact test and no pull-back
 * force. */
#include "bare.h"
#include "law.h"
#include "work.h"

#include "exhand/contact.h"
#include "exhand/units.h"

static int32_t cnt, wander, tick;
static double last_m;
static int32_t op_pos[BENCH_OPS][WORK_FINGERS], op_vel[BENCH_OPS][WORK_FINGERS];
static double op_q[BENCH_OPS][WORK_FINGERS], op_v[BENCH_OPS][WORK_FINGERS];
static float op_qf[BENCH_OPS][WORK_FINGERS], op_vf[BENCH_OPS][WORK_FINGERS];

void wall_seed(void)
{
    bench_seed();
    cnt = wander = tick = 0;
    last_m = 0;
}

int32_t wall_cnt(void)
{
    const int32_t at = tick++ % 1530, slow = at < 765 ? at : 1530 - at;
    wander += bench_in(-1, 1);
    if (wander > 12 || wander < -12) { wander = 0; }
    cnt = 15 + slow * 90 / 765 + wander;
    return cnt < 2 ? 2 : cnt;
}

long double wall_N(long double pos_m, long double last)
{
    return (long double)WALL_K_NPM * pos_m +
           (long double)WALL_B_NSPM / (long double)WALL_T_S * (pos_m - last);
}

/* --- ours --- */

static const struct exh_contact_par par = {
    EXH_Q(7989, 4, EXH_Q_K), EXH_Q(395, 64, EXH_Q_B), 0, 0, 0};
static struct exh_contact contact[WORK_FINGERS];
static struct exh_force_ledger ledger;

static void setup(void)
{
    int32_t last = 0;
    wall_seed();
    for (uint32_t i = 0; i < BENCH_OPS; i++) {
        for (uint32_t f = 0; f < WORK_FINGERS; f++) {
            const int32_t n = wall_cnt();
            op_pos[i][f] = n * 71213;
            op_vel[i][f] = (n - last) * 71213 * 250;
            op_qf[i][f] = (float)(op_q[i][f] = n * WALL_STEP_M);
            op_vf[i][f] = (float)(op_v[i][f] = (n - last) * WALL_STEP_M / WALL_T_S);
            last = n;
        }
    }
    for (uint32_t f = 0; f < WORK_FINGERS; f++) { contact[f] = (struct exh_contact){.started = 0}; }
    wall_seed();
}

static void ours_op(uint32_t i)
{
    for (uint32_t f = 0; f < WORK_FINGERS; f++) {
        exh_contact_step(
            &contact[f], &par, (struct exh_contact_in){op_pos[i][f], op_vel[i][f], 0}, &ledger);
        bench_sink = ledger.spring_N_q20 + ledger.damper_N_q20;
    }
}

static long double ours_off(uint32_t i)
{
    const int32_t n = wall_cnt();
    const double pos = n * WALL_STEP_M;
    const long double want = wall_N(pos, last_m);
    const int32_t vel = (n - (int32_t)(last_m / WALL_STEP_M + 0.5)) * 71213 * 250;
    (void)i;
    exh_contact_step(&contact[0], &par, (struct exh_contact_in){n * 71213, vel, 0}, &ledger);
    last_m = pos;
    return bench_q((long double)(ledger.spring_N_q20 + ledger.damper_N_q20), EXH_Q_FORCE) - want;
}

static void force_op(uint32_t i)
{
    for (uint32_t f = 0; f < WORK_FINGERS; f++) {
        bench_sink =
            exh_contact_force(&par, (struct exh_contact_in){op_pos[i][f], op_vel[i][f], 0});
    }
}

/* --- bare --- */

static struct bare_law bare; /* no constant that the compiler could see through */

static void bare_setup(void)
{
    bare = (struct bare_law){par.k_Npm_q10, par.b_Nspm_q20, 0, 0, 100 << EXH_Q_FORCE};
    setup();
}

static void bare_op(uint32_t i)
{
    for (uint32_t f = 0; f < WORK_FINGERS; f++) {
        bench_sink = bare_law(&bare, op_pos[i][f], op_vel[i][f]);
    }
}

/* --- plain --- */

static const struct law_double in_double = {WALL_K_NPM, WALL_B_NSPM, 0, 0, 100};
static const struct law_float in_float = {(float)WALL_K_NPM, (float)WALL_B_NSPM, 0, 0, 100};
static volatile double sink_double;
static volatile float sink_float;

static void double_op(uint32_t i)
{
    for (uint32_t f = 0; f < WORK_FINGERS; f++) {
        sink_double = law_double(&in_double, op_q[i][f], op_v[i][f]);
    }
}

static void float_op(uint32_t i)
{
    for (uint32_t f = 0; f < WORK_FINGERS; f++) {
        sink_float = law_float(&in_float, op_qf[i][f], op_vf[i][f]);
    }
}

static long double clamped(long double pos, long double last)
{
    return bench_clamp(wall_N(pos, last), 0, 100);
}

static long double double_off(uint32_t i)
{
    const double pos = wall_cnt() * WALL_STEP_M, last = last_m;
    (void)i;
    last_m = pos;
    return law_double(&in_double, pos, (pos - last) / WALL_T_S) - clamped(pos, last);
}

static long double float_off(uint32_t i)
{
    const double pos = wall_cnt() * WALL_STEP_M, last = last_m;
    (void)i;
    last_m = pos;
    return law_float(&in_float, (float)pos, (float)((pos - last) / WALL_T_S)) - clamped(pos, last);
}

/* The next count and what a law with limits ought to give there; returns the velocity. */
static int32_t counts(int32_t *n, long double *want)
{
    const int32_t last = (int32_t)(last_m / WALL_STEP_M + 0.5);
    *n = wall_cnt();
    *want = clamped(*n * WALL_STEP_M, last_m);
    last_m = *n * WALL_STEP_M;
    return (*n - last) * 71213 * 250;
}

static long double force_off(uint32_t i)
{
    int32_t n;
    long double want;
    const int32_t vel = counts(&n, &want);
    (void)i;
    return bench_q(
               exh_contact_force(&par, (struct exh_contact_in){n * 71213, vel, 0}), EXH_Q_FORCE) -
           want;
}

static long double bare_off(uint32_t i)
{
    int32_t n;
    long double want;
    const int32_t vel = counts(&n, &want);
    (void)i;
    return bench_q(bare_law(&bare, n * 71213, vel), EXH_Q_FORCE) - want;
}

static const struct work works[] = {
    {"law", "exhand force alone", "ours", "N", WORK_HOUR, setup, force_op, force_off},
    {"law", "exhand contact law", "ours", "N", WORK_HOUR, setup, ours_op, ours_off},
    {"law", "bare integer law", "integer", "N", WORK_HOUR, bare_setup, bare_op, bare_off},
    {"law", "plain double law", "float", "N", WORK_HOUR, setup, double_op, double_off},
    {"law", "plain float law", "float", "N", WORK_HOUR, setup, float_op, float_off},
};
const struct work_group law_works = {works, sizeof works / sizeof works[0]};
