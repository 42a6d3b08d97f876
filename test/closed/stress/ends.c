/* SPDX-License-Identifier: MIT */
/* All inputs jump from one end of their range to the other in one tick, then all parameters do; in
 * every scene that takes defaults. No code may push or be beyond its span. A drive that is not
 * enabled may have no code. The count of ticks must rise. The signs of saturated values are tested,
 * too. */
#include "stress.h"

#include <math.h>

#define ID_DAC_ZERO 0x0507
#define ID_DAC_SPAN 0x0508
#define ID_MON_ZERO 0x050A
#define ROUND       2400 /* ticks: calm until the gate is open, then the ends */

extern const struct exh_scene exh_scene_guarded, exh_scene_custom, exh_scene_glove,
    exh_scene_bilateral, exh_scene_bringup;

/* --- scenes --- */

static int32_t value_of(const struct exh_scene *sc, uint16_t id, unsigned finger, int32_t without)
{
    int32_t i = -1;
    if (sc->params != NULL) {
        i = exh_signal_find(sc->params->table, id, (uint16_t)finger);
        if (i < 0) { i = exh_signal_find(sc->params->table, id, 0); }
    }
    return i < 0 ? without : sc->params->active[i];
}

enum to { LOWEST, HIGHEST, DEFAULT };

/* All that may change now, at one end or at their defaults. */
static void stage_ends(const struct exh_scene *sc, enum to to)
{
    struct exh_params *p = sc->params;
    const uint32_t n = p == NULL ? 0 : exh_signal_count(p->table);
    for (uint32_t i = 0; i < n; i++) {
        const struct exh_signal *row = exh_signal_at(p->table, i, NULL);
        if (exh_signal_is_fixed(row)) { continue; }
        (void)exh_params_stage_at(p, i,
            to == LOWEST    ? row->min
            : to == HIGHEST ? row->max
                            : row->dflt);
    }
}

/* Before set-up: that it may run without what a device brings. */
static void stage_bare(const struct exh_scene *sc)
{
    struct exh_params *p = sc->params;
    const uint32_t n = p == NULL ? 0 : exh_signal_count(p->table);
    for (uint32_t i = 0; i < n; i++) {
        const struct exh_signal *row = exh_signal_at(p->table, i, NULL);
        if (strstr(row->name, "uncalibrated") != NULL) {
            must(exh_params_stage_at(p, i, 1) == 0, "setting", "%s", row->name);
        }
    }
    if (p != NULL) { exh_params_apply(p); }
}

static struct exh_scene_in calm(const struct exh_scene *sc, uint64_t n)
{
    struct exh_scene_in in;
    memset(&in, 0, sizeof in);
    for (unsigned f = 0; f < EXH_FINGERS; f++) {
        in.drive.mon_raw[f] = (int16_t)value_of(sc, ID_MON_ZERO, f, 0);
    }
    in.drive.din = UINT32_MAX;
    in.glove_new = 1;
    if (sc->safety != NULL &&
        sc->safety->state == EXH_STATE_FAULT) { /* a hand opened before CLEAR */
        if (n % 8 < 4) { in.drive.din &= ~(uint32_t)EXH_DIN_DEADMAN; }
        in.command = n % 8 == 6 ? EXH_CMD_CLEAR : EXH_CMD_NONE;
    } else {
        in.command = n % 8 == 0 ? EXH_CMD_RUN : EXH_CMD_NONE;
    }
    return in;
}

