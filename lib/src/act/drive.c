/* SPDX-License-Identifier: MIT */
/* Set-up of an axis; force limit, slew limit and current limits in the tick. */
#include "exhand/drive.h"

#include "exhand/error.h"
#include "exhand/fix.h"

#include <stddef.h>

/* Ranges of the parameters, from a signal table or from ROM. */
#define SLEW_MAX_NPS      10000000
#define SLEW_DOWN_MIN_NPS 1000
#define I_PEAK_MIN_A_Q26  EXH_Q(1, 10, EXH_Q_CUR)
#define I_PEAK_MAX_A_Q26  EXH_Q(66, 10, EXH_Q_CUR)
#define I_CONT_MAX_A_Q26  EXH_Q(33, 10, EXH_Q_CUR)
#define PEAK_MAX_MS       2700
/* A person's limit of 0 N would duplicate f_max = 0. */
#define PERSON_MIN_N_Q20 EXH_Q(1, 8, EXH_Q_FORCE)

const struct exh_signal exh_drive_rows[EXH_DRIVE_ROWS] = {
    {0x0501, EXH_Q_FORCE, EXH_WHEN_LIMIT, 0, EXH_FORCE_MAX_N_Q20, EXH_Q(40, 1, EXH_Q_FORCE),
        "f_max", "n", "force limit"},
    {0x0502, 0, EXH_WHEN_BOUND, 1, SLEW_MAX_NPS, 200000, "slew_up", "n_per_s",
        "fastest rise of force"},
    /* At 1 kN/s the 22 N of a CyberGrasp motor fall to 0 in 22 ms, so release is never slow. */
    {0x0503, 0, EXH_WHEN_BOUND, SLEW_DOWN_MIN_NPS, SLEW_MAX_NPS, 200000, "slew_down", "n_per_s",
        "fastest fall of force"},
    /* Elmo Castanet data sheet: 6.6 A peak for about 2.7 s, 3.3 A continuous. */
    {0x0504, EXH_Q_CUR, EXH_WHEN_SETUP, I_PEAK_MIN_A_Q26, I_PEAK_MAX_A_Q26, I_PEAK_MAX_A_Q26,
        "i_peak", "a", "peak current of the drive"},
    {0x0505, EXH_Q_CUR, EXH_WHEN_SETUP, 0, I_CONT_MAX_A_Q26, I_CONT_MAX_A_Q26, "i_cont", "a",
        "continuous current of the drive"},
    {0x0506, 0, EXH_WHEN_SETUP, 1, PEAK_MAX_MS, PEAK_MAX_MS, "peak_time", "ms",
        "peak current from cold"},
    /* Sensoray 526: offset binary, 3249 codes/V; Castanet: 1.76 A/V, +-3.75 V. */
    {0x0507, 0, EXH_WHEN_PERSON, 0, 65535, 32768, "dac_zero", "", "D/A code of no current"},
    {0x0508, 0, EXH_WHEN_PERSON, 0, 32767, 12184, "dac_span", "", "codes used either side of it"},
    {0x0509, EXH_Q_DAC, EXH_WHEN_PERSON, EXH_Q(1, 1, EXH_Q_DAC), INT32_MAX,
        EXH_Q(324900, 176, EXH_Q_DAC), "dac_scale", "per_a", "D/A codes per ampere"},
    {0x050A, 0, EXH_WHEN_SETUP, -32768, 32767, 0, "mon_zero", "", "monitor code of no current"},
    /* 305.2 uV per code over 0.591 V/A. */
    {0x050B, EXH_Q_MON, EXH_WHEN_SETUP, 1, INT32_MAX, EXH_Q(5164, 10000000, EXH_Q_MON), "mon_scale",
        "a", "ampere per monitor code"},
    {0x050C, EXH_Q_FORCE, EXH_WHEN_PERSON, PERSON_MIN_N_Q20, EXH_FORCE_MAX_N_Q20,
        EXH_Q(40, 1, EXH_Q_FORCE), "person_f", "n",
        "the person's ceiling of force, whatever f_max becomes"},
    {0x050D, EXH_Q_CUR, EXH_WHEN_PERSON, 0, I_PEAK_MAX_A_Q26, I_PEAK_MAX_A_Q26, "person_i", "a",
        "the person's ceiling of current, whatever a force table says"},
};

