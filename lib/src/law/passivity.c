/* SPDX-License-Identifier: MIT */
/* Passivity observer and controller of one finger: energy received and returned. */
#include "exhand/passivity.h"

#include "exhand/error.h"
#include "exhand/fix.h"
#include "exhand/units.h"

#define SPEED_MIN_MPS_Q27 EXH_Q(1, 10, EXH_Q_VEL)
#define WAY_MAX_CNT       (INT32_C(1) << 24) /* 10 m/s at 1 Hz and 1 um gives 10^7 */
#define LATE              2
/* 100 N over 10^10 counts: beyond any device, and no sum exceeds 64 bits. */
#define ENERGY_MAX_NCNT_Q20 (INT64_C(1) << 60)

const struct exh_signal exh_passivity_rows[EXH_PASSIVITY_ROWS] = {
    {0x0F01, 0, EXH_WHEN_REST, 0, LATE, LATE, "passivity", "",
        "0 observes, 1 limits, 2 limits with outputs up to a tick late"},
};

/* --- set-up --- */

int exh_passivity_setup(struct exh_passivity_cfg *cfg, const struct exh_passivity_par *par,
    const struct exh_drive_cfg *drive, struct exh_table held, struct exh_velocity_scale scale,
    int32_t speed_mps_q27)
{
    const int32_t most =
        drive->f_top_N_q20 < EXH_FORCE_MAX_N_Q20 ? drive->f_top_N_q20 : EXH_FORCE_MAX_N_Q20;
    struct exh_gain cnt; /* per m/s q27, in a tick */
    int64_t way;

    if (!exh_period_ok(scale.T)) { return -EXH_E_RATE; }
    if (scale.step_m_q42 <= 0 || speed_mps_q27 < SPEED_MIN_MPS_Q27 || held.n < 2 ||
        exh_table_at(held, 0) != 0 ||
        exh_gain_mul(drive->tick_N_q20, drive->par->slew_down_Nps) < most ||
        exh_gain_set(&cnt, (uint64_t)scale.T.num << (EXH_Q_STEP - EXH_Q_VEL),
            (uint64_t)scale.T.den * (uint32_t)scale.step_m_q42) < 0) {
        return -EXH_E_RANGE;
    }
    way = exh_gain_mul(cnt, speed_mps_q27) + 1;
    if (way > WAY_MAX_CNT) { return -EXH_E_RANGE; }
    cfg->par = par;
    cfg->drive = drive->par;
    cfg->f_top_N_q20 = drive->f_top_N_q20;
    cfg->held = held;
    cfg->step_m_q42 = scale.step_m_q42;
    cfg->way_cnt = (int32_t)way;
    cfg->shift = 0;
    while (way * EXH_FORCE_MAX_N_Q20 >> cfg->shift >= INT32_MAX) { cfg->shift++; }
    return exh_gain_set(&cfg->share, UINT64_C(1) << cfg->shift, (uint64_t)way);
}

/* --- the tick --- */

/* Energy between two ticks. Outwards counts the lowest possible force, inwards the highest. */
static void observe(struct exh_passivity *s, int32_t moved_cnt, int touching)
{
    const int32_t held = s->held_N_q20, late = s->late_N_q20;
    const int32_t least = late < held ? late : held, most = late < held ? held : late;
    int64_t e = s->energy_Ncnt_q20 + (int64_t)(moved_cnt < 0 ? most : least) * moved_cnt;

    /* A contact ends with a tick without contact and without force. Its energy does not count for
     * the next one. Debt is cleared when no output can still act. */
    if (held == 0 && (!touching || !s->touching) && (e > 0 || late == 0)) { e = 0; }
    s->energy_Ncnt_q20 = exh_clamp64(e, ENERGY_MAX_NCNT_Q20);
}

/* owed / way, rounded up by less than 3 LSB, never down. */
static int64_t owed_over_way(const struct exh_passivity_cfg *cfg, int64_t owed_Ncnt_q20)
{
    const int32_t x = exh_clamp((owed_Ncnt_q20 >> (cfg->shift & 63)) + 1, 0, INT32_MAX);
    return exh_gain_mul(cfg->share, x) + 1;
}

uint32_t exh_passivity_step(struct exh_passivity *s, const struct exh_passivity_cfg *cfg,
    int32_t cnt, int touching, struct exh_force_ledger *f)
{
    const int32_t most =
        cfg->drive->f_max_N_q20 < cfg->f_top_N_q20 ? cfg->drive->f_max_N_q20 : cfg->f_top_N_q20;
    const int64_t asked = f->spring_N_q20 + f->damper_N_q20;
    int64_t less, limit, over;

    observe(s, s->started ? exh_wrap_diff(cnt, s->cnt) : 0, touching);
    s->cnt = cnt;
    s->touching = touching != 0;
    s->started = 1;

    /* Computed in every tick, since the cost must not depend on the debt. */
    less = owed_over_way(cfg, -s->energy_Ncnt_q20);
    limit = less < most ? most - less : 0;
    over = asked - limit;
    if (s->energy_Ncnt_q20 >= 0 || over <= 0 || cfg->par->on == 0) { return 0; }
    f->passivity_N_q20 = -over;
    return EXH_LIMIT_PASSIVITY;
}

void exh_passivity_update(struct exh_passivity *s, const struct exh_passivity_cfg *cfg,
    const struct exh_force_ledger *f, int32_t coded_A_q26)
{
    const int64_t held = exh_table_at(cfg->held, coded_A_q26) - f->pullback_N_q20;
    const int any = f->force_N_q20 > f->pullback_N_q20; /* else all of it is pull-back */
    const int32_t before = s->held_N_q20;
    s->held_N_q20 = any ? exh_clamp(held, 0, INT32_MAX) : 0;
    s->late_N_q20 = cfg->par->on == LATE ? before : s->held_N_q20;
}

int32_t exh_passivity_J_q24(const struct exh_passivity *s, const struct exh_passivity_cfg *cfg)
{
    return exh_sat32(exh_shr_round(
        exh_mul64_q31(s->energy_Ncnt_q20, cfg->step_m_q42), EXH_Q_FORCE + EXH_Q_STEP - 31 - 24));
}

void exh_passivity_serialize(struct exh_bytes *c, struct exh_passivity *s)
{
    exh_bytes_i64(c, &s->energy_Ncnt_q20);
    exh_bytes_i32(c, &s->held_N_q20);
    exh_bytes_i32(c, &s->late_N_q20);
    exh_bytes_i32(c, &s->cnt);
    exh_bytes_u8(c, &s->touching);
    exh_bytes_u8(c, &s->started);
    /* Damaged bytes: keep sums from overflowing and the force from pushing. */
    s->energy_Ncnt_q20 = exh_clamp64(s->energy_Ncnt_q20, ENERGY_MAX_NCNT_Q20);
    s->held_N_q20 = exh_clamp(s->held_N_q20, 0, INT32_MAX);
    s->late_N_q20 = exh_clamp(s->late_N_q20, 0, INT32_MAX);
    s->touching = s->touching != 0;
}
