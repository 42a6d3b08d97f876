/* SPDX-License-Identifier: MIT */
/* The path from position to D/A code, module by module. Where a module has a state,
 * one step is judged from the state it has: errors do not hide in a history. */
#include "force.h"
#include "law.h"
#include "path.h"

#include <math.h>

#define CASES   300000
#define FINGERS 5u
#define HOUR    7200000u /* ticks at 2 kHz */
#define SECOND  2000u

static struct exh_contact_in at[FINGERS][BENCH_OPS];
static double at_q[FINGERS][BENCH_OPS], at_v[FINGERS][BENCH_OPS];
static float at_qf[FINGERS][BENCH_OPS], at_vf[FINGERS][BENCH_OPS];
static struct exh_contact contact[FINGERS];
static struct exh_drive drive[FINGERS];
static struct exh_force_ledger ledger[FINGERS];
static struct exh_current_ledger current;
static struct exh_safety safety;
static int16_t mon[BENCH_OPS];
static const struct exh_permit open = {.mode = EXH_PERMIT_OPEN, .share_q30 = 1 << 30, .ticks = 1};

static struct law_double in_double;
static struct law_float in_float;
static struct force_drift drift;

static double si(int32_t raw, unsigned q) { return (double)raw / (double)(UINT64_C(1) << q); }

static void start(void)
{
    const struct exh_contact_par *p = &path_par.contact;
    path_setup();
    for (uint32_t f = 0; f < FINGERS; f++) {
        contact[f] = (struct exh_contact){.started = 0};
        drive[f] = (struct exh_drive){.force_N_q20 = 0};
        for (uint32_t i = 0; i < BENCH_OPS; i++) {
            at[f][i] = path_in(i + 205 * f);
            at_q[f][i] = si(at[f][i].pos_m_q30, EXH_Q_POS);
            at_v[f][i] = si(at[f][i].vel_mps_q27, EXH_Q_VEL);
            at_qf[f][i] = (float)at_q[f][i];
            at_vf[f][i] = (float)at_v[f][i];
        }
    }
    in_double = (struct law_double){si(p->k_Npm_q10, EXH_Q_K), si(p->b_Nspm_q20, EXH_Q_B),
        si(p->f0_N_q20, EXH_Q_FORCE), si(path_par.own.q_lim_m_q30, EXH_Q_POS),
        si(path_par.drive.f_max_N_q20, EXH_Q_FORCE)};
    in_float = (struct law_float){(float)in_double.k_Npm, (float)in_double.b_Nspm,
        (float)in_double.f0_N, (float)in_double.lim_m, (float)in_double.f_max_N};
    safety = (struct exh_safety){.state = EXH_STATE_RUN, .fingers = 1};
}

/* --- the law, five fingers an op --- */

static void law_op(uint32_t i)
{
    for (uint32_t f = 0; f < FINGERS; f++) {
        exh_contact_step(&contact[f], &path_par.contact, at[f][i], &ledger[f]);
    }
}

static void plain_law_op(uint32_t i)
{
    for (uint32_t f = 0; f < FINGERS; f++) {
        (void)exh_contact_law(&path_par.contact, at[f][i], &ledger[f]);
    }
}

static void plain_force_op(uint32_t i)
{
    for (uint32_t f = 0; f < FINGERS; f++) {
        bench_sink = exh_contact_force(&path_par.contact, at[f][i]);
    }
}

static void law_force_op(uint32_t i)
{
    for (uint32_t f = 0; f < FINGERS; f++) {
        exh_contact_step(&contact[f], &path_par.contact, at[f][i], &ledger[f]);
        bench_sink = exh_drive_force_step(&drive[f], &path_cfg.drive, &open, &ledger[f]);
    }
}

static volatile double sink_double;
static volatile float sink_float;

static void double_op(uint32_t i)
{
    for (uint32_t f = 0; f < FINGERS; f++) {
        sink_double = law_double(&in_double, at_q[f][i], at_v[f][i]);
    }
}

static void float_op(uint32_t i)
{
    for (uint32_t f = 0; f < FINGERS; f++) {
        sink_float = law_float(&in_float, at_qf[f][i], at_vf[f][i]);
    }
}