/* --- set-up --- */

/* Ticks of the longest peak at the highest rate; a timer may exceed the rate by 1000 ppm. */
#define PEAK_TICKS_MAX ((int64_t)PEAK_MAX_MS * 20020 / 1000 + 1)
EXH_STATIC_ASSERT(i2t_has_room,
    ((int64_t)I_PEAK_MAX_A_Q26 >> 10) * (I_PEAK_MAX_A_Q26 >> 10) < INT64_MAX / 2 / PEAK_TICKS_MAX);

/* I2t: heat above i_cont^2, in A^2 ticks with 32 fraction bits. The tick does not multiply by the
 * period. */
static int setup_i2t(
    struct exh_drive_cfg *cfg, const struct exh_drive_par *par, struct exh_period T)
{
    const int64_t peak_A_q16 = par->i_peak_A_q26 >> (EXH_Q_CUR - 16);
    const int64_t cont_A_q16 = par->i_cont_A_q26 >> (EXH_Q_CUR - 16);
    const uint64_t ticks = exh_ticks_in(par->peak_ms, T) + 1;
    const uint64_t excess_q32 = (uint64_t)(peak_A_q16 * peak_A_q16 - cont_A_q16 * cont_A_q16);
    uint64_t knee;

    cfg->i2t_budget_q32 = 0;
    cfg->i2t_shift = 0;
    cfg->i2t_fold.mant = 0;
    cfg->i2t_fold.shift = 1;
    if (excess_q32 == 0) { return 0; }
    cfg->i2t_budget_q32 = (int64_t)(excess_q32 * ticks);
    while (cfg->i2t_budget_q32 >> cfg->i2t_shift > INT32_MAX) { cfg->i2t_shift++; }
    /* Never 0: one LSB of peak above i_cont at i_peak = 0.1 A gives 2^13. */
    knee = (uint64_t)cfg->i2t_budget_q32 >> cfg->i2t_shift >> 2;
    return exh_gain_set(&cfg->i2t_fold, (uint64_t)(par->i_peak_A_q26 - par->i_cont_A_q26), knee);
}

/* Checks that exh_table_setup() has filled the slopes; then the knots rise. */
static int table_ok(struct exh_table t)
{
    for (unsigned i = 0; i + 1 < t.n; i++) {
        if (t.knot[i].slope.mant < INT32_C(1) << 30 || t.knot[i + 1].x <= t.knot[i].x) { return 0; }
    }
    return t.n != 1;
}

/* Parameters in ROM have passed no row check, and a negative span would open the gate. Does not use
 * the rows, since they would link names and help texts. */
static int par_ok(const struct exh_drive_par *par, int monitor)
{
    return exh_inside(par->f_max_N_q20, 0, EXH_FORCE_MAX_N_Q20) &&
           exh_inside(par->slew_up_Nps, 1, SLEW_MAX_NPS) &&
           exh_inside(par->slew_down_Nps, SLEW_DOWN_MIN_NPS, SLEW_MAX_NPS) &&
           exh_inside(par->i_peak_A_q26, I_PEAK_MIN_A_Q26, I_PEAK_MAX_A_Q26) &&
           exh_inside(par->i_cont_A_q26, 0, I_CONT_MAX_A_Q26) &&
           par->i_cont_A_q26 <= par->i_peak_A_q26 && exh_inside(par->peak_ms, 1, PEAK_MAX_MS) &&
           exh_inside(par->dac_zero_raw, 0, UINT16_MAX) &&
           exh_inside(par->dac_span_raw, 0, INT16_MAX) &&
           exh_inside(par->dac_rawpA_q16, EXH_Q(1, 1, EXH_Q_DAC), INT32_MAX) &&
           exh_inside(par->person_N_q20, PERSON_MIN_N_Q20, EXH_FORCE_MAX_N_Q20) &&
           exh_inside(par->person_A_q26, 0, I_PEAK_MAX_A_Q26) &&
           exh_inside(par->mon_zero_raw, INT16_MIN, INT16_MAX) && (!monitor || par->mon_A_q40 > 0);
}

