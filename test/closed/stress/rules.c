/* SPDX-License-Identifier: MIT */
/* The rules that must hold in every tick, listed in stress.c. */
#include "stress.h"

#define LIMITS_ALL (0x3FF | EXH_LIMIT_PERSON) /* PASSIVITY is not in this scene */

/* what the scene does not show */
struct hidden {
    struct exh_force_ledger f;
    struct exh_current_ledger i;
    enum box_gate gate;
    int32_t vel, cnt; /* as measured */
    uint32_t limits;
    int touching;
    struct exh_drive_out out;
};

/* Beyond the speed limit, or pulled without a count, for too long. */
static uint32_t movement_faults(const struct hidden *h)
{
    struct box *b = &rig.box;
    const int64_t v = h->vel < 0 ? -(int64_t)h->vel : h->vel;
    b->fast = v > rig.active.watch.speed_mps_q27 ? b->fast + 1 : 0;
    return (b->fast >= rig.times.fast ? (uint32_t)EXH_FAULT_SPEED : 0u) |
           (rig.times.still > 0 && b->still >= rig.times.still ? (uint32_t)EXH_FAULT_STUCK : 0u);
}

/* The state that the box must come to, from separate causes. */
static void box_tick(struct exh_safety_in in, struct hidden *h)
{
    const uint32_t moved = movement_faults(h);
    const uint32_t told = in.raised & (EXH_FAULT_SPEED | EXH_FAULT_STUCK);
    must(told == moved, "speed", "faults %#lx, want %#lx", (unsigned long)told,
        (unsigned long)moved);
    in.raised = (in.raised & ~told) | moved;
    h->gate = box_step(&rig.box, &rig.times, &in);
}

/* The scene's tick, from the modules, in their documented order. */
static void shadow_tick(struct drop *s, const struct exh_scene_in *in, struct hidden *h)
{
    const struct drop_par *par = &rig.active;
    const int32_t cnt = exh_quad_step(&s->quad, &rig.cfg.quad, in->drive.enc_raw[0]);
    const int32_t pos = exh_quad_pos_m_q30(&par->quad, cnt);
    struct exh_contact_in q = {
        pos, exh_velocity_window_step(&s->velocity, &rig.cfg.velocity, cnt), par->own.q_lim_m_q30};
    const int32_t mon = exh_drive_monitor_A_q26(&rig.cfg.drive, in->drive.mon_raw[0]);
    struct exh_safety_in box = {in->drive.din, 0, in->missed, in->command, 1, 15};
    struct exh_permit permit;
    h->vel = q.vel_mps_q27;
    h->cnt = cnt;
    if (exh_tracking_step(&s->track, &rig.cfg.track, mon)) { box.raised |= EXH_FAULT_TRACKING; }
    if (exh_supply_step(&s->supply, &rig.cfg.supply, in->drive.supply_raw, in->missed)) {
        box.raised |= EXH_FAULT_SUPPLY;
    }
    if (s->quad.lost) {
        box.raised |= EXH_FAULT_ENCODER;
        box.ready &= (uint8_t)~EXH_ARM_ENCODER;
    }
    box.raised |= exh_motion_step(&s->watch, &rig.cfg.watch, &q.vel_mps_q27, &h->limits);
    box.raised |= exh_chatter_step(&s->chatter, &rig.cfg.chatter);
    box_tick(box, h);
    permit = exh_safety_step(&s->safety, &rig.cfg.safety, box);
    h->touching = exh_contact_step(&s->contact, &par->contact, q, &h->f);
    h->limits |= exh_drive_force_step(&s->drive, &rig.cfg.drive, &permit, &h->f);
    h->limits |= exh_drive_current_step(&s->drive, &rig.cfg.drive, &h->f, &h->i);
    exh_gate_step(&s->safety, &rig.cfg.drive, 1, &h->i, &h->limits, &h->out);
    exh_tracking_update(&s->track, h->i.coded_A_q26);
    exh_motion_update(&s->watch, &rig.cfg.watch, cnt, h->i.coded_A_q26);
    exh_chatter_update(&s->chatter, &rig.cfg.chatter, cnt, h->i.coded_A_q26);
}