/* The exact law in LSB of force, from exact inputs; inward decides F0. */
static long double exact_law(const struct exh_contact_par *p, struct exh_contact_in in, int inward)
{
    const int64_t past = (int64_t)in.pos_m_q30 - in.lim_m_q30;
    long double f = inward ? p->f0_N_q20 : 0;
    if (past >= 0) {
        f += bench_q((long double)((int64_t)p->k_Npm_q10 * exh_clamp(past, INT32_MIN, INT32_MAX)),
            EXH_Q_K + EXH_Q_POS - EXH_Q_FORCE);
        f += bench_q((long double)((int64_t)p->b_Nspm_q20 * in.vel_mps_q27),
            EXH_Q_B + EXH_Q_VEL - EXH_Q_FORCE);
    }
    return f;
}

static long double law_off(
    struct exh_contact *s, const struct exh_contact_par *p, struct exh_contact_in in)
{
    struct exh_force_ledger l;
    exh_contact_step(s, p, in, &l);
    return (long double)(l.spring_N_q20 + l.damper_N_q20 + l.pullback_N_q20) -
           exact_law(p, in, s->inward);
}

/* An hour through the wall and back, each period at another height and with other
 * noise, so that no two are alike. */
static struct exh_contact_in hour_in(uint32_t tick)
{
    struct exh_contact_in in = path_in(tick);
    in.pos_m_q30 += (int32_t)(tick / 1024 * 2654435761u >> 12) + bench_in(-70000, 70000);
    in.vel_mps_q27 += bench_in(-70000, 70000);
    return in;
}

static void note(struct force_window *w, uint32_t tick, long double lsb)
{
    const double abs = (double)(lsb < 0 ? -lsb : lsb);
    if (tick < SECOND && abs > w->first_second_lsb) { w->first_second_lsb = abs; }
    if (tick >= HOUR - SECOND && abs > w->last_second_lsb) { w->last_second_lsb = abs; }
}

static void law_error(struct error *e)
{
    start();
    for (uint32_t i = 0; i < HOUR; i++) {
        const long double off = law_off(&contact[0], &path_par.contact, hour_in(i));
        error_add(e, off);
        note(&drift.law, i, off);
    }
    for (int i = 0; i < CASES; i++) {
        /* One by one: a list's initialisers may be evaluated in any order. */
        const int32_t k = bench_in(0, INT32_MAX), b = bench_in(0, INT32_MAX);
        const int32_t f0 = bench_in(0, 20 << EXH_Q_FORCE);
        const int32_t pos = bench_i32(), vel = bench_i32(), lim = bench_i32();
        const struct exh_contact_par p = {k, b, f0, 0, 0};
        struct exh_contact fresh = {.started = 0};
        error_add(e, law_off(&fresh, &p, (struct exh_contact_in){pos, vel, lim}));
    }
}

/* The same hour for the plain laws, which switch F0 by the sign of the velocity. */
static long double exact_plain(struct exh_contact_in in)
{
    const long double f = exact_law(&path_par.contact, in, in.vel_mps_q27 < 0);
    return bench_clamp(f, 0, path_par.drive.f_max_N_q20);
}

static void plain_law_error(struct error *e)
{
    start();
    for (uint32_t i = 0; i < HOUR; i++) {
        const struct exh_contact_in in = hour_in(i);
        struct exh_force_ledger l;
        (void)exh_contact_law(&path_par.contact, in, &l);
        error_add(e, (long double)(l.spring_N_q20 + l.damper_N_q20 + l.pullback_N_q20) -
                         exact_law(&path_par.contact, in, in.vel_mps_q27 < 0));
    }
}

static void plain_force_error(struct error *e)
{
    start();
    for (uint32_t i = 0; i < HOUR; i++) {
        const struct exh_contact_in in = hour_in(i);
        const long double f = exact_law(&path_par.contact, in, in.vel_mps_q27 < 0);
        error_add(
            e, exh_contact_force(&path_par.contact, in) - bench_clamp(f, 0, EXH_FORCE_MAX_N_Q20));
    }
}

static void double_error(struct error *e)
{
    start();
    for (uint32_t i = 0; i < HOUR; i++) {
        const struct exh_contact_in in = hour_in(i);
        const double f =
            law_double(&in_double, si(in.pos_m_q30, EXH_Q_POS), si(in.vel_mps_q27, EXH_Q_VEL));
        error_add(e, (long double)f * (1 << EXH_Q_FORCE) - exact_plain(in));
    }
}