/* The largest whole number of D/A codes within a limit. The gate rounds no current up to it beyond
 * the limit. */
static int32_t whole_codes(const struct exh_drive_cfg *cfg, int32_t limit_A_q26)
{
    const int64_t codes = (int64_t)limit_A_q26 * cfg->par->dac_rawpA_q16 >> (EXH_Q_CUR + EXH_Q_DAC);
    return exh_clamp(exh_gain_floor(cfg->dac_A_q26, (int32_t)codes), 0, limit_A_q26);
}

/* The person's limit, computed once, so that it costs no time in the tick. */
static void setup_top(struct exh_drive_cfg *cfg, const struct exh_drive_par *par)
{
    const int32_t end_N_q20 = cfg->force_to_cur.knot[cfg->force_to_cur.n - 1].x;
    const int cut = par->person_N_q20 < end_N_q20;
    cfg->f_top_N_q20 = cut ? par->person_N_q20 : end_N_q20;
    cfg->top_limit = cut ? EXH_LIMIT_PERSON : EXH_LIMIT_FORCE;
    /* If both give the same code, report i_peak as the limit. */
    cfg->i_top_A_q26 = whole_codes(cfg, par->person_A_q26);
    cfg->i_whole_A_q26 = whole_codes(cfg, par->i_peak_A_q26);
    if (cfg->i_top_A_q26 >= cfg->i_whole_A_q26) { cfg->i_top_A_q26 = par->i_peak_A_q26; }
}

int exh_drive_setup(struct exh_drive_cfg *cfg, const struct exh_drive_par *par, struct exh_period T,
    struct exh_table force_to_cur, struct exh_table cur_to_force)
{
    int err;
    if (!exh_period_ok(T)) { return -EXH_E_RATE; }
    if (!par_ok(par, cur_to_force.n > 0) || force_to_cur.n < 2 || !table_ok(force_to_cur) ||
        !table_ok(cur_to_force)) {
        return -EXH_E_RANGE;
    }
    if (force_to_cur.knot[0].x > 0 || force_to_cur.knot[force_to_cur.n - 1].x <= 0 ||
        exh_table_at(force_to_cur, 0) != 0) {
        return -EXH_E_RANGE;
    }
    cfg->par = par;
    cfg->force_to_cur = force_to_cur;
    cfg->cur_to_force = cur_to_force;
    err = exh_gain_set(&cfg->tick_N_q20, (uint64_t)T.num << EXH_Q_FORCE, T.den);
    if (err == 0) {
        err = exh_gain_set(&cfg->dac_A_q26, UINT64_C(1) << (EXH_Q_CUR + EXH_Q_DAC),
            (uint64_t)(uint32_t)par->dac_rawpA_q16);
    }
    if (err == 0) { setup_top(cfg, par); }
    return err == 0 ? setup_i2t(cfg, par, T) : err;
}

/* --- the tick --- */

/* Gate closed: the slew limit has no force to remember. */
static uint32_t no_force(
    struct exh_drive *s, int64_t asked_N_q20, int32_t small_N_q20, struct exh_force_ledger *f)
{
    /* A force reduced by passivity does not prove that the finger is free. */
    const int64_t law_N_q20 = exh_wrap_diff64(asked_N_q20, f->passivity_N_q20);
    s->force_N_q20 = 0;
    s->fall_N_q20 = 0;
    f->clamp_N_q20 = exh_wrap_diff64(0, asked_N_q20);
    return (asked_N_q20 < 0 ? EXH_LIMIT_PULL : 0u) | (asked_N_q20 > 0 ? EXH_LIMIT_GATE : 0u) |
           (law_N_q20 > small_N_q20 ? EXH_LIMIT_FORCE : 0u);
}

/* Uses the held force only, not the request: a law that lost its inputs must not act. The step is
 * rounded up, so that the last step is not too small. */
