/* SPDX-License-Identifier: MIT */
/* Closed loop over the simulated device: gains, masses, rates and encoders at their ends. */
#include "stress.h"

#include "posix.h"
#include "sim/plant.h"

#include "exhand/board.h"

enum tweak { PLAIN, NO_FRICTION, FREE, STIFF_CABLE, HALF, ALMOST_HALF };

struct closed {
    const char *name;
    double k_Npm, b_Nspm, mass_kg;
    struct exh_period T;
    enum tweak tweak;
    double lo_mm, hi_mm; /* the motor's travel must stay between; 0, 0: not asked */
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

/* The scene's parameters are those of this device. */
static void set_device(const struct sim_device *d)
{
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
    p.wait = 1;
    p.T = c->T;
    if (c->tweak == NO_FRICTION || c->tweak == FREE) {
        p.device.mu_motor = p.device.mu_mass = p.device.coulomb_n = p.device.viscous_nspm = 0;
    }
    if (c->tweak == STIFF_CABLE) { p.device.cable_npm = 1e6; }
    if (!plant_step_will_do(&p.device, 0, 0)) {
        p.device.substep_s = plant_step_that_will_do(&p.device, 0, 0);
    }
    return p;
}

/* What an encoder that jumps adds to its count, so many ticks in RUN. */
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
    struct exh_scene_in in = idle_in(0, 0);
    struct exh_drive_out out;
    struct exh_period T = {1, 1};
    double start_m = 0;
    uint64_t ran = 0;
    fresh();
    set_gains(c->k_Npm, c->b_Nspm);
    set_device(&p.device);
    posix_configure(&p);
    if (c->tweak == FREE) { set(ID_F0, 0); }
    must(exh_board_init(0, &T) == 0, "set-up", "no board");
    start(T);
    while (rig.w.broken == 0 && exh_board_wait() >= 0) {
        exh_board_read_drive(&in.drive);
        if (rig.w.ticks == 0) { start_m = posix_plant()->q_m; }
        in.drive.enc_raw[0] = (in.drive.enc_raw[0] + jump_at(c, ran)) & 0xFFFFFF;
        tick(&in, &out);
        exh_board_write_drive(&out);
        if (exh_safety_is_running(&rig.state.safety) || ran > 0) { ran++; }
        if (ran == 1) { posix_ready(); }
        must(c->hi_mm <= c->lo_mm || rig.sig.faults == 0, "fault", "%#lx",
            (unsigned long)rig.sig.faults);
        if (rig.state.quad.lost && c->tweak < HALF) {
            /* 5 kg outrun the drive, the fall and all: no position any more, and no force. */
            must(c->mass_kg == 5 && rig.sig.faults == (EXH_FAULT_SPEED | EXH_FAULT_ENCODER),
                "fault", "%#lx", (unsigned long)rig.sig.faults);
        } else if (c->tweak < HALF) {
            check_position(&p.device, start_m);
        } else { /* never a newton from a count that lies */
            must(ran <= 97 || (rig.state.safety.first == EXH_FAULT_ENCODER &&
                                  (rig.sig.faults & ~EXH_FAULT_SPEED) == EXH_FAULT_ENCODER),
                "fault", "%#lx", (unsigned long)rig.sig.faults);
        }
        in.command = EXH_CMD_NONE;
    }
}

/* Travel is from the start, +-1 mm; the wall is at 70 mm. Where the loop is much faster than the
 * mass, the drive's 27 N must stop 0.55 kg, 0.34 J, within 17 mm. The first tick and the output
 * delay add 2 mm: 90 mm. (At 90 Hz 11 ms add 13 mm: 110.) A late force may throw the mass up, but
 * not above its start: -3 mm.
 *
 * Some cases have no limits of motion. Below 90 Hz the mass has passed before the loop reads it. 5
 * kg are more than the motor can hold. Others have no gains, or a wrong encoder.
 *
 * F0 outweighs 1 g and winds it up, against 3 Ns/m of friction at 36 mm/s at most for 3 s.
 * On a rotor without friction, a late wall throws 1 g back with more energy than it had: 300 mm are
 * allowed. */
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

void closed_loops(void)
{
    for (size_t i = 0; i < LEN(closed_case); i++) {
        const struct closed *c = &closed_case[i];
        char besides[64];
        run_closed(c);
        snprintf(besides, sizeof besides, "%s",
            c->tweak < HALF ? "q is the plant's to 2 counts" : "an encoder fault at the first");
        if (c->hi_mm > c->lo_mm) {
            const double lo = rig.w.q_min / 1073741.824, hi = rig.w.q_max / 1073741.824;
            must(rig.w.in[EXH_STATE_RUN] + rig.w.in[EXH_STATE_LIMIT] > rig.w.ticks / 2, "power",
                "seldom in RUN");
            snprintf(besides + strlen(besides), sizeof besides - strlen(besides), ", %g..%g mm",
                c->lo_mm, c->hi_mm);
            must(lo >= c->lo_mm && hi <= c->hi_mm, "motion", "%.1f..%.1f mm", lo, hi);
        }
        report(c->name, besides);
    }
}
