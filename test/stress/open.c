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
    start((struct exh_period){1, 2000});
    for (uint64_t n = 0; n < 1000000; n++) {
        struct exh_scene_in in = wild_in(n);
        /* Of 32 bits, half the range is beyond even the blind. */
        in.command = rig.sig.state == EXH_STATE_FAULT ? EXH_CMD_CLEAR : EXH_CMD_RUN;
        tick(&in, &out);
    }
    must(rig.w.slew_share > 0.99 && rig.w.force_max == rig.cfg.drive.f_top_N_q20, "power",
         "slew %.3f, force %ld", rig.w.slew_share, (long)rig.w.force_max);
    report(c->name, "the table's end and the full slew are reached");
}

/* E-stop, drives, late ticks and commands at random, beside wild inputs. */
static void random_box(void)
{
    struct exh_drive_out out;
    uint64_t seen[3] = {0, 0, 0};
    fresh();
    rig.blind = 1;
    set(ID_K, EXH_Q(20000, 1, EXH_Q_K));
    start((struct exh_period){1, 2000});
    for (uint64_t n = 0; n < 1000000; n++) {
        struct exh_scene_in in = wild_in(n);
        in.command = (uint8_t)(any(8) ? any(5) : any(256));
        if (any(50) == 0) { in.drive.din = (uint32_t)any_u64(); }
        if (any(2000) == 0) { in.missed = any(3) ? any(4) : (uint32_t)any_u64(); }
        tick(&in, &out);
        seen[rig.sig.state]++;
    }
    for (int i = 0; i < 3; i++) { must(seen[i] > 10000, "power", "state %d seldom", i); }
    report("e-stop, lateness, commands at random", "every state is seen");
}

static void tiny_slew(void)
{
    struct exh_drive_out out;
    fresh();
    set(ID_K, EXH_Q(1000000, 1, EXH_Q_K));
    set(ID_SLEW_UP, 1);
    rig.blind = 1;
    start((struct exh_period){1, 20000});
    for (uint64_t n = 0; n < 200000; n++) {
        const struct exh_scene_in in = idle_in(n, n % 2000 < 1000 ? 0x7FFFFF : 0);
        tick(&in, &out);
    }
    must(rig.w.force_max > 0 && rig.w.force_max <= EXH_Q(1, 10, EXH_Q_FORCE), "slew", "rose to %ld",
         (long)rig.w.force_max);
    report("slew 1 N/s at 20000 Hz, square demand", "F below 0.1 N: it may rise for 50 ms");
}

void open_loops(void)
{
    for (size_t i = 0; i < LEN(extreme); i++) { extreme_inputs(&extreme[i]); }
    random_box();
    tiny_slew();
}
