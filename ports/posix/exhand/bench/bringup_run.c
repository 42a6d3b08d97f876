/* SPDX-License-Identifier: MIT */
#include "bench/bringup_run.h"

#include "base/assign.h"
#include "base/option.h"
#include "base/param.h"

#include "exhand/run/deadman.h"
#include "exhand/run/loop.h"

#include "exhand/error.h"

#include <stdio.h>
#include <string.h>

const struct bringup_wrong_row bringup_wrong_row[BRINGUP_WRONGS] = {
    {"nothing", "all is well"},
    {"motor_reversed", "the motor's leads are exchanged"},
    {"encoder_reversed", "the encoder's lines are exchanged"},
    {"unplugged", "the encoder is unplugged: its count stands still"},
    {"comes_off", "the encoder's plug comes off while current flows"},
    {"stuck", "the rotor does not turn"},
    {"monitor_dead", "the monitor shows 0 V"},
    {"monitor_half", "the monitor shows half of what it should"},
    {"da_still", "the D/A keeps its voltage"},
    {"not_ready", "the drive is not ready"},
    {"estop", "the emergency stop is open"},
    {"let_go", "the dead-man switch is let go"},
    {"slipped", "the balance is off the string"},
    {"away", "no person acts"},
    {"held", "the dead-man switch is held before it is asked for"},
};

static struct {
    const struct bringup_run_cfg *cfg;
    struct bringup_run *out;
    struct exh_drive_out last; /* of the box */
    uint16_t held_raw;         /* the D/A's code when it stopped moving */
    int phase;                 /* that the person was shown, */
    int began;                 /* whether it has begun, */
    double since_s, from_m;    /* and since when, and from where */
    double wrong_s, end_s, ended_m, turn_s;
    int hooked, held, wrong;
} run;

static double now_s(void) { return posix_time_s(); }

static const struct bringup_own_par *own(void) { return &bringup_config()->par->own; }

/* String at the motor, whatever the encoder says of it. */
static double string_m(void)
{
    const struct sim_finger *finger = posix_finger(0);
    return finger ? finger->plant.q_m : posix_plant()->q_m;
}

static double si(int32_t raw, int frac) { return (double)raw / (double)(INT64_C(1) << frac); }

/* --- the person --- */

/* String drawn out by hand: 25 mm and back in two seconds. */
static double hand_m(double t_s)
{
    const double u = t_s < 0.5 || t_s > 2.5 ? 0 : t_s < 1.5 ? t_s - 0.5 : 2.5 - t_s;
    return 0.025 * u * u * (3 - 2 * u);
}

static int between(double t_s, double from_s, double to_s) { return t_s >= from_s && t_s < to_s; }

static void hook(void)
{
    if (run.hooked) { return; }
    run.hooked = 1;
    posix_bench(BENCH_MASS, own()->mass_kg_q20 ? si(own()->mass_kg_q20, EXH_Q_FORCE) : 1);
}

/* The hand goes all the way back, also when the scene has seen enough. */
static void turn(struct exh_drive_in *in, int asked)
{
    double cnt;
    int32_t by;
    if (asked && !(run.turn_s > 0)) { run.turn_s = now_s() + 1e-9; }
    if (!(run.turn_s > 0)) { return; }
    cnt = hand_m(now_s() - run.turn_s) / si(bringup_config()->par->quad.step_m_q42, EXH_Q_STEP);
    by = run.cfg->wrong == BRINGUP_ENCODER_REVERSED ? -(int32_t)cnt : (int32_t)cnt;
    in->enc_raw[0] = (in->enc_raw[0] + (uint32_t)by) & 0xFFFFFF;
}

/* What the switches are, and the encoder, by hand. */
static void hands(struct exh_drive_in *in)
{
    const struct bringup *s = bringup_state();
    const struct bringup_phase *p = bringup_phase(bringup_config()->list, s->phase);
    const unsigned ask = p ? p->ask : BRINGUP_ASK_NOTHING;
    double t_s;
    if (run.phase != (int)s->phase || run.began != s->busy) {
        run.phase = (int)s->phase;
        run.began = s->busy;
        run.since_s = now_s();
        run.from_m = string_m();
    }
    t_s = now_s() - run.since_s;
    in->din &= ~(uint32_t)EXH_DIN_DEADMAN;
    if (run.wrong && run.cfg->wrong == BRINGUP_AWAY) { return; }
    turn(in, ask == BRINGUP_ASK_TURN);
    if (ask == BRINGUP_ASK_INPUTS) {
        if (between(t_s, 0.5, 1)) { in->din &= ~(uint32_t)EXH_DIN_ESTOP; }
        if (between(t_s, 1.5, 2)) { in->din |= EXH_DIN_DEADMAN; }
        if (between(t_s, 2.5, 3)) { in->din &= ~((uint32_t)EXH_DIN_DRIVE0 << own()->finger); }
    } else if (ask == BRINGUP_ASK_HOOK) {
        if (!run.hooked && t_s > 0.3) { run.held = 0; } /* having read the question */
        if (!run.held && t_s > 0.5) { hook(); }
        if (t_s > 2.5) { run.held |= run.hooked && posix_bench_ready(); }
    } else if (ask == BRINGUP_ASK_HOLD && t_s > 0.3) {
        run.held = 1;
    }
    if (run.held) { in->din |= EXH_DIN_DEADMAN; }
}

