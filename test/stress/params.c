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
        if (row->id == calib_rows[CALIB_ROWS - 1].id) { continue; } /* uncalibrated: it would not arm */
        must(exh_params_stage(&rig.params, row->id, instance, any_value(row)) == 0, "setting", "%s",
             row->name);
    }
}

static void parameters_every_tick(int32_t tune_ms)
{
    const struct exh_period T = {1, 2000};
    const struct exh_tune_par tune = {tune_ms};
    struct exh_drive_out out;
    fresh();
    rig.blind = 1;
    start(T);
    exh_params_slew(&rig.params, &tune, T);
    for (uint64_t n = 0; n < 1000000; n++) {
        const struct exh_scene_in in = wild_in(n);
        stage_all(EXH_WHEN_ANY);
        stage_all(EXH_WHEN_SLEWED);
        exh_params_apply(&rig.params);
        tick(&in, &out);
    }
    report("parameters at random every tick", tune_ms ? "little by little" : "at once");
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
        rig.blind = any(2) == 0;
        rig.enc_bits = (uint8_t)(15 + any(18)); /* 15: refused */
        stage_all(EXH_WHEN_SETUP);
        if (any(2)) { stage_all(EXH_WHEN_ANY); }
        if (any(2)) { stage_all(EXH_WHEN_SLEWED); }
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

void random_parameters(void)
{
    parameters_every_tick(0);
    parameters_every_tick(20);
    random_setups();
}
