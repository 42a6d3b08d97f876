/* Stress: the drop scene at and beyond the ends of its ranges, alone and in closed loop
 * over the simulated device. `make stress` builds it with -fsanitize=address,undefined,
 * runs it, and runs the property tests with EXH_CASES=100000000 for the laws themselves.
 *
 * Prints one table: case, what must hold besides the rules below, what held, ok or FAIL.
 * Exit status 1 on any FAIL. In every tick of every case must hold:
 *
 *   output     the scene gives what its modules give in their documented order
 *   ledgers    force and current terms sum to the last bit
 *   force      0 <= F <= f_max (above f_max, after it was lowered, only on its way down)
 *   slew       |change of F| <= slew * T + 1 LSB
 *   code       dac_zero <= code <= dac_zero + dac_span: a string is never pushed; outside
 *              RUN, and on axes not in use, dac_zero and disabled
 *   current    0 <= i <= i_peak, coded to half a code
 *   heat       the integral of i^2 - i_cont^2 stays within i_peak for peak_time, in whole
 *              ticks rounded up, and one tick more
 *   signals    c is 0 or 1 and agrees with q and q_lim, enums and bit sets are known ones,
 *              the monitored force lies on its table
 */
#include "posix.h"
#include "sim/plant.h"
#include "sim/random.h"

#include "drop/drop.h"
#include "log.h"

#include "exhand/board.h"
#include "exhand/exhand.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define LEN(a)     (sizeof(a) / sizeof((a)[0]))
#define HEALTHY    (EXH_DIN_ESTOP | EXH_DIN_DEADMAN | EXH_DIN_DRIVE0)
#define LIMITS_ALL 0x7F
#define FAULTS_ALL 0x3F

enum { /* parameters that cases set, by id */
       ID_BITS = 0x0202,
       ID_K = 0x0401,
       ID_B = 0x0402,
       ID_F0 = 0x0403,
       ID_SLEW_UP = 0x0502,
       ID_SLEW_DOWN = 0x0503,
       ID_PEAK_TIME = 0x0506,
       ID_Q_LIM = 0x8001
};

void exh_assert_failed(const char *file, int line)
{
    printf("%s:%d: the library's assertion\n", file, line);
    abort();
}

#ifdef EXH_FIX_AUDIT
void exh_fix_saturated(const char *file, int line)
{
    (void)file;
    (void)line;
}
#endif

/* --- the rig: a scene of our own, its shadow, and what was seen --- */

struct watch {
    uint64_t ticks, broken;
    char first[160]; /* the first rule that broke, with its values              */
    int32_t force_max, q_min, q_max;
    int code_max; /* from dac_zero                                            */
    double slew_share, cur_max_A, heat_share;
    uint32_t crc; /* of all outputs and signals                               */
};

struct rig {
    struct drop_par active, staged;
    struct exh_params params;
    struct drop_cfg cfg;
    struct drop state, shadow;
    struct drop_signals sig;
    struct exh_period T;
    double heat; /* A^2 s above continuous, in doubles                       */
    struct watch w;
};

static struct rig rig;
static struct sim_random rng;

#ifdef __GNUC__
__attribute__((format(printf, 3, 4)))
#endif
static void
must(int holds, const char *rule, const char *fmt, ...)
{
    struct watch *w = &rig.w;
    va_list ap;
    int n;
    if (holds) { return; }
    if (w->broken++ > 0) { return; }
    n = snprintf(w->first, sizeof w->first, "%s at tick %" PRIu64 ": ", rule, w->ticks);
    va_start(ap, fmt);
    vsnprintf(w->first + n, sizeof w->first - (size_t)n, fmt, ap);
    va_end(ap);
}

/* Parameters to their defaults; settings follow by set(), then ready(). */
static void fresh(void)
{
    memset(&rig, 0, sizeof rig);
    rig.w.q_min = INT32_MAX;
    rig.w.q_max = INT32_MIN;
    exh_params_init(&rig.params, exh_scene_drop.params->table, (int32_t *)&rig.active,
                    (int32_t *)&rig.staged);
}

static void set(uint16_t id, int32_t raw)
{
    const int err = exh_params_stage(&rig.params, id, 0, raw);
    must(err == 0, "setting", "id %#x = %ld: %d", (unsigned)id, (long)raw, err);
}

/* 0, or the scene's refusal. */
static int ready(struct exh_period T)
{
    exh_params_apply(&rig.params);
    rig.params.locked = 1;
    rig.T = T;
    return drop_setup(&rig.cfg, &rig.active, T);
}