/* --- what is wrong --- */

static void look_for_wrong(void)
{
    const struct bringup *s = bringup_state();
    if (run.wrong || run.cfg->wrong == BRINGUP_RIGHT) { return; }
    if (run.cfg->wrong_phase >= 0 &&
        (s->phase < run.cfg->wrong_phase ||
            (s->phase == run.cfg->wrong_phase && (!s->busy || now_s() - run.since_s < 0.2)))) {
        return;
    }
    run.wrong = 1;
    run.held_raw = run.last.dac_raw[own()->finger];
    run.wrong_s = now_s();
    if (run.cfg->wrong == BRINGUP_SLIPPED) { posix_bench(BENCH_SLACK, 0); }
}

static void wrong_in(struct exh_drive_in *in)
{
    static uint32_t plugged_raw;
    const uint32_t ready = (uint32_t)EXH_DIN_DRIVE0 << own()->finger;
    if (!run.wrong) { plugged_raw = in->enc_raw[0]; }
    if (!run.wrong) { return; }
    if (run.cfg->wrong == BRINGUP_UNPLUGGED || run.cfg->wrong == BRINGUP_COMES_OFF) {
        in->enc_raw[0] = plugged_raw;
    }
    if (run.cfg->wrong == BRINGUP_MONITOR_DEAD) { in->mon_raw[0] = 0; }
    if (run.cfg->wrong == BRINGUP_MONITOR_HALF) { in->mon_raw[0] /= 2; }
    if (run.cfg->wrong == BRINGUP_NOT_READY) { in->din &= ~ready; }
    if (run.cfg->wrong == BRINGUP_ESTOP) { in->din &= ~(uint32_t)EXH_DIN_ESTOP; }
    if (run.cfg->wrong == BRINGUP_HELD) { in->din |= EXH_DIN_DEADMAN; }
    if (run.cfg->wrong == BRINGUP_LET_GO) { in->din &= ~(uint32_t)EXH_DIN_DEADMAN; }
}

/* --- wires: the device's one axis is the finger's --- */

static void wires_in(struct exh_drive_in *in)
{
    const int32_t k = own()->finger;
    const double V = run.last.dac_raw[k] - 32768.0;
    uint32_t enc_raw;
    int16_t mon_raw;
    if (own()->stage == 1) { /* the D/A's voltage, 3249 codes/V, on the A/D's 32768 for 10 V */
        in->mon_raw[0] = (int16_t)(V * 32768 / 32490 + (V < 0 ? -0.5 : 0.5));
    }
    hands(in);
    look_for_wrong();
    if (own()->stage == 1 && run.wrong && run.cfg->wrong == BRINGUP_DA_STILL) {
        in->mon_raw[0] = (int16_t)(((double)run.held_raw - 32768) * 32768 / 32490);
    }
    wrong_in(in);
    enc_raw = in->enc_raw[0];
    mon_raw = in->mon_raw[0];
    in->enc_raw[0] = in->enc_raw[k];
    in->mon_raw[0] = in->mon_raw[k];
    in->enc_raw[k] = enc_raw;
    in->mon_raw[k] = mon_raw;
}

static void wires_out(struct exh_drive_out *out)
{
    const int32_t k = own()->finger;
    run.last = *out;
    out->dac_raw[0] = run.last.dac_raw[k];
    out->enable = run.last.enable >> k & 1;
    if (run.wrong && run.cfg->wrong == BRINGUP_DA_STILL) { out->dac_raw[0] = run.held_raw; }
}

/* --- the loop's hooks --- */

/* Force in the string that the balance holds; a person reads it to 10 mN. */
static void read_balance(void)
{
    const struct bringup *s = bringup_state();
    const struct plant *p = posix_plant();
    const double T_N = run.cfg->board.device.cable_npm * (p->x_m - p->q_m);
    if (!(s->tell & BRINGUP_TELL_LEVEL) || own()->stage != 4) { return; }
    run.out->balance_N[s->told_level] = (double)(int)((T_N > 0 ? T_N : 0) * 100 + 0.5) / 100;
    if (run.cfg->board.log) {
        fprintf(run.cfg->board.log, "        (the balance reads %.2f N)\n",
            run.out->balance_N[s->told_level]);
    }
}