static int64_t asked_of(const struct exh_force_ledger *f)
{
    return f->spring_N_q20 + f->damper_N_q20 + f->pullback_N_q20 + f->passivity_N_q20;
}

/* Open: the commanded force within the present limit, or as near as slew permits. */
static void check_open(const struct exh_force_ledger *f)
{
    const struct exh_drive_par *par = &rig.active.drive;
    const int32_t top = rig.cfg.drive.f_top_N_q20;
    const int32_t most = par->f_max_N_q20 < top ? par->f_max_N_q20 : top;
    const int64_t may =
        (int64_t)((double)most * (double)box_share(&rig.box, &rig.times) / 1073741824.0);
    const int64_t asked = asked_of(f);
    const int64_t want = asked < 0 ? 0 : asked > may ? may : asked;
    const int64_t change = (int64_t)f->force_N_q20 - rig.box.held;
    const int32_t slew = change > 0 ? par->slew_up_Nps : par->slew_down_Nps;
    const double step = (double)slew * 1048576.0 * rig.T.num / rig.T.den;
    const double moved = (double)(change < 0 ? -change : change);
    const int there = f->force_N_q20 >= want - 1 && f->force_N_q20 <= want + 1;
    const int on_the_way =
        (change > 0 ? f->force_N_q20 < want : f->force_N_q20 > want) && moved >= step - 2;
    must(there || on_the_way, "force", "%ld, not %" PRId64 " of %" PRId64 ", change %" PRId64,
        (long)f->force_N_q20, want, may, change);
    must(moved <= step + 1.0001, "slew", "%.0f LSB, may %.3f", moved, step);
    if (step >= 1 && moved / step > rig.w.slew_share) { rig.w.slew_share = moved / step; }
}

/* In equal steps from where it began, each of them rounded up by 1 LSB at most. */
static void check_falling(const struct exh_force_ledger *f)
{
    const int64_t R = (int64_t)rig.times.release, from = rig.box.from;
    const int64_t gone = rig.box.gone < (uint64_t)R ? (int64_t)rig.box.gone : R;
    const int64_t most = from * (R - gone) / R;
    must(f->force_N_q20 <= most && f->force_N_q20 >= most - gone - 1, "release",
        "%ld, %" PRId64 " of %" PRId64 " ticks from %" PRId64, (long)f->force_N_q20, gone, R, from);
    must(f->force_N_q20 <= rig.box.held, "release", "%ld, was %ld", (long)f->force_N_q20,
        (long)rig.box.held);
    must(f->clamp_N_q20 == 0 && f->slew_N_q20 == 0, "release", "clamp %" PRId64 ", slew %" PRId64,
        f->clamp_N_q20, f->slew_N_q20);
}

static void check_force(const struct hidden *h)
{
    const struct exh_force_ledger *f = &h->f;
    const int64_t sum = asked_of(f) + f->clamp_N_q20 + f->slew_N_q20 + f->release_N_q20;
    must(sum == f->force_N_q20, "force ledger", "%" PRId64 " != %ld", sum, (long)f->force_N_q20);
    must(f->force_N_q20 >= 0, "force", "%ld", (long)f->force_N_q20);
    must(h->gate == BOX_FALLS || f->release_N_q20 == 0, "force", "released outside RELEASE");
    switch (h->gate) {
    case BOX_OPEN: check_open(f); break;
    case BOX_FALLS: check_falling(f); break;
    case BOX_SHUT: must(f->force_N_q20 == 0, "force", "%ld while shut", (long)f->force_N_q20);
    }
    if (f->force_N_q20 > rig.w.force_max) { rig.w.force_max = f->force_N_q20; }
}

