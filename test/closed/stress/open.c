/* SPDX-License-Identifier: MIT */
/* Open loop: inputs no device could give. */
#include "stress.h"

static const struct extreme {
    const char *name;
    uint8_t bits;
    double k_Npm, b_Nspm;
} extreme[] = {
    {"extreme inputs, 24 bits", 24, 20000, 60},
    {"extreme inputs, 16 bits, k 1e6, b 1e3", 16, 1e6, 1e3},
    {"extreme inputs, 32 bits, k 1e6, b 1e3", 32, 1e6, 1e3},
};

static void extreme_inputs(const struct extreme *c)
{
    struct exh_drive_out out;
    fresh();
    rig.enc_bits = c->bits;
    rig.blind = 1;
    set_gains(c->k_Npm, c->b_Nspm);
    set(ID_SLEW_UP, 20000); /* half the peak force a tick: so that slew acts, too */
    set(ID_SLEW_DOWN, 30000);
    set(ID_ARM_TIME, 1);
    set(ID_RAMP_TIME, 5);
    start((struct exh_period){1, 2000});
    for (uint64_t n = 0; n < cases; n++) {
        /* Of 32 bits, half the range is beyond even the blind. */
        const struct exh_scene_in in = handled_in(n);
        tick(&in, &out);
    }
    must(
        rig.w.in[EXH_STATE_RUN] + rig.w.in[EXH_STATE_LIMIT] > cases / 10, "power", "seldom in RUN");
    must(rig.w.slew_share > 0.99 && rig.w.force_max == rig.cfg.drive.f_top_N_q20, "power",
        "slew %.3f, force %ld", rig.w.slew_share, (long)rig.w.force_max);
    report(c->name, "the table's end and the full slew are reached");
}

/* E-stop, drives, late ticks and commands at random, beside wild inputs. */
static void random_box(void)
{
    struct exh_drive_out out;
    fresh();
    rig.blind = 1;
    set(ID_K, EXH_Q(20000, 1, EXH_Q_K));
    set(ID_ARM_TIME, 1);
    set(ID_RAMP_TIME, 5);
    start((struct exh_period){1, 2000});
    for (uint64_t n = 0; n < cases; n++) {
        struct exh_scene_in in = handled_in(n);
        if (any(20) == 0) { in.command = (uint8_t)(any(8) ? any(5) : any(256)); }
        if (any(200) == 0) { in.drive.din = (uint32_t)any_u64(); }
        if (any(200) == 0) { in.drive.din ^= UINT32_C(1) << any(9); }
        if (any(500) == 0) { in.missed = any(3) ? any(4) : (uint32_t)any_u64(); }
        tick(&in, &out);
    }
    for (int i = 0; i < EXH_STATES; i++) {
        must(rig.w.in[i] > cases / 200, "power", "state %d seldom: %" PRIu64, i, rig.w.in[i]);
    }
    report("e-stop, lateness, commands at random", "every state is seen");
}

static void tiny_slew(void)
{
    struct exh_drive_out out;
    fresh();
    set(ID_K, EXH_Q(1000000, 1, EXH_Q_K));
    set(ID_SLEW_UP, 1);
    set(ID_F0, 0);
    rig.blind = 1;
    start((struct exh_period){1, 20000});
    arm();
    for (uint64_t n = 0; n < 200000; n++) {
        const struct exh_scene_in in = idle_in(1, n % 2000 < 1000 ? 0x7FFFFF : 0);
        tick(&in, &out);
    }
    must(rig.w.force_max > 0 && rig.w.force_max <= EXH_Q(51, 1000, EXH_Q_FORCE), "slew",
        "rose to %ld", (long)rig.w.force_max);
    report("slew 1 N/s at 20000 Hz, square demand", "F below 0.051 N: it may rise for 50 ms");
}

/* A string that runs out and in at 4 m/s, for less time than speed_time and for more. */
static void too_fast(void)
{
    const uint32_t step = 30, brief = 36, brief_n = 2952, on = 60;
    struct exh_drive_out out;
    fresh();
    set(ID_K, 0);
    start((struct exh_period){1, 2000});
    arm();
    for (uint32_t n = 0; n < 4000; n++) {
        const uint32_t run = n < brief_n ? brief : on;
        const uint32_t at = (n < brief_n ? n : n - brief_n) % (2 * run);
        const struct exh_scene_in in = idle_in(1, (at < run ? at : 2 * run - at) * step);
        tick(&in, &out);
        must(n >= brief_n || rig.sig.faults == 0, "speed", "a fault in %lu", (unsigned long)n);
    }
    must(rig.sig.faults == EXH_FAULT_SPEED, "speed", "faults %#lx", (unsigned long)rig.sig.faults);
    report("4 m/s for 18 ms, then for 30 ms", "the fault in time, and not before");
}

/* A release from 10 N in which the table gets twice as steep in its tick `at`. */
static void steepened(unsigned at)
{
    struct exh_knot *knot = rig.cfg.calib.force_to_cur;
    struct exh_drive_out out;
    fresh();
    rig.blind = 1;
    set(ID_K, EXH_Q(20000, 1, EXH_Q_K));
    start((struct exh_period){1, 2000});
    arm();
    for (unsigned n = 0; n < 60; n++) {
        struct exh_scene_in in = idle_in(1, 1076); /* 0.5 mm into the wall */
        if (n == 10) { in.command = EXH_CMD_OFF; }
        must(
            n != 10 || rig.box.held > EXH_Q(8, 1, EXH_Q_FORCE), "power", "%ld", (long)rig.box.held);
        if (n == 10 + at) {
            for (unsigned k = 0; k < rig.cfg.calib.to_cur_n; k++) { knot[k].y *= 2; }
            must(exh_table_setup(knot, rig.cfg.calib.to_cur_n) == 0, "set-up", "table refused");
        }
        tick(&in, &out);
    }
    must(rig.sig.state == EXH_STATE_OFF, "state", "%ld", (long)rig.sig.state);
}

static void codes_let_go(void)
{
    for (unsigned at = 0; at < 30; at++) {
        steepened(at);
        if (rig.w.broken) { break; }
    }
    report("force table changes in a release", "a code let go never rises");
}

void open_loops(void)
{
    for (size_t i = 0; i < LEN(extreme); i++) { extreme_inputs(&extreme[i]); }
    random_box();
    tiny_slew();
    too_fast();
    codes_let_go();
}