static void float_error(struct error *e)
{
    start();
    for (uint32_t i = 0; i < HOUR; i++) {
        const struct exh_contact_in in = hour_in(i);
        const float f = law_float(
            &in_float, (float)si(in.pos_m_q30, EXH_Q_POS), (float)si(in.vel_mps_q27, EXH_Q_VEL));
        const long double off = (long double)f * (1 << EXH_Q_FORCE) - exact_plain(in);
        error_add(e, off);
        note(&drift.law_float, i, off);
    }
}

/* The force limit, or the end of the table. */
static int32_t most_q20(void)
{
    const int32_t f_max = path_par.drive.f_max_N_q20;
    return f_max < path_cfg.drive.f_top_N_q20 ? f_max : path_cfg.drive.f_top_N_q20;
}

/* Law, limits, slew: 100 N a tick, so that it never acts. */
static void law_force_error(struct error *e)
{
    start();
    for (uint32_t i = 0; i < HOUR; i++) {
        const struct exh_contact_in in = hour_in(i);
        struct exh_force_ledger l;
        exh_contact_step(&contact[0], &path_par.contact, in, &l);
        exh_drive_force_step(&drive[0], &path_cfg.drive, &open, &l);
        error_add(
            e, l.force_N_q20 -
                   bench_clamp(exact_law(&path_par.contact, in, contact[0].inward), 0, most_q20()));
    }
}

struct force_drift force_drift(void) { return drift; }

/* --- limits --- */

static void force_setup(void)
{
    start();
    for (uint32_t i = 0; i < BENCH_OPS; i++) { mon[i] = (int16_t)bench_in(INT16_MIN, INT16_MAX); }
    law_op(0);
    for (uint32_t f = 0; f < FINGERS; f++) { ledger[f].spring_N_q20 = 20 << EXH_Q_FORCE; }
    exh_drive_force_step(&drive[0], &path_cfg.drive, &open, &ledger[0]);
    exh_drive_current_step(&drive[0], &path_cfg.drive, &ledger[0], &current);
}

static void force_op(uint32_t i)
{
    ledger[0].spring_N_q20 = at[0][i].pos_m_q30;
    bench_sink = exh_drive_force_step(&drive[0], &path_cfg.drive, &open, &ledger[0]);
}

/* asked limited to 0..most, then to the last force +- slew * T. */
static void force_error(struct error *e)
{
    const struct exh_drive_par *p = &path_par.drive;
    start();
    for (int i = 0; i < CASES; i++) {
        const long double last = drive[0].force_N_q20;
        const int64_t spring = bench_i32(), damper = bench_i32(), pull = bench_in(0, 1 << 22);
        struct exh_force_ledger l = {spring, damper, pull, 0, 0, 0, 0, 0};
        const long double asked = (long double)(spring + damper + pull);
        const long double up = (long double)p->slew_up_Nps * (1 << EXH_Q_FORCE) / 2000;
        const long double down = (long double)p->slew_down_Nps * (1 << EXH_Q_FORCE) / 2000;
        long double want = bench_clamp(asked, 0, most_q20());
        exh_drive_force_step(&drive[0], &path_cfg.drive, &open, &l);
        want = bench_clamp(want, last - down, last + up);
        error_add(e, l.force_N_q20 - want);
        path_par.drive.slew_up_Nps = bench_in(1, 100000);
        path_par.drive.slew_down_Nps = bench_in(1, 100000);
    }
}

static void current_op(uint32_t i)
{
    ledger[0].force_N_q20 = at[0][i].pos_m_q30 >> 2;
    bench_sink = exh_drive_current_step(&drive[0], &path_cfg.drive, &ledger[0], &current);
}

/* N q20 at the peak current, which the straight table of the scene ends at. */
static long double peak_N_q20(void)
{
    return path_cfg.calib.force_to_cur[1].y == 0 ? 1 : path_cfg.calib.force_to_cur[1].x;
}

/* The current of the whole D/A codes within a limit. */
static long double whole_codes(long double limit_A_q26)
{
    const long double code = (long double)(INT64_C(1) << (EXH_Q_CUR + EXH_Q_DAC)) /
                             (long double)path_par.drive.dac_rawpA_q16;
    return floorl(limit_A_q26 / code) * code;
}