/* --- the rules --- */

struct hidden { /* what the scene does not show */
    struct exh_force_ledger f;
    struct exh_current_ledger i;
    int32_t force_before;
    uint32_t limits;
    int touching;
    struct exh_drive_out out;
};

/* The scene's tick, from the modules, in their documented order. */
static void shadow_tick(struct drop *s, const struct exh_scene_in *in, struct hidden *h)
{
    const struct drop_par *par = &rig.active;
    const int32_t cnt = exh_quad_extend(&s->quad, &par->quad, in->drive.enc_raw[0]);
    const int32_t pos = exh_quad_pos_m_q30(&par->quad, cnt);
    const int32_t vel = exh_velocity_window_mps_q27(&s->velocity, &rig.cfg.velocity, cnt);
    const struct exh_contact_in q = {pos, vel, par->own.q_lim_m_q30};
    const struct exh_safety_in box = {in->drive.din, 0, in->missed, in->command, 1};
    if (exh_safety_step(&s->safety, &par->safety, box) != EXH_STATE_RUN) {
        s->drive.force_N_q20 = 0;
    }
    h->force_before = s->drive.force_N_q20;
    h->touching = exh_contact_law(&s->contact, &par->contact, q, &h->f);
    h->limits = exh_drive_force(&s->drive, &rig.cfg.drive, &h->f);
    h->limits |= exh_drive_current(&s->drive, &rig.cfg.drive, &h->f, &h->i);
    exh_gate(&s->safety, &rig.cfg.drive, 1, &h->i, &h->limits, &h->out);
}