/* Everything at one end; the encoders so far that they do not jump, unless all may. */
static struct exh_scene_in ends(uint64_t n, int all)
{
    struct exh_scene_in in;
    const int high = n % 2 != 0;
    memset(&in, 0, sizeof in);
    for (unsigned f = 0; f < EXH_FINGERS; f++) {
        in.drive.enc_raw[f] = all ? (high ? 0x7FFFFF : 0x800000) : (high ? 25 : 0xFFFFE7);
        in.drive.mon_raw[f] = high ? INT16_MAX : INT16_MIN;
    }
    in.drive.supply_raw = high ? INT16_MIN : INT16_MAX;
    in.drive.din = all && high ? 0 : UINT32_MAX;
    in.missed = all && high ? UINT32_MAX : 0;
    in.command = all ? (uint8_t)(high ? 255 : EXH_CMD_RUN) : (uint8_t)EXH_CMD_NONE;
    in.glove_new = 1;
    for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
        in.glove.raw[i] = high ? INT16_MAX : INT16_MIN;
    }
    in.glove.age_ticks = high ? UINT16_MAX : 0;
    return in;
}

static void check_outputs(
    const struct exh_scene *sc, const struct exh_drive_out *out, uint8_t alive)
{
    must((uint8_t)(out->alive - alive) == 1, "alive", "%u after %u", (unsigned)out->alive,
        (unsigned)alive);
    for (unsigned f = 0; f < EXH_FINGERS; f++) {
        const int32_t zero = value_of(sc, ID_DAC_ZERO, f, 32768),
                      span = value_of(sc, ID_DAC_SPAN, f, 32767);
        const int32_t code = out->dac_raw[f] - zero, enabled = out->enable >> f & 1;
        must(code >= 0 && code <= span, "code", "finger %u: %ld of %ld", f, (long)code, (long)span);
        must(enabled ? f < sc->fingers : code == 0, "gate", "finger %u: code %ld, enable %#x", f,
            (long)code, (unsigned)out->enable);
        if (code > rig.w.code_max) { rig.w.code_max = code; }
    }
}

static void set_up(const struct exh_scene *sc)
{
    if (sc->params != NULL) { sc->params->locked = 0; }
    if (sc->defaults != NULL) { sc->defaults(); }
    stage_bare(sc);
    must(sc->setup((struct exh_scene_board){{1, 2000}, 24}) == 0, "set-up", "refused");
    if (sc->params != NULL) { sc->params->locked = 1; }
}

/* Rounds: calm until the gate opens, 20 ticks more, then the ends for 40, and again; every fourth
 * round everything from the start. */
static void scene_at_its_ends(const struct exh_scene *sc, uint64_t ticks, int opens)
{
    struct exh_drive_out out;
    uint64_t open = 0, at_ends = 0;
    uint8_t alive = 0;
    unsigned since = 0;
    char name[48], besides[64];
    fresh();
    memset(&out, 0, sizeof out);
    for (uint64_t n = 0; n < ticks && rig.w.broken == 0; n++) {
        struct exh_scene_in in;
        const int all = n / ROUND % 4 == 3, hit = all || (since > 20 && since < 60);
        /* An encoder that jumped is not trusted until set-up. */
        if (n % (4 * ROUND) == 0) { set_up(sc); }
        in = hit ? ends(n, all) : calm(sc, n);
        stage_ends(sc, !hit ? DEFAULT : n % 2 ? HIGHEST : LOWEST);
        if (sc->params != NULL) { exh_params_apply(sc->params); }
        sc->tick(&in, &out);
        if (n % (4 * ROUND) > 0) { check_outputs(sc, &out, alive); }
        alive = out.alive;
        since = out.enable ? since % 100 + 1 : 0;
        open += out.enable != 0;
        at_ends += out.enable != 0 && hit;
        rig.w.ticks++;
    }
    must(!opens || (at_ends > ticks / 100 && open > ticks / 20), "power",
        "open in %" PRIu64 ", at the ends in %" PRIu64, open, at_ends);
    rig.w.q_min = rig.w.q_max = 0;
    snprintf(name, sizeof name, "all at their ends: %s", sc->name);
    snprintf(besides, sizeof besides,
        "never pushed; open in %" PRIu64 " ticks, %" PRIu64 " at ends", open, at_ends);
    report(name, besides);
}

/* --- signs --- */

static int sign(double v) { return (v > 0) - (v < 0); }