/* What the next tick goes by. */
static void keep(const struct hidden *h, const struct exh_drive_out *out)
{
    struct box *b = &rig.box;
    const int pulled = h->i.coded_A_q26 > rig.active.watch.stuck_cur_A_q26;
    b->held = h->f.force_N_q20;
    b->calm = asked_of(&h->f) <= rig.times.small_N_q20 ? b->calm + 1 : 0;
    b->still = pulled && h->cnt == b->cnt ? b->still + 1 : 0;
    b->cnt = h->cnt;
    b->off = out->dac_raw[0] - rig.active.drive.dac_zero_raw;
    b->limited = (h->limits & ~(uint32_t)EXH_LIMIT_PULL) != 0;
}

static void check_heat(double i_A)
{
    const struct exh_drive_par *par = &rig.active.drive;
    const double T_s = (double)rig.T.num / rig.T.den;
    const double peak_A = par->i_peak_A_q26 / 67108864.0, cont_A = par->i_cont_A_q26 / 67108864.0;
    const double excess = peak_A * peak_A - cont_A * cont_A;
    const double budget = excess * (par->peak_ms / 1000.0 + 2 * T_s);
    rig.heat += (i_A * i_A - cont_A * cont_A) * T_s;
    if (rig.heat < 0) { rig.heat = 0; }
    /* 1e-3: the library takes currents to 15 uA */
    must(rig.heat <= budget * 1.001 + 1e-3 * T_s, "heat", "%.6f A2s of %.6f", rig.heat, budget);
    if (budget > 0 && rig.heat / budget > rig.w.heat_share) {
        rig.w.heat_share = rig.heat / budget;
    }
}

static void check_current(const struct hidden *h)
{
    const struct exh_current_ledger *i = &h->i;
    const struct exh_drive_par *par = &rig.active.drive;
    const int64_t sum =
        i->table_A_q26 + i->peak_A_q26 + i->i2t_A_q26 + i->gate_A_q26 + i->dac_A_q26;
    const int64_t passed = i->table_A_q26 + i->peak_A_q26 + i->i2t_A_q26 + i->gate_A_q26;
    const double half_code = 67108864.0 * 65536.0 / par->dac_rawpA_q16 / 2;
    const int code = h->out.dac_raw[0] - par->dac_zero_raw;
    /* Limited below the command: the span's end, the word's, or in a release the last code. */
    const int at_end = code == par->dac_span_raw || h->out.dac_raw[0] == 65535 ||
                       (h->gate == BOX_FALLS && code == rig.box.off);
    must(sum == i->coded_A_q26, "current ledger", "%" PRId64 " != %ld", sum, (long)i->coded_A_q26);
    must(passed >= 0 && passed <= par->i_peak_A_q26, "current", "%" PRId64 " of %ld", passed,
        (long)par->i_peak_A_q26);
    must(
        (double)i->dac_A_q26 <= half_code + 2 && (at_end || (double)i->dac_A_q26 >= -half_code - 2),
        "coding", "off by %" PRId64 ", half a code is %.0f", i->dac_A_q26, half_code);
    check_heat((double)passed / 67108864.0);
    if ((double)passed / 67108864.0 > rig.w.cur_max_A) {
        rig.w.cur_max_A = (double)passed / 67108864.0;
    }
}

