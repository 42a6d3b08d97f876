/* SPDX-License-Identifier: MIT */
#include "bringup.h"

void bringup_start(struct bringup *s) { *s = (struct bringup){0}; }

/* --- doubt while current flows --- */

/* Compares the mean of the monitor over a window with that of the command. 1: doubt. Ends the
 * window. */
static int window_off(struct bringup *s, const struct bringup_cfg *cfg)
{
    const struct bringup_own_par *own = &cfg->par->own;
    const int64_t off_A_q26 = s->off_A_q26 < 0 ? -s->off_A_q26 : s->off_A_q26;
    const int64_t may_A_q26 =
        100 * (int64_t)own->mon_A_q26 * s->window + own->mon_percent * s->sum_A_q26;
    s->window = 0;
    s->off_A_q26 = s->sum_A_q26 = 0;
    return 100 * off_A_q26 > may_A_q26;
}

static int monitor_off(struct bringup *s, const struct bringup_cfg *cfg, int32_t mon_A_q26)
{
    s->off_A_q26 += mon_A_q26 - (int64_t)s->coded_A_q26;
    s->sum_A_q26 += s->coded_A_q26;
    return ++s->window >= cfg->doubt_ticks && window_off(s, cfg);
}

static uint8_t doubt(
    struct bringup *s, const struct bringup_cfg *cfg, unsigned far, struct bringup_view v)
{
    const int32_t v_max = cfg->par->own.v_max_mps_q27;
    const int64_t moved = exh_wrap_diff(v.cnt, s->start_cnt);
    const int32_t far_cnt =
        far == BRINGUP_FAR_MOVE ? cfg->polarity.move_cnt : cfg->polarity.travel_cnt;
    s->fast = v.v_mps_q27 > v_max || v.v_mps_q27 < -v_max ? s->fast + 1 : 0;
    if (s->fast >= 3) { return BRINGUP_SPEED; }
    if (far != BRINGUP_FAR_OWN && (moved > far_cnt || moved < -far_cnt)) {
        return EXH_PROBE_TRAVEL;
    }
    return monitor_off(s, cfg, v.mon_A_q26) ? BRINGUP_MONITOR : EXH_PROBE_BUSY;
}

/* --- phases --- */

static void begin_phase(struct bringup *s, int32_t cnt)
{
    static const struct exh_mean none;
    s->opened = s->closed = 0;
    s->busy = 1;
    s->tick = s->window = s->fast = 0;
    s->off_A_q26 = s->sum_A_q26 = 0;
    s->start_cnt = s->far_cnt = s->at_cnt = cnt;
    s->mon = s->coded = none;
    s->level = 0;
}

/* Starts the next phase, or ends. A phase after one that ran continues with the switch held. */
static void next_phase(struct bringup *s, const struct bringup_cfg *cfg)
{
    s->phase++;
    s->busy = s->let_go = 0;
    s->tick = 0;
    if (bringup_phase(cfg->list, s->phase) == NULL) { s->result = EXH_PROBE_DONE; }
}

/* A phase that asks for the switch waits until it is released and held again. A switch held before
 * the question is no answer. */
static void wait(struct bringup *s, const struct bringup_cfg *cfg, const struct bringup_phase *p,
    uint8_t command, int32_t cnt)
{
    const uint32_t cause = s->safety.present;
    const int run = exh_safety_is_running(&s->safety);
    if (cause & EXH_FAULT_DEADMAN) { s->let_go = 1; }
    if (p->hands || p->ask == BRINGUP_ASK_NOTHING || (run && s->let_go)) {
        begin_phase(s, cnt);
    } else if ((p->ask == BRINGUP_ASK_HOOK && cause & ~(uint32_t)EXH_FAULT_DEADMAN) ||
               (command == EXH_CMD_RUN && s->safety.state == EXH_STATE_OFF)) {
        s->result = BRINGUP_OFF; /* more than an open switch */
    } else if (++s->tick >= cfg->wait_ticks) {
        s->result = cause & ~(uint32_t)EXH_FAULT_DEADMAN ? BRINGUP_OFF : BRINGUP_NOBODY;
    }
}