/* Ends, near them, around 0, or anywhere. */
static int32_t any_end(void)
{
    static const int32_t end[] = {
        INT32_MIN, INT32_MIN + 1, INT32_MAX, INT32_MAX - 1, 0, 1, -1, INT32_C(1) << 30};
    const uint64_t u = any_u64();
    return u % 3 == 0 ? end[u / 3 % LEN(end)] : (int32_t)(uint32_t)(u >> 32) >> (u / 3 % 31);
}

/* 0 or of the sign of the exact value. Never 0 if that is one LSB or more. */
static void same_sign(const char *what, int64_t got, double want)
{
    must(got == 0 ? fabs(want) < 1 : sign((double)got) == sign(want), "sign",
        "%s: %" PRId64 ", exact %.3g", what, got, want);
}

static void signs_of_laws(void)
{
    struct exh_contact s = {0, 0, 0, 0};
    const struct exh_contact_par par = {any_end() & INT32_MAX, any_end() & INT32_MAX,
        any_end() & INT32_MAX, any_end() & INT32_MAX, any_end() & INT32_MAX};
    const struct exh_contact_in in = {any_end(), any_end(), any_end()};
    const struct exh_quad_par quad = {any_end() & INT32_MAX, 0};
    const int32_t cnt = any_end();
    struct exh_force_ledger f;
    const int touching = exh_contact_step(&s, &par, in, &f);
    const double past = (double)in.pos_m_q30 - in.lim_m_q30;
    same_sign("spring", f.spring_N_q20,
        touching ? par.k_Npm_q10 * fmin(fmax(past, -2147483648.0), 2147483647.0) / 1048576 : 0);
    same_sign("damper", f.damper_N_q20,
        touching ? (double)par.b_Nspm_q20 * in.vel_mps_q27 / 134217728 : 0);
    same_sign("position", exh_quad_pos_m_q30(&quad, cnt), (double)cnt * quad.step_m_q42 / 4096);
}

/* A jump of the count, by every estimator from rest. */
static void signs_of_speeds(void)
{
    const struct exh_velocity_scale scale = {EXH_Q(480, 1000000, EXH_Q_STEP), {1, 1 + any(20000)}};
    const struct exh_velocity_par p = {(int32_t)any(5)};
    struct exh_velocity_window window;
    struct exh_velocity_pole pole;
    struct exh_velocity_track track;
    struct exh_velocity_foaw foaw;
    struct exh_velocity_window_cfg wc;
    struct exh_velocity_pole_cfg pc;
    struct exh_velocity_track_cfg tc;
    struct exh_velocity_foaw_cfg fc;
    const uint32_t tau_us = any(10000);
    const int32_t from = any_end(), to = any_end();
    const double jump = (double)exh_wrap_diff(to, from);
    if (exh_velocity_window_setup(&wc, scale, &p) != 0 ||
        exh_velocity_pole_setup(&pc, scale, tau_us) != 0 ||
        exh_velocity_track_setup(&tc, scale, tau_us) != 0 ||
        exh_velocity_foaw_setup(&fc, scale, 8, 1) != 0) {
        return;
    }
    if (exh_wrap_diff(to, from) == INT32_MIN) {
        return;
    } /* half a turn of the counter has no sign */
    memset(&window, 0, sizeof window);
    memset(&pole, 0, sizeof pole);
    memset(&track, 0, sizeof track);
    memset(&foaw, 0, sizeof foaw);
    exh_velocity_window_step(&window, &wc, from);
    exh_velocity_pole_step(&pole, &pc, from);
    exh_velocity_track_step(&track, &tc, from);
    exh_velocity_foaw_step(&foaw, &fc, from);
    same_sign("window", exh_velocity_window_step(&window, &wc, to), jump);
    same_sign("pole", exh_velocity_pole_step(&pole, &pc, to), jump);
    same_sign("observer", exh_velocity_track_step(&track, &tc, to), jump);
    same_sign("adaptive window", exh_velocity_foaw_step(&foaw, &fc, to), jump);
}