static uint32_t release(struct exh_drive *s, int64_t asked_N_q20, const struct exh_permit *permit,
    struct exh_force_ledger *f)
{
    int64_t rest;
    if (s->fall_N_q20 == 0) {
        s->fall_N_q20 = (int32_t)exh_gain_floor(permit->fall, s->force_N_q20) + 1;
    }
    rest = s->force_N_q20 - (int64_t)permit->ticks * s->fall_N_q20;
    s->force_N_q20 = rest > 0 ? (int32_t)rest : 0;
    f->force_N_q20 = s->force_N_q20;
    f->release_N_q20 = exh_wrap_diff64(s->force_N_q20, asked_N_q20);
    return EXH_LIMIT_RELEASE;
}

/* Above any force: a longer step has the same end, and 32 bits suffice. */
#define STEP_MAX_N_Q20 (INT32_C(1) << 30)
EXH_STATIC_ASSERT(no_force_is_beyond_a_step, EXH_FORCE_MAX_N_Q20 < STEP_MAX_N_Q20);

uint32_t exh_drive_force_within(struct exh_drive *s, const struct exh_drive_cfg *cfg,
    const struct exh_permit *permit, struct exh_drive_most own, struct exh_force_ledger *f)
{
    const int64_t asked = exh_wrap_add64(exh_wrap_add64(f->spring_N_q20, f->damper_N_q20),
        exh_wrap_add64(f->pullback_N_q20, f->passivity_N_q20));
    const int32_t top = own.f_max_N_q20 < cfg->f_top_N_q20 ? own.f_max_N_q20 : cfg->f_top_N_q20;
    const int32_t most = (int32_t)((int64_t)top * permit->share_q30 >> 30);
    const int32_t held = exh_clamp(asked, 0, most);
    const int rises = held > s->force_N_q20;
    const int64_t rate =
        exh_gain_mul(cfg->tick_N_q20, rises ? own.slew_up_Nps : cfg->par->slew_down_Nps);
    const int32_t step = exh_clamp(rate, 1, STEP_MAX_N_Q20);
    const int32_t end = exh_wrap_add(s->force_N_q20, rises ? step : -step);
    const int32_t slewed = (held > end) == rises ? end : held; /* the nearer one */
    uint32_t limits = 0;

    f->clamp_N_q20 = f->slew_N_q20 = f->release_N_q20 = 0;
    f->force_N_q20 = 0;
    if (permit->mode == EXH_PERMIT_RELEASE) { return release(s, asked, permit, f); }
    if (permit->mode != EXH_PERMIT_OPEN) { return no_force(s, asked, permit->small_N_q20, f); }
    if (asked < 0) { limits |= EXH_LIMIT_PULL; }
    if (asked > top) {
        limits |= own.f_max_N_q20 > cfg->f_top_N_q20 ? cfg->top_limit : EXH_LIMIT_FORCE;
    }
    if (most < top && asked > most) { limits |= EXH_LIMIT_RAMP; }
    if (slewed != held) { limits |= EXH_LIMIT_SLEW; }
    f->clamp_N_q20 = exh_wrap_diff64(held, asked);
    f->slew_N_q20 = (int64_t)slewed - held;
    f->force_N_q20 = slewed; /* between held and the previous force */
    s->force_N_q20 = f->force_N_q20;
    s->fall_N_q20 = 0;
    return limits;
}

/* The present limit of I2t: i_cont, plus a share of the peak while budget remains. Above the knee,
 * at a quarter of the budget, it is the whole peak. With half left, skip the computation. */
static int32_t i2t_limit(const struct exh_drive *s, const struct exh_drive_cfg *cfg)
{
    if (s->i2t_q32 < cfg->i2t_budget_q32 >> 1) { return cfg->par->i_peak_A_q26; }
    const int32_t span = cfg->par->i_peak_A_q26 - cfg->par->i_cont_A_q26;
    const int64_t left = exh_wrap_diff64(cfg->i2t_budget_q32, s->i2t_q32) >> (cfg->i2t_shift & 63);
    const int64_t extra = exh_gain_mul(cfg->i2t_fold, exh_clamp(left, 0, INT32_MAX));
    return cfg->par->i_cont_A_q26 + exh_clamp(extra, 0, span);
}