/* The command to the device. Where the switch answers a question: the person's command. Where no
 * current may flow: off, so releasing the switch, with which every question starts, is no fault. */
static uint8_t command_of(const struct bringup *s, const struct bringup_cfg *cfg, uint8_t given)
{
    const struct bringup_phase *p = bringup_phase(cfg->list, s->phase);
    if (s->result != EXH_PROBE_BUSY || p == NULL || p->hands) { return EXH_CMD_OFF; }
    return !s->busy && p->ask != BRINGUP_ASK_NOTHING && !s->let_go ? (uint8_t)EXH_CMD_OFF : given;
}

/* 1 if current flows or may flow now. */
static int needs_run(const struct bringup *s, const struct bringup_cfg *cfg)
{
    const struct bringup_phase *p = bringup_phase(cfg->list, s->phase);
    if (p == NULL || p->hands) { return 0; }
    return s->busy || p->ask == BRINGUP_ASK_NOTHING;
}

/* One tick of the present activity. Returns its force, N q20. */
static int32_t go_on(
    struct bringup *s, const struct bringup_cfg *cfg, uint8_t command, struct bringup_view v)
{
    const struct bringup_own_par *own = &cfg->par->own;
    const struct bringup_phase *p = bringup_phase(cfg->list, s->phase);
    const int run = exh_safety_is_running(&s->safety);
    int32_t f_N_q20 = 0;
    uint8_t r = EXH_PROBE_BUSY;
    if (s->result != EXH_PROBE_BUSY) { return 0; }
    s->told_phase = s->phase;
    if (own->stage > 1 && (uint32_t)own->shown != cfg->before) {
        s->result = BRINGUP_NOT_SHOWN;
        return 0;
    }
    if (!s->busy) {
        wait(s, cfg, p, command, v.cnt);
        return 0;
    }
    if (s->quad.lost || (needs_run(s, cfg) && !run)) { r = BRINGUP_OFF; }
    if (r == EXH_PROBE_BUSY && needs_run(s, cfg) && (own->stage > 1 || own->loop)) {
        r = doubt(s, cfg, p->far, v);
    }
    if (r == EXH_PROBE_BUSY) { r = bringup_step(s, cfg, p, v, &f_N_q20); }
    /* The rest of a window that a phase cut short, if it is long enough. */
    if (r == EXH_PROBE_DONE && s->window > cfg->doubt_ticks / 4 && window_off(s, cfg)) {
        r = BRINGUP_MONITOR;
    }
    s->tick++;
    s->tell_A_q26 = s->coded_A_q26;
    s->tell_mon_A_q26 = v.mon_A_q26;
    s->tell_mps_q27 = v.v_mps_q27;
    s->tell_cnt = v.cnt;
    if (r == EXH_PROBE_BUSY) { return f_N_q20; }
    s->tell |= BRINGUP_TELL_PHASE;
    if (r == EXH_PROBE_DONE) {
        next_phase(s, cfg);
    } else {
        s->result = r;
    }
    return 0;
}

/* --- a tick --- */

/* Makes the axis of the finger the only one: only its drive must be ready. Stage 1 requires none,
 * since none is enabled. */
static uint32_t inputs_of(const struct bringup_own_par *own, uint32_t din)
{
    const uint32_t drives = ((1u << EXH_FINGERS) - 1u) * EXH_DIN_DRIVE0;
    const uint32_t ready = din >> own->finger & EXH_DIN_DRIVE0;
    return (din & ~drives) | (own->stage == 1 ? (uint32_t)EXH_DIN_DRIVE0 : ready);
}

/* Moves the gate's frame of that axis to the finger's place. Enables only on request. */
static void place(struct exh_drive_out *out, int32_t finger, int enable)
{
    const uint16_t code = out->dac_raw[0];
    out->dac_raw[0] = out->dac_raw[1]; /* the code of 0 A */
    out->dac_raw[finger] = code;
    out->enable = (uint8_t)(enable ? (out->enable & 1u) << finger : 0u);
}