/* 3 s hot and 3 s cool in turn, so that the whole I2t budget is used and regained. The fold-back
 * may be off by 2.5 LSB, which decides whether a code is still within it. */
static void current_error(struct error *e)
{
    const struct exh_drive_par *p = &path_par.drive;
    start();
    for (int i = 0; i < CASES; i++) {
        const int hot = i / 6000 % 2 == 0;
        const long double left = (long double)(path_cfg.drive.i2t_budget_q32 - drive[0].i2t_q32);
        const long double extra = (long double)(p->i_peak_A_q26 - p->i_cont_A_q26) * 4 * left /
                                  (long double)path_cfg.drive.i2t_budget_q32;
        struct exh_force_ledger l = {.force_N_q20 = bench_in(0, (hot ? 40 : 8) << EXH_Q_FORCE)};
        struct exh_current_ledger c;
        const long double want = p->i_peak_A_q26 * bench_clamp(l.force_N_q20 / peak_N_q20(), 0, 1);
        long double limit, now, less, more;
        exh_drive_current_step(&drive[0], &path_cfg.drive, &l, &c);
        limit = p->i_cont_A_q26 + bench_clamp(extra, 0, p->i_peak_A_q26 - p->i_cont_A_q26);
        now = (long double)(c.table_A_q26 + c.peak_A_q26 + c.i2t_A_q26);
        less = now - bench_clamp(want, 0, whole_codes(limit - 2.5L));
        more = now - bench_clamp(want, 0, whole_codes(limit + 2.5L));
        error_add(e, fabsl(less) < fabsl(more) ? less : more);
    }
}

static void monitor_op(uint32_t i)
{
    bench_sink =
        exh_drive_monitor_N_q20(&path_cfg.drive, exh_drive_monitor_A_q26(&path_cfg.drive, mon[i]));
}

static void monitor_error(struct error *e)
{
    const struct exh_drive_par *p = &path_par.drive;
    start();
    for (int32_t raw = INT16_MIN; raw <= INT16_MAX; raw++) {
        const long double cur_A_q26 =
            bench_q((long double)((int64_t)raw * p->mon_A_q40), EXH_Q_MON - EXH_Q_CUR);
        const long double want = peak_N_q20() * bench_clamp(cur_A_q26 / p->i_peak_A_q26, -1, 1);
        error_add(e, exh_drive_monitor_N_q20(
                         &path_cfg.drive, exh_drive_monitor_A_q26(&path_cfg.drive, (int16_t)raw)) -
                         want);
    }
}

/* --- safety and gate --- */

static void gate_op(uint32_t i)
{
    struct exh_drive_out out;
    uint32_t limits = 0;
    current.table_A_q26 = at[0][i].pos_m_q30;
    exh_gate_step(&safety, &path_cfg.drive, 1, &current, &limits, &out);
    bench_sink = out.dac_raw[0];
}

static void gate_error(struct error *e)
{
    const struct exh_drive_par *p = &path_par.drive;
    int64_t most;
    start();
    most = (int64_t)p->i_peak_A_q26 * p->dac_rawpA_q16 >> (EXH_Q_CUR + EXH_Q_DAC);
    if (most > p->dac_span_raw) { most = p->dac_span_raw; }
    for (int i = 0; i < CASES; i++) {
        struct exh_current_ledger c = {.table_A_q26 = i & 1 ? bench_i32() : bench_in(0, 1 << 29)};
        struct exh_drive_out out;
        uint32_t limits = 0;
        const long double want =
            bench_q((long double)(c.table_A_q26 * p->dac_rawpA_q16), EXH_Q_CUR + EXH_Q_DAC);
        exh_gate_step(&safety, &path_cfg.drive, 1, &c, &limits, &out);
        error_add(e, (long double)out.dac_raw[0] - p->dac_zero_raw -
                         bench_clamp(want, (long double)-most, (long double)most));
    }
}

static void safety_op(uint32_t i)
{
    const struct exh_safety_in box = {PATH_HEALTHY, 0, i & 1, EXH_CMD_NONE, 1, EXH_ARM_ALL};
    bench_sink = exh_safety_step(&safety, &path_cfg.safety, box).mode;
}