/* The current of the code that the gate makes. */
static int32_t coded(const struct exh_drive_cfg *cfg, int32_t cur_A_q26)
{
    const int32_t code =
        (int32_t)exh_mul_shr(cur_A_q26, cfg->par->dac_rawpA_q16, EXH_Q_CUR + EXH_Q_DAC);
    return exh_sat32(exh_gain_mul(cfg->dac_A_q26, code));
}

uint32_t exh_drive_current_step(struct exh_drive *s, const struct exh_drive_cfg *cfg,
    const struct exh_force_ledger *f, struct exh_current_ledger *i)
{
    const int32_t table = exh_table_at(cfg->force_to_cur, f->force_N_q20);
    const int32_t allowed = i2t_limit(s, cfg);
    const int warm = allowed < cfg->par->i_peak_A_q26;
    const int32_t hot = warm ? whole_codes(cfg, allowed) : cfg->i_whole_A_q26;
    /* Without heat both limits are equal; report PEAK. */
    const int32_t drive = warm ? cfg->par->i_peak_A_q26 : hot;
    const int person = cfg->i_top_A_q26 < drive;
    const int32_t top = person ? cfg->i_top_A_q26 : drive;
    const int32_t peak = exh_clamp32(table, -top, top);
    const int32_t now = exh_clamp32(peak, -hot, hot);
    const int32_t now_A_q16 = coded(cfg, now) >> (EXH_Q_CUR - 16);
    const int32_t cont_A_q16 = cfg->par->i_cont_A_q26 >> (EXH_Q_CUR - 16);
    const int64_t heat =
        s->i2t_q32 + (int64_t)now_A_q16 * now_A_q16 - (int64_t)cont_A_q16 * cont_A_q16;
    const int64_t most = exh_wrap_add64(cfg->i2t_budget_q32, cfg->i2t_budget_q32);

    /* One tick may exceed the budget, by at most one tick's heat. The excess counts later. */
    s->i2t_q32 = heat < 0 ? 0 : heat > most ? most : heat;
    i->table_A_q26 = table;
    i->peak_A_q26 = (int64_t)peak - table;
    i->i2t_A_q26 = (int64_t)now - peak;
    i->gate_A_q26 = 0;
    i->dac_A_q26 = 0;
    i->coded_A_q26 = 0;
    return (peak == table ? 0u
               : person   ? EXH_LIMIT_PERSON
                          : EXH_LIMIT_PEAK) |
           (now != peak ? EXH_LIMIT_I2T : 0u);
}

int32_t exh_drive_monitor_A_q26(const struct exh_drive_cfg *cfg, int16_t mon_raw)
{
    return exh_sat32(exh_mul_shr(
        (int32_t)mon_raw - cfg->par->mon_zero_raw, cfg->par->mon_A_q40, EXH_Q_MON - EXH_Q_CUR));
}

int32_t exh_drive_monitor_N_q20(const struct exh_drive_cfg *cfg, int32_t mon_A_q26)
{
    return cfg->cur_to_force.n > 0 ? exh_table_at(cfg->cur_to_force, mon_A_q26) : 0;
}

void exh_drive_serialize(struct exh_bytes *c, struct exh_drive *s)
{
    exh_bytes_i32(c, &s->force_N_q20);
    exh_bytes_i32(c, &s->fall_N_q20);
    exh_bytes_i64(c, &s->i2t_q32);
    /* Damaged bytes: keep the force in range and the heat low enough for sums. */
    s->force_N_q20 = exh_clamp(s->force_N_q20, 0, EXH_FORCE_MAX_N_Q20);
    s->fall_N_q20 = exh_clamp(s->fall_N_q20, 0, EXH_FORCE_MAX_N_Q20 + 1);
    if (s->i2t_q32 < 0 || s->i2t_q32 > INT64_MAX / 2) { s->i2t_q32 = INT64_MAX / 2; }
}
