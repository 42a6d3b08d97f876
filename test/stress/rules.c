/* The rules that must hold in every tick, listed in stress.c. */
#include "stress.h"

#define LIMITS_ALL 0x7F
#define FAULTS_ALL 0x3F

struct hidden { /* what the scene does not show */
    struct exh_force_ledger f;
    struct exh_current_ledger i;
    int32_t force_before;
    uint32_t limits;
    int touching, run;
    struct exh_drive_out out;
};

/* The scene's tick, from the modules, in their documented order. */
static void shadow_tick(struct drop *s, const struct exh_scene_in *in, struct hidden *h)
{
    const struct drop_par *par = &rig.active;
    const int32_t cnt = exh_quad_extend(&s->quad, &rig.cfg.quad, in->drive.enc_raw[0]);
    const int32_t pos = exh_quad_pos_m_q30(&par->quad, cnt);
    const int32_t vel = exh_velocity_window_mps_q27(&s->velocity, &rig.cfg.velocity, cnt);
    const struct exh_contact_in q = {pos, vel, par->own.q_lim_m_q30};
    const int32_t mon = exh_drive_monitor_A_q26(&rig.cfg.drive, in->drive.mon_raw[0]);
    const uint32_t lost = s->quad.lost ? EXH_FAULT_ENCODER : 0u;
    const uint32_t astray =
        exh_track_step(&s->track, &rig.cfg.track, mon) ? EXH_FAULT_TRACKING : 0u;
    const uint32_t raised = lost | astray;
    const struct exh_safety_in box = {in->drive.din, raised, in->missed, in->command, 1, 15};
    const struct exh_permit permit = exh_safety_step(&s->safety, &rig.cfg.safety, box);
    const int run = permit.mode != EXH_PERMIT_CLOSED;
    h->run = run;
    h->force_before = run ? s->drive.force_N_q20 : 0;
    h->touching = exh_contact_law(&s->contact, &par->contact, q, &h->f);
    h->limits = exh_drive_force(&s->drive, &rig.cfg.drive, &permit, &h->f);
    h->limits |= exh_drive_current(&s->drive, &rig.cfg.drive, &h->f, &h->i);
    exh_gate(&s->safety, &rig.cfg.drive, 1, &h->i, &h->limits, &h->out);
    exh_track_coded(&s->track, h->i.coded_A_q26);
}

static void check_force(const struct hidden *h)
{
    const struct exh_force_ledger *f = &h->f;
    const struct exh_drive_par *par = &rig.active.drive;
    const int64_t sum = f->spring_N_q20 + f->damper_N_q20 + f->pullback_N_q20 + f->passivity_N_q20 +
                        f->clamp_N_q20 + f->slew_N_q20;
    const int32_t top = rig.cfg.drive.f_top_N_q20;
    const int32_t most = par->f_max_N_q20 < top ? par->f_max_N_q20 : top;
    const int64_t change = (int64_t)f->force_N_q20 - h->force_before;
    const int32_t slew = change > 0 ? par->slew_up_Nps : par->slew_down_Nps;
    const double step = (double)slew * 1048576.0 * rig.T.num / rig.T.den;
    const double moved = (double)(change < 0 ? -change : change);
    must(sum == f->force_N_q20, "force ledger", "%" PRId64 " != %ld", sum, (long)f->force_N_q20);
    must(f->force_N_q20 >= 0, "force", "%ld", (long)f->force_N_q20);
    must(h->run || f->force_N_q20 == 0, "force", "%ld outside RUN", (long)f->force_N_q20);
    must(f->force_N_q20 <= most || (change < 0 && moved >= step - 2), "force",
         "%ld above %ld, change %" PRId64, (long)f->force_N_q20, (long)most, change);
    must(moved <= step + 1.0001, "slew", "%.0f LSB, may %.3f", moved, step);
    if (step >= 1 && moved / step > rig.w.slew_share) { rig.w.slew_share = moved / step; }
    if (f->force_N_q20 > rig.w.force_max) { rig.w.force_max = f->force_N_q20; }
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
    const int at_end =
        (h->limits & EXH_LIMIT_DAC) != 0 || par->dac_zero_raw + par->dac_span_raw > 65535;
    must(sum == i->coded_A_q26, "current ledger", "%" PRId64 " != %ld", sum, (long)i->coded_A_q26);
    must(passed >= 0 && passed <= par->i_peak_A_q26, "current", "%" PRId64 " of %ld", passed,
         (long)par->i_peak_A_q26);
    must((double)i->dac_A_q26 <= half_code + 2 &&
             (at_end || (double)i->dac_A_q26 >= -half_code - 2),
         "coding", "off by %" PRId64 ", half a code is %.0f", i->dac_A_q26, half_code);
    check_heat((double)passed / 67108864.0);
    if ((double)passed / 67108864.0 > rig.w.cur_max_A) {
        rig.w.cur_max_A = (double)passed / 67108864.0;
    }
}

static void check_codes(const struct exh_drive_out *out)
{
    const struct exh_drive_par *par = &rig.active.drive;
    const int open = rig.state.safety.state == EXH_STATE_RUN;
    const int code = out->dac_raw[0] - par->dac_zero_raw;
    must(code >= 0 && code <= par->dac_span_raw, "code", "%d of %ld", code,
         (long)par->dac_span_raw);
    must(out->enable == open && (open || code == 0), "gate", "code %d, enable %u", code,
         (unsigned)out->enable);
    must(!open || !rig.state.quad.lost, "gate", "open after a jump");
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
    must((s->limits & ~LIMITS_ALL) == 0 && (s->faults & ~FAULTS_ALL) == 0, "signals",
         "limits %#lx, faults %#lx", (unsigned long)s->limits, (unsigned long)s->faults);
    must(s->state >= EXH_STATE_OFF && s->state <= EXH_STATE_FAULT &&
             (s->faults != 0) == (s->state == EXH_STATE_FAULT),
         "signals", "state %ld, faults %#lx", (long)s->state, (unsigned long)s->faults);
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
    check_codes(out);
    check_signals(&h);
    rig.w.crc = exh_crc32(rig.w.crc, out->dac_raw, sizeof out->dac_raw);
    rig.w.crc = exh_crc32(rig.w.crc, &rig.sig, sizeof rig.sig);
    rig.w.ticks++;
}