/* Healthy: stays in RUN. Any cause: in that tick FAULT or RELEASE, with the cause. */
static void safety_error(struct error *e)
{
    start();
    for (int i = 0; i < CASES; i++) {
        const uint32_t din = bench_in(0, 3) ? PATH_HEALTHY : (uint32_t)bench_in(0, 0x1FF);
        const struct exh_safety_in box = {
            din, 0, (uint32_t)bench_in(0, 2), EXH_CMD_NONE, 1, EXH_ARM_ALL};
        const uint32_t want = (din & EXH_DIN_ESTOP ? 0u : EXH_FAULT_ESTOP) |
                              (din & EXH_DIN_DEADMAN ? 0u : EXH_FAULT_DEADMAN) |
                              (din & EXH_DIN_WATCHDOG ? 0u : EXH_FAULT_WATCHDOG) |
                              (din & EXH_DIN_CARDS ? 0u : EXH_FAULT_CARD) |
                              (din & EXH_DIN_DRIVE0 ? 0u : EXH_FAULT_DRIVE) |
                              (box.missed > 1 ? EXH_FAULT_OVERRUN : 0u);
        const uint8_t state = want == 0              ? EXH_STATE_RUN
                              : want & EXH_FAULT_CUT ? EXH_STATE_FAULT
                                                     : EXH_STATE_RELEASE;
        struct exh_safety s = {.state = EXH_STATE_RUN};
        (void)exh_safety_step(&s, &path_cfg.safety, box);
        error_add(e, s.faults != want || s.state != state);
    }
}

#define NEWTON  (1.0 / (1 << EXH_Q_FORCE))
#define AMPERE  (1.0 / (1 << EXH_Q_CUR))
#define HARNESS ", 5 fingers, private harness, gcc 12.2 -O2"

static const struct kernel kernels[] = {
    {"contact_law_x5", "N", NEWTON, 1, 1, start, law_op, law_error,
        "contact.h; 1 h of 2 kHz ticks, then random gains at full scale", 104,
        "integer Q31 law with contact test, F0, clamp" HARNESS},
    {"contact_law_plain_x5", "N", NEWTON, 1, 1, start, plain_law_op, plain_law_error,
        "contact.h, exh_contact_law(): no hysteresis, F0 by the velocity's sign; the same hour", 0,
        NULL},
    {"contact_force_x5", "N", NEWTON, 0.51, 1, start, plain_force_op, plain_force_error,
        "contact.h, exh_contact_force(): the same without the ledger, limited", 0, NULL},
    {"law_and_force_x5", "N", NEWTON, 1, 1, start, law_force_op, law_force_error,
        "contact.h, limits exact; 1 h of 2 kHz ticks", 123,
        "CMSIS-DSP arm_pid_q31, Ki = 0: no contact test, F0 or clamp" HARNESS},
    {"plain_double_law_x5", "N", NEWTON, 1, 1, start, double_op, double_error,
        "for the ratio: contact test, F0, clamp; the same hour; exact, as inputs have few bits", 97,
        "double law" HARNESS},
    {"plain_float_law_x5", "N", NEWTON, 64, 1, start, float_op, float_error,
        "for the ratio: contact test, F0, clamp; the same hour", 96, "float law" HARNESS},
    {"drive_force", "N", NEWTON, 1, 1, force_setup, force_op, force_error,
        "one step; random slew limits, full-scale force", 0, NULL},
    {"drive_current", "A", AMPERE, 2.5, 1, force_setup, current_op, current_error,
        "table 1 LSB, fold-back 2.5, in whole codes; the I2t budget used up and regained 25 times",
        0, NULL},
    {"drive_monitor_N", "N", NEWTON, 1.04, 1, force_setup, monitor_op, monitor_error,
        "table 1 LSB + half an LSB of current; every code", 0, NULL},
    {"gate_1", "code", 1, 0.5, 1, force_setup, gate_op, gate_error,
        "one rounding; full-scale currents", 0, NULL},
    {"safety_step", "wrong", 1, 0, 1, force_setup, safety_op, safety_error,
        "state and cause; every input", 0, NULL},
};
const struct kernel_group force_group = {kernels, sizeof kernels / sizeof kernels[0]};