static void check_force(const struct hidden *h)
{
    const struct exh_force_ledger *f = &h->f;
    const struct exh_drive_par *par = &rig.active.drive;
    const int64_t sum = f->spring_N_q20 + f->damper_N_q20 + f->pullback_N_q20 + f->passivity_N_q20 +
                        f->clamp_N_q20 + f->slew_N_q20;
    const int64_t change = (int64_t)f->force_N_q20 - h->force_before;
    const int32_t slew = change > 0 ? par->slew_up_Nps : par->slew_down_Nps;
    const double step = (double)slew * 1048576.0 * rig.T.num / rig.T.den;
    const double moved = (double)(change < 0 ? -change : change);
    must(sum == f->force_N_q20, "force ledger", "%" PRId64 " != %ld", sum, (long)f->force_N_q20);
    must(f->force_N_q20 >= 0, "force", "%ld", (long)f->force_N_q20);
    must(f->force_N_q20 <= par->f_max_N_q20 || (change < 0 && moved >= step - 2), "force",
         "%ld above f_max %ld, change %" PRId64, (long)f->force_N_q20, (long)par->f_max_N_q20,
         change);
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
    const int32_t end = rig.cfg.cur_to_force[1].y;
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

/* One tick of the rig, watched. */
static void tick(const struct exh_scene_in *in, struct exh_drive_out *out)
{
    struct hidden h;
    memset(&h, 0, sizeof h);
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

/* --- the table --- */

static int failures;

static void report(const char *name, const char *besides)
{
    const struct watch *w = &rig.w;
    char held[160];
    snprintf(held, sizeof held,
             "%8" PRIu64 " ticks F %6.2f N slew %3.0f %% code %5d i %5.3f A heat %3.0f %% "
             "q %+7.1f..%+7.1f mm",
             w->ticks, w->force_max / 1048576.0, 100 * w->slew_share, w->code_max, w->cur_max_A,
             100 * w->heat_share, w->q_min / 1073741.824, w->q_max / 1073741.824);
    printf("%-38s | %-46s | %s | %s\n", name, besides, held, w->broken ? "FAIL" : "ok");
    if (w->broken) { printf("    %" PRIu64 " broken, first %s\n", w->broken, w->first); }
    fflush(stdout);
    failures += w->broken != 0;
}

static struct exh_scene_in idle_in(uint32_t enc_raw)
{
    struct exh_scene_in in;
    memset(&in, 0, sizeof in);
    in.drive.enc_raw[0] = enc_raw;
    in.drive.din = HEALTHY;
    return in;
}

/* --- closed loop --- */

enum tweak { PLAIN, NO_FRICTION, FREE, STIFF_CABLE, HALF, ALMOST_HALF };

struct closed {
    const char *name;
    double k_Npm, b_Nspm, mass_kg;
    struct exh_period T;
    enum tweak tweak;
    double lo_mm, hi_mm; /* the motor's travel must stay between; 0, 0: not asked   */
    double enc_start;
};

/* The scene's q is the plant's, to two counts, as long as the string has not run out
 * of the formats (+-2 m). */
static void check_position(const struct sim_device *d, double start_m)
{
    const double q_m = posix_plant()->q_m - start_m;
    const double seen_m = rig.sig.q_m_q30 / 1073741824.0;
    const double want_m = q_m > 2 ? 2 : q_m < -2 ? -2 : q_m;
    const double off = seen_m > want_m ? seen_m - want_m : want_m - seen_m;
    must(off <= 2 * d->step_m, "position", "%.6f m, the plant is at %.6f", seen_m, want_m);
}

static void set_gains(const struct sim_device *d, double k_Npm, double b_Nspm)
{
    fresh();
    set(ID_K, (int32_t)(k_Npm * (1 << EXH_Q_K)));
    set(ID_B, (int32_t)(b_Nspm * (1 << EXH_Q_B)));
    set(ID_Q_LIM, (int32_t)(d->height_m * (1 << EXH_Q_POS)));
    rig.staged.own.kf_NpA_q20 = (int32_t)(d->kf_npa * (1 << EXH_Q_FORCE));
    rig.staged.quad.step_m_q42 = (int32_t)(d->step_m * (double)(INT64_C(1) << EXH_Q_STEP));
}

static struct posix_config device_of(const struct closed *c)
{
    struct posix_config p = posix_config_default();
    p.device.mass_kg = c->mass_kg;
    p.device.observe_s = 2;
    p.device.enc_start = c->enc_start;
    p.falls = 3;
    p.T = c->T;
    if (c->tweak == NO_FRICTION || c->tweak == FREE) {
        p.device.mu_motor = p.device.mu_mass = p.device.coulomb_n = p.device.viscous_nspm = 0;
    }
    if (c->tweak == STIFF_CABLE) {
        p.device.cable_npm = 1e6;
        p.device.substep_s = 5e-6;
    }
    return p;
}

/* What an encoder that jumps adds to its count in this tick. */
static uint32_t jump_at(const struct closed *c, uint64_t n)
{
    if (c->tweak == HALF) { return n / 97 % 2 ? 0x800000 : 0; }
    if (c->tweak == ALMOST_HALF) { return n / 97 % 2 ? 0x7FFFFF : 0; }
    return 0;
}

/* Three falls. */
static void run_closed(const struct closed *c)
{
    const struct posix_config p = device_of(c);
    struct exh_scene_in in = idle_in(0);
    struct exh_drive_out out;
    struct exh_period T;
    double start_m = 0;
    set_gains(&p.device, c->k_Npm, c->b_Nspm);
    posix_configure(&p);
    if (c->tweak == FREE) { set(ID_F0, 0); }
    must(exh_board_init(0, &T) == 0 && ready(T) == 0, "set-up", "refused");
    in.command = EXH_CMD_RUN;
    while (rig.w.broken == 0 && exh_board_wait() >= 0) {
        exh_board_read_drive(&in.drive);
        if (rig.w.ticks == 0) { start_m = posix_plant()->q_m; }
        in.drive.enc_raw[0] = (in.drive.enc_raw[0] + jump_at(c, rig.w.ticks)) & 0xFFFFFF;
        tick(&in, &out);
        exh_board_write_drive(&out);
        if (c->tweak < HALF) { check_position(&p.device, start_m); }
        in.command = EXH_CMD_NONE;
    }
}

/* Travel is from the start, +-1 mm; the wall is at 70 mm. Where the loop is much faster than
 * the mass, the drive's 27 N must stop 0.55 kg, 0.34 J, within 17 mm, and the first tick
 * and the output delay let pass 2 mm more: 90 mm. (At 90 Hz 11 ms let pass 13 mm: 110.)
 * What a late force throws up may not go above where it came from: -3 mm. Not asked of
 * motion: below 90 Hz (the mass has passed before the loop looks), 5 kg (more than
 * the motor can hold), no gains, an encoder that lies. F0 outweighs 1 g: it is wound up,
 * against 3 Ns/m of friction by no more than 36 mm/s for 3 s; and 1 g on a rotor without
 * friction is thrown back by a late wall with more than it had: 300 mm are allowed. */
static const struct closed closed_case[] = {
    {"paper, 2000 Hz", 20000, 60, 0.5, {1, 2000}, PLAIN, -3, 90, 0},
    {"k 1e6 N/m", 1e6, 0, 0.5, {1, 2000}, PLAIN, -3, 90, 0},
    {"b 1e3 Ns/m", 0, 1e3, 0.5, {1, 2000}, PLAIN, 0, 0, 0},
    {"k 1e6 N/m, b 1e3 Ns/m", 1e6, 1e3, 0.5, {1, 2000}, PLAIN, -3, 90, 0},
    {"no gains", 0, 0, 0.5, {1, 2000}, PLAIN, 0, 0, 0},
    {"mass 0.001 kg", 20000, 60, 0.001, {1, 2000}, PLAIN, -110, 71, 0},
    {"mass 0.001 kg, no friction, no F0", 20000, 60, 0.001, {1, 2000}, FREE, -300, 90, 0},
    {"mass 0.02 kg", 20000, 60, 0.02, {1, 2000}, PLAIN, -3, 90, 0},
    {"mass 5 kg", 20000, 60, 5, {1, 2000}, PLAIN, 0, 0, 0},
    {"no friction", 20000, 60, 0.5, {1, 2000}, NO_FRICTION, -3, 90, 0},
    {"no friction, no F0", 20000, 60, 0.5, {1, 2000}, FREE, -3, 90, 0},
    {"no friction, k 1e6, b 1e3", 1e6, 1e3, 0.5, {1, 2000}, NO_FRICTION, -3, 90, 0},
    {"cable 1e6 N/m", 20000, 60, 0.5, {1, 2000}, STIFF_CABLE, -3, 90, 0},
    {"cable 1e6 N/m, k 1e6, b 1e3", 1e6, 1e3, 0.5, {1, 2000}, STIFF_CABLE, -3, 90, 0},
    {"1 Hz", 1500, 0, 0.5, {1, 1}, PLAIN, 0, 0, 0},
    {"1 Hz, k 1e6, b 1e3", 1e6, 1e3, 0.5, {1, 1}, PLAIN, 0, 0, 0},
    {"7 Hz", 1500, 0, 0.5, {1, 7}, PLAIN, 0, 0, 0},
    {"90 Hz", 1500, 0, 0.5, {1, 90}, PLAIN, -3, 110, 0},
    {"90 Hz, k 1e6, b 1e3", 1e6, 1e3, 0.5, {1, 90}, PLAIN, -70, 110, 0},
    {"20000 Hz", 20000, 60, 0.5, {1, 20000}, PLAIN, -3, 90, 0},
    {"20000 Hz, k 1e6, b 1e3", 1e6, 1e3, 0.5, {1, 20000}, PLAIN, -3, 90, 0},
    {"period 597/1193182 s", 20000, 60, 0.5, {597, 1193182}, PLAIN, -3, 90, 0},
    {"counter wraps at the wall", 20000, 60, 0.5, {1, 2000}, PLAIN, -3, 90, 0xFFFFFF},
    {"counter wraps after the start", 20000, 60, 0.5, {1, 2000}, PLAIN, -3, 90, 1000},
    {"encoder jumps by half its range", 20000, 60, 0.5, {1, 2000}, HALF, 0, 0, 0},
    {"encoder jumps by one count less", 20000, 60, 0.5, {1, 2000}, ALMOST_HALF, 0, 0, 0},
};

static void all_closed(void)
{
    for (size_t i = 0; i < LEN(closed_case); i++) {
        const struct closed *c = &closed_case[i];
        char besides[64];
        run_closed(c);
        snprintf(besides, sizeof besides, "%s",
                 c->tweak < HALF ? "q is the plant's to 2 counts" : "");
        if (c->hi_mm > c->lo_mm) {
            const double lo = rig.w.q_min / 1073741.824, hi = rig.w.q_max / 1073741.824;
            snprintf(besides + strlen(besides), sizeof besides - strlen(besides), ", %g..%g mm",
                     c->lo_mm, c->hi_mm);
            must(lo >= c->lo_mm && hi <= c->hi_mm, "motion", "%.1f..%.1f mm", lo, hi);
        }
        report(c->name, besides);
    }
}

/* --- open loop: inputs no device could give --- */

static uint32_t any(uint32_t n)
{
    return (uint32_t)(sim_random_u64(&rng) % n);
}

/* Ends and middles of 16, 24 and 32 bits. */
static const uint32_t enc_extreme[] = {
    0, 0x7FFF, 0x8000, 0xFFFF, 0x7FFFFF, 0x800000, 0xFFFFFF, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF, 1};
static const int16_t mon_extreme[] = {INT16_MIN, INT16_MAX, 0, -1};

/* Corner or random: encoder and monitor at their ends, turn and turn about. */
static struct exh_scene_in wild_in(uint64_t n)
{
    struct exh_scene_in in =
        idle_in(enc_extreme[n % 2 ? n / 2 % LEN(enc_extreme) : any(LEN(enc_extreme))]);
    if (n % 5 == 0) { in.drive.enc_raw[0] = (uint32_t)sim_random_u64(&rng); }
    in.drive.mon_raw[0] = n % 3 ? mon_extreme[n % 4] : (int16_t)((int)any(65536) - 32768);
    in.drive.supply_raw = mon_extreme[n % 4];
    in.command = n == 0 ? EXH_CMD_RUN : EXH_CMD_NONE;
    return in;
}

static void extreme_inputs(const char *name, int32_t bits, double k_Npm, double b_Nspm)
{
    struct exh_drive_out out;
    fresh();
    set(ID_BITS, bits);
    set(ID_K, (int32_t)(k_Npm * (1 << EXH_Q_K)));
    set(ID_B, (int32_t)(b_Nspm * (1 << EXH_Q_B)));
    set(ID_SLEW_UP, 20000); /* a quarter of f_max a tick: so that slew acts, too */
    set(ID_SLEW_DOWN, 30000);
    must(ready((struct exh_period){1, 2000}) == 0, "set-up", "refused");
    for (uint64_t n = 0; n < 1000000; n++) {
        const struct exh_scene_in in = wild_in(n);
        tick(&in, &out);
    }
    must(rig.w.slew_share > 0.99 && rig.w.force_max == EXH_Q(40, 1, EXH_Q_FORCE), "power",
         "slew %.3f, force %ld", rig.w.slew_share, (long)rig.w.force_max);
    report(name, "f_max and the full slew are reached");
}

/* E-stop, drives, late ticks and commands at random, beside wild inputs. */
static void random_box(void)
{
    struct exh_drive_out out;
    uint64_t seen[3] = {0, 0, 0};
    fresh();
    set(ID_K, EXH_Q(20000, 1, EXH_Q_K));
    must(ready((struct exh_period){1, 2000}) == 0, "set-up", "refused");
    for (uint64_t n = 0; n < 1000000; n++) {
        struct exh_scene_in in = wild_in(n);
        in.command = (uint8_t)(any(8) ? any(5) : any(256));
        if (any(50) == 0) { in.drive.din = (uint32_t)sim_random_u64(&rng); }
        if (any(50) == 0) { in.missed = any(3) ? any(4) : (uint32_t)sim_random_u64(&rng); }
        tick(&in, &out);
        seen[rig.sig.state]++;
    }
    for (int i = 0; i < 3; i++) { must(seen[i] > 10000, "power", "state %d seldom", i); }
    report("e-stop, lateness, commands at random", "every state is seen");
}

/* --- parameters --- */

static int32_t any_value(const struct exh_signal *row)
{
    const uint64_t span = (uint64_t)((int64_t)row->max - row->min) + 1;
    const uint64_t u = sim_random_u64(&rng);
    switch (any(8)) {
    case 0: return row->min;
    case 1: return row->max;
    case 2: return row->dflt;
    case 3: return (int32_t)(row->min + (int64_t)((u % span) >> any(31)));
    default: return (int32_t)(row->min + (int64_t)(u % span));
    }
}

/* All parameters that may change now to random allowed values. */
static void stage_all(int when)
{
    const uint32_t n = exh_signal_count(rig.params.table);
    for (uint32_t i = 0; i < n; i++) {
        uint16_t instance;
        const struct exh_signal *row = exh_signal_at(rig.params.table, i, &instance);
        if (row->when != when) { continue; }
        must(exh_params_stage(&rig.params, row->id, instance, any_value(row)) == 0, "setting", "%s",
             row->name);
    }
}

static void parameters_every_tick(void)
{
    struct exh_drive_out out;
    fresh();
    must(ready((struct exh_period){1, 2000}) == 0, "set-up", "refused");
    for (uint64_t n = 0; n < 1000000; n++) {
        const struct exh_scene_in in = wild_in(n);
        stage_all(EXH_WHEN_ANY);
        exh_params_apply(&rig.params);
        tick(&in, &out);
    }
    report("parameters at random every tick", "");
}

/* Any set-up the tables allow is either refused or keeps the rules. */
static void random_setups(void)
{
    static const struct exh_period T[] = {{1, 1},
                                          {1, 7},
                                          {1, 90},
                                          {1, 2000},
                                          {1, 20000},
                                          {597, 1193182},
                                          {999999937, 1000000007},
                                          {4294967295u, 4294967295u},
                                          {214748, 4294967295u}};
    struct watch sum;
    char besides[64];
    unsigned refused = 0, ran = 0;
    memset(&sum, 0, sizeof sum);
    for (unsigned i = 0; i < 4000 && sum.broken == 0; i++) {
        struct exh_drive_out out;
        int err;
        fresh();
        stage_all(EXH_WHEN_SETUP);
        if (any(2)) { stage_all(EXH_WHEN_ANY); }
        if (any(4)) { /* most of all i_peak and i_cont in the order the scene asks for */
            struct exh_drive_par *d = &rig.staged.drive;
            const int32_t swap = d->i_peak_A_q26;
            d->i_peak_A_q26 = swap < d->i_cont_A_q26 ? d->i_cont_A_q26 : swap;
            d->i_cont_A_q26 = swap < d->i_cont_A_q26 ? swap : d->i_cont_A_q26;
        }
        err = ready(T[any(LEN(T))]);
        must(err <= 0 && err > -EXH_E_COUNT, "set-up", "returned %d", err);
        refused += err != 0;
        ran += err == 0;
        for (uint64_t n = 0; err == 0 && n < 250; n++) {
            const struct exh_scene_in in = wild_in(n);
            tick(&in, &out);
        }
        rig.w.ticks += sum.ticks;
        sum = rig.w;
    }
    must(ran > 1000 && refused > 100, "power", "%u ran, %u refused", ran, refused);
    snprintf(besides, sizeof besides, "refused (%u) or within the rules (%u)", refused, ran);
    report("set-ups at random, last one shown", besides);
}

/* --- heat --- */

/* All the force there is, for a minute: the peak for its time, then i_cont for ever. */
static void full_force(const char *name, struct exh_period T)
{
    const double T_s = (double)T.num / T.den;
    struct exh_drive_out out;
    struct exh_scene_in in = idle_in(0);
    char besides[64];
    double peak_s = 0, last_A = 0;
    fresh();
    set(ID_K, EXH_Q(1000000, 1, EXH_Q_K));
    set(ID_Q_LIM, -EXH_Q(1, 10, EXH_Q_POS));
    must(ready(T) == 0, "set-up", "refused");
    in.command = EXH_CMD_RUN;
    for (double t = 0; t < 60; t += T_s) {
        tick(&in, &out);
        in.command = EXH_CMD_NONE;
        last_A = rig.sig.i_des_A_q26 / 67108864.0;
        if (last_A > 6.59) { peak_s += T_s; }
    }
    snprintf(besides, sizeof besides, "peak %.2f s of 2.7, then %.3f A (3.3 + 1 %%)", peak_s,
             last_A);
    must(peak_s >= 0.7 * 2.7 && peak_s <= 2.7 + T_s, "heat", "peak for %.3f s", peak_s);
    must(last_A >= 3.29 && last_A <= 3.3 * 1.01, "heat", "%.4f A after a minute", last_A);
    report(name, besides);
}

/* Full force and none in turn for so many ticks: the mean heat must end at i_cont, also
 * where the peak's time is no longer than a tick. */
static void pulsed_force(const char *name, struct exh_period T, int32_t peak_ms)
{
    struct exh_drive_out out;
    char besides[64];
    const double T_s = (double)T.num / T.den, excess = 6.6 * 6.6 - 3.3 * 3.3;
    /* for ever, and the budget once */
    const double may = 3.3 * 3.3 + excess * (peak_ms / 1000.0 + 2 * T_s) / (10000 * T_s);
    double sum = 0;
    fresh();
    set(ID_K, EXH_Q(1000000, 1, EXH_Q_K));
    set(ID_PEAK_TIME, peak_ms);
    must(ready(T) == 0, "set-up", "refused");
    for (uint32_t n = 0; n < 10000; n++) {
        struct exh_scene_in in = idle_in(n % 2 ? 5000 : 0);
        in.command = n == 0 ? EXH_CMD_RUN : EXH_CMD_NONE;
        tick(&in, &out);
        sum += rig.sig.i_des_A_q26 / 67108864.0 * (rig.sig.i_des_A_q26 / 67108864.0);
    }
    snprintf(besides, sizeof besides, "mean i^2 %.3f A^2, may %.3f", sum / 10000, may);
    must(sum / 10000 <= may * 1.001, "heat", "mean i^2 %.3f A^2, may %.3f", sum / 10000, may);
    report(name, besides);
}

/* --- counters that wrap --- */

/* A run with the tick counter set; the CRC of everything it gave. */
static uint32_t run_from_tick(uint32_t first, uint32_t fault_at)
{
    struct exh_drive_out out;
    fresh();
    set(ID_K, EXH_Q(20000, 1, EXH_Q_K));
    must(ready((struct exh_period){1, 2000}) == 0, "set-up", "refused");
    rig.state.safety.tick = rig.shadow.safety.tick = first;
    for (uint32_t n = 0; n < 4000; n++) {
        struct exh_scene_in in = idle_in((n / 3) & 0xFFFFFF);
        in.command = n == 0 ? EXH_CMD_RUN : EXH_CMD_NONE;
        if (n == fault_at) { in.drive.din = 0; }
        tick(&in, &out);
    }
    must(rig.state.safety.tick == first + 4000u, "tick", "%lu",
         (unsigned long)rig.state.safety.tick);
    must(rig.state.safety.first_tick == first + fault_at, "first_tick", "%lu",
         (unsigned long)rig.state.safety.first_tick);
    return rig.w.crc;
}

static void tick_counter_wraps(void)
{
    static const uint32_t fault_at[] = {1999, 2000, 2001};
    for (size_t i = 0; i < LEN(fault_at); i++) {
        const uint32_t crc = run_from_tick(0, fault_at[i]);
        const uint32_t wrapped = run_from_tick(UINT32_MAX - 1999, fault_at[i]);
        must(crc == wrapped, "outputs", "CRC %08lx, from tick 0 %08lx", (unsigned long)wrapped,
             (unsigned long)crc);
        if (rig.w.broken) { break; }
    }
    report("tick counter wraps, fault at it", "same bits as from tick 0; its tick is kept");
}

/* The log of the scene's own instance over ticks that pass 2^32, and back out of it: ticks
 * run on, a keyframe stands at tick 0, and from it the rest replays bit for bit. */
static char *write_wrapping_log(uint32_t first, uint32_t ticks, size_t *len_B)
{
    const struct exh_scene *sc = &exh_scene_drop;
    struct posix_config p = posix_config_default();
    char *log = NULL;
    p.log = open_memstream(&log, len_B);
    posix_configure(&p);
    sc->defaults();
    must(p.log != NULL && sc->setup((struct exh_period){1, 2000}) == 0, "set-up", "refused");
    exh_log_start(sc, (struct exh_period){1, 2000});
    for (uint32_t n = 0; n < ticks; n++) {
        struct exh_scene_in in = idle_in(n * 7 % 3000);
        struct exh_drive_out out;
        in.command = n == 0 ? EXH_CMD_RUN : EXH_CMD_NONE;
        exh_log_before(first + n, &in);
        sc->tick(&in, &out);
        exh_log_after(first + n, &in, &out);
    }
    exh_log_end(first + ticks);
    fclose(p.log);
    return log;
}

/* One record back in; the frames behind tick 0's keyframe must come out again. */
static void read_back(const struct exh_record *r, uint32_t *next, int *running)
{
    const struct exh_scene *sc = &exh_scene_drop;
    struct exh_bytes c = exh_bytes_reader(r->payload, r->len_B);
    struct exh_scene_in in = idle_in(0);
    struct exh_drive_out rec, out;
    struct drop_signals sig;
    if (r->type == EXH_RECORD_KEYFRAME && r->tick == 0) {
        exh_log_keyframe_bytes(&c, sc);
        *running = 1;
    }
    if (r->type != EXH_RECORD_FRAME) { return; }
    must(r->tick == *next, "tick", "%lu, want %lu", (unsigned long)r->tick, (unsigned long)*next);
    *next = r->tick + 1;
    if (!*running) { return; }
    memset(&rec, 0, sizeof rec);
    exh_log_frame_bytes(&c, sc, &in, &rec, (int32_t *)&sig);
    sc->tick(&in, &out);
    must(out.dac_raw[0] == rec.dac_raw[0] && memcmp(&sig, sc->signal, sizeof sig) == 0, "replay",
         "tick %lu differs", (unsigned long)r->tick);
    rig.w.ticks++;
}

static void log_wraps(void)
{
    const uint32_t first = UINT32_MAX - 2499;
    uint32_t next = first, seq = 0;
    size_t len_B = 0, at = 0;
    int running = 0;
    char *log;
    fresh();
    log = write_wrapping_log(first, 5000, &len_B);
    while (at < len_B && rig.w.broken == 0) {
        struct exh_record r;
        const int32_t n = exh_record_read(log + at, (uint32_t)(len_B - at), &r);
        must(n > 0, "record", "%ld at %zu", (long)n, at);
        if (n <= 0) { break; }
        must(r.seq == seq++, "sequence", "%lu", (unsigned long)r.seq);
        read_back(&r, &next, &running);
        at += (size_t)n;
    }
    free(log);
    must(next == first + 5000u && running && rig.w.ticks == 2500, "log", "%lu ticks replayed",
         (unsigned long)rig.w.ticks);
    rig.w.q_min = rig.w.q_max = 0;
    report("record ticks wrap", "in order, keyframe at tick 0, rest replays");
}

/* The extended count over all its 32 bits, both ways, at the fastest legal speed. */
static void count_wraps(int32_t step)
{
    struct exh_drive_out out;
    uint32_t raw = 0;
    int32_t cnt = 0;
    fresh();
    must(ready((struct exh_period){1, 2000}) == 0, "set-up", "refused");
    for (uint32_t n = 0; n < 2000; n++) {
        struct exh_scene_in in = idle_in(raw & 0xFFFFFF);
        in.command = n == 0 ? EXH_CMD_RUN : EXH_CMD_NONE;
        tick(&in, &out);
        must(rig.state.quad.cnt == cnt, "count", "%ld, want %ld", (long)rig.state.quad.cnt,
             (long)cnt);
        must(n < 2 || (rig.sig.qd_mps_q27 > 0) == (step > 0), "velocity", "%ld",
             (long)rig.sig.qd_mps_q27);
        raw += (uint32_t)step;
        cnt = exh_wrap_add(cnt, step);
    }
    report(step > 0 ? "count wraps upward" : "count wraps downward",
           "exact, velocity keeps its sign");
}

/* --- force limits that move --- */

static void tiny_slew(void)
{
    struct exh_drive_out out;
    fresh();
    set(ID_K, EXH_Q(1000000, 1, EXH_Q_K));
    set(ID_SLEW_UP, 1);
    set(ID_SLEW_DOWN, 1);
    must(ready((struct exh_period){1, 20000}) == 0, "set-up", "refused");
    for (uint64_t n = 0; n < 200000; n++) {
        struct exh_scene_in in = idle_in(n % 2000 < 1000 ? 0x7FFFFF : 0);
        in.command = n == 0 ? EXH_CMD_RUN : EXH_CMD_NONE;
        tick(&in, &out);
    }
    must(rig.w.force_max > 0 && rig.w.force_max <= EXH_Q(1, 10, EXH_Q_FORCE), "slew", "rose to %ld",
         (long)rig.w.force_max);
    report("slew 1 N/s at 20000 Hz, square demand", "F below 0.1 N: it may rise for 50 ms");
}

int main(void)
{
    rng.state = 1;
    exh_scene_drop.defaults(); /* its table is the one the rig uses */
    printf("In every tick: output, ledgers, force, slew, code, current, heat, signals (see "
           "source).\n");
    all_closed();
    extreme_inputs("extreme inputs, 24 bits", 24, 20000, 60);
    extreme_inputs("extreme inputs, 16 bits, k 1e6, b 1e3", 16, 1e6, 1e3);
    extreme_inputs("extreme inputs, 32 bits, k 1e6, b 1e3", 32, 1e6, 1e3);
    random_box();
    parameters_every_tick();
    random_setups();
    full_force("full force for a minute, 2000 Hz", (struct exh_period){1, 2000});
    full_force("full force for a minute, 7 Hz", (struct exh_period){1, 7});
    full_force("full force for a minute, 20000 Hz", (struct exh_period){1, 20000});
    pulsed_force("pulses, 2000 Hz", (struct exh_period){1, 2000}, 100);
    pulsed_force("pulses, 1 Hz", (struct exh_period){1, 1}, 2700);
    pulsed_force("pulses, 90 Hz, peak for 1 ms", (struct exh_period){1, 90}, 1);
    tick_counter_wraps();
    log_wraps();
    count_wraps(0x7FFFFF);
    count_wraps(-0x7FFFFF);
    tiny_slew();
    printf("%d failed\n", failures);
    return failures != 0;
}
