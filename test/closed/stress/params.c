/* SPDX-License-Identifier: MIT */
/* Parameters: any the tables allow, at set-up and while it runs. */
#include "stress.h"

static int32_t any_value(const struct exh_signal *row)
{
    const uint64_t span = (uint64_t)((int64_t)row->max - row->min) + 1;
    const uint64_t u = any_u64();
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
        if (row->id == exh_calib_set_rows[2].id) { continue; } /* uncalibrated: it would not arm */
        must(exh_params_stage(&rig.params, row->id, instance, any_value(row)) == 0, "setting", "%s",
            row->name);
    }
}

static void stage_force(void)
{
    stage_all(EXH_WHEN_SLEWED);
    stage_all(EXH_WHEN_LIMIT);
    stage_all(EXH_WHEN_WALL);
}

/* Parameters that act immediately. */
static void stage_rest(void)
{
    static const int when[] = {
        EXH_WHEN_ANY, EXH_WHEN_BOUND, EXH_WHEN_REST, EXH_WHEN_MATERIAL, EXH_WHEN_WORD};
    for (size_t i = 0; i < sizeof when / sizeof when[0]; i++) { stage_all(when[i]); }
}

static void parameters_every_tick(int32_t tune_ms)
{
    struct exh_drive_out out;
    fresh();
    rig.blind = 1;
    set(ID_TUNE_TIME, tune_ms);
    set(ID_ARM_TIME, 1);
    set(ID_RAMP_TIME, 5);
    start((struct exh_period){1, 2000});
    for (uint64_t n = 0; n < cases; n++) {
        const struct exh_scene_in in = handled_in(n);
        stage_rest();
        /* Held for a while, too, or none would ever come near its ends. */
        if (any(n / 4096 % 2 ? 1 : 256) == 0) { stage_force(); }
        if (!exh_safety_is_running(&rig.state.safety)) {
            set(ID_F0, 0);
        } /* more than arm_force: it would not arm */
        apply();
        tick(&in, &out);
    }
    must(
        rig.w.in[EXH_STATE_RUN] + rig.w.in[EXH_STATE_LIMIT] > cases / 10, "power", "seldom in RUN");
    report(
        "parameters at random every tick", tune_ms ? "little by little, as each may" : "at once");
}

/* Random set-ups; of most, so that they arm: no supply judged, no pull-back force. */
static void stage_setup(void)
{
    stage_all(EXH_WHEN_SETUP);
    stage_all(EXH_WHEN_PERSON);
    if (any(8)) { set(ID_SUPPLY_MIN, 0); }
    if (any(2)) {
        stage_rest();
        stage_force();
        if (any(4)) { set(ID_F0, 0); }
    }
    if (any(2)) { set(ID_ARM_TIME, 1); }
    if (any(2)) { set(ID_RAMP_TIME, 1 + (int32_t)any(20)); }
    if (any(4)) { /* most of all i_peak and i_cont in the order the scene asks for */
        struct exh_drive_par *d = &rig.staged.drive;
        const int32_t swap = d->i_peak_A_q26;
        d->i_peak_A_q26 = swap < d->i_cont_A_q26 ? d->i_cont_A_q26 : swap;
        d->i_cont_A_q26 = swap < d->i_cont_A_q26 ? swap : d->i_cont_A_q26;
    }
}

/* Any set-up the tables allow is either refused or keeps the rules. */
static void random_setups(void)
{
    static const struct exh_period T[] = {{1, 1}, {1, 7}, {1, 90}, {1, 2000}, {1, 20000},
        {597, 1193182}, {999999937, 1000000007}, {4294967295u, 4294967295u}, {214748, 4294967295u}};
    struct watch sum;
    char besides[64];
    unsigned refused = 0, ran = 0, runs = 0;
    const unsigned setups = (unsigned)(cases / 250);
    memset(&sum, 0, sizeof sum);
    for (unsigned i = 0; i < setups && sum.broken == 0; i++) {
        struct exh_drive_out out;
        int err;
        fresh();
        rig.blind = any(2) == 0;
        rig.enc_bits = (uint8_t)(15 + any(18)); /* 15: refused */
        stage_setup();
        err = ready(T[any(LEN(T))]);
        must(err <= 0 && err > -EXH_E_COUNT, "set-up", "returned %d", err);
        refused += err != 0;
        ran += err == 0;
        for (uint64_t n = 0; err == 0 && n < 250; n++) {
            const struct exh_scene_in in = handled_in(n);
            tick(&in, &out);
        }
        runs += rig.w.in[EXH_STATE_RUN] + rig.w.in[EXH_STATE_LIMIT] > 0;
        rig.w.ticks += sum.ticks;
        sum = rig.w;
    }
    must(ran > setups / 4 && refused > setups / 40 && runs > ran / 8, "power",
        "%u ran, %u of them armed, %u refused", ran, runs, refused);
    snprintf(besides, sizeof besides, "refused (%u) or within the rules (%u, %u in RUN)", refused,
        ran, runs);
    report("set-ups at random, last one shown", besides);
}

void random_parameters(void)
{
    parameters_every_tick(0);
    parameters_every_tick(20);
    random_setups();
}