static void check_codes(const struct hidden *h, const struct exh_drive_out *out)
{
    const struct exh_drive_par *par = &rig.active.drive;
    const int open = h->gate != BOX_SHUT;
    const int code = out->dac_raw[0] - par->dac_zero_raw;
    must(
        code >= 0 && code <= par->dac_span_raw, "code", "%d of %ld", code, (long)par->dac_span_raw);
    must(out->enable == open && (open || code == 0), "gate", "code %d, enable %u", code,
        (unsigned)out->enable);
    must(h->gate != BOX_OPEN || !rig.state.quad.lost, "gate", "open after a jump");
    must(h->gate != BOX_FALLS || code <= rig.box.off, "release", "code %d, was %d", code,
        (int)rig.box.off);
    must(out->alive == (uint8_t)(rig.w.ticks + 1), "alive", "%u", (unsigned)out->alive);
    for (unsigned k = 1; k < EXH_FINGERS; k++) {
        must(out->dac_raw[k] == par->dac_zero_raw, "code", "axis %u not in use: %u", k,
            (unsigned)out->dac_raw[k]);
    }
    if (code > rig.w.code_max) { rig.w.code_max = code; }
}

static void check_signals(const struct hidden *h)
{
    const struct drop_signals *s = &rig.sig;
    const struct drop_par *par = &rig.active;
    const int64_t past = (int64_t)s->q_m_q30 - par->own.q_lim_m_q30;
    const int32_t end = rig.cfg.calib.cur_to_force[1].y;
    must(s->c == h->touching && s->f_des_N_q20 == h->f.force_N_q20 &&
             s->i_des_A_q26 == h->i.coded_A_q26 && s->limits == (int32_t)h->limits,
        "output", "signals are not those of the modules");
    must(s->c == 0 || s->c == 1, "signals", "c = %ld", (long)s->c);
    must(s->c ? past >= -(int64_t)par->contact.hyst_m_q30 : past < 0, "signals",
        "c = %ld at %" PRId64 " past q_lim", (long)s->c, past);
    must((s->limits & ~LIMITS_ALL) == 0, "signals", "limits %#lx", (unsigned long)s->limits);
    must(
        ((s->limits & EXH_LIMIT_SPEED) != 0) == (rig.box.fast > 0) &&
            s->qd_mps_q27 == exh_clamp(h->vel, -par->watch.speed_mps_q27, par->watch.speed_mps_q27),
        "speed", "%ld into the law, %ld measured", (long)s->qd_mps_q27, (long)h->vel);
    must(s->state == rig.box.state && (uint32_t)s->faults == rig.box.faults &&
             (uint32_t)s->present == rig.box.present,
        "state", "%ld, faults %#lx, present %#lx, want %d, %#lx, %#lx", (long)s->state,
        (unsigned long)s->faults, (unsigned long)s->present, rig.box.state,
        (unsigned long)rig.box.faults, (unsigned long)rig.box.present);
    must(s->f_mon_N_q20 >= -end && s->f_mon_N_q20 <= end, "signals", "f_mon %ld of %ld",
        (long)s->f_mon_N_q20, (long)end);
    if (s->q_m_q30 < rig.w.q_min) { rig.w.q_min = s->q_m_q30; }
    if (s->q_m_q30 > rig.w.q_max) { rig.w.q_max = s->q_m_q30; }
}

void tick(const struct exh_scene_in *in, struct exh_drive_out *out)
{
    struct hidden h;
    memset(&h, 0, sizeof h);
    if (rig.blind) { rig.state.quad.lost = rig.shadow.quad.lost = 0; }
    drop_tick(&rig.state, &rig.cfg, in, out, &rig.sig);
    shadow_tick(&rig.shadow, in, &h);
    must(memcmp(out->dac_raw, h.out.dac_raw, sizeof out->dac_raw) == 0 &&
             out->enable == h.out.enable && out->alive == h.out.alive,
        "output", "code %u, the modules give %u", (unsigned)out->dac_raw[0],
        (unsigned)h.out.dac_raw[0]);
    check_force(&h);
    check_current(&h);
    check_codes(&h, out);
    check_signals(&h);
    keep(&h, out);
    rig.w.in[rig.box.state]++;
    rig.w.crc = exh_crc32(rig.w.crc, out->dac_raw, sizeof out->dac_raw);
    rig.w.crc = exh_crc32(rig.w.crc, &rig.sig, sizeof rig.sig);
    rig.w.ticks++;
}