static void after(uint32_t tick, const struct exh_scene_in *in, const struct exh_drive_out *out)
{
    const struct bringup *s = bringup_state();
    struct bringup_signals sig;
    double cur_A;
    (void)tick;
    (void)in;
    memcpy(&sig, exh_scene_signals(&exh_scene_bringup), sizeof sig);
    cur_A = si(sig.i_des_A_q26, EXH_Q_CUR);
    read_balance();
    for (unsigned i = 0; i < EXH_FINGERS; i++) { /* the others' drives */
        run.out->unsafe += (int32_t)i != own()->finger &&
                           (out->dac_raw[i] != bringup_config()->par->drive.dac_zero_raw ||
                               (out->enable >> i & 1));
    }
    if (s->result == EXH_PROBE_BUSY) {
        if (out->enable && cur_A > run.out->most_A) { run.out->most_A = cur_A; }
        return;
    }
    if (run.out->result == EXH_PROBE_BUSY) {
        run.out->phase = s->told_phase;
        run.out->result = s->result;
        run.end_s = now_s();
        run.out->took_s = run.end_s - (run.wrong_s > run.since_s ? run.wrong_s : run.since_s);
        run.ended_m = run.from_m;
        if (s->result == EXH_PROBE_DONE && bringup_config()->list <= BRINGUP_STAGES) {
            run.out->number = bringup_config()->number;
        }
    }
    run.out->unsafe += sig.state == EXH_STATE_RUN && now_s() > run.end_s + 0.1;
    for (unsigned i = 0; i < EXH_FINGERS; i++) {
        run.out->unsafe +=
            out->enable != 0 || out->dac_raw[i] != bringup_config()->par->drive.dac_zero_raw;
    }
    run.out->moved_m = string_m() - run.ended_m;
    if (now_s() > run.end_s + 0.2) { posix_stop(); }
}

/* --- a run --- */

/* "name=value name=value ...". 0, or -EXH_E… after a line on stderr. */
static int set_parameters(const char *boot)
{
    char word[64], name[ASSIGN_NAME_B];
    int n = 0;
    exh_scene_bringup.defaults();
    for (; sscanf(boot, " %63s%n", word, &n) == 1; boot += n) {
        double value;
        int err;
        if (assign_split("boot", word, name, &value)) { return -EXH_E_RANGE; }
        err = cli_param_set_by(exh_scene_bringup.params, "--boot: ", name, value);
        if (err < 0) { return err; }
    }
    return 0;
}

static int weighs(void)
{
    uint32_t at = 0;
    return cli_signal_find(exh_scene_bringup.params->table, "mass", &at) != NULL &&
           exh_scene_bringup.params->staged[at] > 0;
}

static void place(struct posix_config *board)
{
    const enum bringup_wrong w = run.cfg->wrong;
    const int32_t stage =
        exh_scene_bringup.params->staged[EXH_QUAD_ROWS + EXH_DRIVE_ROWS + EXH_SAFETY_ROWS];
    board->bench = stage < 5;
    board->drives = (1u << EXH_FINGERS) - 1u;
    board->wires_in = wires_in;
    board->wires_out = wires_out;
    board->wrong = w == BRINGUP_MOTOR_REVERSED     ? BENCH_MOTOR_REVERSED
                   : w == BRINGUP_ENCODER_REVERSED ? BENCH_ENCODER_REVERSED
                   : w == BRINGUP_SLIPPED          ? BENCH_NO_MASS
                                                   : 0u;
    if (stage <= 2 || w == BRINGUP_STUCK) { board->wrong |= BENCH_STUCK; } /* a load */
    if (stage == 4 && w != BRINGUP_SLIPPED && !weighs()) {
        board->wrong |= BENCH_FIXED_MASS;
    }                 /* a stiff balance */
    if (stage == 5) { /* a finger that stays where it is, bent */
        board->exo.fingers = 1;
        board->exo.path[0].start_m = 0.03;
        board->exo.path[0].first_s = 1e6;
    }
}

int bringup_run(const struct bringup_run_cfg *cfg, struct bringup_run *out)
{
    static const struct exh_loop_hooks hooks = {exh_deadman_start, exh_deadman_before, after};
    struct posix_config board = cfg->board;
    int err;
    memset(out, 0, sizeof *out);
    memset(&run, 0, sizeof run);
    run.cfg = cfg;
    run.out = out;
    run.phase = -1;
    for (unsigned i = 0; i < EXH_FINGERS; i++) { run.last.dac_raw[i] = 32768; }
    err = set_parameters(cfg->boot);
    if (err < 0) { return err; }
    place(&board);
    posix_configure(&board);
    err = exh_loop(&exh_scene_bringup, cfg->rate_Hz, &hooks);
    if (err < 0) { cli_complain("%s", exh_error_text(err)); }
    return err;
}