/* The current for the monitor's voltage. In stage 1 the D/A may be wired to the monitor input:
 * 32768 codes for 10 V against 3249 per V. */
static int32_t monitor_A_q26(const struct bringup_cfg *cfg, int16_t mon_raw)
{
    if (cfg->par->own.stage > 1) { return exh_drive_monitor_A_q26(&cfg->drive, mon_raw); }
    return exh_sat32(exh_gain_mul(cfg->looped_A_q26, mon_raw));
}

static void signals(const struct bringup *s, const struct exh_axis_now *now, struct bringup_view v,
    uint32_t limits, struct bringup_signals *sig)
{
    sig->q_m_q30 = now->pos_m_q30;
    sig->v_mps_q27 = v.v_mps_q27;
    sig->i_des_A_q26 = s->coded_A_q26;
    sig->i_mon_A_q26 = v.mon_A_q26;
    sig->phase = s->phase;
    sig->result = s->result;
    sig->limits = (int32_t)limits;
    sig->state = s->safety.state;
    sig->faults = exh_from_u32(s->safety.faults);
    sig->present = (int32_t)s->safety.present;
}

/* The result of this scene proves the polarity. */
#define VOUCHED (EXH_UNTESTED | EXH_UNCALIBRATED | EXH_UNPOLARISED)

void bringup_tick(struct bringup *s, const struct bringup_cfg *cfg, const struct exh_scene_in *in,
    struct exh_drive_out *out, struct bringup_signals *sig)
{
    const struct bringup_par *par = cfg->par;
    const int32_t finger = par->own.finger;
    /* No tracking: the phases compare monitor and code themselves, and more tightly. */
    const struct exh_axis axis = {.quad = &s->quad,
        .quad_cfg = &cfg->quad,
        .velocity = &s->vel,
        .velocity_cfg = &cfg->vel,
        .drive = &s->drive,
        .drive_cfg = &cfg->drive};
    const struct exh_axis_now now = exh_axis_sense(&axis, &in->drive, (unsigned)finger);
    const uint32_t ready = in->drive.din >> finger & EXH_DIN_DRIVE0;
    const struct bringup_view v = {now.cnt, now.vel_mps_q27,
        monitor_A_q26(cfg, in->drive.mon_raw[finger]), (in->drive.din & 3u) | (ready ? 4u : 0u)};
    const uint8_t command = command_of(s, cfg, in->command);
    const struct exh_safety_in box = {
        inputs_of(&par->own, in->drive.din), EXH_UNTRACKED, in->missed, command, 1, VOUCHED};
    struct exh_force_ledger f = {0};
    struct exh_permit permit;
    struct exh_current_ledger i;
    uint32_t limits;
    int live;

    s->tell = s->safety.tick == 0 ? BRINGUP_TELL_START : 0;
    s->tell_raw = s->code_raw;
    permit = exh_axis_permit(&s->safety, &cfg->safety, &now, 1, box);
    f.pullback_N_q20 = go_on(s, cfg, command, v);
    live = s->result == EXH_PROBE_BUSY && exh_safety_is_running(&s->safety) && needs_run(s, cfg);
    if (!live) { permit.mode = EXH_PERMIT_CLOSED; } /* without a ramp, at any force */
    limits = now.limits | exh_axis_force(&axis, &permit, &f, &i);
    exh_axis_out(&axis, &s->safety, now.cnt, &i, &limits, out);
    s->coded_A_q26 = i.coded_A_q26;
    if (live && (limits & ~(uint32_t)EXH_LIMIT_SLEW)) {
        s->result = BRINGUP_LIMITED; /* known only after the gate: its code goes no further */
        s->coded_A_q26 = 0;
        out->dac_raw[0] = (uint16_t)par->drive.dac_zero_raw;
    }
    s->code_raw = out->dac_raw[0];
    place(out, finger, live && par->own.stage > 1 && s->result == EXH_PROBE_BUSY);
    if (s->result > EXH_PROBE_DONE && !s->said) { s->tell |= BRINGUP_TELL_PHASE; }
    s->said = s->result != EXH_PROBE_BUSY;
    signals(s, &now, v, limits, sig);
}