static void signs_of_drive(void)
{
    const struct exh_drive_par *p = &rig.active.drive;
    const int16_t mon = (int16_t)any_end();
    struct exh_permit permit = {
        EXH_PERMIT_OPEN, (int32_t)any((UINT32_C(1) << 30) + 1), 0, 1, {0, 0}};
    struct exh_force_ledger f;
    struct exh_current_ledger i;
    memset(&f, 0, sizeof f);
    f.spring_N_q20 = (int64_t)any_end() * 2097152;
    f.damper_N_q20 = (int64_t)any_end() * 2097152;
    f.pullback_N_q20 = any_end() & INT32_MAX;
    exh_drive_force_step(&rig.state.drive, &rig.cfg.drive, &permit, &f);
    exh_drive_current_step(&rig.state.drive, &rig.cfg.drive, &f, &i);
    must(f.force_N_q20 >= 0 && f.force_N_q20 <= rig.cfg.drive.f_top_N_q20, "sign", "force %ld",
        (long)f.force_N_q20);
    must(i.table_A_q26 >= 0 && i.table_A_q26 + i.peak_A_q26 + i.i2t_A_q26 >= 0, "sign",
        "current %" PRId64, i.table_A_q26);
    same_sign("monitor", exh_drive_monitor_A_q26(&rig.cfg.drive, mon),
        ((double)mon - p->mon_zero_raw) * p->mon_A_q40 / 16384);
}

/* One low-pass rail to rail: where the ideal one is clear of 0 by 64 LSB, and within the word or
 * beyond it, so is ours. */
static void signs_of_filter(uint64_t samples)
{
    const double ratio = 0.001 * pow(440, any(1000) / 1000.0),
                 g = tan(3.14159265358979323846 * ratio), k = 1.4142135623730951;
    const struct exh_filter_par par = {2, (int32_t)(ratio * 20000 * 65536)};
    const double a1 = 1 / (1 + g * (g + k)), a2 = g * a1, a3 = g * a2;
    struct exh_filter_cfg cfg;
    struct exh_filter s;
    int32_t x = 0, y;
    double s1 = 0, s2 = 0;
    must(exh_filter_setup(&cfg, &par, (struct exh_period){1, 20000}) == 0, "set-up", "%g", ratio);
    memset(&s, 0, sizeof s);
    exh_filter_reset(&s, &x, 1);
    for (uint64_t n = 0; n < samples; n++) {
        double v1, v2, v3;
        if (any(1 + (uint32_t)(1 / ratio)) == 0) { x = any(2) ? INT32_MAX : INT32_MIN; }
        v3 = x - s2;
        v1 = a1 * s1 + a2 * v3;
        v2 = s2 + a2 * s1 + a3 * v3;
        s1 = 2 * v1 - s1;
        s2 = 2 * v2 - s2;
        exh_filter_step(&s, &cfg, &x, &y, 1);
        must(fabs(v2) < 64 || sign(y) == sign(v2), "sign", "low-pass at %g: %ld, ideal %.0f", ratio,
            (long)y, v2);
    }
}

static void signs(void)
{
    const uint64_t n = cases / 10;
    fresh();
    start((struct exh_period){1, 2000});
    for (uint64_t i = 0; i < n; i++) {
        signs_of_laws();
        signs_of_speeds();
        signs_of_drive();
        if (i % 20 == 0) { signs_of_filter(2000); }
        rig.w.ticks++;
    }
    rig.w.q_min = rig.w.q_max = 0;
    report("saturated at random and at ends",
        "position, speeds, law, force, current, low-pass keep their signs");
}

void all_at_their_ends(void)
{
    static const struct exh_scene *const scene[] = {&exh_scene_drop, &exh_scene_guarded,
        &exh_scene_custom, &exh_scene_glove, &exh_scene_bilateral, &exh_scene_bringup};
    for (size_t i = 0; i < LEN(scene); i++) {
        scene_at_its_ends(scene[i], cases < 200000 ? 20000 : cases / 10,
            scene[i] != &exh_scene_glove && scene[i] != &exh_scene_bringup);
    }
    signs();
}
